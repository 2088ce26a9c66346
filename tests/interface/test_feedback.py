"""Quiet feedback names the control and whether it took; what became of the car is left to the screen."""

import re

import numpy as np
import pytest

from automotive_cosim.cockpit import actions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import word
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.contracts import Action, ActionType, Direction, Element, Feedback, FeedbackCode
from automotive_cosim.contracts.given import Interface
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import UserError
from automotive_cosim.interface.feedback import control, quiet
from automotive_cosim.interface.observe import ALL, Channel, See
from tests.laws import over

from ..cockpit.conftest import outside, town

SIGNAL = re.compile(r"\b(?:Is[A-Z]|[A-Z][a-z]+[A-Z])\w*|[A-Za-z_]\.\w|(?:is|reads) (?:already )?(?:on|off|\d|')")
OUTCOMES = tuple(
    word(outcome, language) for outcome in ("done", "nothing changed") for language in HMI.LANGUAGE.allowed
)


@pytest.fixture(scope="module")
def parked() -> Cockpit:
    cockpit = Cockpit(town(), rng=np.random.default_rng(1))
    cockpit.sense(outside(speed_kmh=0.0), 0.0)
    return cockpit


def told(cockpit: Cockpit, action: Action, *, by_name: bool = True) -> Feedback:
    elements = cockpit.elements()
    name = control(action, cockpit, elements, by_name=by_name)
    return quiet(cockpit.spoken(actions.perform(action, cockpit, elements)), name, cockpit)


def index_of(cockpit: Cockpit, key: str) -> int:
    return next(at for at, element in enumerate(cockpit.elements()) if element.resource_id == shown_id(key))


def touch(cockpit: Cockpit, key: str) -> Action:
    return Action(ActionType.CLICK, index=index_of(cockpit, key))


def test_a_control_is_named_and_not_its_signal(parked: Cockpit) -> None:
    car = parked.copy()
    car.open_app("climate")
    assert told(car, touch(car, "dock.front_defroster")) == Feedback(FeedbackCode.OK, "Front defroster: done")
    assert told(car, touch(car, "dock.home")).text == "Home: done"
    assert told(car, Action(ActionType.NAVIGATE_HOME)) == Feedback(FeedbackCode.NO_EFFECT, "nothing changed")
    assert told(car, Action(ActionType.WAIT)).text == ""


def test_a_control_without_letters_has_no_name_in_the_picture(parked: Cockpit) -> None:
    car = parked.copy()
    assert (
        told(car, touch(car, "dock.driver_temperature.increase")).text == "Driver's temperature higher by 0.5: done"
    )
    assert told(car, touch(car, "dock.driver_temperature.increase"), by_name=False).text == "done"
    assert told(car, touch(car, "dock.climate"), by_name=False).text == "Climate: done"


def test_why_not_is_told_as_before(parked: Cockpit) -> None:
    car = parked.copy()
    for action in (
        Action(ActionType.CLICK, index=4000),
        Action(ActionType.OPEN_APP, app_name="nowhere"),
        Action(ActionType.REQUEST_REROUTE, destination="200,99"),
    ):
        plain = actions.perform(action, car.copy(), car.elements())
        assert plain.code not in (FeedbackCode.OK, FeedbackCode.NO_EFFECT)
        assert told(car, action) == plain


@pytest.mark.parametrize(("speed_kmh", "is_heard"), [(50.0, True), (0.0, False)])
def test_what_is_read_out_is_heard(parked: Cockpit, speed_kmh: float, is_heard: bool) -> None:
    car = parked.copy()
    car.sense(outside(speed_kmh=speed_kmh), 1.0)
    car.open_app("phone")
    for key in ("phone.tab.messages", "phone.thread.0"):
        told(car, touch(car, key))
    assert (" wrote: " in told(car, touch(car, "thread.read")).text) is is_heard


@over(pages())
def test_no_touch_tells_a_signal(screen: str, parked: Cockpit) -> None:
    car = parked.copy()
    car.visit(screen)
    for index, element in enumerate(car.elements()):
        if element.is_clickable:
            there = car.copy()
            said = told(there, Action(ActionType.CLICK, index=index))
            if said.code in (FeedbackCode.OK, FeedbackCode.NO_EFFECT):
                assert not SIGNAL.search(said.text), (element.resource_id, said.text)
                assert said.text.endswith(OUTCOMES)


@pytest.mark.parametrize(("language", "outcome"), [("de", "erledigt"), ("fr", "fait"), ("ja", "完了")])
def test_it_is_told_in_the_language_of_the_screens(language: str, outcome: str, parked: Cockpit) -> None:
    car = parked.copy()
    car.command(HMI.LANGUAGE, language)
    said = told(car, touch(car, "dock.climate"))
    (name,) = {element.text for element in car.elements() if element.resource_id == shown_id("dock.climate")}
    assert said.text == f"{name}: {outcome}"


def test_without_a_list_an_index_names_nothing(parked: Cockpit) -> None:
    car = parked.copy()
    before = car.elements()
    for action in (touch(car, "dock.climate"), Action(ActionType.SCROLL, index=3, direction=Direction.DOWN)):
        said = actions.perform(action, car, ())
        assert said.code is FeedbackCode.NO_SUCH_ELEMENT
        assert "x and y" in said.text
    assert car.elements() == before


@pytest.mark.parametrize("see", See)
def test_only_who_calls_functions_may_see_nothing_of_the_screen(see: See) -> None:
    given = SessionSetup(conditions=Conditions(see=see, interface=Interface.FUNCTIONS)).given
    assert ALL - given == see.withheld
    if see is See.NOTHING:
        with pytest.raises(UserError, match="--interface functions"):
            SessionSetup(conditions=Conditions(see=see))
    else:
        assert SessionSetup(conditions=Conditions(see=see)).given & {Channel.ELEMENTS, Channel.SCREENSHOT}


@pytest.mark.parametrize(("channel", "see"), [(Channel.ELEMENTS, See.PICTURE), (Channel.SCREENSHOT, See.TREE)])
def test_an_agent_is_not_blinded(channel: Channel, see: See) -> None:
    with pytest.raises(UserError, match=f"--see {see}"):
        SessionSetup(frozenset({channel}), Conditions(see=see))
    assert SessionSetup(frozenset({Channel.GPS}), Conditions(see=see)).given == {Channel.GPS}


def test_the_drawn_list_has_the_boxes_and_only_the_letters(parked: Cockpit) -> None:
    car = parked.copy()
    for screen in pages():
        car.visit(screen)
        both = list(zip(car.elements(), car.drawn(), strict=True))
        assert all(one.bbox_pixels == other.bbox_pixels for one, other in both)
        assert all(other.text in (one.text, "") for one, other in both)

    def named(elements: tuple[Element, ...], key: str) -> Element:
        return next(each for each in elements if each.resource_id == shown_id(key))

    assert named(car.elements(), "dock.front_defroster").content_description == "Front defroster"
    assert named(car.drawn(), "dock.front_defroster").content_description == ""
