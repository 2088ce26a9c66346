import gzip
import json
import re
import shutil
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from shapely import Polygon

from automotive_cosim.contracts import GroundKind, LimitSource
from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.geo.place import shipped
from automotive_cosim.osm import demand, extract
from automotive_cosim.osm.agreement import of_edges
from automotive_cosim.osm.importer import import_map
from automotive_cosim.osm.report import ImportReport
from automotive_cosim.osm.roads import describe
from automotive_cosim.osm.settings import ImportOptions
from automotive_cosim.scenarios import load
from automotive_cosim.scenarios.check import _place
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.network import Edge, read_network
from automotive_cosim.traffic.stability import HALTED_SHARE_LIMIT, measure
from tests.osm.maps import Map

Imported = tuple[Path, ImportReport]


def _contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def _edges(folder: Path) -> dict[str, Edge]:
    return dict(read_network(next(folder.glob("*.net.xml.gz"))).edges)


def _named(folder: Path, name: str) -> list[Edge]:
    return [edge for edge in _edges(folder).values() if edge.name == name]


@pytest.mark.parametrize("ending", ["", ".gz", ".bz2", ".xml"])
def test_every_format_gives_the_same_network(
    ending: str, formats: dict[str, Path], imported: Imported, quick: ImportOptions, tmp_path: Path
) -> None:
    import_map(formats[ending], tmp_path / "again", quick)
    ours, theirs = _contents(tmp_path / "again"), _contents(imported[0])
    differing = {name for name in ours.keys() | theirs.keys() if ours.get(name) != theirs.get(name)}
    assert differing <= {"import.json", "README.md"}, "only the extract's name and hash may differ"


def test_the_seed_makes_the_traffic(
    formats: dict[str, Path], imported: Imported, quick: ImportOptions, tmp_path: Path
) -> None:
    import_map(formats[".pbf"], tmp_path / "same", quick)
    assert _contents(tmp_path / "same") == _contents(imported[0])
    import_map(formats[".pbf"], tmp_path / "other", replace(quick, seed=1))
    ours, theirs = _contents(tmp_path / "other"), _contents(imported[0])
    assert ours["village.net.xml.gz"] == theirs["village.net.xml.gz"]
    assert ours["village.trips.xml.gz"] != theirs["village.trips.xml.gz"]


def test_the_folder_is_a_scenario(imported: Imported) -> None:
    folder, report = imported
    scenario = load(folder)
    assert scenario.country == "FR"
    assert scenario.sumo.scale == report.scale
    assert str(scenario.start.tzinfo) == "Europe/Paris"
    edges = _edges(folder)
    assert scenario.ego.trips
    assert all({trip.from_edge, trip.to_edge} <= set(edges) for trip in scenario.ego.trips)
    assert len({trip.name for trip in scenario.ego.trips}) == len(scenario.ego.trips)


def test_water_green_and_buildings_are_kept_and_sumo_reads_them(imported: Imported) -> None:
    folder, report = imported
    assert report.ground == {"green": 1, "water": 1, "building": 2}
    assert any(line.startswith("water, green and buildings") for line in report.guessed)
    ground = network_of(load(folder)).map.ground
    assert [area.kind for area in ground] == [*GroundKind, GroundKind.BUILDING]
    sizes_m2 = [Polygon(area.outline_m).area for area in ground]
    assert sizes_m2 == pytest.approx([100.0**2, 60.0**2, 20.0**2, 12.0 * 24.0], rel=0.03)
    done, printed = sumo_programs.run("sumo", ["-c", load(folder).config, "--end", "1", "--no-step-log"])
    assert done, printed


def test_roads_keep_their_names_classes_and_limits(imported: Imported) -> None:
    folder, _ = imported
    main = _named(folder, "Rue de l'Église")
    assert {edge.road_class for edge in main} == {"secondary"}
    assert all(edge.limit_mps == pytest.approx(50 / 3.6, abs=0.01) for edge in main)
    assert all(edge.limit_source is LimitSource.POSTED for edge in main)
    assert any(edge.lit and edge.centre_line is False for edge in main)
    assert {edge.in_tunnel for edge in main} == {True, False}
    tunnel_m = sum(edge.length_m for edge in main if edge.in_tunnel and not edge.edge_id.startswith("-"))
    assert 150 < tunnel_m < 250, "it is 202 m long, and nothing beside it is a tunnel"


def test_a_motorway_without_a_limit_has_none(imported: Imported) -> None:
    motorway = _named(imported[0], "A 99")
    assert {edge.road_class for edge in motorway if edge.limit_mps is None} == {"motorway"}
    assert imported[1].derestricted_km == pytest.approx(sum(edge.length_m for edge in motorway) / 1000, rel=0.05)


def test_a_missing_limit_is_the_countrys_own_and_assumed(imported: Imported) -> None:
    folder, report = imported
    for name, kmh in (("Rue des Prés 1", 50), ("Allée 3", 50), ("Route de Villeneuve-l'Étang", 80)):
        roads = _named(folder, name)
        assert roads
        assert all(edge.limit_source is LimitSource.ASSUMED for edge in roads)
        assert all(edge.limit_mps == pytest.approx(kmh / 3.6, abs=0.01) for edge in roads)
    edges = _edges(folder).values()
    posted_m = sum(edge.length_m for edge in edges if edge.limit_source is LimitSource.POSTED)
    assert report.posted_share == pytest.approx(posted_m / sum(edge.length_m for edge in edges), abs=1e-3)
    assert 0.2 < report.posted_share < 0.8


def test_every_edge_agrees_with_its_way_and_a_changed_one_is_told(
    imported: Imported, formats: dict[str, Path]
) -> None:
    folder, report = imported
    assert report.differences == ()
    roads = describe(extract.read(formats[""]), shipped(), "FR")
    edges = _edges(folder)
    assert not list(of_edges(edges.values(), roads))
    edge = next(edge for edge in edges.values() if edge.name == "Rue du Lavoir")
    for what, wrong in (
        ("limit", replace(edge, limit_mps=50 / 3.6)),
        ("limit", replace(edge, limit_source=LimitSource.ASSUMED)),
        ("name", replace(edge, name="Rue du Four")),
        ("class", replace(edge, road_class="primary")),
        ("tunnel", replace(edge, in_tunnel=True)),
    ):
        assert [found.what for found in of_edges([wrong], roads)] == [what]


def test_a_zone_changes_no_sign_in_the_network(imported: Imported) -> None:
    lane = _named(imported[0], "Rue du Lavoir")
    assert {round((edge.limit_mps or 0) * 3.6) for edge in lane} == {30}
    assert all(edge.built_up for edge in lane), "its zone is urban"


def test_signals_roundabouts_and_oneways_are_there(imported: Imported) -> None:
    folder, report = imported
    assert report.signals == 1
    assert report.roundabouts == 1
    oneway = {edge.edge_id.lstrip("-") for edge in _named(folder, "Allée 3")}
    both = {edge.edge_id for edge in _named(folder, "Allée 1")}
    assert len(oneway) == len(_named(folder, "Allée 3"))
    assert any(edge.startswith("-") for edge in both)


def test_what_cars_may_not_use_is_left_out(imported: Imported) -> None:
    assert not _named(imported[0], "Cour privée")
    assert {edge.road_class for edge in _edges(imported[0]).values()} <= {
        "motorway", "motorway_link", "secondary", "tertiary", "residential"
    }  # fmt: skip


def test_the_report_and_the_attribution_stand_in_the_folder(imported: Imported) -> None:
    folder, report = imported
    told = json.loads((folder / "import.json").read_text(encoding="utf-8"))
    assert told["edges"] == report.edges == len(_edges(folder))
    assert told["tunnels"] == report.tunnels > 0
    assert told["guessed"]
    for name in ("README.md", "import.json", "scenario.toml"):
        text = (folder / name).read_text(encoding="utf-8")
        assert "© OpenStreetMap contributors" in text
        assert "ODbL" in text
    net = gzip.decompress((folder / "village.net.xml.gz").read_bytes()).decode()
    assert str(folder.parent) not in net, "no path of the maker's machine"


def test_the_traffic_stays_stable_beyond_what_the_import_tried(imported: Imported) -> None:
    run = measure(load(imported[0]), observe_s=1200, seed=7)
    assert run.stable, run.problems
    assert run.halted_share_max < HALTED_SHARE_LIMIT
    assert run.vehicles_mean > 5


@pytest.mark.sumo
def test_britain_drives_on_the_left_in_miles(
    make_village: Callable[..., object], quick: ImportOptions, tmp_path: Path
) -> None:
    file = tmp_path / "Little Snoring.osm"
    file.write_text(make_village((-1.5, 52.2)).xml(), encoding="utf-8")  # type: ignore[attr-defined]
    report = import_map(file, tmp_path / "out", quick)
    assert report.country == "GB"
    assert report.left_hand
    network = read_network(tmp_path / "out" / "little_snoring.net.xml.gz")
    assert network.map.left_hand
    street = [edge for edge in network.edges.values() if edge.name == "Rue des Prés 1"]
    assert all(edge.limit_mps == pytest.approx(30 / 2.236936, abs=0.01) for edge in street)


@pytest.mark.sumo
def test_the_country_may_be_given_and_progress_names_every_stage(
    formats: dict[str, Path], quick: ImportOptions, tmp_path: Path
) -> None:
    told: list[tuple[str, float | None]] = []
    options = replace(quick, country="jp", name="somewhere")
    report = import_map(formats[""], tmp_path / "out", options, lambda stage, share: told.append((stage, share)))
    assert report.country == load(tmp_path / "out").country == "JP"
    assert report.left_hand
    assert load(tmp_path / "out").name == "somewhere"
    shares = [share for stage, share in told if "scale 1, in steps of 1 s" in stage and share is not None]
    assert len({stage for stage, _ in told}) >= 4
    assert shares == sorted(shares)
    assert all(0 <= share <= 1 for share in shares)


@pytest.mark.sumo
def test_a_folder_is_replaced_only_if_asked_and_only_a_scenarios(
    formats: dict[str, Path], imported: Imported, quick: ImportOptions, tmp_path: Path
) -> None:
    other = tmp_path / "letters"
    other.mkdir()
    (other / "love.txt").write_text("dear")
    for options in (quick, replace(quick, replaces=True)):
        with pytest.raises(UserError, match="--out"):
            import_map(formats[""], other, options)
    assert _contents(other) == {"love.txt": b"dear"}
    scenario = tmp_path / "scenario"
    shutil.copytree(imported[0], scenario)
    (scenario / "note.txt").write_text("old")
    with pytest.raises(UserError, match="--force"):
        import_map(formats[""], scenario, quick)
    import_map(formats[""], scenario, replace(quick, replaces=True))
    assert not (scenario / "note.txt").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["letters", "scenario"]


@pytest.mark.sumo
@pytest.mark.parametrize("failure", [KeyboardInterrupt(), OSError(28, "No space left on device"), UserError("no")])
def test_a_failed_import_leaves_nothing_and_harms_nothing(
    failure: BaseException,
    formats: dict[str, Path],
    imported: Imported,
    quick: ImportOptions,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    out = tmp_path / "village"
    shutil.copytree(imported[0], out)
    before = _contents(out)

    def fail(*_: object, **__: object) -> None:
        raise failure

    monkeypatch.setattr(demand, "write", fail)
    for options, target in ((replace(quick, replaces=True), out), (quick, tmp_path / "new")):
        with pytest.raises((UserError, KeyboardInterrupt)):
            import_map(formats[""], target, options)
    assert _contents(out) == before
    assert [path.name for path in tmp_path.iterdir()] == ["village"]


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize("later_s", [0.0, 0.3])
def test_however_often_it_is_terminated_an_import_leaves_nothing(
    later_s: float, formats: dict[str, Path], tmp_path: Path, program, until
) -> None:
    code = "from automotive_cosim.cli.main import main; main()"
    importing = program(
        sys.executable, "-c", code, "scenarios", "import", formats[""], "--out", tmp_path / "village"
    )
    until(lambda: importing.poll() is not None or list(tmp_path.glob(".village-*")))
    time.sleep(later_s)
    while importing.poll() is None:
        importing.send_signal(signal.SIGTERM)
        time.sleep(0.001)
    if importing.returncode == 0:  # on a busy machine, it was over before it was told
        assert [path.name for path in tmp_path.iterdir()] == ["village"]
        return
    assert importing.returncode in (143, -signal.SIGTERM)  # the same to a shell; the latter as the interpreter ends
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_cannot_be_written_is_refused(formats: dict[str, Path], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    for out in (tmp_path / "file" / "village", tmp_path / "missing" / "village"):
        with pytest.raises(UserError, match="choose another --out") as refused:
            import_map(formats[""], out)
        assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "options",
    [
        ImportOptions(country="France"),
        ImportOptions(country="XX"),
        ImportOptions(name="../elsewhere"),
        ImportOptions(density_per_km=0.0),
        ImportOptions(density_per_km=float("nan")),
        pytest.param(ImportOptions(density_per_km=1e-9), marks=pytest.mark.sumo),
        ImportOptions(density_per_km=1e9),
        ImportOptions(seed=-1),
    ],
)
def test_an_impossible_option_is_refused(options: ImportOptions, formats: dict[str, Path], tmp_path: Path) -> None:
    with pytest.raises(UserError) as refused:
        import_map(formats[""], tmp_path / "out", options)
    assert "\n" not in str(refused.value)
    assert not list(tmp_path.iterdir())


@pytest.mark.sumo
def test_a_map_without_a_drivable_road_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "dot.osm"
    file.write_text(
        '<osm version="0.6"><node id="1" lat="48" lon="2"/><node id="2" lat="48" lon="2"/>'
        '<way id="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/></way></osm>'
    )
    with pytest.raises(UserError, match=r"no drivable road|larger extract"):
        import_map(file, tmp_path / "out")
    assert [path.name for path in tmp_path.iterdir()] == ["dot.osm"]


def test_without_eclipse_sumo_the_mend_is_named(
    formats: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(name: str) -> None:
        raise sumo_programs.PackageNotFoundError(name)

    monkeypatch.setattr(sumo_programs, "distribution", missing)
    with pytest.raises(SetupError, match=re.escape(install_hint("maps"))):
        import_map(formats[""], tmp_path / "out")
    assert not list(tmp_path.iterdir())


@pytest.mark.proof
@pytest.mark.sumo
def test_western_paris_is_imported_and_flows_with_a_seed_nobody_tried(
    data_of_others: Callable[[str], Path], tmp_path: Path
) -> None:
    extract = data_of_others("paris_16e_etoile/paris_16e_etoile.osm.xml.gz")
    report = import_map(extract, tmp_path / "etoile", ImportOptions(quick=True))
    scenario = load(tmp_path / "etoile")
    assert report.country == "FR"
    assert report.posted_share > 0.9
    assert report.tunnels > 20
    assert report.signals > 100
    assert report.stability.stable
    assert report.stability.observed_s > 590
    names = {edge.name for edge in _edges(scenario.folder).values()}
    assert {"Quai d'Orsay", "Avenue Foch", "Avenue d'Iéna"} <= names
    tunnels_m = report.tunnel_km * 1000
    assert 3000 < tunnels_m < 4500, "the map's own tunnel ways, not stretched by merging"
    wrong = [found for found in report.differences if "lanes" not in found]
    assert not wrong, "netconvert widens some roads at ramps, and changes nothing else"
    run = measure(scenario, observe_s=600, seed=12345)
    assert run.halted_share_max < HALTED_SHARE_LIMIT
    assert run.vehicles_mean > 50


def test_a_map_over_the_180th_meridian_is_refused_with_the_cure(
    make_village: Callable[..., Map], tmp_path: Path
) -> None:
    made = make_village((179.99, -17.0))
    made.nodes |= {"far": (3000.0, 0.0)}
    text = re.sub(r'lon="(18[0-9.]+)"', lambda lon: f'lon="{float(lon[1]) - 360:.7f}"', made.xml())
    source = tmp_path / "fiji.osm"
    source.write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match=r"180th meridian.*--bbox 0,-90,180,90"):
        import_map(source, tmp_path / "out")


def test_check_finds_a_network_on_the_wrong_side(imported: Imported) -> None:
    scenario = load(imported[0])
    network = network_of(scenario)
    assert _place(scenario, network).ok
    mirrored = replace(network, map=replace(network.map, left_hand=True))
    found = _place(scenario, mirrored)
    assert not found.ok
    assert "traffic keeps left in the network, not in FR" in found.detail
