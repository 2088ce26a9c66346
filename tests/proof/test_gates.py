"""Each gate catches the fault it is there for, planted in a task that is sound otherwise."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from datetime import timedelta

import pytest

from automotive_cosim.agents.by_calls import translated
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.agents.trivial import Random
from automotive_cosim.cockpit.signals import ADAS, ENERGY, HVAC, SEAT
from automotive_cosim.contracts import (
    Action,
    ActionType,
    AlertKind,
    BoundingBox,
    GoalStatus,
    PullOver,
    Reason,
    VehicleState,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.interface.functions import call_of
from automotive_cosim.proof import first_sight, gates
from automotive_cosim.proof.functions import functions_are_not_enough, functions_win
from automotive_cosim.proof.hand_over import Ground, Script
from automotive_cosim.tasking import verdict
from automotive_cosim.tasking.checks import (
    AlertGiven,
    AllOf,
    AnyOf,
    AppDataIs,
    SignalIs,
    nothing_done,
    road_asked,
    signal_raised,
)
from automotive_cosim.tasking.moves import Do, Open, Tap, Warn
from automotive_cosim.tasking.task import Basis, Differs, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import (
    All,
    Not,
    Trigger,
    dark,
    driving,
    in_country,
    in_tunnel,
    lit,
    parked,
    signal_above,
    speed_between,
    standing,
)
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.future import KnownDrives
from tests.laws import over
from tests.written import COMFORT, ON_THE_WAY, asked

SAYS = ("Warm my seat.", "Seat heating on.", "My seat, please.", "Heat this seat.")
GRID = Start("grid", "avenue")
SOUND = asked(
    "seat",
    Module.HVAC,
    SAYS,
    SignalIs(SEAT.DRIVER_HEATING, (50.0,)),
    Open("climate"),
    Tap("hvac.driver_seat_heating"),
    start=GRID,
    deadline=COMFORT,
    scenarios=("grid",),
)
ALWAYS = verdict.Part(True, "whatever")


@dataclass(frozen=True)
class _EverHeated:
    """Held at any time, so that putting it back changes nothing: what no goal may be."""

    writes = frozenset({SEAT.DRIVER_HEATING.path})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return any(moment.signals[SEAT.DRIVER_HEATING.path] > 0 for moment in trace)


@dataclass(frozen=True)
class _AnySeat:
    """Does not care which seat."""

    writes = frozenset({SEAT.DRIVER_HEATING.path})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return any(now.signals[seat.path] > 0 for seat in (SEAT.DRIVER_HEATING, SEAT.PASSENGER_HEATING))


@dataclass(frozen=True)
class _AnyRequest:
    """Does not care what the road is asked for."""

    writes = frozenset({"requests"})

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return len(now.commands["requests"]) == len(start.commands["requests"]) + 1


@pytest.fixture
def ground(simulations):
    grounds, drives = [], KnownDrives(simulations)

    def reach(task: Task, half: str = "first") -> Ground:
        grounds.append(Ground.reach(task, half, 0, drives))
        return grounds[-1]

    yield reach
    for made in grounds:
        made.close()
    drives.close()


def changed(**fields: object) -> Task:
    return replace(SOUND, first=replace(SOUND.first, **fields))


HALF_GATES = ("oracle", "makes", "start", "world", "wording", "slip", "prefix", "late", "random", "effect")


@pytest.mark.parametrize("gate", HALF_GATES)
def test_a_sound_task_passes(ground, gate):
    assert list(getattr(gates, gate)(ground(SOUND))) == []


@pytest.mark.parametrize("gate", ["undone", "near", "coupled", "uncoupled", "optional", "knowable", "lawful"])
def test_a_sound_end_state_passes(ground, gate):
    stand = ground(SOUND)
    assert list(getattr(gates, gate)(stand, stand.reference)) == []


@pytest.mark.parametrize("gate", ["leak", "road", "repeat"])
def test_a_sound_start_passes(ground, simulations, gate):
    assert list(getattr(gates, gate)(ground(SOUND), simulations)) == []


PLANTED = (
    ("oracle", changed(moves=(Open("climate"), Tap("hvac.passenger_seat_heating"))), "goal: not reached"),
    ("oracle", changed(moves=(Tap("hvac.no_such_widget"),)), "hvac.no_such_widget is not on the screen"),
    ("oracle", changed(ways=((Open("climate"), Tap("hvac.sync")),)), "^solution 1"),
    ("oracle", changed(deadline=replace(COMFORT, seconds=2.5)), "of 2.5 s"),
    ("start", changed(goal=SignalIs(SEAT.DRIVER_HEATING, (0.0,))), "^holds already"),
    ("start", replace(SOUND, templates=tuple(f"{words} (element 12)" for words in SAYS)), "by its number"),
    ("prefix", changed(moves=(*SOUND.first.moves, Open("home"))), "^complete after 2 actions succeeds$"),
)
"""An expert who fails, finds nothing to tap, has a second way that fails, or is too slow; a goal that holds at the
start, a widget named by its number, a way longer than need be."""


@over(PLANTED)
def test_a_planted_fault_is_seen(gate, task, told, ground):
    (wrong,) = getattr(gates, gate)(ground(task))
    assert re.search(told, wrong)


def test_a_slip_that_succeeds_or_cannot_be_made_is_seen(ground):
    missed, twice = (Open("climate"), Tap("hvac.sync")), (Open("climate"), Tap("hvac.driver_seat_heating", 2))
    assert list(gates.slip(ground(changed(slips=(missed, twice, ()))))) == []
    right, nowhere = SOUND.first.moves, (Tap("hvac.no_such_widget"),)
    wins, stuck = gates.slip(ground(changed(slips=(missed, right, nowhere))))
    assert wins == "slip 1 succeeds"
    assert stuck.startswith("slip 2 cannot be made: hvac.no_such_widget")


def test_a_deadline_that_does_not_count_is_seen(ground, monkeypatch):
    monkeypatch.setattr(verdict, "_in_time", lambda *_: ALWAYS)
    (wrong,) = gates.late(ground(SOUND))
    assert wrong == "succeeds 30 s late"


def test_a_goal_that_survives_being_undone_is_seen(ground):
    stand = ground(changed(goal=_EverHeated()))
    assert list(gates.undone(stand, stand.reference)) == ["succeeds with everything reverted"]


def test_a_goal_that_takes_the_wrong_seat_is_seen(ground):
    stand = ground(changed(goal=_AnySeat(), may_write=frozenset({SEAT.PASSENGER_HEATING.path})))
    assert any("PassengerSide" in wrong for wrong in gates.near(stand, stand.reference))


@pytest.mark.parametrize(
    ("goal", "wrong"), [(_AnyRequest(), 1), (road_asked(PullOver), 0)], ids=["any", "that one"]
)
def test_a_goal_that_takes_another_request_is_seen(ground, goal, wrong):
    stand = ground(changed(goal=goal, moves=(Open("safety"), Tap("safety.pull_over"))))
    assert list(gates.near(stand, stand.reference)) == ["succeeds with requests something else"] * wrong


@pytest.mark.parametrize(
    ("condition", "stands", "moves"),
    [
        (parked(), True, False),
        (All((dark(), All((standing(), lit())))), True, False),
        (Not(parked()), False, False),
        (All((dark(), driving())), False, True),
        (speed_between(0.0, 12.0), False, True),
        (speed_between(-1.0, 12.0), False, False),
        (Not(driving()), False, False),
    ],
    ids=str,
)
def test_a_trigger_that_asks_for_a_standing_or_a_moving_car_is_known_by_its_structure(condition, stands, moves):
    assert gates._requires(condition, gates._stands) is stands
    assert gates._requires(condition, gates._moves) is moves


def test_a_verdict_blind_to_side_effects_is_seen(ground, monkeypatch):
    stand = ground(SOUND)
    played = stand.reference
    monkeypatch.setattr(verdict, "_clean", lambda *_: ALWAYS)
    assert len(list(gates.coupled(stand, played))) > 100


def test_a_switch_that_the_car_couples_to_the_goal_fails_when_it_is_turned_by_itself(ground):
    """Air conditioning follows the fan in this car, but nobody asked for it."""
    goal = SignalIs(HVAC.FAN_SPEED, (100.0,))
    stand = ground(changed(goal=goal, moves=(Open("climate"), Tap("hvac.fan.max"))))
    assert stand.reference.success
    taps = (Open("climate"), Tap("hvac.fan.max"), Tap("hvac.air_conditioning"))
    played = stand.play(stand.oracle(taps))
    assert played.verdict.goal.ok
    assert played.verdict.clean.why == "also changed: air conditioning is on, was off"


ONE_SIDE = {
    "goal": SignalIs(HVAC.DRIVER_TEMPERATURE, (21.5,)),
    "moves": (Open("climate"), Tap("hvac.driver_temperature.increase")),
}


def test_what_only_followed_may_be_set_back_or_kept_from_following(ground, monkeypatch):
    """The passenger's side follows the driver's while both are in sync."""
    stand = ground(changed(**ONE_SIDE))
    assert list(gates.uncoupled(stand, stand.reference)) == []
    monkeypatch.setattr(verdict, "parted", lambda *_: frozenset())
    wrong = list(gates.uncoupled(stand, stand.reference))
    assert any("as before, which only followed" in words for words in wrong)
    assert any("IsSyncActive off first" in words for words in wrong)


def test_a_profiles_temperature_may_be_parted_from_the_passengers():
    half = replace(SOUND.first, goal=AppDataIs("driver.profile", ("Guest",)))
    assert verdict.may_part(half) == {HVAC.SYNC.path}
    both = AllOf((half.goal, SignalIs(HVAC.PASSENGER_TEMPERATURE, (21.0,))))
    assert verdict.may_part(replace(half, goal=both)) == frozenset()


def test_sync_is_no_side_effect_only_where_one_side_is_asked_for(ground):
    stand = ground(SOUND)
    played = stand.play(stand.oracle((*SOUND.first.moves, Tap("hvac.sync"))))
    assert played.verdict.clean.why == "also changed: sync is off, was on"


def test_an_alert_that_takes_no_advice_is_seen(ground, monkeypatch):
    warned = changed(goal=AlertGiven(AlertKind.TUNNEL), moves=(Warn(AlertKind.TUNNEL),))
    stand = ground(warned)
    assert list(gates.optional(stand, stand.reference)) == []
    monkeypatch.setattr(AlertGiven, "_advises", lambda self, speed_kmh, then: speed_kmh is None)
    (wrong,) = gates.optional(stand, stand.reference)
    assert "speed_kmh" in wrong


def test_a_set_point_that_warms_nobody_is_seen(ground):
    start = replace(GRID, cabin={"temperature_c": 8.0})
    task = changed(goal=signal_raised(HVAC.DRIVER_TEMPERATURE, 2.0), start=start, moves=())
    moves = (Open("climate"), Tap("hvac.driver_temperature.increase", times=4))
    task = replace(task, dimension=Dimension.IMPLICIT_INTENT, first=replace(task.first, moves=moves))
    (wrong,) = gates.effect(ground(task))
    assert wrong.startswith("solution 0 has no effect on the air")
    blown = replace(
        task.first, goal=SignalIs(HVAC.FAN_SPEED, (100.0,)), moves=(Open("climate"), Tap("hvac.fan.max"))
    )
    assert list(gates.effect(ground(replace(task, first=blown)))) == []


def test_words_that_could_mean_both_are_seen(ground):
    task = CATALOGUE["hvac_ask_which_defroster"]
    vague = replace(task, templates=("Defroster off.", *task.templates[1:]))
    assert list(gates.wording(ground(task))) == []
    assert list(gates.wording(ground(vague))) == ["'Defroster off.' does not say that one of several is meant"]


def test_a_cruise_above_the_limit_is_seen(ground):
    goal = AllOf((SignalIs(ADAS.CRUISE_ACTIVE, (True,)), SignalIs(ADAS.CRUISE_SPEED, (180.0,))))
    start = replace(GRID, signals={ADAS.CRUISE_SPEED.path: 180.0})
    moves = (Open("vehicle"), Tap("vehicle.tab.assistance"), Tap("adas.cruise"))
    stand = ground(changed(goal=goal, moves=moves, start=start))
    (wrong,) = gates.lawful(stand, stand.reference)
    assert wrong.startswith("has cruise control hold 180 km/h where the limit is ")


def test_a_task_that_wants_nothing_is_seen(ground):
    free = changed(goal=AnyOf((SignalIs(HVAC.AUTO, (True,)), nothing_done())), moves=())
    wrong = list(gates.trivial({"first": ground(free)}))
    assert "complete wins" in wrong


def test_functions_win_what_touch_wins_and_nothing_by_themselves(ground):
    stand = ground(SOUND)
    assert [call_of(call.action) for call in translated(stand.episode.branch())] == [
        ("set_seat_heating", {"which": "driver", "percent": 50.0}),
        ("status", {"goal_status": GoalStatus.COMPLETE}),
    ]
    assert list(functions_win(stand)) == []
    assert list(functions_are_not_enough({"first": stand})) == []
    (wrong,) = functions_win(ground(changed(goal=SignalIs(SEAT.DRIVER_HEATING, (50.0, -50.0)))))
    assert "succeeds with set_seat_heating {'which': 'driver', 'percent': -50.0}" in wrong
    free = changed(goal=AnyOf((SignalIs(HVAC.AUTO, (True,)), nothing_done())), moves=())
    assert "complete at once wins by functions" in list(functions_are_not_enough({"first": ground(free)}))


def test_a_task_that_luck_wins_is_seen(ground, monkeypatch):
    monkeypatch.setattr(gates, "Random", lambda number: Oracle())
    assert list(gates.random(ground(SOUND))) == ["random actions win 20 of 20, where chance explains 1"]


def test_a_refusal_may_be_won_by_the_declarations_of_chance(ground):
    refused = ground(changed(goal=nothing_done(), moves=(), declares=GoalStatus.INFEASIBLE))
    assert list(gates.random(refused)) == []
    assert [gates.by_chance(trials, 1 / 3) for trials in (0, 1, 4, 5, 9, 20)] == [0, 1, 4, 4, 6, 12]
    assert gates.by_chance(20, 0.0) == 0


def test_only_what_is_lost_is_given_up(ground):
    """Luck that ends in success without giving up does so with it, and the other way round."""
    easy = ground(replace(SOUND, first=replace(SOUND.first, goal=AnyOf((SOUND.first.goal, nothing_done())))))
    for at in (easy, ground(SOUND)):
        for number in range(8):
            whole, short = (at.play(at.agent(Random(number)), stop_when_lost=stop) for stop in (False, True))
            assert whole.success == short.success
            assert len(short.actions) <= len(whole.actions)
    assert easy.play(easy.oracle(), stop_when_lost=True).success


def test_a_side_effect_that_stays_ends_a_hopeless_run(ground):
    at = ground(SOUND)
    alerts = Script((Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED), Action(ActionType.WAIT, seconds=1)))
    assert at.play(alerts, stop_when_lost=True).actions == ()
    harmless = Script((Action(ActionType.OPEN_APP, app_name="Media"), *alerts.actions))
    assert len(at.play(harmless, stop_when_lost=True).actions) == 1
    assert len(at.play(alerts).actions) > 1


def test_a_trigger_without_a_drive_is_seen(ground, simulations):
    free = changed(trigger=Trigger(signal_above(HVAC.CABIN_TEMPERATURE, -50.0), for_s=2.0, within_s=20.0))
    assert list(gates.road(ground(free), simulations)) == ["its trigger is reached by a parked car"]


def test_a_pair_with_one_right_act_is_seen(ground):
    pair = replace(SOUND, second=SOUND.first, difference="none")
    grounds = {half: ground(pair, half) for half in pair.halves}
    assert len(list(gates.law(grounds))) == 2


def test_a_pair_that_can_always_be_declined_is_seen(ground):
    declares, reasons = GoalStatus.INFEASIBLE, frozenset({Reason.SAFETY})
    idle = Half(GRID, ON_THE_WAY, nothing_done(), (), COMFORT, Basis.WISH, declares=declares, reasons=reasons)
    pair = replace(SOUND, first=idle, second=idle, difference="none")
    grounds = {half: ground(pair, half) for half in pair.halves}
    assert f"{GoalStatus.INFEASIBLE} wins both halves" in list(gates.trivial(grounds))


@pytest.mark.parametrize(
    ("start", "differs", "seen"),
    [
        (GRID, "traffic", ""),
        (replace(GRID, cabin={"temperature_c": 12.0}), "place and road", "cabin_temperature_c"),
        (replace(GRID, cabin={"temperature_c": 12.0}), "weather", ""),
        (replace(GRID, signals={HVAC.DRIVER_TEMPERATURE.path: 16.0}), "weather and date", "the settings"),
        (replace(GRID, start="2026-03-10T20:30:00"), "road", "the local time"),
        (replace(GRID, start="2026-03-10T20:30:00"), "date", ""),
        (replace(GRID, sign_camera=False), "weather", "the sign"),
        (
            replace(GRID, signals={ENERGY.LEVEL.path: 71.9}),
            "place, road, date, weather and motion",
            "energy_level_pct",
        ),
        (replace(GRID, cabin={"humidity_pct": 40.1}), "place, road, date and motion", "cabin_humidity_pct"),
        (
            replace(GRID, weather=None, start="2026-03-10T08:30:01"),
            "place, road, weather and motion",
            "the local time",
        ),
    ],
)
def test_a_pair_that_gives_itself_away_is_seen(ground, start, differs, seen):
    pair = replace(SOUND, second=replace(SOUND.first, start=start), difference=f"{differs}: one, or the other")
    wrong = list(gates.sight({half: ground(pair, half) for half in pair.halves}))
    assert bool(wrong) == bool(seen)
    assert seen in "; ".join(wrong)


def test_whatever_an_observation_tells_is_compared(ground):
    """Every field that differs alone gives a pair away that declares nothing."""
    taken = ground(SOUND, "first")
    seen, moment = taken.episode.observation, taken.episode.moments[0]
    assert list(first_sight.undeclared(frozenset(), (seen, moment), (seen, moment))) == []
    others = [replace(seen, goal="Else."), replace(seen, elements=seen.elements[:-1])]
    others += [replace(seen, vehicle=replace(seen.vehicle, **change)) for change in _changes(seen.vehicle)]
    others += [replace(seen, gps=replace(seen.gps, **change)) for change in _changes(seen.gps)]
    for place, element in enumerate(seen.elements):
        for change in _changes(element):
            changed = replace(element, **change)
            others.append(replace(seen, elements=(*seen.elements[:place], changed, *seen.elements[place + 1 :])))
    for other in others:
        assert list(first_sight.undeclared(frozenset(), (seen, moment), (other, moment))), other


def test_whatever_a_line_of_the_context_is_made_of_is_compared(ground):
    taken = ground(SOUND, "first")
    seen, moment = taken.episode.observation, taken.episode.moments[0]
    road, limit = moment.context.road, moment.context.road.limit
    for there in (
        replace(road, road_class="motorway"), replace(road, lane_count=7), replace(road, in_tunnel=True),
        replace(road, name="Elsewhere"), replace(road, school_zone=True),
        replace(road, limit=replace(limit, mps=7.0)),
        replace(road, built_up=not road.built_up), replace(road, limit_hours="40 km/h Mo"),
    ):  # fmt: skip
        driving = replace(moment.driving, road=there)
        context = replace(moment.context, driving=driving)
        assert list(
            first_sight.undeclared(frozenset(), (seen, moment), (seen, replace(moment, context=context)))
        ), there
    later = replace(moment, local_time=moment.local_time + timedelta(seconds=1))
    assert list(first_sight.undeclared(frozenset(), (seen, moment), (seen, later)))
    for change in _changes(moment.weather):
        other = replace(moment, weather=replace(moment.weather, **change))
        assert list(first_sight.undeclared(frozenset(), (seen, moment), (seen, other))), change
    for change in _changes(moment.connectivity):
        other = replace(moment, connectivity=replace(moment.connectivity, **change))
        assert list(first_sight.undeclared(frozenset(), (seen, moment), (seen, other))), change


def _changes(what):
    """Another value of each field."""
    for field in fields(what):
        value = getattr(what, field.name)
        match value:
            case bool():
                yield {field.name: not value}
            case int() | float():
                yield {field.name: value + 0.001}
            case str():
                yield {field.name: value + " 1"}
            case None:
                yield {field.name: 1.0}
            case BoundingBox():
                yield {field.name: replace(value, x_min=value.x_min + 1)}


LYON, LEEDS = (4.85, 45.75), (-1.55, 53.80)


@pytest.mark.parametrize(
    ("tags", "origins", "countries", "rule", "seen"),
    [
        ((), (LYON, LEEDS), (), "", ""),
        (("place",), (LYON, LEEDS), (), "", "screens and vehicle tell all"),
        ((), (LYON, LEEDS), ("FR", "GB"), "", "it would not hold: the car is driving, in FR"),
        (("place",), (LYON, LEEDS), ("FR", "GB"), "", ""),
        ((), (LYON, LYON), (), "FR.horn", "Switzerland on horn: allowed, not forbidden"),
        (("place",), (LYON, LYON), (), "FR.horn", ""),
        ((), (LYON, LYON), (), "FR.yield_emergency", ""),
    ],
)
def test_a_wrong_tag_of_place_is_seen(ground, tags, origins, countries, rule, seen):
    halves = [
        replace(
            SOUND.first,
            start=replace(GRID, origin=origin),
            trigger=Trigger(All((driving(), *map(in_country, countries[at : at + 1]))), 3.0, 60.0),
            basis=Basis.LAW if rule else Basis.WISH,
            rule=rule,
        )
        for at, origin in enumerate(origins)
    ]
    pair = replace(
        SOUND, first=halves[0], second=halves[1], difference="place: here, or there", tags=frozenset(tags)
    )
    wrong = list(gates.place({half: ground(pair, half) for half in pair.halves}))
    assert bool(wrong) == bool(seen)
    assert seen in "; ".join(wrong)


def test_every_reading_has_a_facet_and_every_difference_frees_some():
    assert {field.name for field in fields(VehicleState)} == set(first_sight.READINGS)
    assert set(first_sight.FREED) == set(Differs)


def test_a_scenario_out_of_reach_is_seen(simulations):
    dark = changed(trigger=Trigger(in_tunnel(), for_s=1.0, within_s=5.0))
    (wrong,) = gates.reach(replace(dark, scenarios=("grid",)), 0, simulations)
    assert wrong.startswith("first in grid: ")


def test_an_expert_who_fails_in_another_scenario_is_seen(simulations):
    lost = changed(moves=())
    (wrong,) = gates.reach(replace(lost, scenarios=("grid",)), 0, simulations)
    assert wrong.startswith("first in grid: goal: ")
    assert list(gates.reach(replace(changed(), scenarios=("grid",)), 0, simulations)) == []


ASKING = CATALOGUE["hvac_ask_which_seat"]
TALKERS = {"always-ask", "asks first", "never asks"}


def on_grid(half: Half) -> Half:
    return replace(half, start=replace(half.start, scenario="grid", trip="avenue"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("loose", "winner"), [((), set()), (("second",), {"asks first"}), (("first",), {"never asks"})]
)
def test_asking_always_or_never_wins_only_where_a_half_does_not_care(ground, loose, winner):
    halves = {name: on_grid(ASKING.half(name)) for name in ASKING.halves}
    for name in loose:
        halves[name] = replace(halves[name], goal=halves[name].goal.checks[1])
    task = replace(ASKING, **halves)
    won = {why.partition(" wins")[0] for why in gates.trivial({name: ground(task, name) for name in halves})}
    assert won & TALKERS == winner


EITHER = replace(
    changed(moves=(Open("climate"), Tap("hvac.{seat}_seat_heating"))),
    templates=("Warm a seat.", "Seat heating on.", "One seat, please.", "Heat this seat."),
    parameters={"seat": ("driver", "passenger")},
)


def test_an_expert_who_guesses_is_seen(ground):
    stand = ground(EITHER)
    (wrong,) = gates.knowable(stand, stand.reference)
    assert "depends on seat" in wrong
    told = ground(replace(EITHER, templates=tuple(f"{words} {{seat}}" for words in EITHER.templates)))
    assert list(gates.knowable(told, told.reference)) == []


def test_halves_that_part_before_they_differ_are_seen(ground):
    other = replace(EITHER.first, moves=(Open("climate"), Tap("hvac.passenger_seat_heating")))
    blind = replace(SOUND, second=other, difference="content: a message that nobody opens, or none")
    (wrong,) = gates.parted({half: ground(blind, half) for half in blind.halves})
    assert wrong == "the halves part at action 2, before anything seen differs"
    seen = replace(blind, second=replace(other, start=replace(GRID, signals={HVAC.FAN_SPEED.path: 70.0})))
    assert list(gates.parted({half: ground(seen, half) for half in seen.halves})) == []


def test_a_tunnel_that_ends_before_the_solution_is_seen(ground):
    task = CATALOGUE["hvac_all_windows_a_crack"]
    patient = replace(task.first.deadline, seconds=90.0)
    wait = (Do(Action(ActionType.WAIT, seconds=10)),) * 7
    slow = replace(
        task,
        first=replace(task.first, deadline=patient),
        second=replace(task.second, moves=(*wait, *task.second.moves), deadline=patient),
    )
    wrong = list(gates.lasting({half: ground(slow, half) for half in slow.halves}))
    assert any(fault.startswith("first: in a tunnel for less than") for fault in wrong)
