"""The service of episodes: many at once, each as if it were alone, and nothing of the verdict before the end."""

import json
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from automotive_cosim.agents import Oracle
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import FeedbackCode, Json
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import play
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import End, EpisodeSpec, SeedSource
from automotive_cosim.errors import TrafficError, UnknownNameError, UserError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.service import EpisodeService, ServiceLimits
from automotive_cosim.traffic.fork import Simulations

SPEC = EpisodeSpec("hvac_fan_max", scenario="grid")
DONE: Json = {"action_type": "status", "goal_status": "complete"}
WAIT: Json = {"action_type": "wait"}
SECRETS = ("verdict", "success", "trigger", "deadline", "baseline", "oracle", "instance", "half", "reward")
"""Words that no turn may hold as a key."""


class Clock:
    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def serve(simulations: Simulations, clock: Clock) -> Iterator[Callable[..., EpisodeService]]:
    made: list[EpisodeService] = []

    def serve_(**limits: float) -> EpisodeService:
        made.append(EpisodeService(simulations, ServiceLimits(**limits), clock))  # type: ignore[arg-type]
        return made[-1]

    yield serve_
    for service in made:
        service.close()


@pytest.fixture(scope="module")
def oracle(simulations: Simulations) -> Callable[[int], tuple[list[Json], str]]:
    """The reference solution's actions for a seed, and the trace that they give alone."""

    def solve(seed: int) -> tuple[list[Json], str]:
        spec = replace(SPEC, seed=seed)
        hand_over = SituationFinder(spec, simulations).find(SeedSource(seed).next())
        episode = Episode.take_over(hand_over, spec.session())
        agent = Oracle()
        agent.reset(episode.goal)
        agent.brief(episode.instance)
        play(episode, agent)
        episode.close()
        return [to_json(step.action) for step in episode.steps if step.action], episode.trace_sha256

    return solve


def keys(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        for name, entry in value.items():
            yield str(name)
            yield from keys(entry)
    elif isinstance(value, list):
        for entry in value:
            yield from keys(entry)


def test_the_same_seed_and_actions_give_the_same_trace_and_no_verdict_before_the_end(serve, oracle):
    service = serve()
    actions, trace = oracle(0)
    turn = service.start(SPEC)
    told = [turn.as_json()]
    for action in actions:
        assert turn.end is None
        turn = service.act(turn.episode_id, action)
        told.append(turn.as_json())
        assert service.observe(turn.episode_id).as_json() == told[-1]
    assert turn.end is End.DECLARED
    for turn_json in json.loads(json.dumps(told)):
        assert not set(keys(turn_json)) & set(SECRETS)
    outcome = service.finish(turn.episode_id)
    assert outcome["trace_sha256"] == trace
    assert (outcome["success"], outcome["end"], outcome["steps"]) == (True, "declared", len(actions))
    assert outcome["verdict"]["parts"]["goal"]["ok"]
    assert json.loads(json.dumps(outcome)) == outcome


@pytest.mark.slow
def test_sixteen_at_once_are_each_as_if_alone(serve, oracle):
    service = serve(episodes=16)
    expected = {seed: oracle(seed) for seed in range(4)}
    together = threading.Barrier(16)

    def drive(number: int) -> str:
        seed = number % 4
        turn = service.start(replace(SPEC, seed=seed))
        together.wait(240)
        for action in expected[seed][0]:
            turn = service.act(turn.episode_id, action)
        return service.finish(turn.episode_id)["trace_sha256"]

    with ThreadPoolExecutor(16) as threads:
        traces = list(threads.map(drive, range(16)))
    assert traces == [expected[number % 4][1] for number in range(16)]


def test_callers_of_one_episode_wait_for_each_other(serve):
    service = serve()
    begun = service.start(replace(SPEC, max_steps=8))
    with ThreadPoolExecutor(8) as threads:
        turns = list(threads.map(lambda _: service.act(begun.episode_id, WAIT), range(8)))
    assert sorted(turn.step for turn in turns) == list(range(1, 9))
    assert service.finish(begun.episode_id)["end"] == "out_of_steps"


def test_an_agent_gets_the_channels_it_asks_for_and_no_others(serve):
    service = serve()
    whole = service.start(SPEC)
    assert {"elements", "vehicle", "gps", "connectivity", "context"} <= whole.as_json().keys()
    assert whole.picture is not None
    assert whole.picture.startswith(b"\x89PNG")
    bare = service.start(SPEC, frozenset())
    assert bare.as_json().keys() == {"episode_id", "step", "end", "goal", "said", "time_s", "feedback"}
    assert bare.picture is None
    eyes = service.start(SPEC, frozenset({Channel.SCREENSHOT}))
    assert eyes.picture == whole.picture


def test_an_unreadable_action_costs_a_step(serve):
    service = serve()
    turn = service.start(SPEC)
    for number, action in enumerate(({"action_type": "fly"}, "no JSON", {"action_type": "click"}), 1):
        turn = service.act(turn.episode_id, action)
        assert (turn.step, turn.observation.feedback.code) == (number, FeedbackCode.MALFORMED)
    assert turn.observation.time_s == pytest.approx(3.0)


def test_an_episode_that_is_over_can_only_be_looked_at_and_finished_once(serve):
    service = serve()
    turn = service.act(service.start(SPEC).episode_id, DONE)
    with pytest.raises(UserError, match=r"is over \(declared\); finish it"):
        service.act(turn.episode_id, WAIT)
    assert service.observe(turn.episode_id).end is End.DECLARED
    assert not service.finish(turn.episode_id)["success"]
    for call in (service.observe, service.finish, lambda name: service.act(name, WAIT)):
        with pytest.raises(UserError, match="no episode"):
            call(turn.episode_id)


def test_one_that_is_given_up_is_judged_as_it_is(serve):
    service = serve()
    outcome = service.finish(service.start(SPEC).episode_id)
    assert (outcome["end"], outcome["success"], outcome["steps"]) == ("out_of_budget", False, 0)


def test_idle_episodes_expire_and_others_do_not(serve, clock):
    service = serve(idle_s=60)
    idle, used = service.start(SPEC).episode_id, service.start(SPEC).episode_id
    clock.now_s = 59.0
    service.observe(used)
    clock.now_s = 61.0
    service.expire()
    assert service.observe(used).step == 0
    with pytest.raises(UserError, match="idle for 60 s"):
        service.observe(idle)


def test_there_are_no_more_than_the_limit(serve):
    service = serve(episodes=2)
    first, _ = service.start(SPEC), service.start(SPEC)
    with pytest.raises(UserError, match="2 episodes at once is the limit"):
        service.start(SPEC)
    service.finish(first.episode_id)
    assert service.start(SPEC).step == 0


def test_what_cannot_be_started_takes_no_room(serve):
    service = serve(episodes=1)
    for wrong, error in ((replace(SPEC, task="fly"), UnknownNameError), (replace(SPEC, seed=-1), UserError)):
        with pytest.raises(error):
            service.start(wrong)

    class Interrupts(Observer):
        def moved(self, moment, cockpit):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        service.start(SPEC, ALL, Interrupts())
    assert service.start(SPEC).step == 0


def test_a_simulation_that_dies_takes_its_own_episode_along_and_no_other(serve):
    service = serve(episodes=2)
    doomed, other = service.start(SPEC), service.start(SPEC)
    traffic = service._running[doomed.episode_id].episode.world.traffic
    os.kill(traffic._traffic.pid, signal.SIGKILL)
    with pytest.raises(TrafficError):
        service.act(doomed.episode_id, WAIT)
    with pytest.raises(UserError, match="no episode"):
        service.observe(doomed.episode_id)
    assert service.act(other.episode_id, WAIT).step == 1
    assert service.start(SPEC).step == 0


def test_closing_ends_every_episode(serve):
    service = serve()
    begun = service.start(SPEC)
    service.close()
    service.close()
    with pytest.raises(UserError, match="no episode"):
        service.observe(begun.episode_id)


@pytest.mark.parametrize("limits", [{"episodes": 0}, {"idle_s": 0}, {"idle_s": float("nan")}])
def test_limits_are_above_zero(limits):
    with pytest.raises(UserError, match="above 0"):
        ServiceLimits(**limits)
