"""Laws over all drive families, as the gates are for tasks, on one recorded drive of each (``record``).

On the record nobody acts, so what an agent would have changed on the road is left out;
``benchmarks/drives.py --watch`` lets each of these watchers drive.
"""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace

import pytest

from automotive_cosim.contracts import AlertKind, Cruise, PullOver, Reroute, RoadRequest, Severity, SlowDown
from automotive_cosim.drives.changes import WAKES
from automotive_cosim.drives.events import KINDS, DriveAct, DriveEvent
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import NOT_DUE, ORDER, Judgement, Worth, judge
from automotive_cosim.drives.score import Score, score
from automotive_cosim.run.job_row import from_json
from automotive_cosim.traffic.fork import Simulations
from tests.drives.record import Recorded, came_off, outdated, recorded
from tests.drives.record import drive as drive_of
from tests.drives.rote import most_frequent

EVERY = [pytest.param(family) for family in FAMILIES]
DELAYS_S = (0.0, 1.0, 3.0, 8.0, 15.0, 45.0, 130.0)


@pytest.fixture
def drive(family: str) -> Recorded:
    """The recorded drive of a family."""
    return recorded()[family]


def judged(drive: Recorded, acts: Iterable[DriveAct], events: Sequence[DriveEvent] | None = None) -> Judgement:
    return judge(KINDS, drive.events if events is None else events, list(acts), {}, drive.against)


def scored(drive: Recorded, acts: Iterable[DriveAct], events: Sequence[DriveEvent] | None = None) -> Score:
    return score(judged(drive, acts, events), drive.driven_s)


def right(event: DriveEvent, delay_s: float = 0.0) -> DriveAct:
    """An act that settles an event, so long after its obligation."""
    assert event.obliged_s is not None
    kind, at_s = KINDS[event.kind], event.obliged_s + delay_s
    return DriveAct(at_s, min(kind.alerts)) if kind.alerts else DriveAct(at_s, said=f"{kind.says[0]}, mph and km/h")


def every(drive: Recorded, seconds: float) -> list[float]:
    """Simulation times at equal distances."""
    return [drive.begun_s + seconds * count for count in range(1, int(drive.driven_s / seconds))]


def counted(judgement: Judgement) -> list[int]:
    """The numbers of the events in which something had to be done."""
    return [index for index, event in enumerate(judgement.events) if event.outcome.counts]


def test_the_record_is_of_the_drives_as_they_are_drawn() -> None:
    assert not outdated(), "run python -m tests.drives.record --renew"


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize(
    "family", [pytest.param(each, marks=() if each == "grid_june" else pytest.mark.proof) for each in FAMILIES]
)
def test_what_happens_on_a_drive_is_what_is_on_record(family: str, simulations: Simulations) -> None:
    """A change that means to alter traffic renews the record."""
    driven = json.loads(json.dumps(asdict(drive_of(family, simulations))))
    assert from_json(Recorded, driven) == recorded()[family]


@pytest.mark.parametrize("family", EVERY)
def test_a_drive_has_events_and_look_alikes(drive: Recorded) -> None:
    silent = scored(drive, ())
    assert silent.events >= 1
    assert silent.lookalikes >= 3


def test_a_drive_has_several_events_on_average() -> None:
    assert sum(scored(each, ()).events for each in recorded().values()) >= 5 * len(FAMILIES)


def test_most_of_what_is_staged_comes_off() -> None:
    """A driver cannot hurry in a jam, and roadworks need a road that begins where they are due."""
    came = [did for _, did in came_off()]
    assert sum(came) >= 0.87 * len(came), f"{sum(came)} of {len(came)}"


@pytest.mark.parametrize("family", EVERY)
def test_silence_meets_nothing_and_disturbs_nobody(drive: Recorded) -> None:
    silent = scored(drive, ())
    assert (silent.recall, silent.false_alarms, silent.nuisances, silent.value) == (0.0, 0, 0, 0.0)


@pytest.mark.parametrize("family", EVERY)
def test_a_right_act_at_each_obligation_wins(drive: Recorded) -> None:
    acts = [right(event) for event in drive.events if event.obliged_s is not None]
    found = scored(drive, sorted(acts, key=lambda act: act.time_s))
    assert found.recall == 1.0
    assert found.false_alarms == 0
    assert found.value > 80.0


@pytest.mark.parametrize("family", EVERY)
def test_who_alerts_by_rote_does_worse_than_nobody(drive: Recorded) -> None:
    kinds = tuple(AlertKind)
    in_turn = [DriveAct(at_s, kinds[turn % len(kinds)]) for turn, at_s in enumerate(every(drive, 10.0))]
    assert scored(drive, in_turn).value < 0.0
    assert scored(drive, (DriveAct(at_s, AlertKind.SPEED) for at_s in drive.wakes_s)).value < 0.0
    assert scored(drive, (DriveAct(at_s, AlertKind.SPEED) for at_s in every(drive, 30.0))).value < 0.0
    likeliest = most_frequent(judged(drive, ()), KINDS)
    assert scored(drive, (DriveAct(at_s, likeliest) for at_s in every(drive, 30.0))).value < 0.0


REQUESTS: tuple[RoadRequest, ...] = (PullOver(), SlowDown(20.0), SlowDown(45.0), Cruise(45.0), Reroute())
VALUES = (True, False, "OFF", "UP", "AUTO", "SNOW", "MILES", 20.0, 60.0)
WORDS = ("a child is alone in the car", "signs are in mph here", "another law on lamps and horn", "look out")


def acts_at(time_s: float) -> Iterator[DriveAct]:
    """Every alert, with and without a speed, every request, every switch that a kind is about, and words."""
    for alert in AlertKind:
        yield DriveAct(time_s, alert)
        yield DriveAct(time_s, alert, Severity.CRITICAL, 30.0)
    yield from (DriveAct(time_s, requests=(request,)) for request in REQUESTS)
    for path in sorted({path for kind in KINDS.values() for path in kind.writes}):
        yield from (DriveAct(time_s, writes=((path, value),)) for value in VALUES)
    yield from (DriveAct(time_s, said=words) for words in WORDS)


@pytest.mark.parametrize("family", EVERY)
def test_against_each_act_that_is_charged_a_fact_speaks_that_the_agent_can_know(drive: Recorded) -> None:
    """Each act by itself, whenever facts are on record, incidents on the road among them."""
    for at_s in drive.facts_s[len(drive.events) % 8 :: 8]:
        against = {name: drive.against(kind, at_s) for name, kind in KINDS.items()}
        near = [event for event in drive.events if event.observable_s - 10 <= at_s <= event.last_s + 60]
        for act in acts_at(at_s):
            (found,) = judged(drive, (act,), near).acts
            assert bool(found.reason) is found.worth.is_nuisance, (act, found)
            if not found.worth.is_nuisance:
                continue
            meant = [name for name, kind in KINDS.items() if kind.settles(act, None) or kind.concerns(act)]
            facts = [against[name] for name in meant]
            assert found.reason == ("; ".join(filter(None, facts)) or (NOT_DUE if meant else ORDER)), (act, found)
            if not act.holds_back or act.alert is not None:  # a stop must be due, and not only true
                assert None not in facts, (act, found, facts)


@pytest.mark.parametrize("family", EVERY)
def test_a_look_alike_is_only_taken_where_a_fact_tells_it_from_an_event(drive: Recorded) -> None:
    """No kind that is supported for all that is known is charged as a look-alike."""
    for event in drive.events:
        for alert in KINDS[event.kind].alerts if event.lookalike else ():
            (found,) = judged(drive, [DriveAct(event.observable_s, alert)], [event]).acts
            if found.worth is Worth.LOOKALIKE:
                assert drive.against(KINDS[event.kind], event.observable_s), (event, found)
                assert found.reason


@pytest.mark.parametrize("kind", [pytest.param(name) for name in KINDS])
def test_what_speaks_for_and_against_a_warning_stands_among_the_readings(kind: str) -> None:
    assert KINDS[kind].told_by
    assert {*KINDS[kind].told_by} <= {wake.name for wake in WAKES}


@pytest.mark.parametrize("family", EVERY)
def test_what_is_on_its_way_is_no_false_alarm(drive: Recorded) -> None:
    """From the instant at which an event can be known, each of its alerts is at worst neutral."""
    for event in drive.events:
        if not event.lookalike:
            for alert in KINDS[event.kind].alerts:
                for at_s in {event.observable_s, event.obliged_s or event.observable_s}:
                    (found,) = judged(drive, [DriveAct(at_s, alert)]).acts
                    too_fast = alert is AlertKind.SPEED and event.value is not None
                    assert not found.worth.is_nuisance or too_fast, (event, alert, found)


@pytest.mark.parametrize("family", EVERY)
def test_a_delay_loses_exactly_the_events_whose_deadline_it_passes(drive: Recorded) -> None:
    """Each event by itself, since one alert may settle several."""
    for index in counted(judged(drive, ())):
        event = drive.events[index]
        for delay_s in DELAYS_S:
            (alone,) = judged(drive, [right(event, delay_s)], [event]).events
            assert event.obliged_s is not None
            assert event.deadline_s is not None
            in_time = event.obliged_s + delay_s <= event.deadline_s
            assert alone.outcome.is_credited is in_time, (event, delay_s)


@pytest.mark.parametrize("family", EVERY)
def test_without_its_events_nothing_is_gained_on_a_drive(drive: Recorded) -> None:
    lookalikes = [replace(event) for event in drive.events if event.lookalike]
    assert scored(drive, (), lookalikes).value == 0.0
    assert scored(drive, [DriveAct(drive.begun_s + 100.0, requests=(PullOver(),))], lookalikes).value <= 0.0


def test_every_kind_comes_in_some_family_as_an_event_and_as_a_look_alike() -> None:
    """But for what few of the drives on record stage."""
    events = {event.kind for each in recorded().values() for event in each.events if event.obliged_s is not None}
    lookalikes = {event.kind for each in recorded().values() for event in each.events if event.lookalike}
    kinds = {name for name, kind in KINDS.items() if kind.is_due_ever and not kind.by_state}  # see test_errands
    assert len(events) >= 0.8 * len(kinds), kinds - events
    assert len(lookalikes) >= 0.8 * len(kinds), kinds - lookalikes
