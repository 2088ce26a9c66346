"""What becomes of events and what acts are, on events made by hand."""

from dataclasses import replace

import pytest

from automotive_cosim.cockpit.road import Ask
from automotive_cosim.cockpit.signals import CABIN, LIGHTS
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.contracts import AlertKind, Answer, PullOver, Severity, SlowDown
from automotive_cosim.contracts.given import Order
from automotive_cosim.drives.acts import acts_of, refusal
from automotive_cosim.drives.events import KINDS, DriveAct, DriveEvent, EventKind
from automotive_cosim.drives.events.base import Measured
from automotive_cosim.drives.judge import NOT_DUE, NUISANCE, ORDER, EventOutcome, Judgement, Worth, judge
from automotive_cosim.drives.score import score, together
from tests.drives.scenes import moment

SPEEDING = DriveEvent(
    kind="over_limit",
    subject="50",
    words="60 where 50 apply",
    lookalike=False,
    weight=1.0,
    observable_s=100.0,
    last_s=140.0,
    value=50.0,
    due_until_s=140.0,
    obliged_s=104.0,
    deadline_s=114.0,
    severities=[(100.0, 1.0)],
)
LOOKALIKE = replace(SPEEDING, lookalike=True, obliged_s=None, deadline_s=None, due_until_s=None)
APPROACH = replace(
    SPEEDING, kind="tunnel", subject="", value=None, obliged_s=None, deadline_s=None, due_until_s=None
)


def judged(
    *acts: DriveAct,
    events: tuple[DriveEvent, ...] = (SPEEDING,),
    due: dict[int, float | None] | None = None,
    true: tuple[str, ...] = (),
) -> Judgement:
    """Against every kind but those that are ``true`` for all that is known, a fact speaks."""

    def against(kind: EventKind, time_s: float) -> str | None:
        return None if kind.name in true else f"no {kind.name}"

    return judge(KINDS, events, acts, due or {}, against, {LIGHTS.HIGH_BEAM.path: False})


@pytest.mark.parametrize("order", Order)
def test_what_a_measure_alone_speaks_against_is_charged_to_who_was_told_it(order: Order) -> None:
    """52 in a 50, and an alert again: who was told no threshold and no minute is charged for neither, but for what
    is simply not so."""

    def acts(fact: str, *at_s: float) -> list[Worth]:
        found = judge(KINDS, [LOOKALIKE], [warn(each) for each in at_s], {}, lambda kind, time_s: fact, order=order)
        return [act.worth for act in found.acts]

    is_told = order is Order.FULL
    assert acts(Measured("52 where 50 apply"), 110.0) == [Worth.LOOKALIKE if is_told else Worth.NEUTRAL]
    assert acts("48 where 50 apply", 110.0) == [Worth.LOOKALIKE]
    assert acts("48 where 50 apply", 190.0) == [Worth.FALSE]
    again = [
        judge(KINDS, [SPEEDING], [warn(106.0), warn(106.0 + later)], {}, lambda kind, time_s: None, order=order)
        .acts[1].worth
        for later in (10.0, 20.0)
    ]  # fmt: skip
    assert again == [Worth.REPEAT, Worth.NEUTRAL if order is Order.PLAIN else Worth.REPEAT]


def warn(time_s: float, kind: AlertKind = AlertKind.SPEED) -> DriveAct:
    return DriveAct(time_s, kind)


@pytest.mark.parametrize(
    ("at_s", "outcome", "worth", "credit"),
    [
        (97.0, EventOutcome.MISSED, Worth.FALSE, -1.0),
        (98.5, EventOutcome.PREPARED, Worth.RIGHT, 1.0),
        (101.0, EventOutcome.PREPARED, Worth.RIGHT, 1.0),
        (106.0, EventOutcome.HIT, Worth.RIGHT, 1.0),
        (110.5, EventOutcome.HIT, Worth.RIGHT, 0.5),
        (114.0, EventOutcome.HIT, Worth.RIGHT, 0.0),
        (115.0, EventOutcome.LATE, Worth.LATE, -1.0),
    ],
)
def test_an_alert_is_worth_what_its_time_is_worth(
    at_s: float, outcome: EventOutcome, worth: Worth, credit: float
) -> None:
    found = judged(warn(at_s))
    assert found.events[0].outcome is outcome
    assert found.events[0].credit == pytest.approx(credit)
    assert found.acts[0].worth is worth


def test_nobody_at_the_cockpit_misses_it() -> None:
    assert judged().events[0].outcome is EventOutcome.MISSED


def test_an_act_long_before_the_obligation_does_not_prepare_for_it() -> None:
    far = replace(SPEEDING, obliged_s=170.0, deadline_s=180.0, last_s=200.0, due_until_s=200.0)
    assert judged(warn(101.0), events=(far,)).events[0].outcome is EventOutcome.MISSED
    assert judged(warn(101.0), events=(far,)).acts[0].worth is Worth.NEUTRAL
    assert judged(warn(101.0), warn(118.0), events=(far,)).events[0].outcome is EventOutcome.PREPARED


def test_what_comes_slowly_is_remembered_for_longer() -> None:
    """A tyre that loses its air, told of five minutes before it is soft."""
    leak = replace(SPEEDING, kind="tyre", subject="", value=None, obliged_s=400.0, deadline_s=460.0)
    assert judged(warn(101.0, AlertKind.VEHICLE), events=(leak,)).events[0].outcome is EventOutcome.PREPARED


def test_an_act_that_puts_the_obligation_off_prepares_for_when_it_would_have_come() -> None:
    """A driver who is told of a breakdown slows down, and comes near it later."""
    far = replace(SPEEDING, obliged_s=190.0, deadline_s=200.0, last_s=220.0, due_until_s=220.0)
    found = judged(warn(101.0), events=(far,), due={0: 150.0})
    assert (found.events[0].outcome, found.acts[0].worth) == (EventOutcome.PREPARED, Worth.RIGHT)
    early = judged(warn(101.0), events=(far,), due={0: 170.0})
    assert (early.events[0].outcome, early.acts[0].worth) == (EventOutcome.MISSED, Worth.NEUTRAL)


def test_a_switch_or_a_request_prepares_however_early_it_comes() -> None:
    """Words are forgotten; lamps that are on, and a driver who was asked to go slower, are not."""
    far = replace(SPEEDING, obliged_s=130.0, deadline_s=140.0)
    slower = judged(DriveAct(101.0, requests=(SlowDown(50.0),)), events=(far,))
    assert slower.events[0].outcome is EventOutcome.PREPARED
    lamps = replace(far, kind="lamps", subject="", value=1.0)
    lit = judged(DriveAct(101.0, writes=((LIGHTS.LOW_BEAM.path, True),)), events=(lamps,))
    assert lit.events[0].outcome is EventOutcome.PREPARED


def test_a_request_to_the_driver_settles_it_too() -> None:
    assert judged(DriveAct(105.0, requests=(SlowDown(50.0),))).events[0].outcome is EventOutcome.HIT


def test_another_alert_is_wrong_while_something_is_due() -> None:
    found = judged(warn(106.0, AlertKind.FATIGUE))
    assert found.acts[0].worth is Worth.WRONG
    assert found.events[0].outcome is EventOutcome.MISSED


def test_an_alert_for_nothing_is_false() -> None:
    assert judged(warn(300.0)).acts[0].worth is Worth.FALSE


def test_an_act_on_a_look_alike_is_a_false_alarm() -> None:
    found = judged(warn(110.0), events=(LOOKALIKE,))
    assert found.acts[0].worth is Worth.LOOKALIKE
    assert found.events[0].outcome is EventOutcome.TAKEN
    assert judged(events=(LOOKALIKE,)).events[0].outcome is EventOutcome.AVOIDED


def test_a_repeat_within_a_minute_is_a_nuisance_unless_it_has_become_worse() -> None:
    assert [act.worth for act in judged(warn(105.0), warn(130.0), true=("over_limit",)).acts] == [
        Worth.RIGHT,
        Worth.REPEAT,
    ]
    worse = replace(SPEEDING, severities=[(100.0, 1.0), (120.0, 2.0)])
    assert [act.worth for act in judged(warn(105.0), warn(130.0), events=(worse,)).acts] == [
        Worth.RIGHT,
        Worth.NEUTRAL,
    ]
    long = replace(SPEEDING, last_s=300.0)
    assert [act.worth for act in judged(warn(105.0), warn(170.0), events=(long,)).acts][1] is Worth.NEUTRAL


def test_what_passes_by_itself_before_its_deadline_is_void() -> None:
    short = replace(SPEEDING, last_s=108.0, due_until_s=108.0)
    assert judged(events=(short,)).events[0].outcome is EventOutcome.VOID
    assert judged(warn(105.0), events=(short,)).events[0].outcome is EventOutcome.HIT


def test_what_becomes_due_too_late_for_anybody_is_void_however_long_it_could_be_seen() -> None:
    """A jam that could be seen from afar, and to which the car comes fast only in the last metres."""
    sudden = replace(SPEEDING, observable_s=40.0, obliged_s=100.0, deadline_s=101.0)
    assert judged(events=(sudden,)).events[0].outcome is EventOutcome.VOID
    assert judged(warn(98.0), events=(sudden,)).events[0].outcome is EventOutcome.PREPARED


def test_an_alert_is_about_what_is_due_soonest() -> None:
    """Poor visibility for rain on the glass, then the tunnel: the second is no repeat of the first."""
    wipers = replace(SPEEDING, kind="wipers", subject="", value=None)
    tunnel = replace(wipers, kind="tunnel", obliged_s=None, deadline_s=None, observable_s=100.0)
    acts = [warn(105.0, AlertKind.VISIBILITY), warn(115.0, AlertKind.TUNNEL)]
    worths = [act.worth for act in judged(*acts, events=(tunnel, wipers)).acts]
    assert worths == [Worth.RIGHT, Worth.NEUTRAL]


def test_an_alert_is_about_what_hardly_anything_else_settles() -> None:
    """A collision alert for a leader that brakes and is slow; then traffic tells of that, and is no repeat."""
    slow = replace(SPEEDING, kind="tractor", subject="", value=None)
    brakes = replace(slow, kind="leader_brakes", obliged_s=105.0)
    acts = [warn(105.0, AlertKind.COLLISION), warn(107.0, AlertKind.TRAFFIC)]
    assert [act.worth for act in judged(*acts, events=(slow, brakes)).acts] == [Worth.RIGHT, Worth.NEUTRAL]


def test_what_nobody_could_have_met_is_void() -> None:
    sudden = replace(SPEEDING, obliged_s=100.0, deadline_s=101.0)
    assert judged(events=(sudden,)).events[0].outcome is EventOutcome.VOID


def test_an_obligation_that_comes_only_without_the_agent_is_prevented() -> None:
    act = DriveAct(101.0, AlertKind.TUNNEL)
    assert judged(act, events=(APPROACH,), due={0: 110.0}).events[0].outcome is EventOutcome.PREVENTED
    assert judged(act, events=(APPROACH,), due={0: None}).events[0].outcome is EventOutcome.VOID
    assert judged(events=(APPROACH,), due={0: 110.0}).events[0].outcome is EventOutcome.VOID
    # what is void is no false alarm either: the tunnel could be known
    assert judged(act, events=(APPROACH,), due={0: None}).acts[0].worth is Worth.RIGHT


def test_an_event_of_the_agents_own_making_earns_nothing() -> None:
    """The cheat of switching lamps off in order to switch them on."""
    dark = replace(SPEEDING, kind="lamps", subject="", value=1.0)
    off, on = (
        DriveAct(at_s, writes=((LIGHTS.LOW_BEAM.path, lit),)) for at_s, lit in ((99.0, False), (105.0, True))
    )
    found = judged(off, on, events=(dark,))
    assert found.events[0].outcome is EventOutcome.CAUSED
    assert found.events[0].credit == -1.0
    assert found.acts[0].worth is Worth.FALSE


def test_a_switch_set_back_is_no_nuisance_but_one_turned_for_nothing_is() -> None:
    lit, unlit = (
        DriveAct(at_s, writes=((LIGHTS.HIGH_BEAM.path, on),)) for at_s, on in ((10.0, True), (20.0, False))
    )
    assert [act.worth for act in judged(lit, unlit).acts] == [Worth.FALSE, Worth.NEUTRAL]


def test_words_and_stops_against_which_a_fact_speaks_are_nuisances() -> None:
    said, stopped = DriveAct(10.0, said="Signs are in mph here"), DriveAct(12.0, requests=(PullOver(),))
    assert [act.worth for act in judged(said, stopped).acts] == [Worth.FALSE, Worth.FALSE]
    assert judged(said).acts[0].reason == "no limit_units"
    assert judged(said, true=("limit_units",)).acts[0].worth is Worth.NEUTRAL


def test_words_that_no_kind_of_event_is_about_are_neither_right_nor_false() -> None:
    assert judged(DriveAct(105.0, said="Slow down a little")).acts[0].worth is Worth.NEUTRAL


def test_a_warning_is_false_only_if_a_fact_speaks_against_each_thing_that_it_can_mean() -> None:
    """A warning of speed may also mean the limit ahead, a school, weather, a jam or what stands ahead."""
    meant = [kind.name for kind in KINDS.values() if AlertKind.SPEED in kind.alerts]
    found = judged(warn(300.0)).acts[0]
    assert (found.worth, found.reason) == (Worth.FALSE, "; ".join(f"no {name}" for name in meant))
    for name in meant:
        assert judged(warn(300.0), true=(name,)).acts[0].worth is Worth.NEUTRAL


def test_what_is_true_is_not_a_look_alike_either() -> None:
    """Both are there: a limit that the car almost keeps, and a lower one ahead."""
    found = judged(warn(110.0), events=(LOOKALIKE,), true=("limit_falls",))
    assert (found.acts[0].worth, found.events[0].outcome) == (Worth.NEUTRAL, EventOutcome.AVOIDED)


def test_a_stop_must_be_due_and_not_only_true() -> None:
    stop = DriveAct(300.0, requests=(PullOver(),))
    meant = tuple(kind.name for kind in KINDS.values() if PullOver in kind.requests)
    found = judged(stop, true=meant).acts[0]
    assert (found.worth, found.reason) == (Worth.FALSE, NOT_DUE)
    soft = replace(SPEEDING, kind="tyre", subject="", value=None)
    assert judged(replace(stop, time_s=105.0), events=(soft,)).acts[0].worth is Worth.RIGHT


def test_to_crawl_is_not_to_keep_a_limit() -> None:
    speeds = {kmh: judged(DriveAct(105.0, requests=(SlowDown(kmh),))).events[0].outcome for kmh in (20.0, 45.0)}
    assert speeds == {20.0: EventOutcome.MISSED, 45.0: EventOutcome.HIT}


def test_what_is_true_and_was_just_told_is_a_repeat() -> None:
    worths = [act.worth for act in judged(warn(300.0), warn(330.0), warn(391.0), true=("over_limit",)).acts]
    assert worths == [Worth.NEUTRAL, Worth.REPEAT, Worth.NEUTRAL]


def test_thicker_fog_may_be_told_again_with_a_clearly_lower_speed() -> None:
    told = [
        replace(warn(at_s, AlertKind.VISIBILITY), speed_kmh=kmh)
        for at_s, kmh in ((300.0, 80.0), (320.0, 50.0), (335.0, 45.0))
    ]
    worths = [act.worth for act in judged(*told, true=("weather_speed",)).acts]
    assert worths == [Worth.NEUTRAL, Worth.NEUTRAL, Worth.REPEAT]


def test_what_was_just_told_of_another_case_is_no_repeat() -> None:
    """Two vehicles that brake ahead, half a minute apart, and nobody in between."""

    def against(kind: EventKind, time_s: float) -> str | None:
        there = kind.name == "leader_brakes" and not 310.0 <= time_s <= 325.0
        return None if there else "nobody ahead"

    acts = [warn(300.0, AlertKind.COLLISION), warn(335.0, AlertKind.COLLISION)]
    found = judge(KINDS, (), acts, {}, against).acts
    assert [(act.worth, act.about) for act in found] == [(Worth.NEUTRAL, "leader_brakes")] * 2


def test_what_comes_back_within_a_minute_may_be_told_again() -> None:
    """The driver slows down when warned, and soon drives too fast once more."""

    def against(kind: EventKind, time_s: float) -> str | None:
        return "the car keeps the limit" if 110.0 <= time_s <= 120.0 or kind.name != "over_limit" else None

    acts = judge(KINDS, (SPEEDING,), [warn(105.0), warn(125.0), warn(135.0)], {}, against).acts
    assert [act.worth for act in acts] == [Worth.RIGHT, Worth.NEUTRAL, Worth.REPEAT]


def test_hazard_lights_for_who_comes_fast_from_behind_are_neutral() -> None:
    lit = DriveAct(300.0, writes=((LIGHTS.HAZARD.path, True),))
    assert judged(lit, true=("rear_end",)).acts[0].worth is Worth.NEUTRAL
    assert judged(lit).acts[0].worth is Worth.FALSE


def test_to_take_advice_back_is_no_act_and_what_the_road_refuses_is_none() -> None:
    driving = moment(kmh=30.0).driving
    back, slower = (CommandRecord(300.0, Ask(SlowDown(kmh)), frozenset({"requests"})) for kmh in (50.0, 30.0))
    taken, asked = (
        next(acts_of([replace(record, answers=((record.command.request, Answer(True, "")),))], driving))
        for record in (back, slower)
    )
    assert (taken.releases, taken.holds_back, asked.releases) == (True, False, False)
    assert judged(taken).acts[0].worth is Worth.NEUTRAL
    assert judged(asked).acts[0].worth.is_false
    refused = replace(slower, answers=((SlowDown(30.0), Answer(False, "too slow for this road")),))
    assert not list(acts_of([refused], driving))
    assert refusal(refused) == "too slow for this road"


def test_a_repeat_holds_nobody_back() -> None:
    """A red warning of a tyre that the driver was told of just now costs a nuisance, and no minutes."""
    soft = replace(SPEEDING, kind="tyre", subject="", value=None)
    red = DriveAct(120.0, AlertKind.VEHICLE, Severity.CRITICAL)
    found = judged(warn(105.0, AlertKind.VEHICLE), red, events=(soft,), true=("tyre",)).acts[1]
    assert (found.worth, found.holds_s) == (Worth.REPEAT, 0.0)
    assert judged(replace(red, time_s=300.0)).acts[0].holds_s > 0.0


def test_a_limit_that_the_car_keeps_at_its_sign_is_void() -> None:
    """A driver who brakes late, but in time."""
    falls = replace(SPEEDING, kind="limit_falls", due_until_s=118.0)
    assert judged(events=(falls,)).events[0].outcome is EventOutcome.MISSED
    eased = replace(falls, eased_s=119.0)
    assert judged(events=(eased,)).events[0].outcome is EventOutcome.VOID
    assert judged(warn(105.0), events=(eased,)).events[0].outcome is EventOutcome.HIT
    assert judged(events=(replace(SPEEDING, eased_s=141.0),)).events[0].outcome is EventOutcome.MISSED


def test_a_command_that_no_kind_concerns_is_against_the_order() -> None:
    assert (
        judged(DriveAct(10.0, writes=(("Vehicle.Cabin.Infotainment.Media.Volume", 50.0),))).acts[0].reason == ORDER
    )


def test_one_alert_settles_all_that_it_is_about() -> None:
    other = replace(SPEEDING, kind="school_zone", subject="a")
    assert [event.outcome for event in judged(warn(105.0), events=(SPEEDING, other)).events] == [
        EventOutcome.HIT
    ] * 2


def test_a_second_alert_may_be_about_a_second_event() -> None:
    """The tyre and the tailgate share a kind of alert: two alerts for two events are no repeat, a third is."""
    tyre = replace(SPEEDING, kind="tyre", subject="", value=None)
    door = replace(tyre, kind="door")
    acts = [warn(at_s, AlertKind.VEHICLE) for at_s in (105.0, 108.0, 111.0)]
    assert [act.worth for act in judged(*acts, events=(tyre, door), true=("tyre", "door")).acts] == [
        Worth.RIGHT,
        Worth.NEUTRAL,
        Worth.REPEAT,
    ]


# --- the score -----------------------------------------------------------------------------------------------


def test_doing_nothing_is_0_and_perfection_100() -> None:
    assert score(judged(), 600.0).value == 0.0
    assert score(judged(warn(105.0)), 600.0).value == 100.0


def test_each_nuisance_costs_the_same() -> None:
    one, two = (score(judged(warn(105.0), *(warn(300.0 + 100 * i) for i in range(n))), 600.0) for n in (1, 2))
    assert 100.0 - one.value == pytest.approx(100 * NUISANCE / 2)
    assert one.value - two.value == pytest.approx(100.0 - one.value)


def test_who_takes_each_look_alike_for_its_event_gains_nothing() -> None:
    """Blue lights and plain vans, told alike; and one who tells them apart."""
    light = replace(SPEEDING, kind="blue_light", subject="", value=None, weight=2.0)
    van = replace(light, lookalike=True, observable_s=400.0, last_s=440.0, obliged_s=None, deadline_s=None)
    alike = [warn(at_s, AlertKind.YIELD) for at_s in (105.0, 410.0)]
    assert score(judged(*alike, events=(light, van)), 600.0).value == 0.0
    assert score(judged(alike[0], events=(light, van)), 600.0).value == 100.0


def test_on_a_drive_without_events_nothing_can_be_gained() -> None:
    assert score(judged(events=(LOOKALIKE,)), 600.0).value == 0.0
    assert score(judged(warn(110.0), events=(LOOKALIKE,)), 600.0).value < 0.0
    assert score(judged(events=()), 600.0).recall is None


def test_a_drive_without_events_changes_no_score_of_several() -> None:
    """A drive and a pool of drives mean the same by their scores."""
    good, empty = score(judged(warn(105.0)), 600.0), score(judged(events=(LOOKALIKE,)), 600.0)
    assert together((good, empty, empty)).value == good.value == 100.0
    assert together((empty, empty)).value == 0.0
    one, four = (together([score(judged(warn(110.0), events=(LOOKALIKE,)), 600.0)] * n).value for n in (1, 4))
    assert one == four < 0.0


STOP = DriveAct(90.0, requests=(PullOver(),))


def stopped(*acts: DriveAct) -> Judgement:
    """A drive on which nothing arises, while the do-nothing run speeds."""
    against = {"over_limit": "the car keeps the limit"}
    return judge(KINDS, (), acts, {}, lambda kind, at_s: against.get(kind.name, "nothing"), {}, (SPEEDING,))


def test_what_was_avoided_by_stopping_for_no_reason_is_missed() -> None:
    (event,) = stopped(STOP).events
    assert (event.kind, event.outcome) == ("over_limit", EventOutcome.EVADED)
    assert not stopped().events
    assert not stopped(replace(STOP, time_s=300.0)).events


def test_what_was_told_or_settled_in_time_was_not_avoided() -> None:
    """The tailgate would have been open on the road; the car was stopped for nothing, and the tailgate closed."""
    door = replace(SPEEDING, kind="door", subject=CABIN.TRUNK.path, value=None)
    closed = DriveAct(100.0, writes=((CABIN.TRUNK.path, False),))

    def outcomes(*acts: DriveAct) -> list[EventOutcome]:
        against = {"door": None} if closed in acts else {}
        found = judge(KINDS, (), acts, {}, lambda kind, at_s: against.get(kind.name, "nothing"), {}, (door,))
        return [event.outcome for event in found.events]

    assert outcomes(STOP) == [EventOutcome.EVADED]
    assert outcomes(STOP, closed) == []


def test_a_stop_for_no_reason_costs_the_minutes_that_it_takes() -> None:
    needless, two = score(stopped(STOP), 600.0), score(stopped(STOP, replace(STOP, time_s=100.0)), 600.0)
    assert needless.held_s == 120.0
    assert two.held_s == 130.0
    assert needless.value < -100.0


def test_an_event_that_comes_in_spite_of_the_stop_counts_once() -> None:
    against = {"over_limit": "the car keeps the limit"}
    found = judge(
        KINDS, (SPEEDING,), (STOP,), {}, lambda kind, at_s: against.get(kind.name, "nothing"), {}, (SPEEDING,)
    )
    assert [event.outcome for event in found.events] == [EventOutcome.MISSED]


def test_an_alert_of_any_kind_every_ten_seconds_falls_below_0() -> None:
    kinds = tuple(AlertKind)
    acts = [warn(10.0 * i, kinds[i % len(kinds)]) for i in range(60)]
    assert score(judged(*acts), 600.0).value < 0.0


def test_drives_together_count_as_one() -> None:
    good, bad = score(judged(warn(105.0)), 600.0), score(judged(), 1200.0)
    both = together((good, bad))
    assert (both.events, both.met, both.driven_s) == (2, 1, 1800.0)
    assert both.recall == 0.5
    assert both.value == 50.0


@pytest.mark.parametrize("delay_s", [0.0, 3.0, 9.0, 13.0, 20.0])
def test_a_delay_loses_exactly_the_events_whose_deadline_it_passes(delay_s: float) -> None:
    events = tuple(
        replace(SPEEDING, kind=kind, observable_s=at_s, obliged_s=at_s + 4, deadline_s=at_s + 4 + left_s,
                last_s=at_s + 100, due_until_s=at_s + 100)
        for kind, at_s, left_s in (("over_limit", 100.0, 4.0), ("tyre", 300.0, 60.0), ("belt", 500.0, 10.0))
    )  # fmt: skip
    alerts = (AlertKind.SPEED, AlertKind.VEHICLE, AlertKind.SEAT_BELT)
    acts = [warn(event.observable_s + delay_s, alert) for event, alert in zip(events, alerts, strict=True)]
    lost = [event.outcome is EventOutcome.LATE for event in judged(*acts, events=events).events]
    assert lost == [event.observable_s + delay_s > (event.deadline_s or 0.0) for event in events]
