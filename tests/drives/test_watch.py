"""A watch on a drive: what wakes, what ends it, and that watchers get what they deserve."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import pytest

from automotive_cosim.agents import Thinker, make_agent
from automotive_cosim.cockpit.signals import TYRE
from automotive_cosim.contracts import Action, ActionType, AlertKind, Element, GoalStatus, Observation
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.events import KINDS, WatchAct
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import JudgedEvent, judge, most_frequent
from automotive_cosim.drives.score import Score, score
from automotive_cosim.drives.wakes import LONGEST_S, WAKES, Alarm
from automotive_cosim.drives.watch import Watch
from automotive_cosim.drives.watchers import READS, AlertAll, AlertOften, AlertOnWake, RulePerfect, Silent
from automotive_cosim.episode.loop import Actor, play
from automotive_cosim.episode.specification import Conditions, End
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.traffic.fork import Simulations
from tests.drives.scenes import limit, moment, vehicle

FAMILY, SEED, FOR_S = "grid_june", 43, 420.0

Begin = Callable[..., Watch]


@pytest.fixture
def begin(simulations: Simulations) -> Iterator[Begin]:
    """Departs on a drive of which only the first minutes are driven."""
    watches: list[Watch] = []

    def departed(seconds: float = FOR_S, channels: frozenset[Channel] = READS) -> Watch:
        world = depart(FAMILIES[FAMILY].draw(SEED), simulations)
        watches.append(Watch.depart_with(world, Conditions(channels, max_steps=10_000, max_sim_s=seconds)))
        return watches[-1]

    yield departed
    for watch in watches:
        watch.close()


@pytest.fixture(scope="module")
def departures(simulations: Simulations) -> Iterator[Begin]:
    """The same for drives that several tests look at."""
    watches: list[Watch] = []

    def departed() -> Watch:
        world = depart(FAMILIES[FAMILY].draw(SEED), simulations)
        watches.append(Watch.depart_with(world, Conditions(READS, max_steps=10_000, max_sim_s=FOR_S)))
        return watches[-1]

    yield departed
    for watch in watches:
        watch.close()


@pytest.fixture(scope="module")
def perfect(departures: Begin) -> tuple[Watch, Score]:
    """A drive with the rule-perfect watcher."""
    watch = departures()
    return watch, played(watch, RulePerfect())


@pytest.fixture(scope="module")
def silent(departures: Begin) -> tuple[Watch, Score]:
    """A drive with a watcher that says nothing."""
    watch = departures()
    return watch, played(watch, Silent())


def played(watch: Watch, actor: Actor) -> Score:
    play(watch, actor)
    assert watch.judgement is not None
    return score(watch.judgement, watch.seconds)


def under_way() -> Alarm:
    """An alarm that has told what there was to tell."""
    alarm = Alarm()
    for second in range(2):
        alarm.see(moment(float(second)))
    return alarm


# --- what wakes ------------------------------------------------------------------------------------------------


def test_what_changes_is_told_once_and_what_is_over_wakes_nobody() -> None:
    alarm = under_way()
    (change,) = alarm.see(moment(2.0, limit=limit(30), kmh=30))
    assert (change.words, change.wakes) == ("limit: 30 km/h, the car drives 30", True)
    assert not alarm.see(moment(3.0, limit=limit(30), kmh=30))


def test_a_look_alike_wakes_as_well() -> None:
    for kmh in (52.0, 60.0):
        alarm = under_way()
        told = [change.words for second in range(2, 7) for change in alarm.see(moment(float(second), kmh=kmh))]
        assert told == [f"speed: {kmh:.0f} km/h where 50 apply"]


def test_a_leader_that_is_gone_is_told_with_the_next_change() -> None:
    alarm = under_way()
    near = [change for second in (2, 3) for change in alarm.see(moment(float(second), leader=vehicle(15.0)))]
    assert [change.wakes for change in near] == [True]
    gone = [change for second in (4, 5) for change in alarm.see(moment(float(second)))]
    assert [(change.words, change.wakes) for change in gone] == [("vehicle ahead: over", False)]


def test_three_seconds_above_the_limit_wake_also_a_car_that_gets_faster() -> None:
    alarm = under_way()
    speeds = [52.0, 56.0, 61.0, 66.0, 66.0, 66.0, 66.0]
    told = {second: alarm.see(moment(float(second), kmh=kmh)) for second, kmh in enumerate(speeds, start=2)}
    assert {second: [one.words for one in changes] for second, changes in told.items() if changes} == {
        5: ["speed: 66 km/h where 50 apply"]
    }


def test_a_reading_that_only_flickers_wakes_nobody() -> None:
    alarm = under_way()
    classes = ["trunk", "secondary", "trunk", "secondary", "trunk", "trunk"]
    told = [alarm.see(moment(float(second), road_class=road)) for second, road in enumerate(classes, start=2)]
    assert [len(changes) for changes in told] == [0, 0, 0, 0, 0, 1]


def test_a_vehicle_ahead_wakes_in_time_to_brake_gently_and_once_more_when_it_is_urgent() -> None:
    alarm = under_way()
    left = [8.5, 7.5, 6.5, 5.5, 4.5, 3.5]
    told = [
        alarm.see(moment(float(second), leader=vehicle(100.0, 10.0, time_to_collision_s=left_s)))
        for second, left_s in enumerate(left, start=2)
    ]
    assert [len(changes) for changes in told] == [0, 0, 1, 0, 0, 1]


def test_a_gauge_below_its_step_does_not_read_as_if_it_had_reached_it() -> None:
    tyre = {TYRE.REAR_LEFT.path: 199.9}
    told = [change.words for second in (2, 3) for change in under_way().see(moment(float(second), signals=tyre))]
    assert told[0] == "tyre: lowest 199 kPa"


def test_every_wake_says_what_it_is_about() -> None:
    assert len({wake.name for wake in WAKES}) == len(WAKES)
    assert all(wake.about and ";" not in wake.words(moment()) for wake in WAKES)


# --- a watch -------------------------------------------------------------------------------------------------


def test_a_wait_ends_when_something_changes_or_after_a_minute(begin: Begin) -> None:
    watch = begin(240.0)
    waits = []
    while watch.end is None:
        before_s = watch.seconds
        watch.step(Action(ActionType.WAIT))
        waits.append((round(watch.seconds - before_s, 6), "; " in watch.observation.feedback.text))
    assert all(waited_s <= LONGEST_S for waited_s, _ in waits)
    assert all(woken or waited_s == LONGEST_S for waited_s, woken in waits[:-1])
    assert any(0 < waited_s < LONGEST_S for waited_s, _ in waits)


def test_neither_a_status_nor_many_steps_end_a_watch(begin: Begin) -> None:
    watch = begin(60.0)
    for _ in range(40):
        watch.step(Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE))
    assert watch.end is None
    assert watch.declared is None
    played(watch, Silent())
    assert watch.end is End.WATCH_OVER
    assert watch.seconds == pytest.approx(60.0)


def test_a_picture_comes_when_it_is_asked_for(begin: Begin) -> None:
    watch = begin(60.0, ALL)
    watch.step(Action(ActionType.WAIT, seconds=1))
    assert watch.observation.screenshot is None
    watch.step(Action(ActionType.NAVIGATE_HOME))
    assert watch.observation.screenshot is not None


def test_an_agent_that_breaks_down_leaves_the_drive_to_itself(begin: Begin) -> None:
    watch = begin(120.0)
    watch.step(Action(ActionType.WAIT, seconds=5))
    watch.give_up("its process has ended")
    assert watch.end is End.AGENT_FAILED
    assert watch.seconds == pytest.approx(120.0)
    assert watch.judgement is not None


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
def test_the_same_seed_and_actions_give_the_same_trace(begin: Begin) -> None:
    first, second = begin(240.0), begin(240.0)
    assert played(first, RulePerfect()) == played(second, RulePerfect())
    assert first.trace_sha256 == second.trace_sha256
    assert first.judgement == second.judgement


@pytest.mark.slow
def test_nobody_at_the_cockpit_scores_0_and_drives_as_the_baseline(silent: tuple[Watch, Score]) -> None:
    watch, found = silent
    assert found.events >= 2
    assert (found.value, found.recall, found.false_alarms) == (0.0, 0.0, 0)
    assert [m.driving for m in watch.moments] == [m.driving for m in watch.baseline_moments]


@pytest.mark.slow
def test_the_rule_perfect_watcher_meets_every_event_and_disturbs_nobody(perfect: tuple[Watch, Score]) -> None:
    watch, found = perfect
    assert found.events >= 2
    assert found.recall == 1.0
    assert found.nuisances == 0
    assert found.value > 90.0
    mine, nobodys = watch.harms
    assert mine.over_limit_s <= nobodys.over_limit_s


@pytest.mark.slow
@pytest.mark.parametrize("watcher", [AlertAll(), AlertOnWake(), AlertOften()])
def test_who_alerts_by_rote_does_worse_than_nobody(begin: Begin, watcher: Actor) -> None:
    assert played(begin(), watcher).value < 0.0


@pytest.mark.slow
def test_the_stand_in_keeps_watch_with_one_call_a_wait(begin: Begin) -> None:
    agent = make_agent("asurada", "rules")
    watch = begin(240.0, agent.channels)
    agent.reset(watch.goal)
    asked = []

    def count(session: Watch, seen: Sequence[Element]) -> None:
        assert isinstance(agent, Thinker)
        asked.append((session.steps[-2].action, sum(stage.reply is not None for stage in agent.stages)))

    play(watch, agent, (count,))
    assert watch.judgement is not None
    assert score(watch.judgement, watch.seconds).met > 0
    waited = {calls for before, calls in asked if before is not None and before.action_type is ActionType.WAIT}
    assert waited == {1}


@pytest.mark.slow
def test_a_late_watcher_loses_and_delays(begin: Begin, perfect: tuple[Watch, Score]) -> None:
    _, prompt = perfect
    late = played(begin(), RulePerfect(delay_s=8.0))
    assert late.value < prompt.value
    assert late.late + late.missed > 0


class Muted(RulePerfect):
    """Notes what it would tell, and tells nobody: the drive is as with nobody at the cockpit."""

    def reset(self, goal: str) -> None:
        super().reset(goal)
        self.acts: list[WatchAct] = []
        self.begun_s = 0.0

    def act(self, observation: Observation) -> Action:
        action = super().act(observation)
        if action.action_type is ActionType.SHOW_ALERT:
            self.acts.append(WatchAct(self.begun_s + observation.time_s, action.kind))
            return Action(ActionType.WAIT, seconds=1)
        return action


@pytest.mark.slow
def test_a_delay_loses_exactly_the_events_whose_deadline_it_passes(begin: Begin) -> None:
    watch, agent = begin(), Muted()
    agent.reset(watch.goal)
    agent.begun_s = watch.moments[0].time_s
    play(watch, agent)

    def judged(delay_s: float) -> list[JudgedEvent]:
        late = [replace(act, time_s=act.time_s + delay_s) for act in agent.acts]
        return [event for event in judge(KINDS, watch.events, late, {}).events if not event.lookalike]

    prompt = [event for event in judged(0.0) if event.outcome.is_credited]
    assert len(prompt) >= 2
    for delay_s in (1.0, 3.0, 10.0, 30.0):
        credited = {(event.kind, event.observable_s) for event in judged(delay_s) if event.outcome.is_credited}
        for event in prompt:
            assert event.acted_s is not None
            assert event.deadline_s is not None
            in_time = event.acted_s + delay_s <= event.deadline_s
            assert ((event.kind, event.observable_s) in credited) is in_time, (delay_s, event)


@pytest.mark.slow
def test_the_most_frequent_right_alert_by_rote_does_worse_than_nobody(
    begin: Begin, silent: tuple[Watch, Score]
) -> None:
    watch, _ = silent
    assert watch.judgement is not None
    kind = most_frequent(watch.judgement, KINDS)
    assert kind is not None
    assert played(begin(), AlertOften(kind)).value < 0.0


@pytest.mark.slow
def test_thinking_takes_time_on_the_road(begin: Begin) -> None:
    watch = begin(60.0)
    watch.think(20.0)
    watch.step(Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED))
    assert watch.seconds == pytest.approx(21.0)
