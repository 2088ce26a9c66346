"""Pictures of scenarios: everything that is declared is drawn, and names and signs lie clear of each other."""

from collections import Counter
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageOps

from automotive_cosim import scenarios
from automotive_cosim.cockpit import theme
from automotive_cosim.cockpit.theme import DAY, Weight, can_set, face
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.scenarios import Ego, Trip, open_scenario
from automotive_cosim.scenarios.labels import Labels, place_labels
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.scenarios.picture import ASPECTS, Viewport, draw_scenario, save_picture, trip_colour

GRID = scenarios.load("grid")


def _colours(picture: Image.Image) -> Counter[tuple[int, ...]]:
    packed = np.asarray(picture).astype(np.int32) @ (1 << 16, 1 << 8, 1)
    values, counts = np.unique(packed, return_counts=True)
    return Counter(
        {(v >> 16, v >> 8 & 255, v & 255): n for v, n in zip(values.tolist(), counts.tolist(), strict=True)}
    )


@pytest.mark.parametrize("name", scenarios.shipped())
def test_every_shipped_scenario_has_its_picture(name: str) -> None:
    folder = scenarios.load(name).folder
    with Image.open(folder / "map.webp") as shipped:
        assert shipped.format == "WEBP"
        assert shipped.size == draw_scenario(open_scenario(name))[0].size, "render it again"
    assert (folder / "map.webp").stat().st_size < 150_000
    assert "(map.webp)" in (folder / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["grid", "border", "gulf"])
def test_all_roads_lie_on_the_map(name: str) -> None:
    network = network_of(scenarios.load(name))
    frame = Viewport.around(network.edges.values())
    assert ASPECTS[0] - 0.01 <= frame.width / frame.height <= ASPECTS[1] + 0.01
    for edge in network.edges.values():
        pixels = frame.pixels(edge.shape_m)
        assert pixels.min() >= 0
        assert np.all(pixels <= (frame.width, frame.height))


@pytest.mark.slow
def test_every_trip_and_road_class_shows() -> None:
    seen = _colours(draw_scenario(scenarios.load("paris_centre"))[0])
    for number in range(len(scenarios.load("paris_centre").ego.trips)):
        assert seen[trip_colour(number)] > 500
    for colour in (DAY.motorway, DAY.avenue, DAY.street):
        assert seen[colour] > 1000


def test_the_same_scenario_is_drawn_the_same() -> None:
    assert draw_scenario(GRID)[0].tobytes() == draw_scenario(GRID)[0].tobytes()


@pytest.mark.parametrize("name", ["paris_centre", "london"])
def test_names_and_signs_do_not_cover_each_other(name: str) -> None:
    network = network_of(scenarios.load(name))
    frame = Viewport.around(network.edges.values())
    labels = Labels(Image.new("RGB", (frame.width, frame.height)), frame.pixels)
    place_labels(labels, network)
    assert len(labels.taken) > 40
    assert not any(a.intersects(b) for a, b in combinations(labels.taken, 2))


@pytest.mark.parametrize(
    ("name", "has"),
    [
        ("Λεωφόρος Συγγρού", True),
        ("Невский проспект", True),
        ("銀座通り", True),
        ("中关村大街", True),
        ("세종대로", True),
        ("شارع الشيخ زايد", True),
        ("דרך בגין", True),
        ("ถนนสุขุมวิท", False),
    ],
)
def test_a_name_is_drawn_in_its_letters_or_told(name: str, has: bool) -> None:
    network = network_of(GRID)
    longest = max(network.edges.values(), key=lambda edge: edge.length_m)
    street = {longest.edge_id: replace(longest, name=name)}
    frame = Viewport.around(network.edges.values())
    blank = Image.new("RGB", (frame.width, frame.height))
    labels = Labels(blank.copy(), frame.pixels)
    place_labels(labels, replace(network, edges=street))
    assert can_set(name, Weight.MEDIUM, 14) is has
    assert labels.unwritten == ([] if has else [name])
    unnamed = Labels(blank.copy(), frame.pixels)
    place_labels(unnamed, replace(network, edges={longest.edge_id: replace(longest, name="")}))
    assert (labels.picture.tobytes() != unnamed.picture.tobytes()) is has


def _ink(text: str) -> Image.Image:
    picture = Image.new("L", (100, 60))
    ImageDraw.Draw(picture).text((0, 0), text, 255, face(text, Weight.MEDIUM, 40))
    return picture


def test_arabic_and_hebrew_are_joined_and_set_from_the_right() -> None:
    pytest.importorskip("matplotlib", reason="its fonts are those of Arabic and Hebrew")
    joined = face("شارع", Weight.MEDIUM, 40)
    assert joined.getlength("شارع") < sum(map(joined.getlength, "شارع"))
    assert ImageOps.crop(_ink("אב"), (0, 0, 80, 0)).tobytes() == ImageOps.crop(_ink("ב"), (0, 0, 80, 0)).tobytes()


def test_without_their_fonts_such_names_are_told_and_nothing_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(theme, "sets_right_to_left", lambda: False)
    assert not can_set("شارع", Weight.MEDIUM, 14)
    assert face("شارع", Weight.MEDIUM, 14).getlength("شارع") > 0


@pytest.mark.parametrize("ends", [("cwc0", "nowhere"), ("nowhere", "cwc0")])
def test_a_trip_without_a_way_is_named(ends: tuple[str, str]) -> None:
    lost = replace(GRID, ego=Ego((Trip("lost", *ends),)))
    with pytest.raises(ScenarioError, match="'lost'"):
        draw_scenario(lost)


@pytest.mark.parametrize("ending", [".png", ".webp"])
def test_a_picture_is_saved_whole(tmp_path: Path, ending: str) -> None:
    save_picture(GRID, tmp_path / "new" / f"grid{ending}")
    with Image.open(tmp_path / "new" / f"grid{ending}") as picture:
        picture.load()
    assert [path.name for path in (tmp_path / "new").iterdir()] == [f"grid{ending}"]


def test_a_place_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(UserError, match="cannot write"):
        save_picture(GRID, tmp_path / "file" / "grid.webp")
