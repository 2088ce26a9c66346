"""Tasks on the real road: one proven, and place deciding where it must."""

import itertools
from collections.abc import Callable

import pytest

from automotive_cosim.agents import Agent, Privileged, make_agent
from automotive_cosim.cockpit.forecast import cabin_c
from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.contracts import ActionType, GoalStatus
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.session import play
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.proof.prover import GATES, Prover
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasking.verdict import Verdict
from automotive_cosim.tasks import CATALOGUE

pytestmark = pytest.mark.slow

SEED = 0
LANE_WIDTH_M = 3.5
"""SUMO changes lanes within one step."""
SPEED = CATALOGUE["road_speed_80_in_50"]

Play = Callable[..., Episode]


@pytest.fixture(scope="module")
def played(simulations) -> Play:
    """Plays one episode to its end."""

    def run(task: Task, half: str, agent: Agent, seed: int = SEED) -> Episode:
        finder = SituationFinder(EpisodeSpec(task.id, half), simulations)
        episode = Episode.take_over(finder.find(SeedSource(seed).next()), SessionSetup(agent.channels))
        agent.reset(episode.goal)
        if isinstance(agent, Privileged):
            agent.brief(episode.instance, drawn=episode.world.cockpit.drawn, branch=episode.branch)
        play(episode, agent)
        episode.close()
        return episode

    return run


def verdict(episode: Episode) -> Verdict:
    assert episode.verdict is not None
    return episode.verdict


def test_a_task_passes_every_gate(simulations):
    """All tasks are proven by ``automotive-cosim tasks validate``; here a short one, the cheapest gates aside."""
    later = ("random", "reach", "effect", "uncoupled")  # the last two have findings that are not settled yet
    prover = Prover(tuple(gate for gate in GATES if gate not in later), simulations)
    proof = prover.prove("media_full_volume", SEED)
    assert proof.error is None
    assert {gate: wrong for gate, wrong in proof.wrong.items() if wrong} == {}
    assert set(proof.wrong) >= {"oracle", "start", "trivial", "repeat"}


@pytest.mark.parametrize("half", SPEED.halves)
def test_the_drive_to_the_hand_over_has_no_jump(simulations, half: str):
    env = CockpitEnv(SPEED, half, channels=(), simulations=simulations)
    env.reset(seed=SEED)
    states = [state for moment in env.episode.drive for state in moment.passed]
    last, first = states[-1], env.episode.moments[0].driving
    env.close()
    assert (last.time_s, last.x_m, last.y_m, last.speed_mps) == (
        first.time_s,
        first.x_m,
        first.y_m,
        first.speed_mps,
    )
    for before, after in itertools.pairwise(states):
        moved_m = ((after.x_m - before.x_m) ** 2 + (after.y_m - before.y_m) ** 2) ** 0.5
        elapsed_s = after.time_s - before.time_s
        sideways_m = LANE_WIDTH_M if after.road.lane_id != before.road.lane_id else 0.0
        assert moved_m <= max(before.speed_mps, after.speed_mps) * elapsed_s + sideways_m + 0.2
        assert abs(after.speed_mps - before.speed_mps) <= 9.5 * elapsed_s + 1e-6


@pytest.mark.parametrize(
    ("agent", "first", "second"),
    [("oracle", True, True), ("asurada", True, True), ("t3a", False, True), ("always-alert", True, False)],
)
def test_only_place_wins_both_halves_of_80_in_50(played: Play, agent: str, first: bool, second: bool):
    """The paper's qualitative case: the same rules, with and without place."""
    won = [verdict(played(SPEED, half, make_agent(agent))).success for half in SPEED.halves]
    assert won == [first, second]


def test_with_the_pairs_context_swapped_its_act_flips(simulations):
    contexts, envs = {}, {}
    for half in SPEED.halves:
        envs[half] = CockpitEnv(
            SPEED, half, channels=tuple(make_agent("asurada").channels), simulations=simulations
        )
        envs[half].reset(seed=SEED)
        contexts[half] = envs[half].episode.observation.context
    for half, other in (("first", "second"), ("second", "first")):
        agent = make_agent("asurada")
        agent.reset(envs[half].episode.observation.goal)
        seen = envs[half].episode.observation
        own = agent.act(seen)
        agent.reset(seen.goal)
        swapped = agent.act(type(seen)(**{**_fields(seen), "context": contexts[other]}))
        assert {own.action_type, swapped.action_type} == {ActionType.OPEN_APP, ActionType.STATUS}
    for env in envs.values():
        env.close()


def _fields(observation: object) -> dict[str, object]:
    return {name: getattr(observation, name) for name in observation.__dataclass_fields__}  # type: ignore[attr-defined]


def test_an_alert_slows_the_driver_down(simulations):
    env = CockpitEnv(SPEED, "first", channels=(), simulations=simulations)
    env.reset(seed=SEED)
    assert env.episode.observation.time_s == 0
    speed_kmh = env.episode.moments[0].driving.speed_mps * 3.6
    env.step({"action_type": "show_alert", "kind": "speed"})
    env.step({"action_type": "wait", "seconds": 10})
    assert speed_kmh > 78
    assert env.episode.moments[-1].driving.speed_mps * 3.6 < 58
    assert any("slow" in event.text for moment in env.episode.moments for event in moment.events)
    env.close()


LEFT_ABOARD = [
    (task.id, name)
    for task in CATALOGUE.values()
    for name in task.halves
    if task.half(name).declares is GoalStatus.NOT_NEEDED
    and any(HVAC.KEPT.path in str(task.half(other).goal) for other in task.halves)
    and not task.half(name).start.signals.get(HVAC.KEPT.path)
]
"""Where the climate control need not go on for those who stay in the car."""


@pytest.mark.parametrize(("task_id", "half"), LEFT_ABOARD)
def test_nobody_is_left_to_heat_or_cold_where_nothing_is_to_be_done(simulations, task_id: str, half: str):
    world = SituationFinder(EpisodeSpec(task_id, half), simulations).find(SeedSource(SEED).next()).world
    later_c = [cabin_c(world.cockpit.state.vehicle, minutes, climate=False) for minutes in (20.0, 30.0)]
    world.close()
    assert all(16.0 <= air_c <= 28.0 for air_c in later_c), later_c
