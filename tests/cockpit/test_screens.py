"""Laws of every screen: what is listed is drawn, can be read, and can be touched."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from automotive_cosim.cockpit import accessibility
from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.map.state import Navigation
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.figure import SENTENCES
from automotive_cosim.cockpit.apps.safety.commands import WarnDriver
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.drawing import Ink
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat
from automotive_cosim.cockpit.registry import apps_in, pages
from automotive_cosim.cockpit.render import render
from automotive_cosim.cockpit.signals import ACTUATORS, difference
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.theme import TOUCH, Colour
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.cockpit.widgets import Rows, Screen, Slider
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    Answer,
    Connectivity,
    Direction,
    FeedbackCode,
    GpsFix,
    Reroute,
    RoadNetwork,
    Severity,
    Surroundings,
    Weather,
)
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.contracts.ids import resource_id as shown_id
from tests.cockpit.fingers import find, middle, press
from tests.laws import hold, over

Make = Callable[..., Cockpit]
DOES = (FeedbackCode.OK, FeedbackCode.READ_OUT, FeedbackCode.REFUSED)


def busy(cockpit: Cockpit) -> Cockpit:
    """With all on that takes room: notice, history, lamps, long names."""
    cockpit.alert(Alert(AlertKind.CORRIDOR, Severity.CRITICAL, "", 20.0))
    cockpit.alert(Alert(AlertKind.YIELD, Severity.WARNING))
    cockpit.hazards(True)
    cockpit.visit("vehicle")
    for key in ("lights.switch.low_beam", "lights.high_beam", "lights.front_fog", "lights.rear_fog"):
        press(cockpit, key)
    return cockpit


FULL = (
    Occupant(Seat.PASSENGER, Kind.ELDERLY, 128.0, asleep=True),
    Occupant(Seat.REAR_LEFT, Kind.BABY),
    Occupant(Seat.REAR_MIDDLE, Kind.OBJECT, 3.5, belted=False),
    Occupant(Seat.REAR_RIGHT, Kind.PET, belted=False),
)


def _speaking(language: str) -> dict[str, str]:
    return {"Vehicle.Cabin.Infotainment.HMI.CurrentLanguage": language}


CASES: dict[str, Callable[[Make, Surroundings], Cockpit]] = {
    "day": lambda make, o: make(surroundings=o),
    "night": lambda make, o: make(surroundings=replace(o, sun_elevation_deg=-20.0)),
    "busy": lambda make, o: busy(make(surroundings=replace(o, sun_elevation_deg=-20.0))),
    "busy by day": lambda make, o: busy(make(surroundings=o, aboard=FULL)),
    "parked": lambda make, o: make(
        surroundings=replace(o, driving=replace(o.driving, speed_mps=0.0)),
        signals={"Vehicle.Powertrain.Transmission.Gear": "P"},
    ),
    "offline, cold and without camera": lambda make, o: make(
        surroundings=replace(
            o,
            gps=GpsFix(False, 2.3, 48.8, 40.0, 30.0, 0.0),
            connectivity=Connectivity(False, "none", 0),
            weather=Weather(-18.0, 90.0, 3.0, 73, 100.0, 300.0, 40.0),
        ),
        sign_camera=False,
    ),
    "a call rings": lambda make, o: make(
        surroundings=o,
        arrivals=[Arrival("message", 0.0, "Femi Lindqvist"), Arrival("call", 0.0, "Tilda Lindqvist")],
    ),
    "busy in French": lambda make, o: busy(make(surroundings=o, signals=_speaking("fr"), aboard=FULL)),
    "parked in German by night": lambda make, o: make(
        surroundings=replace(o, sun_elevation_deg=-20.0, driving=replace(o.driving, speed_mps=0.0)),
        aboard=FULL,
        signals={**_speaking("de"), "Vehicle.Powertrain.Transmission.Gear": "P"},
    ),
    "a call in Japanese": lambda make, o: make(
        surroundings=o, signals=_speaking("ja"), aboard=FULL, arrivals=[Arrival("call", 0.0, "Tilda Lindqvist")]
    ),
    "miles and fahrenheit, very fast": lambda make, o: make(
        surroundings=replace(o, driving=replace(o.driving, speed_mps=69.0)),
        signals={
            "Vehicle.Cabin.Infotainment.HMI.DistanceUnit": "MILES",
            "Vehicle.Cabin.Infotainment.HMI.TemperatureUnit": "F",
        },
    ),
    "wide": lambda make, o: make(surroundings=o, size=ScreenSize.WIDE),
    "portrait": lambda make, o: make(surroundings=o, size=ScreenSize.PORTRAIT),
    "wide, parked in German by night, on the left": lambda make, o: make(
        surroundings=replace(o, sun_elevation_deg=-20.0, driving=replace(o.driving, speed_mps=0.0)),
        aboard=FULL,
        signals={**_speaking("de"), "Vehicle.Powertrain.Transmission.Gear": "P"},
        size=ScreenSize.WIDE,
        left_hand=True,
    ),
    "portrait, a call, busy in French, on the left": lambda make, o: busy(
        make(
            surroundings=o,
            signals=_speaking("fr"),
            aboard=FULL,
            arrivals=[Arrival("call", 0.0, "Tilda Lindqvist")],
            size=ScreenSize.PORTRAIT,
            left_hand=True,
        )
    ),
}


WITHIN_OTHERS = ("night", "busy by day", "parked", "a call rings", "wide", "portrait")
"""What they have the other cases have too, in other company: they are left to the proofs."""


@pytest.fixture(scope="session")
def views(
    network: RoadNetwork, outdoors: Callable[..., Surroundings], walker: Callable[[Cockpit], tuple[Any, ...]]
) -> Callable[[str], tuple[Any, ...]]:
    """Every view from home in a case. Their cockpits are only looked at."""

    def make(
        seed: int = 1, surroundings: Surroundings | None = None, left_hand: bool = False, **options: Any
    ) -> Cockpit:
        here = replace(network, left_hand=left_hand)
        cockpit = Cockpit(here, rng=np.random.default_rng(seed), **options)
        cockpit.sense(surroundings or outdoors(), 0.0)
        return cockpit

    def of(case: str, name: CarMake = CarMake.HOME) -> tuple[Any, ...]:
        own = partial(make, make=make_named(name))
        return walker(CASES[case](own, outdoors()))

    return cache(of)


@dataclass
class Drawn:
    """A view, and each text on its picture with the pixels around it."""

    cockpit: Cockpit
    inks: list[tuple[Ink, npt.NDArray[np.int64]]]

    @classmethod
    def of(cls, cockpit: Cockpit) -> Drawn:
        canvas = render(cockpit.tree)
        pixels, inks = canvas.pixels(), []
        for ink in canvas.inks:
            rect = ink.rect.inset(-2)
            patch = pixels[max(0, rect.y) : rect.bottom, max(0, rect.x) : rect.right]
            inks.append((ink, patch.astype(np.int64) @ np.array((1 << 16, 1 << 8, 1))))
        return cls(cockpit, inks)


@pytest.mark.slow
@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=pytest.mark.proof) if case in WITHIN_OTHERS else case for case in CASES]
)
def test_every_view_keeps_every_law(case: str, views: Callable[[str], tuple[Any, ...]]) -> None:
    drawn = [Drawn.of(view.cockpit) for view in views(case)]
    assert numbers(drawn[0].cockpit) == numbers(views("day")[0].cockpit)
    hold([(law,) for law in LAWS], lambda law: law(drawn))


MAKES = [name for name in CarMake if name not in (CarMake.HOME, CarMake.DRAWN)]
IN_MAKES = ("busy in French", "wide, parked in German by night, on the left", "a call in Japanese", "busy")
"""A case for each make; those of one make are left to the proofs for the others."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "case"),
    [
        pytest.param(name, case, marks=() if case == own else pytest.mark.proof)
        for name, own in zip(MAKES, IN_MAKES, strict=True)
        for case in CASES
    ],
)
def test_every_view_of_every_make_keeps_every_law(name: CarMake, case: str, views: Any) -> None:
    drawn = [Drawn.of(view.cockpit) for view in views(case, name)]
    hold([(law,) for law in LAWS], lambda law: law(drawn))


@pytest.mark.slow
@over(MAKES)
def test_every_screen_and_every_control_of_home_is_in_every_make(name: CarMake, views: Any) -> None:
    there, home = views("parked", name), views("parked")
    assert {view.cockpit.screen for view in there} >= set(pages())
    known, own = (
        {w.key for view in found for w in view.cockpit.tree.walk() if w.listens} for found in (home, there)
    )
    gone = {key for key in known - own if not key.startswith(("dock.", "vehicle.tab.", "settings.page.", "apps."))}
    assert gone == set()


def test_every_screen_is_reached_from_home(views: Any) -> None:
    parked, moving = views("parked"), views("day")
    assert {view.cockpit.screen for view in parked} == set(pages())
    assert len(parked) >= 70
    missing = {name for app in apps_in(Where.STORE) if not app.preinstalled for name in app.pages}
    assert {view.cockpit.screen for view in moving} == set(pages()) - missing


def test_every_actuator_is_set_from_home(make: Make, around: Surroundings, walker: Any) -> None:
    set_by_taps, known = set[str](), set[tuple[str, str]]()
    for view in walker(CASES["parked"](make, replace(around, sun_elevation_deg=-20.0))):
        before = view.cockpit.signals.commanded()
        for widget in view.cockpit.tree.walk():
            if not widget.listens or not widget.usable or (view.cockpit.screen, widget.key) in known:
                continue
            known.add((view.cockpit.screen, widget.key))
            if isinstance(widget, Slider):
                set_by_taps.add(widget.signal.path)
                continue
            twin = view.cockpit.copy()
            twin.tap(*widget.rect.centre)
            set_by_taps |= set(difference(before, twin.signals.commanded()))
    assert set(ACTUATORS) - set_by_taps == set()


def test_no_form_is_ready_before_anybody_filled_it_in(views: Any) -> None:
    """What is sent or paid for good stands on the button in full, tells what the car knows, or cannot be sent."""
    arrive = SENTENCES["arrive"].said(14 * 60 + 20)  # the route's, in steps of five minutes
    ready = set[str]()
    for view in views("parked"):
        forms = [view.cockpit]
        for key in SENTENCES if view.cockpit.screen == "figure" else ():
            forms.append(view.cockpit.copy())
            assert press(forms[-1], f"figure.say.{key}") in (FeedbackCode.OK, FeedbackCode.NO_EFFECT)
        for cockpit in forms:
            for widget in cockpit.tree.walk():
                command = widget.on_tap.command if widget.on_tap else None
                aims = command.aims(cockpit._state) if command else frozenset()
                if widget.usable and aims & {"payments", "messages.sent", "alerts"}:
                    whole = isinstance(command, WarnDriver) and command.alert is not None
                    assert whole or getattr(command, "text", "") in (widget.text, arrive), widget.key
                    ready.add(widget.key)
    assert {"thread.answer.0", "figure.send"} <= ready


def what_can_be_touched_lies_on_the_screen_is_named_large_and_unique(drawn: list[Drawn]) -> None:
    for cockpit in (view.cockpit for view in drawn):
        keys = Counter(element.resource_id for element in cockpit.elements() if element.resource_id)
        assert [key for key, count in keys.items() if count > 1] == []
        for element in cockpit.elements():
            box = element.bbox_pixels
            assert cockpit.size.whole.encloses(
                Rect(box.x_min, box.y_min, box.x_max - box.x_min, box.y_max - box.y_min)
            )
            if element.is_clickable:
                assert element.text or element.content_description
                assert element.resource_id
                assert min(box.x_max - box.x_min, box.y_max - box.y_min) >= TOUCH, element.resource_id


def a_tap_on_the_middle_reaches_the_widget(drawn: list[Drawn]) -> None:
    for cockpit in (view.cockpit for view in drawn):
        for element in cockpit.elements():
            if element.is_clickable:
                hit = cockpit.tree.at(*middle(element))
                assert hit is not None
                assert shown_id(hit.key) == element.resource_id


def every_usable_widget_does_something_and_every_other_says_why_not(drawn: list[Drawn]) -> None:
    known = set()
    for cockpit in (view.cockpit for view in drawn):
        for element in cockpit.elements():
            here = (cockpit.screen, element.resource_id, element.is_enabled, element.is_selected)
            if not element.is_clickable or here in known:
                continue
            known.add(here)
            twin = cockpit.copy()
            feedback = twin.tap(*middle(element))
            assert feedback.text
            changed = twin.commands() != cockpit.commands() or twin.tree != cockpit.tree
            if element.is_enabled:
                same = element.is_selected or element.is_scrollable or element.is_focused
                same |= element.resource_id == shown_id("hvac.fan.max")
                assert same or feedback.code in DOES, element.resource_id
                assert changed or feedback.code is not FeedbackCode.OK, element.resource_id
            else:
                assert feedback.code in (FeedbackCode.DISABLED, FeedbackCode.RESTRICTED)
                assert not changed


def no_text_is_cut_off_leaves_its_box_or_lies_over_another(drawn: list[Drawn]) -> None:
    for view in drawn:
        screen, inks = view.cockpit.screen, [ink for ink, _ in view.inks]
        for ink in inks:
            assert not ink.cut, f"{screen}: {ink.text}"
            assert ink.box.inset(-1, -3).encloses(ink.rect), f"{screen}: {ink}"
        for one, other in combinations(inks, 2):
            assert not one.rect.overlaps(other.rect), f"{screen}: {one.text} over {other.text}"


LONG = (
    "Place du Maréchal-de-Lattre-de-Tassigny",
    "Raststätte Gräfenhausen West, Parkplatz",
    "Chemin de la Vieille Église de Saint-Barthélemy Est",
    "Upper Saint Bartholomew's Square / Old Harbour Road",
    "Avenue de la Porte-de-Saint-Cloud",
    "Boulevard Périphérique Extérieur",
)
"""The longest street names of the shipped scenarios, and longer ones than any map at hand has (49 letters)."""


@pytest.mark.slow
@pytest.mark.parametrize(("language", "parked", "here"), [("en", False, 2), ("de", True, 3), ("ja", False, 3)])
def test_the_longest_street_names_are_not_cut(
    network: RoadNetwork, around: Surroundings, walker: Any, language: str, parked: bool, here: int
) -> None:
    """On every screen, as the current road, the goal, a stop, a recent destination, the address of a place."""
    known = list(dict.fromkeys(road.name for road in network.roads))
    roads = tuple(replace(road, name=LONG[known.index(road.name) % len(LONG)]) for road in network.roads)
    signals = _speaking(language) | ({"Vehicle.Powertrain.Transmission.Gear": "P"} if parked else {})
    home = Cockpit(replace(network, roads=roads), rng=np.random.default_rng(1), signals=signals)
    speed_mps = 0.0 if parked else around.driving.speed_mps
    driving = replace(around.driving, road=replace(around.driving.road, name=LONG[here]), speed_mps=speed_mps)
    home.sense(replace(around, driving=driving), 0.0)
    for name in LONG:
        home.answered(Reroute(name), Answer(True, f"New route of 12.3 km to {name}"))
    home._state.keep(replace(home._state.of(Navigation), onward=LONG[2]))
    for view in walker(home):
        for ink in render(view.cockpit.tree).inks:
            assert not ink.cut, f"{view.name}: {ink.text}"
            assert ink.box.inset(-1, -3).encloses(ink.rect), f"{view.name}: {ink}"


def every_text_on_the_picture_is_in_the_list(drawn: list[Drawn]) -> None:
    for view in drawn:
        said = " ".join(
            f"{element.text} {element.content_description} {element.hint_text}"
            for element in view.cockpit.elements()
        )
        for ink, _ in view.inks:
            assert ink.text in said


def every_text_stands_out_from_its_ground(drawn: list[Drawn]) -> None:
    for view in drawn:
        for ink, patch in view.inks:
            colours, counts = np.unique(patch, return_counts=True)
            own = int(np.dot(ink.colour, (1 << 16, 1 << 8, 1)))
            ground = int(colours[np.argmax(np.where(colours == own, 0, counts))])
            shade = (ground >> 16, ground >> 8 & 255, ground & 255)
            assert contrast(ink.colour, shade) >= 4.5, f"{view.cockpit.screen}: {ink.text}"


def contrast(one: Colour, other: Colour) -> float:
    """Ratio by WCAG 2.1."""

    def luminance(colour: Colour) -> float:
        linear = [c / 3294.6 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in colour]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    lighter, darker = sorted((luminance(one), luminance(other)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def test_the_measure_of_contrast_is_right() -> None:
    assert contrast((0, 0, 0), (255, 255, 255)) == pytest.approx(21.0)
    assert contrast((119, 119, 119), (255, 255, 255)) == pytest.approx(4.48, abs=0.01)


def children_lie_within_their_parents(drawn: list[Drawn]) -> None:
    for cockpit in (view.cockpit for view in drawn):
        for widget in cockpit.tree.walk():
            for child in widget.children:
                assert widget.rect.encloses(child.rect), f"{child.key or child.text} beyond {widget.key}"


def seen_to_the_end(cockpit: Cockpit, key: str) -> set[str]:
    """What a list shows while it is scrolled down as far as it goes."""
    seen = set[str]()
    while True:
        here = next(widget for widget in cockpit.tree.walk() if widget.key == key)
        seen |= {child.key for child in here.children}
        if cockpit.scroll(key, Direction.DOWN).code is not FeedbackCode.OK:
            return seen


def test_every_list_scrolls_through_all_it_has(views: Any) -> None:
    for view in views("parked"):
        for rows in [widget for widget in view.cockpit.tree.walk() if isinstance(widget, Rows)]:
            cockpit = view.cockpit.copy()
            seen = seen_to_the_end(cockpit, rows.key)
            assert len(seen) >= rows.total
            while cockpit.scroll(rows.key, Direction.UP).code is FeedbackCode.OK:
                pass
            assert next(w for w in cockpit.tree.walk() if w.key == rows.key).first == 0  # type: ignore[attr-defined]


def test_long_lists_end_early_while_driving(around: Surroundings, views: Any) -> None:
    """Android's limit of 21; the end is seen, locked and says why, and is gone as soon as the car stands."""
    cut = set()
    still = replace(around, driving=replace(around.driving, speed_mps=0.0))
    for view in views("day"):
        for rows in [widget for widget in view.cockpit.tree.walk() if isinstance(widget, Rows)]:
            cockpit = view.cockpit.copy()
            seen = seen_to_the_end(cockpit, rows.key)
            if f"{rows.key}.rest" not in seen:
                assert len(seen) <= 21
                continue
            cut.add(rows.key)
            assert len(seen) == 21 + 1
            last = find(cockpit, f"{rows.key}.rest")
            assert not last.is_enabled
            assert "while driving" in last.content_description
            assert press(cockpit, f"{rows.key}.rest") is FeedbackCode.RESTRICTED
            cockpit.sense(still, 1.0)
            assert all(element.resource_id != shown_id(f"{rows.key}.rest") for element in cockpit.elements())
            assert cockpit.scroll(rows.key, Direction.DOWN).code is FeedbackCode.OK
    assert cut >= {"phone.contacts", "media.entries"}


@pytest.mark.slow
def test_same_state_same_bytes_and_another_state_other_bytes(make: Make, around: Surroundings, walker: Any) -> None:
    slow = replace(around, driving=replace(around.driving, speed_mps=0.0))
    for one, other in [*zip(walker(make()), walker(make()), strict=True)][::3]:
        assert one.cockpit.screenshot().tobytes() == other.cockpit.screenshot().tobytes()
        assert one.cockpit.elements() == other.cockpit.elements()
        other.cockpit.sense(slow, 1.0)
        assert one.cockpit.screenshot().tobytes() != other.cockpit.screenshot().tobytes()


def test_an_unchanged_tree_keeps_its_picture(cockpit: Cockpit, around: Surroundings) -> None:
    first = cockpit.screenshot()
    assert cockpit.screenshot() is first
    cockpit.open_app("settings")
    settings = cockpit.screenshot()
    cockpit.sense(around, 0.0)
    assert cockpit.screenshot() is settings
    assert not first.flags.writeable


@pytest.mark.parametrize("width", [640, 960, 1920])
def test_other_resolutions_show_and_hit_the_same(network: object, around: Surroundings, width: int) -> None:
    cockpit = Cockpit(network, rng=np.random.default_rng(1), width=width)  # type: ignore[arg-type]
    cockpit.sense(around, 0.0)
    assert cockpit.screenshot().shape == (width * 9 // 16, width, 3)
    assert press(cockpit, "dock.climate") is FeedbackCode.OK
    assert press(cockpit, "hvac.fan.max") is FeedbackCode.OK


@pytest.mark.parametrize("size", ScreenSize)
def test_a_screen_of_any_size_has_its_pixels(network: RoadNetwork, around: Surroundings, size: ScreenSize) -> None:
    cockpit = Cockpit(network, rng=np.random.default_rng(1))
    cockpit.sense(around, 0.0)
    cockpit.screenshot()
    cockpit.resize(size)
    assert cockpit.screenshot().shape == (size.height, size.width, 3)
    assert press(cockpit, "dock.climate") is FeedbackCode.OK
    repainted = cockpit.screenshot()
    assert repainted.tobytes() == render(cockpit.tree).pixels().tobytes()


def test_the_companion_stands_beside_every_app_without_a_map_of_its_own(views: Any) -> None:
    for view in views("portrait"):
        keys = {key_of(element.resource_id) for element in view.cockpit.elements()}
        assert len(keys & {"companion.map", "map.view", "home.map"}) == 1, view.name


def test_the_picture_changes_only_with_the_tree(cockpit: Cockpit) -> None:
    tree: Screen = cockpit.tree
    assert render(tree).pixels().tobytes() == render(tree).pixels().tobytes()
    assert accessibility.elements(tree) == accessibility.elements(tree)


def numbers(cockpit: Cockpit) -> dict[str, int]:
    """Index of every element of status bar and dock that is always there."""
    passing = {"status.notice", "status.limit_sign"}
    return {
        key: index
        for index, element in enumerate(cockpit.elements())
        for key in [key_of(element.resource_id)]
        if key.startswith(("status.", "dock.")) and key not in passing
    }


def status_bar_and_dock_keep_their_numbers(drawn: list[Drawn]) -> None:
    """On every screen, whatever tell-tale, notice or caller comes."""
    known = numbers(drawn[0].cockpit)
    assert sorted(known.values()) == list(range(len(known)))
    assert len(known) > 14
    for view in drawn:
        if not view.cockpit._state.is_typing:
            assert numbers(view.cockpit) == known, view.cockpit.screen


LAWS = (
    what_can_be_touched_lies_on_the_screen_is_named_large_and_unique,
    a_tap_on_the_middle_reaches_the_widget,
    every_usable_widget_does_something_and_every_other_says_why_not,
    no_text_is_cut_off_leaves_its_box_or_lies_over_another,
    every_text_on_the_picture_is_in_the_list,
    every_text_stands_out_from_its_ground,
    children_lie_within_their_parents,
    status_bar_and_dock_keep_their_numbers,
)
