"""The episode core: seeds, sessions, branches, the baseline run and the loop."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest

from automotive_cosim.cockpit.signals import ENERGY, HVAC, TYRE
from automotive_cosim.contracts import Action, ActionType, AlertKind, FeedbackCode, GoalStatus
from automotive_cosim.contracts.given import Hearing, Language
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.cosim.simulation import TICK_S
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Session, driven, play, playing
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import End, EpisodeSpec, Seeds, SeedSource, SessionSetup
from automotive_cosim.errors import (
    ActionError,
    AgentError,
    InfrastructureError,
    NoRoomError,
    OutOfBudgetError,
    SetupError,
    UserError,
)
from automotive_cosim.interface.observe import Channel
from automotive_cosim.interface.trace import sha256
from automotive_cosim.tasking.dialogue import NEUTRAL, PARDON, TOLD_HEARD, Says, Topic, spoken_s
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.voice.cabin import driver_snr_db, level_db

SPEC = EpisodeSpec("hvac_fan_max", scenario="grid")
BLIND = SessionSetup(frozenset({Channel.ELEMENTS}))
WAIT = Action(ActionType.WAIT, seconds=1)
WARN = Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED)
DONE = Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)


class Acts:
    """Plays a list of actions; an exception in it is raised."""

    def __init__(self, *actions: Action | Exception):
        self._left = list(actions)

    def act(self, observation):
        action = self._left.pop(0)
        if isinstance(action, Exception):
            raise action
        return action


@pytest.fixture
def begin(simulations) -> Iterator[Callable[..., Episode]]:
    begun: list[Episode] = []

    def begin_(conditions: SessionSetup = BLIND, observer: Observer | None = None, seed: int = 0) -> Episode:
        hand_over = SituationFinder(SPEC, simulations, observer=observer).find(SeedSource(seed).next())
        begun.append(Episode.take_over(hand_over, conditions, observer))
        return begun[-1]

    yield begin_
    for episode in begun:
        episode.close()


def test_seeds_follow_from_the_seed_alone():
    one, other = SeedSource(7), SeedSource(7)
    assert [one.next() for _ in range(3)] == [other.next() for _ in range(3)]
    other.traffic = 8
    assert (one.next(), one.traffic) == (replace(other.next(), traffic=7), 7)
    assert SeedSource().next() != SeedSource().next()
    assert SeedSource(2**31 + 5).next().traffic == 5
    assert [SeedSource(seed).next().instance for seed in range(20)] == list(range(20))
    again = SeedSource(7)
    assert len({again.next().instance for _ in range(20)}) == 20


def test_at_the_hand_over_the_car_is_as_it_departed(simulations):
    """However long the way took; and the way there leads up to that clock."""
    finder = SituationFinder(SPEC, simulations)
    hand_over = finder.find(SeedSource(0).next())
    departed, *_, before, now = hand_over.drive
    world = hand_over.world
    assert now is world.moment
    assert now.time_s > departed.time_s + 2.0
    assert now.local_time == finder.scenario.start
    assert now.local_time - before.local_time == timedelta(seconds=now.time_s - before.time_s)
    assert now.context.local_time == now.local_time
    for signal in (ENERGY.LEVEL, ENERGY.RANGE, HVAC.CABIN_TEMPERATURE, HVAC.CABIN_HUMIDITY, TYRE.FRONT_LEFT):
        assert now.signals[signal.path] == departed.signals[signal.path] == world.cockpit.signals[signal]
    assert now.driving.distance_m > departed.driving.distance_m  # the road knows the way
    clock = world.cockpit.elements()[0]
    assert (clock.resource_id, clock.text) == (shown_id("status.clock"), f"{finder.scenario.start:%H:%M}")
    later = world.advance(2.0)[-1]
    assert later.local_time - now.local_time == timedelta(seconds=2)
    assert later.signals[ENERGY.LEVEL.path] < now.signals[ENERGY.LEVEL.path]
    world.close()


def test_where_the_first_road_is_full_another_trip_is_tried():
    class TriedError(Exception):
        """Another trip was tried."""

    class Simulation:
        def depart(self, plan):
            tried.append(plan.trip.name)
            if len(tried) <= full:
                raise NoRoomError(f"no gap on {plan.trip.from_edge}")
            raise TriedError

    class OneSimulation:
        @contextmanager
        def held(self, scenario, seed, progress):
            yield Simulation()

    finder = SituationFinder(SPEC, OneSimulation())
    names = [trip.name for trip in finder.scenario.ego.trips]
    assert len(names) > 1
    for full, ends in ((1, TriedError), (len(names), NoRoomError)):
        tried = []
        with pytest.raises(ends):
            finder.find(SeedSource(0).next())
        assert tried == names[: full + 1]


def test_the_loop_steps_refuses_and_tells_each_step(begin):
    seen = []
    episode = begin()
    end = driven(playing(episode, Acts(WAIT, ActionError("no JSON"), DONE), lambda session, was: seen.append(was)))
    assert end is episode.end is End.DECLARED
    assert [step.feedback.code for step in episode.steps][2] is FeedbackCode.MALFORMED
    assert len(seen) == len(episode.steps) - 1 == 3
    assert seen[0] == episode.steps[0].elements
    assert episode.verdict is not None


def test_who_may_think_no_further_is_judged_as_it_stands(begin):
    episode = begin()
    assert play(episode, Acts(WAIT, OutOfBudgetError("spent"))) is End.OUT_OF_BUDGET
    assert episode.verdict is not None
    assert not episode.verdict.declared.ok


def test_who_can_act_no_more_has_failed_whatever_was_done(begin):
    episode = begin()
    assert play(episode, Acts(WAIT, AgentError("it crashed"))) is End.AGENT_FAILED
    assert episode.failure == "it crashed"
    assert episode.verdict is not None
    assert not episode.verdict.declared.ok
    assert "it crashed" in episode.verdict.declared.why


@pytest.mark.parametrize(
    ("conditions", "end", "steps"),
    [
        (replace(BLIND, max_steps=2), End.OUT_OF_STEPS, 2),
        (replace(BLIND, max_sim_s=3.0), End.OUT_OF_TIME, 3),
        (replace(BLIND, max_sim_s=3.0, action_cost_s=2.0), End.OUT_OF_TIME, 2),
    ],
)
def test_it_is_cut_off_by_its_limits(begin, conditions, end, steps):
    episode = begin(conditions)
    assert play(episode, Acts(*[WAIT] * 9)) is end
    assert end.is_cut_off
    assert len(episode.steps) == steps + 1


def test_nothing_can_be_done_when_it_is_over(begin):
    episode = begin()
    play(episode, Acts(DONE))
    for late in (lambda: episode.step(WAIT), lambda: episode.refuse("why"), episode.branch):
        with pytest.raises(RuntimeError, match="over"):
            late()


def test_a_branch_goes_its_own_way_from_the_same_instant(begin):
    episode = begin()
    episode.step(WAIT)
    branch, twin = episode.branch(), episode.branch(max_steps=1)
    assert (branch.observation, branch.trace_sha256) == (episode.observation, episode.trace_sha256)
    before = episode.trace_sha256
    play(branch, Acts(WARN, DONE))
    play(twin, Acts(WAIT))
    assert twin.end is End.OUT_OF_STEPS
    assert episode.trace_sha256 == before
    assert episode.end is None
    assert len(episode.moments) == 2
    for each in (branch, twin):
        each.close()
    play(episode, Acts(WARN, DONE))
    assert episode.trace_sha256 == branch.trace_sha256
    assert episode.verdict == branch.verdict


@pytest.mark.parametrize("cost_s", [1.0, 0.4, 1.7])
@pytest.mark.parametrize("acts", [(WAIT,) * 12, (WARN,) + (WAIT,) * 3, (WAIT, WAIT, WARN, WAIT)])
def test_the_baseline_run_is_the_drive_that_nobody_touched(begin, acts, cost_s):
    """However the episode goes, whenever the two part and in whatever slices; some seconds after its end too."""
    episode, alone = begin(replace(BLIND, action_cost_s=cost_s)), begin()
    undisturbed = alone.branch()
    for act in acts:
        episode.step(act)
    after_s = episode.aftermath(8.0)[-1].time_s
    seconds = np.ceil(round(after_s - episode.moments[0].time_s, 6))
    expected = [undisturbed.moments[0], *undisturbed.world.advance(seconds * TICK_S)]
    undisturbed.close()

    def told(moments):
        return [(each.driving, each.passed, each.events, each.context, each.commands) for each in moments]

    during = episode.baseline_moments
    assert told(during) == told(expected[: len(during)])
    assert told(episode.baseline.until(after_s)) == told(expected)


def test_a_listener_hears_of_every_second_in_order(begin):
    class Times(Observer):
        def __init__(self):
            self.times_s: list[float] = []

        def moved(self, moment, cockpit):
            self.times_s.append(moment.time_s)

    heard = Times()
    episode = begin(observer=heard)
    episode.step(replace(WAIT, seconds=5))
    episode.step(DONE)
    after = episode.aftermath(2.0)
    every = [*episode.drive[1:], *episode.moments[1:], *after]
    assert heard.times_s == [moment.time_s for moment in every]
    assert np.diff(heard.times_s) == pytest.approx(TICK_S)


def test_a_session_needs_no_task(begin):
    """As in a study: an agent at the cockpit of any drive."""
    world = begin().world.branch()
    session = Session.begin(world, "Warm me up.", replace(BLIND, max_steps=3))
    assert play(session, Acts(*[WAIT] * 9)) is End.OUT_OF_STEPS
    assert session.observation.goal == "Warm me up."
    assert session.seconds == pytest.approx(3.0)
    session.close()


ASK = Action(ActionType.ASK_DRIVER, text="Full blast, or gently?")
HOW = Topic("how strong", (("full",), ("gently",)), "Full blast.", ("fan",))


@pytest.fixture
def talk(simulations) -> Iterator[Callable[..., Episode]]:
    begun: list[Episode] = []

    def talk_(*says: Says, topics: tuple[Topic, ...] = (HOW,), setup: SessionSetup = BLIND) -> Episode:
        task = CATALOGUE["hvac_fan_max"]
        task = replace(task, first=replace(task.first, topics=topics, says=says))
        hand_over = SituationFinder(SPEC, simulations, task=task).find(SeedSource(0).next())
        begun.append(Episode.take_over(hand_over, setup))
        return begun[-1]

    yield talk_
    for episode in begun:
        episode.close()


def test_the_driver_answers_and_it_takes_as_long_as_it_is_said(talk):
    episode = talk()
    before = episode.moments[0].commands
    assert episode.observation.said == ()
    episode.step(ASK)
    assert episode.observation.said == episode.steps[-1].said == ("Full blast.",)
    assert episode.seconds == pytest.approx(1.0 + spoken_s(ASK.text, "Full blast."))
    episode.step(Action(ActionType.ASK_DRIVER, text="What's the fan to do?"))
    episode.step(Action(ActionType.ASK_DRIVER, text="Nice weather?"))
    assert episode.observation.said == ("Full blast.", "Full blast.", NEUTRAL)
    assert [question.is_needed for question in episode.questions] == [False, False, False]
    after = {**episode.moments[-1].commands, "questions": []}
    assert after == {**before, "questions": []}, "a question changes nothing in the car"


def test_a_question_without_words_is_refused_and_costs_a_step(talk):
    episode = talk()
    episode.step(Action(ActionType.ASK_DRIVER, text="  "))
    assert episode.observation.feedback.code is FeedbackCode.REFUSED
    assert episode.seconds == pytest.approx(1.0)
    assert episode.observation.said == () == episode.questions


def test_a_question_notes_what_was_changed_before_it(talk):
    episode = talk()
    episode.step(Action(ActionType.OPEN_APP, app_name="climate"))
    episode.step(ASK)
    episode.step(Action(ActionType.HAZARD_LIGHTS, on=True))
    episode.step(ASK)
    assert [asked["commands"] for asked in episode.moments[-1].commands["questions"]] == [0, 1]


def test_the_driver_says_each_remark_once_and_branches_hear_their_own(talk):
    episode = talk(Says("No, leave it.", step=2), Says("Thanks.", after=1), Says("Hm.", time_s=2.0))
    episode.step(WAIT)
    branch = episode.branch()
    episode.step(WAIT)
    assert episode.steps[-1].said == ("No, leave it.", "Hm.")
    episode.step(WAIT)
    assert episode.steps[-1].said == ()
    branch.step(ASK)
    assert branch.observation.said == ("Full blast.", "No, leave it.", "Thanks.", "Hm.")
    assert episode.observation.said == ("No, leave it.", "Hm.")
    branch.close()


def test_what_the_driver_says_is_in_the_trace(talk):
    quiet, other = talk(), talk(Says("No, leave it.", step=1))
    assert quiet.trace_sha256 == other.trace_sha256
    for episode in (quiet, other):
        episode.step(WAIT)
    assert quiet.trace_sha256 != other.trace_sha256
    assert other.trace_sha256 == sha256([step.as_json() for step in other.steps])
    assert "said" not in quiet.steps[-1].as_json()


BY_EAR = replace(BLIND, conditions=Conditions(hear=Hearing.CABIN))
PARDONED = Action(ActionType.ASK_DRIVER, text="Pardon, could you say that again?")


@pytest.fixture
def loud(monkeypatch) -> None:
    """What is heard is said with its ratio to the noise; the car's voice is understood unless it is off."""
    monkeypatch.setattr("automotive_cosim.episode.session.heard", lambda text, snr_db: f"{text} ({snr_db:.1f})")


def test_by_ear_the_noise_of_the_instant_decides_and_the_driver_repeats_what_he_said(talk, loud):
    episode = talk(Says("Hurry up.", step=1), setup=BY_EAR)
    wish, first_db = episode.instance.goal, driver_snr_db(level_db(episode.moments[0]))
    assert episode.observation.goal == f"{wish} ({first_db:.1f})"
    assert episode.observation.feedback.text == TOLD_HEARD
    assert episode.steps[0].as_json()["heard"] == [episode.observation.goal]
    assert episode.goal == wish
    episode.step(PARDONED)
    now_db = driver_snr_db(level_db(episode.world.moment))
    assert episode.steps[1].said == (wish, "Hurry up.")
    assert episode.observation.said == (f"{wish} ({now_db:.1f})", f"Hurry up. ({now_db:.1f})")
    assert not episode.questions
    # What the agent does to the cabin is heard at once: with more of the blower, the same words are less clear.
    episode.step(Action(ActionType.OPEN_APP, app_name="climate"))
    fan = next(i for i, each in enumerate(episode.elements) if each.resource_id == shown_id("hvac.fan.max"))
    episode.step(Action(ActionType.CLICK, index=fan))
    episode.step(PARDONED)
    assert driver_snr_db(level_db(episode.world.moment)) < now_db - 3
    assert episode.steps[-1].said == (wish, "Hurry up.")
    episode.step(ASK)
    assert [each.topic for each in episode.questions] == [HOW]


def test_by_ear_speaking_takes_its_time_and_who_is_not_understood_is_asked_again(talk, loud, monkeypatch):
    episode = talk(setup=BY_EAR)
    answer = Action(ActionType.ANSWER, text="One two three four five six seven eight nine ten.")
    begun_s = episode.seconds
    episode.step(answer)
    assert episode.seconds - begun_s == pytest.approx(1 + spoken_s(answer.text))
    assert episode.said == (answer.text,)
    monkeypatch.setattr("automotive_cosim.episode.session.is_understood", lambda moment, noise_db: False)
    episode.step(answer)
    episode.step(ASK)
    assert [step.said for step in episode.steps[-2:]] == [(PARDON,), (PARDON,)]
    assert episode.said == (answer.text,)
    assert not episode.questions


def test_by_ear_who_else_speaks_hides_the_drivers_words_until_it_is_over(talk, loud):
    episode = talk(Says("From the rear left seat: " + "Are we there yet? " * 5, step=1), setup=BY_EAR)
    episode.step(WAIT)
    quiet_db = level_db(episode.world.moment)
    assert episode.steps[-1].cabin_db == pytest.approx(quiet_db)
    episode.step(WAIT)
    assert episode.steps[-1].cabin_db == pytest.approx(level_db(episode.world.moment, 1))
    for _ in range(8):
        episode.step(WAIT)
    assert episode.steps[-1].cabin_db == pytest.approx(level_db(episode.world.moment))


def test_by_sound_the_agent_gets_every_word_as_sound_and_no_text(talk, monkeypatch):
    monkeypatch.setattr("automotive_cosim.episode.session.sounding", lambda text, snr_db: f"RIFF {text}".encode())
    monkeypatch.setattr("automotive_cosim.episode.specification.is_installed", lambda: True)
    episode = talk(
        Says("From the rear left seat: Hurry up.", step=1),
        setup=replace(BLIND, conditions=Conditions(hear=Hearing.AUDIO)),
    )
    wish = episode.instance.goal
    assert (episode.observation.goal, episode.observation.sounds) == ("[spoken]", (f"RIFF {wish}".encode(),))
    episode.step(WAIT)
    assert episode.observation.said == ("From the rear left seat: [spoken]",)
    assert episode.observation.sounds[1:] == (b"RIFF From the rear left seat: Hurry up.",)


def test_words_as_text_leave_no_trace_of_the_cabin(talk):
    episode = talk()
    episode.step(PARDONED)
    assert episode.observation.said == (NEUTRAL,)
    assert not {"heard", "cabin_db"} & episode.steps[-1].as_json().keys()


def test_there_is_no_voice_in_other_languages():
    with pytest.raises(UserError, match="--hear cabin has no voice in French; give --language en, or --hear text"):
        SessionSetup(conditions=Conditions(hear=Hearing.CABIN, language=Language.FRENCH))


def test_what_cannot_be_heard_is_told_before_anything_runs(monkeypatch):
    cabin, audio = (Conditions(hear=each) for each in (Hearing.CABIN, Hearing.AUDIO))
    for module in ("voice.engines", "episode.specification"):
        monkeypatch.setattr(f"automotive_cosim.{module}.is_installed", lambda: False)
    with pytest.raises(
        SetupError, match=r"^--hear audio needs the extra voice: pip install .* or give --hear cabin$"
    ):
        SessionSetup(conditions=audio)
    monkeypatch.setattr("automotive_cosim.voice.table._shipped", dict)
    finder = SituationFinder(EpisodeSpec("media_newest_episode", conditions=cabin), simulations=None)
    with pytest.raises(
        InfrastructureError, match=r"^the table of what was heard does not have '.+'; .* or --hear text$"
    ):
        finder.find(Seeds(0, 0))


def test_a_session_without_a_task_gets_an_answer_that_does_not_help(begin):
    episode = begin()
    session = Session.begin(episode.world.branch(), "Drive on.", BLIND)
    session.step(ASK)
    assert session.observation.said == (NEUTRAL,)
    session.close()
