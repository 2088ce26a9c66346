"""What people aboard ask for on a drive: the script, the words, and the judge of the state that is reached."""

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.cockpit.actions import perform
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import HMI, HVAC
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import Action, ActionType, Observation
from automotive_cosim.contracts.errand import Errand, ErrandKind
from automotive_cosim.contracts.given import CarMake, Language
from automotive_cosim.cosim.car import with_cause
from automotive_cosim.drives.errands import AFTER_S, ASKED_APART_S, SPARE_S, said, thanks, understood, with_errands
from automotive_cosim.drives.events import KINDS, DriveAct, Tracker
from automotive_cosim.drives.events.errands import carried_out
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import EventOutcome, Judgement, Worth, facts_of, judge
from automotive_cosim.drives.score import score
from automotive_cosim.drives.script import DriveScript, read_script, script_json
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.touches import Hands
from automotive_cosim.traffic.fork import Simulations
from tests.cockpit.conftest import outside, town
from tests.drives.scenes import moment
from tests.laws import over

SEEDS = (0, 1, 2)
DRIVER = HVAC.DRIVER_TEMPERATURE.path
WARMTH = Errand(ErrandKind.CLIMATE, 5.0, "driver", "23")
MESSAGE = Errand(ErrandKind.MESSAGE, 5.0, "Mia Frost", "On my way")


def test_nobody_speaks_of_a_call_that_does_not_ring() -> None:
    call = Errand(ErrandKind.CALL, 5.0, "Tom Hale")
    errands = (WARMTH, call)
    assert with_cause(errands, 4.0, 5.0, "Tom Hale") == errands
    assert with_cause(errands, 4.0, 5.0, "") == (WARMTH,)
    assert with_cause(errands, 3.0, 4.0, "") == with_cause(errands, 5.0, 6.0, "") == errands


@over((family, seed) for family in FAMILIES for seed in SEEDS)
def test_errands_come_just_after_something_staged_and_one_is_declined(family: str, seed: int) -> None:
    script = FAMILIES[family].draw(seed)
    made = with_errands(script)
    assert made == DriveSettings(errands=True).applied(script) == read_script(script_json(made))
    assert replace(made, errands=(), arrivals=script.arrivals, signals=script.signals) == script
    staged_s = [staged.at_s for staged in script.staged]
    for errand in made.errands:
        assert any(AFTER_S[0] <= errand.at_s - at_s <= AFTER_S[1] for at_s in staged_s)
        assert errand.at_s <= script.duration_s - SPARE_S
    assert all(later.at_s - one.at_s >= ASKED_APART_S for one, later in pairwise(made.errands))
    assert len({errand.kind for errand in made.errands}) == len(made.errands) >= 3
    assert sum(errand.is_declined for errand in made.errands) == 1
    for errand, language in ((errand, language) for errand in made.errands for language in Language):
        text = said(errand, language)
        assert understood(text) == (None if errand.is_declined else replace(errand, at_s=0.0)), text


def test_without_errands_a_script_is_what_it_was() -> None:
    script = FAMILIES["grid_june"].draw(0)
    assert "errands" not in script_json(script)
    assert DriveSettings(errands=False).applied(script) == script


def judged(errand: Errand, states: dict[float, dict[str, Any]], acts: tuple[DriveAct, ...]) -> Judgement:
    """Two minutes in which somebody asks for something, and from when on something is as it is."""
    drive, tracker, now = [], Tracker(KINDS), dict[str, Any]()
    for second in range(120):
        now = now | states.get(float(second), {})
        asked = (errand,) if second >= errand.at_s else ()
        drive.append(moment(float(second), asked=asked, **now))
        tracker.see(drive)
    return judge(KINDS, tracker.events, acts, {}, facts_of(drive), drive[0].commands)


def sets(at_s: float, degrees: float) -> DriveAct:
    return DriveAct(at_s, writes=((DRIVER, degrees),))


def warm(degrees: float) -> dict[str, Any]:
    return {"signals": {DRIVER: degrees}}


def sent(*texts: str) -> dict[str, Any]:
    return {"done": {"messages.sent": [{"to": "Mia Frost", "text": text} for text in texts]}}


@pytest.mark.parametrize(
    ("states", "outcome", "credit"),
    [
        ({10.0: warm(22.0), 11.0: warm(23.0)}, EventOutcome.PREPARED, 1.0),
        ({66.0: warm(23.0)}, EventOutcome.HIT, 29 / 57),
        ({96.0: warm(23.0)}, EventOutcome.LATE, -1.0),
        ({10.0: warm(24.0)}, EventOutcome.MISSED, -1.0),
        ({10.0: warm(23.0), 12.0: warm(24.0)}, EventOutcome.MISSED, -1.0),
        ({}, EventOutcome.MISSED, -1.0),
    ],
)
def test_a_temperature_counts_by_the_state(
    states: dict[float, dict[str, Any]], outcome: EventOutcome, credit: float
) -> None:
    acts = tuple(sets(at_s - 1, change["signals"][DRIVER]) for at_s, change in states.items())
    found = judged(WARMTH, states, acts)
    (event,) = found.events
    assert event.outcome is outcome
    assert event.credit == pytest.approx(credit)
    assert not any(act.worth.is_nuisance for act in found.acts)
    assert [act.worth for act in found.acts].count(Worth.RIGHT) == (credit > 0)


def test_thanks_are_said_once_it_is_done_and_mean_nothing_to_do() -> None:
    declined = replace(WARMTH, is_declined=True)
    for errand, done in ((WARMTH, {WARMTH.at_s}), (declined, set[float]())):
        drive = [
            moment(
                float(second),
                asked=(errand,) if second >= errand.at_s else (),
                **warm(23.0 if second > 20 else 21.0),
            )
            for second in range(40)
        ]
        assert carried_out(drive[:20]) == frozenset()
        assert carried_out(drive) == done
    for language in Language:
        assert said(WARMTH, language) in thanks(WARMTH, language)
        assert understood(thanks(WARMTH, language)) is None


def test_the_right_reply_alone_counts() -> None:
    answered = DriveAct(9.0, writes=(("messages.sent", None),))
    outcomes = [
        judged(MESSAGE, {10.0: state}, (answered,)).events[0].outcome
        for state in (sent("On my way"), sent("No"), sent("No", "On my way"))
    ]
    assert outcomes == [EventOutcome.PREPARED, EventOutcome.MISSED, EventOutcome.MISSED]


def test_what_the_driver_declines_is_a_look_alike_and_charged_once() -> None:
    declined = replace(WARMTH, is_declined=True)
    left = judged(declined, {}, ())
    taken = judged(declined, {10.0: warm(22.0), 11.0: warm(23.0)}, (sets(9.0, 22.0), sets(10.0, 23.0)))
    assert [event.outcome for event in (*left.events, *taken.events)] == [EventOutcome.AVOIDED, EventOutcome.TAKEN]
    assert [act.worth for act in taken.acts] == [Worth.LOOKALIKE, Worth.NEUTRAL]
    assert score(left, 120.0).value == 0.0 > score(taken, 120.0).value


def test_what_nobody_asks_for_is_charged() -> None:
    (act,) = judged(replace(WARMTH, at_s=500.0), {}, (sets(9.0, 22.0),)).acts
    assert (act.worth, act.reason) == (Worth.FALSE, "nobody has asked for it")


IN_MAKES = zip([make for make in CarMake if make not in (CarMake.HOME, CarMake.DRAWN)], Language, strict=True)


@pytest.mark.parametrize(("make", "language"), [*((CarMake.HOME, language) for language in Language), *IN_MAKES])
def test_the_watcher_s_hands_do_what_is_asked_in_every_language_and_make(make: CarMake, language: Language) -> None:
    errands = (
        replace(WARMTH, about="passenger", wanted="19"),
        WARMTH,
        MESSAGE,
        replace(MESSAGE, wanted="I'll be 10 minutes late"),
        Errand(ErrandKind.CALL, 0.0, "Tom Hale"),
        Errand(ErrandKind.PLACE, 0.0, "Work"),
        replace(WARMTH, wanted="24", is_declined=True),
    )
    for errand in errands:
        cockpit = Cockpit(
            town(),
            rng=np.random.default_rng(1),
            signals={HMI.LANGUAGE.path: str(language)},
            make=make_named(make),
            arrivals=[Arrival("message", 1.0, "Mia Frost", "Where are you?"), Arrival("call", 1.0, "Tom Hale")],
        )
        cockpit.sense(outside(), 0.0)
        cockpit.sense(outside(902.0), 2.0)
        hands, requests = Hands(), []
        for second in range(20):
            elements = cockpit.elements()
            seen: Any = SimpleNamespace(time_s=float(second), said=(said(errand, language),), elements=elements)
            hands.hear(seen)
            action = hands.act(seen)
            if action is None:
                break
            perform(action, cockpit, elements)
            requests += cockpit.drain_requests()
        state = cockpit.commands()
        assert state[DRIVER] == (23.0 if errand == WARMTH else 21.0)
        if errand != WARMTH:  # which the passenger's side follows
            assert state[HVAC.PASSENGER_TEMPERATURE.path] == (19.0 if errand.about == "passenger" else 21.0)
        wanted = [{"to": errand.about, "text": errand.wanted}] if errand.kind is ErrandKind.MESSAGE else []
        assert state["messages.sent"] == wanted
        assert state["calls.declined"] == (["Tom Hale"] if errand.kind is ErrandKind.CALL else [])
        assert len(requests) == (errand.kind is ErrandKind.PLACE)


def test_an_agent_hears_what_is_asked_and_a_wait_ends(simulations: Simulations) -> None:
    heard: dict[Language, Observation] = {}
    script: DriveScript = replace(FAMILIES["grid_june"].draw(0), errands=(replace(WARMTH, at_s=8.0),))
    for language in (Language.ENGLISH, Language.GERMAN):
        spec = DriveSpec("grid_june", conditions=replace(DriveSpec("grid_june").conditions, language=language))
        session = spec.begin(simulations, script=script)
        while not session.observation.said:
            assert session.seconds < 20.0
            session.step(Action(ActionType.WAIT))
        heard[language] = session.observation
        assert len(session.goal.encode()) <= 512
        session.close()
    for language, seen in heard.items():
        assert seen.said == (said(WARMTH, language),)
        assert seen.vehicle is not None
        assert "asked (changed): 0 s ago" in (seen.vehicle.noticed or "")
        assert seen.feedback.text.endswith("something changed")
