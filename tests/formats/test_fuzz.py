"""Whatever a file of others holds, it is read, or refused in one line: cut, with flipped bits, with parts swapped,
and grown from the grammars of its format. That costs neither much time nor much memory."""

import gzip
import json
import re
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.vendor.pretty import RepresentationPrinter

from automotive_cosim import scenarios
from automotive_cosim.agents.answer import read as read_answer
from automotive_cosim.agents.memory import Memory, Strategy
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import ActionType
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.geo.rulefile import read_jurisdiction
from automotive_cosim.interface.spaces import action_space, decode_action
from automotive_cosim.models.replay import Replay
from automotive_cosim.osm import extract
from automotive_cosim.run.moments import Judged, judged_file, read_judged
from automotive_cosim.run.plan import make_plan, read_plan
from automotive_cosim.run.road import read_record
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.script import read_script
from automotive_cosim.run.store import read_evaluation, read_rows, read_trace, write_trace
from automotive_cosim.scenarios import open_scenario

GRID = scenarios.load("grid").folder
QUICK = settings(max_examples=30, database=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
LONGEST = 600
"""Characters of a refusal."""

OSM = (
    '<?xml version="1.0"?><osm version="0.6"><node id="1" version="1" lat="48.1" lon="2.1"/>'
    '<node id="2" version="1" lat="48.2" lon="2.2"><tag k="highway" v="speed_camera"/></node>'
    '<way id="3" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/>'
    '<tag k="maxspeed" v="50"/></way><relation id="4" version="1"><member type="way" ref="3" role="from"/>'
    '<tag k="restriction" v="no_u_turn"/></relation></osm>'
)
OVERPASS = json.dumps(
    {
        "version": 0.6,
        "elements": [
            {"type": "node", "id": 1, "lat": 48.1, "lon": 2.1},
            {"type": "node", "id": 2, "lat": 48.2, "lon": 2.2, "tags": {"highway": "speed_camera"}},
            {"type": "way", "id": 3, "nodes": [1, 2], "tags": {"highway": "residential", "maxspeed": "50"}},
            {"type": "way", "id": 4, "nodes": [1, 2], "geometry": [{"lat": 48.1, "lon": 2.1}, None],
             "tags": {"highway": "primary"}},
            {"type": "relation", "id": 5, "members": [{"type": "way", "ref": 3, "role": "from"}],
             "tags": {"restriction": "no_u_turn"}},
        ],
    }
)  # fmt: skip
CONFIGURATION = (
    '<configuration><input><net-file value="grid.net.xml"/><route-files value="grid.rou.xml"/>'
    '<additional-files value="x.add.xml"/></input><time><begin value="36000"/><step-length value="0.5"/></time>'
    '<processing><scale value="1.5"/></processing></configuration>'
)
ADDITIONAL = (
    '<additional><e1Detector id="d" lane="c1c2_0" pos="50" period="60" file="x.xml"/>'
    '<vType id="t"><param key="device.rerouting.probability" value="1"/></vType></additional>'
)
PLAN = 'agents = ["oracle"]\nseeds = [0, 1]\nrepeats = 2\n[limits]\nsteps = 5\nsim_s = 60.0\n'
ACTIONS = '{"action_type": "click", "x": 3, "y": 4}\n{"action_type": "wait", "seconds": 2}\n'
COUNTS = "site,hour,vehicles_per_hour,edge\n" + "".join(f"a,{hour},{100 + hour},e\n" for hour in range(24))
ROW = {"id": "a", "task": "hvac_fan_max", "half": "first", "pair": "", "dimension": "explicit_control",
       "module": "hvac", "scenario": "grid", "agent": "oracle", "model": "none", "conditions": {"geo": "full"},
       "seed": 0, "repeat": 0}  # fmt: skip
ANSWER = {"text": "a", "tokens_in": 1, "tokens_out": 1, "cost_usd": 0.0}
ROAD = (
    {"format": 1},
    {"lanes": [["road", 3.2, [0.0, 1.0, 2.0, 3.0], [["c1", 0]]]]},
    {"junctions": [[0.0, 1.0, 2.0, 3.0]]},
    {"vehicles": [[0, "ego", "passenger", 4.5, 1.8]]},
    {"at_s": 0.0, "seen": [[0, 1.0, 2.0, 90.0, 13.9, 0]], "lights": {"c1": "G"}, "incidents": [], "sun_deg": 30.0},
)
STEP = {"stages": [{"asked": "x", "pictures": False, "reply": ANSWER}]}


@dataclass(frozen=True)
class Kind:
    """One kind of file: a good one, and what reads it."""

    path: Path
    good: bytes
    read: Callable[[], object]

    def _repr_pretty_(self, printer: RepresentationPrinter, cycle: bool) -> None:
        """Its name only: Hypothesis prints the arguments of what failed, and its warning of long ones is an error
        here, which hides the failure and, before the last draw, looks as if draws depended on something else."""
        printer.text(self.path.name)


def _kinds(folder: Path) -> Iterator[tuple[str, Kind]]:
    def kind(name: str, good: str | bytes, read: Callable[[Path], object]) -> tuple[str, Kind]:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        data = good.encode() if isinstance(good, str) else good
        path.write_bytes(data)
        return name, Kind(path, data, lambda: read(path))

    town = folder / "town"
    shutil.copytree(GRID, town)
    (town / "x.add.xml").write_text(ADDITIONAL)
    toml = (town / "scenario.toml").read_text()
    (town / "whole.sumocfg").write_text(CONFIGURATION)
    yield kind("map.osm", OSM, extract.read)
    yield kind("map.osm.gz", gzip.compress(OSM.encode()), extract.read)
    yield kind("map.json", OVERPASS, extract.read)
    yield kind("town/scenario.toml", toml, lambda path: scenarios.load(path.parent))
    yield kind("town/x.sumocfg", CONFIGURATION, open_scenario)
    yield kind("town/x.add.xml", ADDITIONAL, lambda _: open_scenario(town / "whole.sumocfg"))
    rules = (Path(scenarios.__file__).parents[1] / "geo" / "data" / "FR.toml").read_text()
    yield kind("FR.toml", rules, read_jurisdiction)
    yield kind("plan.toml", PLAN, lambda path: make_plan(read_plan(path)))
    yield kind("actions.jsonl", ACTIONS, read_script)
    if find_spec("automotive_cosim.studies"):
        from automotive_cosim.studies.calibration.counts import read_counts

        yield kind("counts.csv", COUNTS, lambda path: read_counts(path, ZoneInfo("Europe/Paris")))
    yield kind("answers/steps.jsonl", json.dumps(STEP), lambda path: Replay.read(path.parent))
    results = folder / "results"
    manifest = json.dumps({"format": 1, "plan": {"agents": ["oracle"]}, "starts": []})
    yield kind("results/manifest.json", manifest, lambda _: make_plan(read_evaluation(results)["plan"]))
    yield kind("results/episodes.jsonl", json.dumps(ROW) + "\n", lambda _: read_rows(results, EpisodeRow))
    write_trace(results, "a", [{"step": 0, "time_s": 0.0}, {"result": {}}])
    yield kind(
        "results/traces/a.jsonl.gz",
        (results / "traces/a.jsonl.gz").read_bytes(),
        lambda _: read_trace(results, "a"),
    )
    road = "".join(f"{json.dumps(line)}\n" for line in ROAD)
    yield kind("road.jsonl.gz", gzip.compress(road.encode()), read_record)
    judged_file(results, "a").parent.mkdir(parents=True, exist_ok=True)
    name = str(judged_file(results, "a").relative_to(folder))
    yield kind(
        name,
        json.dumps({"classes": [], "pool": [], "value": ["d", []]}),
        lambda _: read_judged(results, "a", Judged),
    )
    Memory(folder / "memory.db").keep(Strategy("P", "open the map", "now", "click"), worked=True)
    data = (folder / "memory.db").read_bytes()
    yield kind("memory.db", data, lambda path: Memory(path).recall("P", "open the map"))


@pytest.fixture(scope="module")
def kinds(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Kind]:
    return dict(_kinds(tmp_path_factory.mktemp("files")))


NAMES = (
    "map.osm", "map.osm.gz", "map.json", "town/scenario.toml", "town/x.sumocfg", "town/x.add.xml", "FR.toml",
    "plan.toml", "actions.jsonl", "counts.csv", "answers/steps.jsonl", "results/manifest.json",
    "results/episodes.jsonl", "results/traces/a.jsonl.gz", "memory.db",
    "road.jsonl.gz",
)  # fmt: skip


def _accepted_or_refused(kind: Kind, data: bytes) -> None:
    kind.path.write_bytes(data)
    try:
        kind.read()
    except UserError as error:
        for line in error.args:
            assert 0 < len(str(line)) < LONGEST
            assert "\n" not in str(line).strip()
    finally:
        kind.path.write_bytes(kind.good)


@pytest.mark.parametrize("name", NAMES)
def test_the_good_file_is_read(kinds: dict[str, Kind], name: str) -> None:
    kinds[name].read()


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@QUICK
@given(data=st.data())
def test_a_damaged_file_is_read_or_refused(kinds: dict[str, Kind], name: str, data: st.DataObject) -> None:
    good = kinds[name].good
    is_inside = name.endswith(".gz") and data.draw(st.booleans())
    good = gzip.decompress(good) if is_inside else good
    place = st.integers(0, len(good) - 1)
    broken = bytearray(good)
    match data.draw(st.sampled_from(["cut", "flipped", "swapped", "repeated", "other"])):
        case "cut":
            broken = broken[: data.draw(place)]
        case "flipped":
            for _ in range(data.draw(st.integers(1, 4))):
                broken[data.draw(place)] ^= 1 << data.draw(st.integers(0, 7))
        case "swapped":
            first, middle, last = sorted(data.draw(st.lists(place, min_size=3, max_size=3)))
            broken = bytearray(good[:first] + good[middle:last] + good[first:middle] + good[last:])
        case "repeated":
            first, last = sorted((data.draw(place), data.draw(place)))
            broken = bytearray(good[:last] + good[first:last] * data.draw(st.integers(1, 30)) + good[last:])
        case _:
            broken = bytearray(kinds[data.draw(st.sampled_from(NAMES))].good)
    _accepted_or_refused(kinds[name], gzip.compress(broken, 1) if is_inside else bytes(broken))


ROUGH = st.sampled_from(
    ["nan", "-nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "9" * 400, "-1", "0", "", " ", "\u0661",
     "0x10", "1_0", "true", "null", "[]", "{}", "/dev/zero", "../../etc/passwd", "\u202e", "\\u001b[2J",
     "9999-12-31T23:59:59", "a,b", "nan,nan", "é" * 300]
)  # fmt: skip
NUMBER = re.compile(rb'(?<=[" :=\[,])-?\d+(\.\d+)?(?=["\s,}\]])|(?<=")[^"<>\n]{1,40}(?=")')


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if not name.endswith(".db")])
@QUICK
@given(place=st.integers(0, 10**6), rough=ROUGH | st.text(st.characters(codec="utf-8"), max_size=20))
def test_any_value_anywhere_is_read_or_refused(kinds: dict[str, Kind], name: str, place: int, rough: str) -> None:
    is_packed = name.endswith(".gz")
    good = gzip.decompress(kinds[name].good) if is_packed else kinds[name].good
    spans = [found.span() for found in NUMBER.finditer(good)]
    first, last = spans[place % len(spans)]
    rough_one = good[:first] + rough.encode() + good[last:]
    _accepted_or_refused(kinds[name], gzip.compress(rough_one, 1) if is_packed else rough_one)


XML = st.recursive(
    st.sampled_from(
        ["<node/>", '<node id="1" lat="1" lon="1"/>', "<way/>", "text", "<!-- c -->", "<?p?>",
         "<![CDATA[x]]>", "&amp;", '<net-file value="grid.net.xml"/>', '<begin v="1:2:3"/>', "<e1Detector/>",
         '<param key="device.x" value="1"/>',
         '<include href="x.add.xml"/>', '<vType id="é"/>', '<edge id="e"><lane/></edge>',
         '<location netOffset=","/>']
    ),
    lambda inner: st.builds(
        lambda tag, parts: f"<{tag}>{''.join(parts)}</{tag}>",
        st.sampled_from(["osm", "configuration", "additional", "routes", "net", "edge", "input", "metadata"]),
        st.lists(inner, max_size=4),
    ),
    max_leaves=12,
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", ["map.osm", "town/x.sumocfg", "town/x.add.xml"])
@QUICK
@given(text=XML)
def test_any_xml_is_read_or_refused(kinds: dict[str, Kind], name: str, text: str) -> None:
    _accepted_or_refused(kinds[name], text.encode())


@pytest.mark.slow
@QUICK
@given(data=st.data(), rough=ROUGH)
def test_a_network_with_any_value_anywhere_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, rough: str
) -> None:
    good = (GRID / "grid.net.xml").read_bytes()
    spans = [found.span() for found in re.finditer(rb'(?<=")[^"<>]*(?=")', good)]
    first, last = data.draw(st.sampled_from(spans))
    path = tmp_path_factory.getbasetemp() / "rough.net.xml"
    value = rough.replace('"', "").replace("<", "").replace("&", "")
    _accepted_or_refused(Kind(path, good, lambda: open_scenario(path)), good[:first] + value.encode() + good[last:])


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**400), 10**400) | st.floats() | st.text(max_size=6),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=6,
)


FIELDS = "index x y text seconds speed_kmh destination direction on app_name".split()  # noqa: SIM905


@pytest.mark.slow
@settings(max_examples=60)
@given(kind=st.sampled_from(ActionType), fields=st.dictionaries(st.sampled_from(FIELDS), JSON, max_size=3))
def test_any_action_is_read_or_refused(kind: ActionType, fields: dict[str, object]) -> None:
    text = json.dumps({"action_type": str(kind)} | fields)
    for read in (lambda: parse(text), lambda: read_answer(f"Action: {text}")):
        try:
            read()
        except ActionError as error:
            assert "\n" not in str(error)
            assert len(str(error)) < LONGEST


SPACE = action_space(100, 100)


@pytest.mark.slow
@settings(max_examples=60)
@given(
    name=st.sampled_from(sorted(SPACE)),
    value=JSON | st.integers(-3, 99),
    kind=st.integers(-1, len(ActionType)),
    seed=st.integers(0, 2**31),
)
def test_any_action_of_a_space_is_read_or_refused(name: str, value: object, kind: int, seed: int) -> None:
    SPACE.seed(seed)
    sample = {**SPACE.sample(), "action_type": kind, name: value}
    try:
        decode_action(sample)
    except ActionError as error:
        assert "\n" not in str(error)
        assert len(str(error)) < LONGEST
    sample = SPACE.sample()
    sample.pop(name)
    with pytest.raises(ActionError, match="lacks"):
        decode_action(sample)


@pytest.mark.slow
@QUICK
@given(row=st.tuples(*[st.none() | st.binary(max_size=3) | st.text(max_size=5) | st.integers(-9, 2**63 - 1)] * 6))
def test_any_row_of_a_memory_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, row: tuple[object, ...]
) -> None:
    path = tmp_path_factory.getbasetemp() / "rough.db"
    path.unlink(missing_ok=True)
    file = sqlite3.connect(path)
    file.execute("CREATE TABLE strategies (place, goal, trigger, steps, worked, failed, used)")
    file.execute("INSERT INTO strategies VALUES (?, ?, ?, ?, ?, ?, 1)", row)
    file.commit()
    file.close()
    try:
        Memory(path).recall("P", "open the map")
    except UserError as error:
        assert "\n" not in str(error)


# --- memory and time -------------------------------------------------------------------------------------------

MEMORY_BYTES = 2**30
SECONDS = 20
CHILD = """
import resource, sys
from pathlib import Path
from zoneinfo import ZoneInfo
from automotive_cosim.errors import UserError
from automotive_cosim.osm import extract
from automotive_cosim.run.store import read_trace
from automotive_cosim.scenarios import open_scenario
resource.setrlimit(resource.RLIMIT_DATA, ({memory}, {memory}))
resource.setrlimit(resource.RLIMIT_CPU, ({seconds}, {seconds}))
for name in sys.argv[1:]:
    path = Path(name)
    try:
        if path.suffix == ".csv":
            from automotive_cosim.studies.calibration.counts import read_counts
            read_counts(path, ZoneInfo("UTC"))
        elif "traces" in name:
            read_trace(path.parents[1], "a")
        elif ".osm" in name:
            extract.read(path)
        else:
            open_scenario(path)
    except UserError as error:
        print(error)
"""


@pytest.mark.slow
def test_bombs_and_endless_files_cost_neither_time_nor_memory(tmp_path: Path) -> None:
    blank = gzip.compress(b" " * 2**20)
    (tmp_path / "traces").mkdir()
    for name, begin in (
        ("a.net.xml.gz", b"<net>"), ("a.osm.gz", b"<osm version='0.6'>"), ("a.csv", b"hour,vehicles_per_hour\n"),
        ("traces/a.jsonl.gz", b"{"),
    ):  # fmt: skip
        (tmp_path / name).write_bytes(gzip.compress(begin) + blank * 1500)
    (tmp_path / "a.sumocfg").write_text('<configuration><net-file value="/dev/zero"/></configuration>')
    names = ("a.net.xml.gz", "a.osm.gz", "a.csv", "traces/a.jsonl.gz", "a.sumocfg")
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            CHILD.format(memory=MEMORY_BYTES, seconds=SECONDS),
            *(tmp_path / name for name in names),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr  # within the limits that the child has set for itself
    refusals = done.stdout.splitlines()
    assert len(refusals) == len(names), done.stdout
    assert all("unpacks to over" in line or "longer than" in line for line in refusals[:4]), done.stdout
