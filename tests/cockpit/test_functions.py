"""Functions of the car: one for whatever a finger can command, restricted as the finger is."""

import json
import re
from collections.abc import Callable, Iterator

import pytest

from automotive_cosim.cockpit import calls
from automotive_cosim.cockpit.actions import perform
from automotive_cosim.cockpit.calls import functions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.functions import CarFunction, groups, named
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.signals import ACTUATORS, CATALOGUE, MEDIA, MOTION
from automotive_cosim.cockpit.state import Command
from automotive_cosim.cockpit.widgets import Button, Slider, Widget
from automotive_cosim.contracts import ActionType, FeedbackCode
from automotive_cosim.contracts.given import Interface
from automotive_cosim.errors import ActionError
from automotive_cosim.interface.functions import CAR, action_of, as_openai, call_of, grouped, offered
from automotive_cosim.interface.translation import actions_of
from tests.laws import over

from .conftest import View, outside


def commands(widget: Widget) -> Iterator[Command]:
    """What touches of a widget command."""
    messages = [widget.on_tap, widget.on_hold if isinstance(widget, Button) else None]
    if isinstance(widget, Slider):
        messages = [widget.message_by(1), widget.message_by(-1)]
    yield from (each.command for each in messages if each is not None and each.command is not None)


@pytest.mark.slow
def test_whatever_a_touch_commands_a_call_commands_too(
    make: Callable[..., Cockpit], walker: Callable[[Cockpit], tuple[View, ...]]
) -> None:
    wrong, tried = list[str](), set[str]()
    for view in walker(make()):
        for widget in view.cockpit.tree.walk():
            for command in commands(widget) if widget.usable else ():
                if repr(command) in tried:
                    continue
                tried.add(repr(command))
                calls = actions_of(command, view.cockpit.copy().state)
                touched, called = view.cockpit.copy(), view.cockpit.copy()
                touched._perform(command)
                for action in calls or ():
                    perform(action_of(*call_of(action)), called, ())
                if calls is None or touched.commands() != called.commands():
                    wrong.append(f"{view.name} {widget.key}: {command}, not as {calls}"[:300])
    assert not wrong, "\n".join(wrong)
    assert len(tried) > 300


@pytest.mark.slow
def test_what_is_locked_for_a_finger_while_driving_is_locked_for_a_call(
    make: Callable[..., Cockpit], walker: Callable[[Cockpit], tuple[View, ...]]
) -> None:
    wrong, tried = list[str](), set[str]()
    for view in walker(make()):
        for widget in view.cockpit.tree.walk():
            for command in commands(widget) if widget.locked else ():
                if repr(command) in tried:
                    continue
                tried.add(repr(command))
                standing = view.cockpit.copy()
                standing.inject(MOTION.GEAR.path, "P")
                standing.inject(MOTION.SPEED.path, 0.0)
                standing.inject(MOTION.IS_MOVING.path, False)
                for action in actions_of(command, standing.state) or ():
                    code = perform(action, view.cockpit.copy(), ()).code
                    if code not in (FeedbackCode.RESTRICTED, FeedbackCode.REFUSED):
                        wrong.append(f"{view.name} {widget.key}: {call_of(action)} is {code}")
    assert not wrong, "\n".join(wrong)
    assert tried


def test_every_switch_of_the_car_is_in_one_function_and_no_reading_tells_the_place(cockpit: Cockpit) -> None:
    paths = [path for function in functions().values() for path in function.signals]
    assert sorted(paths) == sorted({*ACTUATORS} - {MEDIA.SELECTED.path})
    told = json.loads(perform(action_of("get_signals", {"path": "Vehicle"}), cockpit, ()).text)
    assert {*CATALOGUE} - {*told} == {MOTION.LATITUDE.path, MOTION.LONGITUDE.path, MOTION.HEADING.path}
    for group in set(groups()) - {"motion"}:
        assert perform(action_of("get_signals", {"path": group}), cockpit, ()).code is FeedbackCode.OK


@over(functions().values())
def test_a_function_says_what_it_does_and_refuses_what_its_schema_refuses(function: CarFunction) -> None:
    assert function.about.endswith((".", ")")), function.about
    for each in function.parameters:
        assert each.schema["type"] in ("string", "boolean", "integer", "number")
    with pytest.raises(ActionError, match="no argument of"):
        action_of(function.name, {"no_such": 1})
    fitting = {each.name: _fits(each.schema) for each in function.parameters}
    for each in function.parameters:
        wrong: list[object] = [[1], {"a": 1}]
        wrong += ["\ud800"] if each.schema["type"] == "string" else ["x", float("nan")]
        wrong += [each.schema["minimum"] - 1, each.schema["maximum"] + 1] if "minimum" in each.schema else []
        for value in wrong:
            with pytest.raises(ActionError):
                function.read(fitting | {each.name: value})
        if not each.required:
            said = {name: value for name, value in fitting.items() if name != each.name}
            for nothing in (None, "", "null", "None", ["null"]):
                assert function.read(said | {each.name: nothing}) == said


def _fits(schema: dict[str, object]) -> object:
    if "enum" in schema:
        return schema["enum"][0]  # type: ignore[index]
    return {"string": "x", "boolean": True}.get(str(schema["type"]), schema.get("minimum", 1))


def test_a_screen_is_read_as_it_is_shown_from_end_to_end(make: Callable[..., Cockpit]) -> None:
    parked = make(surroundings=outside(speed_kmh=0.0), signals={})
    parked.inject(MOTION.GEAR.path, "P")
    before = parked.elements(), parked.commands()
    contacts = perform(action_of("read_screen", {"screen": "phone", "item": "contacts"}), parked, ()).text
    assert all(name in contacts for name in parked.content["contacts"])
    assert len(contacts.splitlines()) > 60
    assert (parked.elements(), parked.commands()) == before
    moving = make()
    hidden = perform(
        action_of("read_screen", {"screen": "thread", "item": moving.content["unread"][0]}), moving, ()
    )
    assert "Messages are read out while driving" in hidden.text
    assert perform(action_of("search_places", {"text": "a"}), moving, ()).code is FeedbackCode.RESTRICTED
    assert perform(action_of("read_screen", {"screen": "timer"}), moving, ()).code is FeedbackCode.REFUSED


def test_a_call_says_what_it_set_or_why_not(cockpit: Cockpit) -> None:
    def said(name: str, **arguments: object) -> str:
        return perform(action_of(name, arguments), cockpit, ()).text

    assert "Temperature is 24" in said("set_hvac_temperature", which="driver", celsius="24")
    assert "navigation.avoid is ['tolls']" in said("avoid_on_route", what="tolls", on=True)
    assert "goes from 0 to 100" in said("set_seat_heating", which="rear_left", percent=-50)
    assert "one of OFF, INTERVAL, SLOW" in said("choose_body", which="rear_wiper", value="FAST")
    assert "does not move while driving" in said("recall_seat", position=1)
    assert "No contact" in said("call", who="Nobody")
    with pytest.raises(ActionError, match="did you mean 'set_hvac_temperature'"):
        action_of("set_hvac_temp", {})
    assert action_of("wait", '{"seconds": 3}').action_type is ActionType.WAIT


def test_whatever_a_screen_lists_can_be_read_by_how_it_is_listed(make: Callable[..., Cockpit]) -> None:
    """Tabs and rows lead on by the text that they show; what is not there is told as that, with what is."""
    parked = make(surroundings=outside(speed_kmh=0.0), signals={})
    parked.inject(MOTION.GEAR.path, "P")
    for app in ("calendar", "memo"):
        perform(action_of("install_app", {"app": app, "on": True}), parked, ())
    wrong, tried = list[str](), 0
    for screen in pages():
        for widget in _usable(parked, screen):
            way = widget.on_tap
            if not isinstance(way, Show) or not way.item or not widget.text:
                continue
            tried += 1
            is_own = screen in calls._by_screen()[way.screen].pages
            for item in (widget.text, way.item) if is_own else (way.item,):
                read = perform(action_of("read_screen", {"screen": way.screen, "item": item}), parked, ())
                if read.code is not FeedbackCode.OK or "no longer there" in read.text:
                    wrong.append(f"{way.screen}, {item}: {read.text}")
    assert not wrong, "\n".join(wrong)
    assert tried > 10
    for screen in ("appointment", "note", "phone", "seats"):
        lost = perform(action_of("read_screen", {"screen": screen, "item": "xyzzy"}), parked, ())
        assert lost.code is FeedbackCode.NO_SUCH_ELEMENT
        assert "xyzzy" in lost.text


def _usable(cockpit: Cockpit, screen: str) -> Iterator[Widget]:
    twin = cockpit.copy()
    twin.visit(screen)
    yield from twin.tree.walk()


def test_a_part_of_a_name_is_enough_where_it_means_one_thing() -> None:
    names = ("Nora Frost", "Tom Hale", "Nora Kline", "Main road 1", "Main road 12")
    assert [named(each, names) for each in ("tom", "hale  TOM", "frost", "main road 1")] == [
        "Tom Hale", "Tom Hale", "Nora Frost", "Main road 1",
    ]  # fmt: skip
    assert [named(each, names) for each in ("nora", "", "to", "Nora Hale")] == [None] * 4


@over(functions().values())
def test_every_argument_says_in_words_what_it_takes_and_every_number_its_unit(function: CarFunction) -> None:
    for each in function.parameters:
        assert each.schema.get("description"), each.name
        if each.schema["type"] == "number":
            assert re.match(r"In \S+; ", each.schema["description"]), each.name


def test_definitions_that_are_sent_with_each_question_have_twelve_thousand_characters_at_most() -> None:
    """The car's functions go as one, which names each with what it takes; a call through it is the same action."""
    sent = grouped(offered())
    assert len(json.dumps([as_openai(each) for each in sent])) <= 12_000
    listed = sent[-1].about
    for function in functions().values():
        assert f"\n{function.name}(" in listed
        assert all(each.name in listed for each in function.parameters)
    given = {"which": "driver", "celsius": 21.5}
    for arguments in (given, json.dumps(given)):
        through = action_of(CAR, {"function": "set_hvac_temperature", "arguments": arguments})
        assert through == action_of("set_hvac_temperature", given)
    with pytest.raises(ActionError, match="did you mean 'set_hvac_temperature'"):
        action_of(CAR, {"function": "set_hvac_temp"})
    assert grouped(offered(Interface.TOUCH)) == offered(Interface.TOUCH)
