"""Makes: their files, what a finger taps on the way to a screen, and what is refused in a file of one's own."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.cockpit import own_make, tree
from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.make import HOME, BarOfMake, Make, OwnScreen, Shelf
from automotive_cosim.cockpit.registry import apps, apps_in
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import FeedbackCode, RoadNetwork
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.errors import UserError
from automotive_cosim.formats.toml import parse
from tests.cockpit.fingers import find, middle
from tests.laws import over

from .conftest import outside

MAKES = [name for name in CarMake if name not in (CarMake.HOME, CarMake.DRAWN)]
FOLDER = files("automotive_cosim.cockpit").joinpath("makes")


def test_every_file_of_the_folder_is_a_make_and_each_is_drawn() -> None:
    assert {file.name for file in FOLDER.iterdir()} == {f"{name}.toml" for name in MAKES}
    assert {CarMake.DRAWN.at(seed) for seed in range(100)} == set(MAKES)
    assert CarMake.DRAWN.at(3) is CarMake.DRAWN.at(3)


@over(MAKES)
def test_what_a_make_names_is_there(name: CarMake) -> None:
    own_make.check(parse(FOLDER.joinpath(f"{name}.toml").read_text("utf-8"), Path(f"{name}.toml")))


@over(MAKES)
def test_the_way_to_every_screen_leads_there(name: CarMake, network: RoadNetwork) -> None:
    make = tree.make_named(name)
    start = Cockpit(network, rng=np.random.default_rng(1), make=make)
    start.sense(outside(speed_kmh=0.0), 0.0)
    for screen in {*apps(), *tree.SUBPAGES, *make.screens} - {app.name for app in apps_in(Where.STORE)}:
        cockpit = start.copy()
        for key in tree.way(make, screen):
            found = find(cockpit, key)
            assert cockpit.tap(*middle(found)).code in (FeedbackCode.OK, FeedbackCode.NO_EFFECT), (screen, key)
        assert cockpit.screen == screen


@over(MAKES)
def test_only_what_stands_in_the_bar_or_the_launcher_opens_by_name(name: CarMake, network: RoadNetwork) -> None:
    make = tree.make_named(name)
    cockpit = Cockpit(network, rng=np.random.default_rng(1), make=make)
    for screen in (*tree.entries(make), *tree.loose(make)):
        assert cockpit.open_app(screen).code is not FeedbackCode.NO_SUCH_ELEMENT
    for screen in make.holders.keys() - tree.opens(make).keys():
        assert cockpit.open_app(screen).code is FeedbackCode.NO_SUCH_ELEMENT
    assert tree.opens(HOME).keys() >= {"climate", "vehicle", "settings"}


BAR = 'bar = { entries = ["home", "apps"] }\n'
TITLED = 'title = ["a", "b", "c", "d"]\nicon = "SEAT"\n'


def menu(name: str, *holds: str) -> str:
    return f"[screens.{name}]\n{TITLED}holds = {[each.strip(chr(34)) for each in holds]}\n"


def shelves(name: str, *controls: str) -> str:
    return f'[screens.{name}]\n{TITLED}shelves = [{{ of = "climate", controls = [{", ".join(controls)}] }}]\n'


WRONG = {
    'bar = { side = "inside" }': "line 1: no side named",
    'bar = { entries = ["home", "aps"] }': "did you mean",
    'bar = { entries = ["home", "map"] }': "lacks home or apps",
    BAR + '[screens.ease]\ntitle = ["a", "b", "c", "d"]\nicon = "SEAT"\nholds = ["seats"]': "line 2",
    BAR + '[screens.apps]\ntitle = ["a", "b", "c", "d"]\nicon = "SEAT"': "holds, of screens, or shelves",
    BAR + '[words]\n"No such words" = ["a", "b", "c", "d"]': "line 3",
    BAR + '[words]\n"Home" = ["a", "b"]': "line 3",
    BAR + '[words]\n"{screen} is shown" = ["a", "b", "c", "d"]': "other fields in braces",
    BAR + '[look.day]\nsurface = "white"': "such as 1A2B3C",
    BAR + '[look.day]\nsurfaces = "FFFFFF"': "did you mean",
    BAR + '[look.icons]\nHOME = "no_such_glyph"': "line 3",
    "[wheels]\ncount = 4": "line 1",
    'bar = { entries = ["home", "apps", "home"] }': "names home twice",
    BAR + menu("a", "b") + menu("b", "a"): "only it leads to",
    BAR + menu("a", "a"): "only it leads to",
    BAR + menu("vehicle", '"A b"') + menu('"A b"', "seats"): "is no name of a screen",
    BAR + menu("vehicle", "seats", "seats"): "names seats twice",
    BAR + shelves("vehicle", '["hvac.front_defroster", "a", "b"]'): "in every language",
    BAR + shelves("vehicle", '["hvac.fan"]', '["hvac.front_defogger"]'): "line 5 [screens.vehicle]: "
    "shelves[0].controls[1][0] no control named 'hvac.front_defogger': did you mean 'hvac.front_defroster'?",
    BAR + shelves("vehicle", '["door.all"]'): "no control named 'door.all'",
}


@over(WRONG.items())
def test_what_is_wrong_in_a_file_is_told_with_its_line(text: str, told: str) -> None:
    with pytest.raises(UserError, match=r"own\.toml") as refused:
        own_make.check(parse(text, Path("own.toml")))
    assert told in str(refused.value)


def test_a_shelf_may_have_what_only_another_part_or_a_moving_car_shows() -> None:
    for of, key in (
        ("doors", "door.driving"),
        ("seats", "seat.passenger.massage"),
        ("outside", "outside.act.hazard"),
    ):
        text = BAR + shelves("vehicle", f'["{key}"]').replace('"climate"', f'"{of}"')
        own_make.check(parse(text, Path("own.toml")))


def test_a_shelf_shows_what_there_is_of_any_part_of_any_screen(network: RoadNetwork) -> None:
    cockpit = Cockpit(network, rng=np.random.default_rng(1))
    cockpit.sense(outside(speed_kmh=0.0), 0.0)
    for of, control in (
        ("climate", "hvac.misspelt"),
        ("seats", "seat.driver"),
        ("map", "map.view"),
        ("media", "media"),
    ):
        place = OwnScreen(("a", "b", "c", "d"), "SEAT", shelves=(Shelf(of, ((control,),)),))
        cockpit.resize(
            ScreenSize.STANDARD, Make(BarOfMake(entries=("home", "apps", "own")), screens={"own": place})
        )
        assert cockpit.visit("own").code is FeedbackCode.OK
        shown = {key_of(one.resource_id) for one in cockpit.elements()}
        assert any(f"{key}.".startswith(f"{control}.") for key in shown) is (of in ("seats", "media")), control
        assert cockpit.visit("home").code is FeedbackCode.OK


def test_a_make_of_ones_own_is_named_by_its_content_and_must_not_change(tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    file.write_text(BAR, encoding="utf-8")
    name = CarMake(own_make.resolved(str(file)))
    assert tree.make_named(name).bar.entries == ("home", "apps")
    file.write_text(BAR + "mirrored = true", encoding="utf-8")
    assert own_make.resolved(str(file)) != name
    tree.make_named.cache_clear()
    with pytest.raises(UserError, match="has changed since the run began"):
        tree.make_named(name)
    assert own_make.resolved("cedar") == "cedar"
