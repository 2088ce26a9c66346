"""One hand-over, from which every gate plays its own episode."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from automotive_cosim.agents.base import Agent, Privileged
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.contracts import Action, ActionType, FeedbackCode, GoalStatus, Observation
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import ActionError
from automotive_cosim.interface import trace
from automotive_cosim.interface.observe import Channel
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.moves import Move
from automotive_cosim.tasking.task import Half, Task
from automotive_cosim.tasking.verdict import Verdict
from automotive_cosim.traffic.fork import Simulations

CHANNELS = (Channel.ELEMENTS, Channel.VEHICLE, Channel.CONNECTIVITY, Channel.GPS, Channel.CONTEXT)
"""Everything but the picture, which shows what the elements list."""


class Actor(Protocol):
    """Whoever acts in an episode."""

    def act(self, observation: Observation) -> Action:
        """The next action."""
        ...


@dataclass(frozen=True, slots=True)
class Played:
    """A finished episode."""

    verdict: Verdict
    moments: tuple[Moment, ...]
    idle: tuple[Moment, ...]
    actions: tuple[Action | None, ...]
    codes: tuple[FeedbackCode, ...]
    stuck: str = ""
    """Why the actor could not go on, if it could not."""

    @property
    def success(self) -> bool:
        """Whether it counts."""
        return self.verdict.success

    @property
    def seconds(self) -> float:
        """Simulated seconds from the hand-over to when the goal held, or to the declaration."""
        whole_s = self.moments[-1].time_s - self.moments[0].time_s
        return whole_s if self.verdict.goal_s is None else self.verdict.goal_s

    @property
    def why(self) -> str:
        """What spoilt it, in words."""
        parts = {name: getattr(self.verdict, name) for name in ("goal", "clean", "safe", "in_time", "declared")}
        spoilt = [f"{name}: {part.why}" for name, part in parts.items() if not part.ok]
        return self.stuck or "; ".join(spoilt) or "success"


@dataclass(slots=True)
class Script:
    """Carries out given actions, one after the other; the last again and again."""

    actions: Sequence[Action]
    _next: int = 0

    def act(self, observation: Observation) -> Action:
        """The next of them."""
        action = self.actions[min(self._next, len(self.actions) - 1)]
        self._next += 1
        return action


@dataclass(slots=True)
class Ground:
    """A task's half at its hand-over, with one seed."""

    task: Task
    half_name: str
    seed: int
    env: CockpitEnv

    @classmethod
    def reach(
        cls, task: Task, half_name: str, seed: int, simulations: Simulations, scenario: str | None = None
    ) -> Ground:
        """Drives up to the hand-over, in the task's own scenario or another.

        Raises:
            TriggerNotReachedError, TrafficError: as ``CockpitEnv.reset``.
        """
        env = CockpitEnv(task, half_name, scenario=scenario, channels=CHANNELS, simulations=simulations)
        env.reset(seed=seed)
        return cls(task, half_name, seed, env)

    @property
    def instance(self) -> Instance:
        """The task as it was drawn."""
        return self.env.instance

    @property
    def half(self) -> Half:
        """The half with its parameters filled in."""
        return self.env.instance.half

    def play(self, actor: Actor, max_steps: int = 20, *, give_up: bool = False) -> Played:
        """An episode from the hand-over; with ``give_up`` it ends as soon as it can no longer succeed."""
        return finish(self.env.branch(max_steps), actor, give_up=give_up)

    def oracle(self, moves: Sequence[Move] | None = None) -> Oracle:
        """An oracle that knows this instance."""
        oracle = Oracle()
        oracle.reset(self.instance.goal)
        oracle.brief(self.instance, moves)
        return oracle

    def agent(self, agent: Agent) -> Agent:
        """The agent, told the goal."""
        agent.reset(self.instance.goal)
        if isinstance(agent, Privileged):
            agent.brief(self.instance)
        return agent

    def declares(self, status: GoalStatus) -> Played:
        """An episode of one declaration."""
        return self.play(Script((Action(ActionType.STATUS, goal_status=status),)))

    def close(self) -> None:
        """Ends the drive."""
        self.env.close()


SENT = frozenset({"alerts", "requests", "horn", "washer"})
"""Of a cockpit's commands what nobody can take back."""


def is_lost(env: CockpitEnv) -> bool:
    """Whether an episode can no longer succeed, whatever comes: by side effects that stay, or by its deadline."""
    half = env.instance.half
    start, now = env.moments[0], env.moments[-1]
    if any(now.commands[key] != start.commands[key] for key in SENT - half.goal.writes - half.may_write):
        return True
    if now.time_s - start.time_s <= half.deadline.seconds:
        return False
    return half.declares is not GoalStatus.COMPLETE or not half.goal.holds(start, now, env.moments)


def finish(env: CockpitEnv, actor: Actor, *, give_up: bool = False) -> Played:
    """Plays an episode to its end, with ``give_up`` until it is lost, and closes it."""
    done, stuck = False, ""
    while not done:
        if give_up and is_lost(env):
            env.cut_off()
            break
        try:
            action = actor.act(env.observation)
        except ActionError as error:
            stuck = str(error)
            _, _, terminated, truncated, _ = env.cut_off()
        else:
            _, _, terminated, truncated, _ = env.step(action)
        done = terminated or truncated
    assert env.verdict is not None
    steps = env.steps
    played = Played(
        env.verdict,
        tuple(env.moments),
        env.idle_moments,
        tuple(step.action for step in steps[1:]),
        tuple(step.feedback.code for step in steps[1:]),
        stuck,
    )
    env.close()
    return played


def sha256(env: CockpitEnv) -> str:
    """The hash of what happened so far."""
    return trace.sha256([step.as_json() for step in env.steps])
