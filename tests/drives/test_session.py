"""A session on a drive: what wakes, what ends it, and that watchers get what they deserve."""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from typing import Any

import pytest

from automotive_cosim.agents import Thinker, make_agent
from automotive_cosim.cockpit.signals import CABIN, CALL, GLASS, HMI, LIGHTS, MOTION, SEAT, TYRE
from automotive_cosim.contracts import (
    Action,
    ActionType,
    AlertKind,
    Element,
    GoalStatus,
    Observation,
    Sight,
    SightKind,
)
from automotive_cosim.contracts.given import Language, Order
from automotive_cosim.drives.alarm import Alarm, noticed
from automotive_cosim.drives.changes import LONGEST_S, WAKES
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.driver import driver_events, driver_line
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.order import ANSWERS, ordered
from automotive_cosim.drives.result import judged_since
from automotive_cosim.drives.score import Score, score
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.timeline import timeline
from automotive_cosim.drives.watchers import READS, AlertOnWake, RulePerfect, Silent
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.session import Actor, driven, play, playing
from automotive_cosim.episode.specification import End, SessionSetup
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.spaces import GOAL_BYTES
from automotive_cosim.run.drive import JudgedDrive
from automotive_cosim.tasking.reading import FOREIGN, shared
from automotive_cosim.traffic.base import Event
from automotive_cosim.traffic.fork import Simulations
from tests.drives.scenes import limit, moment, vehicle

FAMILY, SEED, FOR_S = "grid_june", 43, 240.0

Begin = Callable[..., DriveSession]


@pytest.fixture
def begin(simulations: Simulations) -> Iterator[Begin]:
    """Departs on a drive of which only the first minutes are driven."""
    sessions: list[DriveSession] = []

    def departed(seconds: float = FOR_S, channels: frozenset[Channel] = READS) -> DriveSession:
        world = depart(FAMILIES[FAMILY].draw(SEED), simulations)
        sessions.append(
            DriveSession.depart_with(world, SessionSetup(channels, max_steps=10_000, max_sim_s=seconds))
        )
        return sessions[-1]

    yield departed
    for session in sessions:
        session.close()


@pytest.fixture(scope="module")
def departures(simulations: Simulations) -> Iterator[Begin]:
    """The same for drives that several tests look at."""
    sessions: list[DriveSession] = []

    def departed() -> DriveSession:
        world = depart(FAMILIES[FAMILY].draw(SEED), simulations)
        sessions.append(DriveSession.depart_with(world, SessionSetup(READS, max_steps=10_000, max_sim_s=FOR_S)))
        return sessions[-1]

    yield departed
    for session in sessions:
        session.close()


@pytest.fixture(scope="module")
def perfect(departures: Begin) -> tuple[DriveSession, Score]:
    """A drive with the rule-perfect watcher."""
    session = departures()
    return session, played(session, RulePerfect())


@pytest.fixture(scope="module")
def silent(departures: Begin) -> tuple[DriveSession, Score]:
    """A drive with a watcher that says nothing."""
    session = departures()
    return session, played(session, Silent())


def played(session: DriveSession, actor: Actor) -> Score:
    play(session, actor)
    assert session.judgement is not None
    return score(session.judgement, session.seconds)


def woken(scenes: Sequence[dict[str, Any]]) -> dict[int, list[str]]:
    """By number of a scene, a second each, what wakes then; before them an ordinary moment."""
    alarm, drive, told = Alarm(), [moment(-2.0), moment(-1.0)], {}
    for count in (1, 2):
        alarm.see(drive[:count])
    for second, scene in enumerate(scenes):
        drive.append(moment(float(second), **scene))
        changes = alarm.see(drive)
        if changes:
            told[second] = [change.name for change in changes if change.wakes]
    return told


# --- what wakes ------------------------------------------------------------------------------------------------


def test_what_changes_is_told_once() -> None:
    assert woken([{"limit": limit(30), "kmh": 30}] * 2) == {0: ["limit"]}


def test_a_look_alike_wakes_as_well() -> None:
    for kmh in (52.0, 60.0):
        assert woken([{"kmh": kmh}] * 5) == {3: ["speed"]}


def test_what_has_ended_wakes_nobody_and_is_read_with_the_next_look() -> None:
    near, gone = {"leader": vehicle(15.0)}, dict[str, Any]()
    assert woken([near, near, gone, gone]) == {1: ["vehicle ahead"], 3: []}
    read = noticed([moment()], ["vehicle ahead", "school zone"]).splitlines()
    assert "vehicle ahead (changed): ended, nobody within 150 m" in read
    assert "school zone (changed): ended, no longer ahead" in read


def test_a_jam_that_the_car_has_reached_is_read_by_what_is_left_of_it() -> None:
    ahead, within = Sight(SightKind.JAM, "", 300.0), Sight(SightKind.JAM, "", 0.0, 140.0)
    assert "jam: in 300 m, 22 s at this speed" in noticed([moment(sights=(ahead,))]).splitlines()
    assert "jam: the car is in it, 140 m are left" in noticed([moment(sights=(within,))]).splitlines()
    assert woken([{"sights": (ahead,)}, {"sights": (within,)}, {}]) == {0: ["jam"], 2: []}


@pytest.mark.parametrize("kind", [SightKind.JAM, SightKind.ROADWORKS, SightKind.SCHOOL_ZONE])
def test_what_the_car_is_in_has_not_ended(kind: SightKind) -> None:
    """Its end is told once the car has left it, and its beginning is none."""
    name, ahead, within = kind.value.replace("_", " "), Sight(kind, "", 60.0), Sight(kind, "", 0.0)
    assert f"{name}: the car is in it" in noticed([moment(sights=(within,))]).splitlines()
    scenes = [{"sights": sights} for sights in ((ahead,), (within,), (within,), ())]
    assert woken(scenes) == {0: [name], 3: []}


def test_a_limit_that_falls_for_a_school_is_read_with_the_hours_of_its_sign() -> None:
    hours = "Mo-Fr 08:00-09:30"
    sign = {"next_limit": limit(40), "next_limit_distance_m": 100.0}
    seen = tuple(Sight(kind, "", 100.0, hours=hours) for kind in (SightKind.SCHOOL_ZONE, SightKind.LIMIT))
    read = noticed([moment(sights=seen, **sign)]).splitlines()
    assert "limit ahead: 40 km/h in 100 m, 7 s at this speed, signed for Mo-Fr 08:00-09:30" in read
    assert "school zone: in 100 m, 7 s at this speed, signed for Mo-Fr 08:00-09:30" in read
    assert "limit ahead: 40 km/h in 100 m, 7 s at this speed" in noticed([moment(**sign)]).splitlines()


def test_a_gap_that_becomes_shorter_than_a_second_wakes_again_and_one_that_opens_does_not() -> None:
    gaps_s = [1.9] * 3 + [0.8] * 3 + [1.5] * 3 + [0.8] * 3 + [1.5] * 13 + [0.8] * 3
    told = woken([{"leader": vehicle(gap_s * 50 / 3.6)} for gap_s in gaps_s])
    assert {second: names for second, names in told.items() if names} == {
        1: ["vehicle ahead"],
        4: ["vehicle ahead"],
        26: ["vehicle ahead"],
    }


def test_the_grip_is_read_before_it_matters_and_wakes_as_it_falls() -> None:
    grips = (1.0, 0.95, 0.85, 0.72, 0.65, 0.5, 0.45, 0.45, 0.55, 0.45)
    told = woken([{"friction": grip} for grip in grips])
    assert told == {second: ["grip"] for second in (2, 4, 6)}
    drive = [moment(float(second), friction=grip) for second, grip in enumerate(grips[:7])]
    assert "grip: 0.45 of 1, falling" in noticed(drive).splitlines()


def test_the_road_of_departure_is_no_change_a_second_later() -> None:
    alarm, drive = Alarm(), [moment(float(second)) for second in range(4)]
    told = [tuple(change.name for change in alarm.see(drive[:count])) for count in range(1, 5)]
    assert "road" in told[0]
    assert "road" not in {name for names in told[1:] for name in names}


def test_three_seconds_above_the_limit_wake_also_a_car_that_gets_faster() -> None:
    assert woken([{"kmh": kmh} for kmh in (52.0, 56.0, 61.0, 66.0, 66.0, 66.0, 66.0)]) == {3: ["speed"]}


def test_another_road_is_told_in_the_second_in_which_it_comes() -> None:
    classes = ["secondary", "trunk", "trunk", "secondary"]
    assert woken([{"road_class": road} for road in classes]) == {1: ["road"], 3: ["road"]}
    hours = [{"limit_hours": hours} for hours in ("", "Mo-Fr 08:00-09:30")]
    assert woken(hours) == {1: ["road"]}
    assert "road: secondary, another limit Mo-Fr 08:00-09:30" in noticed([moment(**hours[1])]).splitlines()


def test_a_reading_that_only_flickers_wakes_nobody() -> None:
    near = {"leader": vehicle(15.0)}
    assert woken([near, {}, near, {}, near, near]) == {5: ["vehicle ahead"]}


def test_fog_that_thickens_is_told_as_often_as_it_asks_for_less_speed() -> None:
    """In steps of some seconds, between which it falls as well."""
    seen_m = [70.0] * 12 + [38.0] * 12 + [21.0] * 18
    scenes = [{"visibility": visibility_m, "weather_code": 45} for visibility_m in seen_m]
    assert woken(scenes) == {0: ["weather"], 12: ["weather"], 24: ["weather"]}
    for second in (12, 23, 24, 41):
        drive = [moment(float(number), **scene) for number, scene in enumerate(scenes[: second + 1])]
        assert f"visibility {seen_m[second]:.0f} m, falling" in noticed(drive)
    assert woken([{"visibility": visibility_m} for visibility_m in (9000.0, 5000.0, 2000.0)]) == {}


def test_what_wakes_says_something_new(silent: tuple[DriveSession, Score]) -> None:
    """At the instant at which it wakes, or after the seconds for which it had to last; at departure all is new."""
    session, wakes = silent[0], {wake.name: wake for wake in WAKES}
    times_s = [round(each.time_s) for each in session.moments]
    told = [(times_s.index(round(time_s)), wakes[name]) for time_s, names in session.woken for name in names]
    assert told
    for at, wake in (each for each in told if each[0] > each[1].hold_s):
        before = session.moments[: at - round(wake.hold_s)]
        assert wake.words(session.moments[: at + 1][-20:]) != wake.words(before[-20:]), (at, wake.name)


def test_a_vehicle_ahead_wakes_in_time_to_brake_gently_and_once_more_when_it_is_urgent() -> None:
    scenes = [
        {"leader": vehicle(100.0, 10.0, time_to_collision_s=left_s)} for left_s in (8.5, 7.5, 6.5, 5.5, 4.5, 3.5)
    ]
    assert list(woken(scenes)) == [2, 5]


def test_nothing_ahead_wakes_in_a_queue() -> None:
    assert not woken([{"kmh": 5.0, "leader": vehicle(2.0, 0.0, time_to_collision_s=1.5)}] * 4)
    scenes = [{"kmh": kmh, "tunnel_distance_m": 100.0} for kmh in (50.0, 50.0, 0.0, 0.0, 20.0, 50.0, 50.0)]
    assert woken(scenes) == {0: ["tunnel"]}


@pytest.mark.parametrize("kmh", [30.0, 50.0, 90.0, 130.0])
def test_what_lies_ahead_wakes_before_it_is_due_whatever_the_speed(kmh: float) -> None:
    """Breakdowns 12 s ahead and limits from where a driver has to lift the foot: told 15 s before, and 2 s."""
    mps = kmh / 3.6
    for name, due_m, scene in (
        ("breakdown", 12.0 * mps, lambda m: {"sights": (Sight(SightKind.BREAKDOWN, "", m),)}),
        (
            "limit ahead",
            max(0.0, (mps**2 - (23.0 / 3.6) ** 2) / 2) + 1.1 * mps,
            lambda m: {"next_limit": limit(20), "next_limit_distance_m": m, "limit": limit(kmh)},
        ),
    ):
        starts_m = due_m + 20 * mps
        told = woken([{"kmh": kmh, **scene(starts_m - mps * second)} for second in range(20)])
        waits = [second for second, names in told.items() if name in names]
        assert waits == pytest.approx([5, 18], abs=1), (name, told)


def test_a_reading_states_quantity_limit_and_trend() -> None:
    drive = [moment(float(second), kmh=50.0 + second, signals=leak(second)) for second in range(15)]
    lines = noticed(drive).splitlines()
    assert "speed: 64 km/h, limit 50, rising" in lines
    pressures = "front left 250, front right 250, rear left 240 falling, rear right 250 kPa"
    assert f"tyres: {pressures}, recommended 250, too low below 200" in lines
    ahead = noticed([moment(leader=vehicle(25.0, 36.0, time_to_collision_s=6.4))]).splitlines()
    assert "vehicle ahead: 25 m at 36 km/h, time gap 1.8 s, time to collision 6.4 s" in ahead


def test_what_is_still_ahead_does_not_read_as_if_it_were_here() -> None:
    ahead = Sight(SightKind.JAM, "", 0.3)
    assert "jam: in 1 m" in noticed([moment(kmh=0.0, sights=(ahead,))]).splitlines()


@pytest.mark.parametrize(
    ("signals", "words"),
    [
        ({}, "on: dipped beam, switch: beam"),
        ({LIGHTS.LOW_BEAM.path: False}, "on: daytime running lamps, switch: beam"),
        ({LIGHTS.LOW_BEAM.path: False, LIGHTS.REAR_FOG.path: True}, "on: rear fog lamp, daytime running lamps"),
        ({LIGHTS.LOW_BEAM.path: False, LIGHTS.FRONT_FOG.path: True}, "on: front fog lamps, switch"),
        ({LIGHTS.LOW_BEAM.path: False, MOTION.GEAR.path: "P"}, "on: none, switch"),
    ],
)
def test_lamps_that_light_by_themselves_are_read_too(signals: dict[str, Any], words: str) -> None:
    assert f"lamps: {words}" in noticed([moment(signals=signals)])


def test_a_reading_that_has_just_turned_round_reads_as_it_goes() -> None:
    fogged = [0.02 * second for second in range(8)] + [0.1, 0.06]
    drive = [moment(float(s), signals={GLASS.WINDSHIELD_FOG.path: fog}) for s, fog in enumerate(fogged)]
    assert "windshield fogged by 6.0%, falling" in noticed(drive)
    assert "windshield fogged by 14.0%, rising" in noticed(drive[:8])


def test_beyond_the_radar_there_is_no_vehicle_ahead() -> None:
    assert "vehicle ahead" not in noticed([moment(leader=vehicle(160.0))])
    assert "vehicle ahead" in noticed([moment(leader=vehicle(140.0))])


def test_who_hardly_closes_does_not_close_and_who_creeps_does_not_stand() -> None:
    slow = {"leader": vehicle(70.0, time_to_collision_s=4288.0)}
    assert "vehicle ahead: 70 m at 50 km/h, time gap 5.0 s, not closing" in noticed([moment(**slow)])
    assert "time gap 84.0 s" in noticed([moment(kmh=3.0, **slow)])
    assert "the car stands" in noticed([moment(kmh=0.0, **slow)])


@pytest.mark.parametrize(
    ("name", "signals"),
    [
        ("belt", {SEAT.DRIVER_BELT.path: False}),
        ("open", {CABIN.TRUNK.path: True}),
        ("phone", {CALL.PHONE.path: "HAND"}),
    ],
)
def test_what_stays_open_in_a_queue_wakes_once_more_and_no_oftener(name: str, signals: dict[str, Any]) -> None:
    scenes = [{"kmh": kmh, "signals": signals} for kmh in (0.0, 0.0, 8.0, 0.0, 8.0, 3.0, 9.0)]
    told = woken(scenes)
    assert [second for second, names in told.items() if name in names] == [0, 2]


def test_a_tyre_that_warms_up_is_no_change() -> None:
    kpa = (241.0, 239.0, 229.0, 231.0, 241.0, 239.0, 219.0)
    told = woken([{"signals": {TYRE.REAR_LEFT.path: value}} for value in kpa])
    assert told == {1: ["tyres"], 2: ["tyres"], 6: ["tyres"]}


def driver_words(*events: tuple[float, str, str], until_s: float, stands_s: float = 0.0) -> list[str]:
    """The line about the driver after some events, each at its second."""
    drive = [moment(float(second)) for second in range(int(until_s) + 1)]
    for at_s, kind, text in events:
        then = drive[int(at_s)]
        drive[int(at_s)] = replace(then, events=(*then.events, Event(at_s, f"driver_{kind}", f"driver {text}")))
    drive[-1] = replace(drive[-1], driving=replace(drive[-1].driving, standing_s=stands_s))
    return list(driver_line(drive[-1], driver_events(drive)))


def test_what_the_driver_was_asked_for_is_told_as_long_as_it_is_in_force() -> None:
    slows, stops = (10.0, "slows", "slows to 50 km/h"), (20.0, "pulls_over", "pulls over in 30 m")
    both = driver_words(slows, stops, until_s=100, stands_s=42.0)
    assert both == ["driver: slows to 50 km/h, 90 s ago; pulls over in 30 m, 80 s ago; the car stands for 42 s"]
    released = (90.0, "released", "drives as before; advice taken back")
    assert driver_words(slows, released, until_s=100) == ["driver: drives as before; advice taken back, 10 s ago"]
    assert driver_words(slows, released, until_s=160) == []
    over = (60.0, "goes_on", "goes on; the advised speed has ended")
    assert driver_words(slows, over, until_s=100) == ["driver: goes on; the advised speed has ended, 40 s ago"]
    assert driver_words(slows, over, until_s=130) == []
    assert driver_words(stops, (90.0, "drives_on", "drives on"), until_s=100) == ["driver: drives on, 10 s ago"]


def leak(second: int) -> dict[str, Any]:
    return {TYRE.REAR_LEFT.path: 250.0 - 0.7 * second}


def test_a_gauge_below_its_step_does_not_read_as_if_it_had_reached_it() -> None:
    assert "rear left 199" in noticed([moment(signals={TYRE.REAR_LEFT.path: 199.9})])


def test_every_wake_says_what_it_is_about() -> None:
    assert len({wake.name for wake in WAKES}) == len(WAKES)
    assert all(wake.about and "\n" not in wake.words([moment()]) for wake in WAKES)


def test_a_result_says_that_something_changed_and_not_what(begin: Begin) -> None:
    """So that no table of the words in results watches a drive: what changed stands in the readings."""
    session, told = begin(), set()
    while session.end is None:
        session.step(Action(ActionType.WAIT))
        told.add(re.sub(r"\d+", "N", session.observation.feedback.text))
        assert session.observation.vehicle is not None
        assert ("(changed)" in (session.observation.vehicle.noticed or "")) is bool(session.marked)
    assert told <= {"N s passed", "N s passed; something changed"}


# --- a session -------------------------------------------------------------------------------------------------


def test_a_wait_ends_when_something_changes_or_after_a_minute(begin: Begin) -> None:
    session = begin()
    waits = []
    while session.end is None:
        before_s = session.seconds
        session.step(Action(ActionType.WAIT))
        waits.append((round(session.seconds - before_s, 6), "; " in session.observation.feedback.text))
    assert all(waited_s <= LONGEST_S for waited_s, _ in waits)
    assert all(woken or waited_s == LONGEST_S for waited_s, woken in waits[:-1])
    assert any(0 < waited_s < LONGEST_S for waited_s, _ in waits)


def test_neither_a_status_nor_many_steps_end_a_watch(begin: Begin) -> None:
    session = begin(60.0)
    for _ in range(40):
        session.step(Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE))
    assert session.end is None
    assert session.declared is None
    played(session, Silent())
    assert session.end is End.MINUTES_OVER
    assert session.seconds == pytest.approx(60.0)


def test_a_picture_comes_when_it_is_asked_for(begin: Begin) -> None:
    session = begin(60.0, ALL)
    session.step(Action(ActionType.WAIT, seconds=1))
    assert session.observation.screenshot is None
    session.step(Action(ActionType.NAVIGATE_HOME))
    assert session.observation.screenshot is not None


def test_an_agent_that_breaks_down_leaves_the_drive_to_itself(begin: Begin) -> None:
    session = begin(120.0)
    session.step(Action(ActionType.WAIT, seconds=5))
    failed_s = round(session.seconds, 1)
    driven(session.ending(End.AGENT_FAILED, "its process has ended"))
    assert session.end is End.AGENT_FAILED
    assert session.seconds == pytest.approx(120.0)
    assert session.judgement is not None
    assert session.unwatched_from_s == failed_s < 10.0
    assert timeline(session)["watched_until_s"] == failed_s


def test_nothing_that_an_agent_reads_names_an_event(begin: Begin) -> None:
    class Reads(Silent):
        def act(self, observation: Observation) -> Action:
            words.append(f"{observation.goal} {observation.feedback.text} {observation.context}")
            return super().act(observation)

    words: list[str] = []
    played(begin(180.0), Reads())
    told = " ".join(words)
    assert not [word for word in ("lookalike", "oblig", "deadline", "event", "over_limit", "due") if word in told]


@pytest.mark.slow
def test_the_same_seed_and_actions_give_the_same_trace(begin: Begin, perfect: tuple[DriveSession, Score]) -> None:
    first, second = perfect[0], begin()
    assert played(second, RulePerfect()) == perfect[1]
    assert first.trace_sha256 == second.trace_sha256
    assert first.judgement == second.judgement


@pytest.mark.slow
def test_nobody_at_the_cockpit_scores_0_and_drives_as_the_baseline(silent: tuple[DriveSession, Score]) -> None:
    session, found = silent
    assert found.events >= 2
    assert (found.value, found.recall, found.false_alarms) == (0.0, 0.0, 0)
    assert [m.driving for m in session.moments] == [m.driving for m in session.baseline_moments]
    assert session.unwatched_from_s is None
    told = timeline(session)
    seconds = len(session.moments)
    for key in ("time_s", "speed_kmh", "limit_kmh", "gap_s", "ttc_s", "visibility_m", "grip", "lamps"):
        assert len(told[key]) == seconds, key
    assert len(told["wakes"]) == len(session.woken) > 0
    assert told["advice"] == []


@pytest.mark.slow
def test_attention_changes_nothing_by_itself_and_who_talks_and_flickers_takes_it(simulations: Simulations) -> None:
    class Flickers(Silent):
        def act(self, observation: Observation) -> Action:
            self.turn = getattr(self, "turn", 0) + 1
            if self.turn % 3 == 0:
                return Action(ActionType.ANSWER, text="There is a nice place to eat on the left")
            return (
                Action(ActionType.CLICK, x=40, y=680) if self.turn % 3 == 1 else Action(ActionType.WAIT, seconds=2)
            )

    def driven(attention: str, actor: Actor) -> DriveSession:
        settings, conditions = DriveSettings(minutes=1.5), Conditions.named({"attention": attention})
        spec = DriveSpec(FAMILY, SEED, conditions, settings=settings)
        with closing(spec.begin(simulations, READS)) as session:
            play(session, actor)
        return session

    off, on = (driven(each, Silent()) for each in ("off", "on"))
    assert [(step.moment.driving, step.elements) for step in off.steps] == [
        (step.moment.driving, step.elements) for step in on.steps
    ]
    assert {moment.awareness for moment in off.moments} == {None}
    first, second = driven("on", Flickers()), driven("on", Flickers())
    assert first.trace_sha256 == second.trace_sha256
    assert [m.driving for m in first.baseline_moments] == [m.driving for m in off.moments]
    mine, baseline = first.harms
    assert baseline.unaware_s == 0.0 < 10.0 < mine.unaware_s
    assert min(timeline(first)["awareness"]) < 0.7
    speeds = [[m.driving.speed_mps for m in each.moments] for each in (off, first, driven("off", Flickers()))]
    assert speeds[0] == speeds[2] != speeds[1]


@pytest.mark.slow
def test_the_rule_perfect_watcher_meets_every_event_and_disturbs_nobody(
    perfect: tuple[DriveSession, Score],
) -> None:
    session, found = perfect
    assert found.events >= 2
    assert found.recall == 1.0
    assert found.nuisances == 0
    assert found.value > 90.0
    mine, baseline = session.harms
    assert mine.over_limit_s <= baseline.over_limit_s


@pytest.mark.slow
def test_who_alerts_by_rote_does_worse_than_nobody(begin: Begin) -> None:
    """On the road; whole drives and other habits are on record (``test_laws.py``)."""
    session = begin()
    assert played(session, AlertOnWake()).value < 0.0
    assert session.judgement is not None
    again = JudgedDrive.of(session).judgement()
    assert again == judged_since(session.judgement, session.moments[0].time_s, session.seconds), "as from its file"


@pytest.mark.slow
def test_the_stand_in_keeps_watch_with_one_call_a_wait(begin: Begin) -> None:
    agent = make_agent("asurada", "rules")
    session = begin(channels=agent.channels)
    agent.reset(session.goal)
    assert session.observation.on_watch
    asked = []

    def count(session: DriveSession, seen: Sequence[Element]) -> None:
        assert isinstance(agent, Thinker)
        asked.append((session.steps[-2].action, sum(stage.reply is not None for stage in agent.stages)))

    driven(playing(session, agent, count))
    assert session.judgement is not None
    assert score(session.judgement, session.seconds).met > 0
    waited = {calls for before, calls in asked if before is not None and before.action_type is ActionType.WAIT}
    assert waited == {1}


@pytest.mark.parametrize("language", Language)
def test_driver_and_car_speak_the_language(simulations: Simulations, language: Language) -> None:
    with closing(DriveSpec(FAMILY, SEED, Conditions(language=language)).begin(simulations)) as session:
        assert session.goal == ordered(Order.PLAIN, language, with_errands=False)
        assert session.world.cockpit.signals[HMI.LANGUAGE] == language
        session.step(Action(ActionType.ASK_DRIVER, text="?"))
        assert session.observation.said == (ANSWERS[language],)
        assert len(session.goal.encode()) <= GOAL_BYTES


def test_the_answer_is_the_one_that_drivers_give_in_tasks() -> None:
    for language in FOREIGN:
        assert shared().lines[language][ANSWERS[Language.ENGLISH]] == ANSWERS[language]


@pytest.mark.slow
def test_thinking_takes_time_on_the_road(begin: Begin) -> None:
    session = begin(60.0)
    driven(session.thinking(20.0))
    session.step(Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED))
    assert session.seconds == pytest.approx(21.0)
