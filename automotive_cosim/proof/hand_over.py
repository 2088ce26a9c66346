"""One hand-over, from which every gate plays its own episode."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any

from automotive_cosim.agents.base import Agent, Privileged
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.cockpit.actions import perform
from automotive_cosim.cockpit.signals import named
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import Action, ActionType, FeedbackCode, GoalStatus, Observation
from automotive_cosim.contracts.given import CarMake, See
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.session import Actor, play
from automotive_cosim.episode.situation import HandOver, SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.errors import ActionError, OutOfBudgetError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.trace import Hash, Step
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.moves import Move, Tap
from automotive_cosim.tasking.task import Half, Task
from automotive_cosim.tasking.verdict import Verdict
from automotive_cosim.tasking.ways import units_in
from automotive_cosim.traffic.base import WarmSimulations

SEEING = Conditions(see=See.CAMERA)
"""No task lacks anything that is seen."""
SETUP = SessionSetup(ALL - {Channel.SCREENSHOT})
"""Every channel except the screenshot, which shows what the elements list."""


@dataclass(kw_only=True)
class Trial(Episode):
    """An episode that a gate plays: its actor is shown what it looks at, and a screen when it looks."""

    shows: frozenset[Channel] = SETUP.channels

    def _channels(self, action: Action | None) -> frozenset[Channel]:
        return self.shows & self.setup.given


@dataclass(frozen=True, slots=True)
class Played:
    """A finished episode."""

    verdict: Verdict
    moments: tuple[Moment, ...]
    baseline: tuple[Moment, ...]
    counterfactual: Callable[[], Mapping[str, Any]]
    """Gives what would be commanded at the end, had only the commands that belong to the goal been given."""
    given: tuple[CommandRecord, ...]
    """What was commanded, in order."""
    steps: tuple[Step, ...]
    stuck: str = ""
    """Why the actor could not continue, if it could not."""

    @property
    def actions(self) -> tuple[Action | None, ...]:
        return tuple(step.action for step in self.steps[1:])

    @property
    def said(self) -> tuple[str, ...]:
        """What the driver was told."""
        answers = (each for each in self.actions if each and each.action_type is ActionType.ANSWER)
        return tuple(each.text or "" for each in answers)

    @property
    def codes(self) -> tuple[FeedbackCode, ...]:
        """The cockpit's feedback to each."""
        return tuple(step.feedback.code for step in self.steps[1:])

    @property
    def trace_sha256(self) -> str:
        """The hash of the trace."""
        return Hash(self.steps).hex

    @property
    def success(self) -> bool:
        return self.verdict.success

    @property
    def seconds(self) -> float:
        """Simulated seconds from the hand-over to when the goal held, or to the declaration."""
        whole_s = self.moments[-1].time_s - self.moments[0].time_s
        return whole_s if self.verdict.goal_s is None else self.verdict.goal_s

    @property
    def why(self) -> str:
        """Why it did not succeed, in words."""
        spoilt = [f"{name}: {part.why}" for name, part in self.verdict.parts.items() if not part.ok]
        return self.stuck or "; ".join(spoilt) or "success"


@dataclass(slots=True)
class Script:
    """Plays given actions in order and repeats the last one."""

    actions: Sequence[Action]
    channels: frozenset[Channel] = frozenset()
    _next: int = 0

    def act(self, observation: Observation) -> Action:
        action = self.actions[min(self._next, len(self.actions) - 1)]
        self._next += 1
        return action


@dataclass
class Ground:
    """A task's half at its hand-over, with one seed."""

    task: Task
    half_name: str
    seed: int
    episode: Trial
    _begun: list[int] = field(default_factory=list)

    @classmethod
    def reach(
        cls,
        task: Task,
        half_name: str,
        seed: int,
        simulations: WarmSimulations,
        scenario: str | None = None,
        *,
        coarse: bool = False,
    ) -> Ground:
        """Drives up to the hand-over, in the task's own scenario or another.

        Args:
            seed: determines traffic, drive, phrasing and parameters.
            simulations: warm traffic; ``KnownDrives`` are driven once for all plays.
            scenario: used instead of the task's own.
            coarse: in steps of a second, which is quicker and other traffic.

        Raises:
            TriggerNotReachedError, TrafficError: see ``SituationFinder.find``."""
        finder = SituationFinder(
            EpisodeSpec(task.id, half_name, scenario, seed=seed, conditions=SEEING), simulations, task=task
        )
        if coarse:
            finder.scenario = replace(finder.scenario, sumo=finder.scenario.sumo.stepping(1.0))
        hand_over = finder.find(SeedSource(seed).next())
        return cls(task, half_name, seed, Trial.take_over(hand_over, SETUP))

    @property
    def instance(self) -> Instance:
        """The instance that was drawn."""
        return self.episode.instance

    @property
    def half(self) -> Half:
        """The half, with the parameters filled in."""
        return self.episode.instance.half

    def play(self, actor: Actor, max_steps: int | None = None, *, stop_when_lost: bool = False) -> Played:
        """An episode from the hand-over; with ``stop_when_lost`` it ends as soon as it can no longer succeed."""
        return finish(self.episode.branch(max_steps), actor, stop_when_lost=stop_when_lost)

    @cached_property
    def reference(self) -> Played:
        """The episode of the reference solution."""
        return self.play(_Noting(self.oracle(), self._begun))

    def in_make(self, make: CarMake) -> Played:
        """The episode of the reference solution in the cockpit of another make, which stood there all along."""
        episode, units = self.episode, units_in(make_named(make), self.task)
        instance, world = replace(self.instance, make=make), episode.world.branch()
        for path, unit in {**units, **self.half.start.signals}.items():
            if path in units:
                world.cockpit.signals[named(path)] = unit
        car = world.cockpit
        world.moment = replace(world.moment, signals=car.signals.snapshot(), commands=car.commands())
        there = HandOver(instance, world, episode.drive, episode.scenario, episode.traffic_seed)
        setup = replace(SETUP, conditions=Conditions(make=make))
        oracle = Oracle()
        oracle.brief(instance)
        return finish(Trial.take_over(there, setup), oracle)

    @property
    def move_of_action(self) -> tuple[int | None, ...]:
        """For each action of the reference solution, the number of the move it belongs to; None for its end."""
        assert self.reference.steps
        taps = [move.times if isinstance(move, Tap) else 1 for move in self.half.moves]
        numbers = [number for number, times in enumerate(taps) for _ in range(times)]
        return tuple(numbers[begun] if begun < len(numbers) else None for begun in self._begun)

    def oracle(self, moves: Sequence[Move] | None = None, declares: GoalStatus | None = None) -> Oracle:
        """An oracle for this instance, or for other moves or another declaration."""
        oracle = Oracle()
        oracle.reset(self.instance.goal)
        oracle.brief(self.instance, moves, declares)
        return oracle

    def agent(self, agent: Agent) -> Agent:
        """The agent, after being told the goal."""
        agent.reset(self.instance.goal)
        if isinstance(agent, Privileged):
            episode = self.episode
            agent.brief(self.instance, drawn=episode.world.cockpit.drawn, branch=episode.branch)
        return agent

    def declares(self, status: GoalStatus) -> Played:
        """An episode of one declaration."""
        return self.play(Script((Action(ActionType.STATUS, goal_status=status),)))

    def close(self) -> None:
        self.episode.close()


@dataclass(slots=True)
class _Noting:
    """An oracle, with a note of how far it was at each action."""

    oracle: Oracle
    begun: list[int]

    @property
    def channels(self) -> frozenset[Channel]:
        return self.oracle.channels

    def act(self, observation: Observation) -> Action:
        action = self.oracle.act(observation)
        self.begun.append(self.oracle.begun)
        return action


SENT = frozenset({"alerts", "requests", "horn", "washer"})
"""The commands of a cockpit that cannot be undone."""


HARMLESS = frozenset({
    ActionType.ANSWER, ActionType.ASK_DRIVER, ActionType.QUERY, ActionType.STATUS, ActionType.WAIT,
})  # fmt: skip
"""Actions that command nothing."""


def is_lost(episode: Episode) -> bool:
    """Whether an episode can no longer succeed, because of lasting side effects or its deadline."""
    half = episode.instance.half
    first, now = episode.moments[0], episode.moments[-1]
    if any(now.commands[key] != first.commands[key] for key in SENT - half.allowed_writes):
        return True
    if now.time_s - first.time_s <= half.deadline.seconds:
        return False
    return half.declares is not GoalStatus.COMPLETE or not half.goal.holds(first, now, episode.moments)


def would_lose(episode: Episode, action: Action) -> bool:
    """Whether an action sends what cannot be undone and is not asked for, tried on a copy of the cockpit: so the
    road need not be driven on."""
    if action.action_type in HARMLESS:
        return False
    cockpit = episode.world.cockpit.copy()
    before = cockpit.commands()
    perform(action, cockpit, episode.elements)
    after = cockpit.commands()
    return any(after[key] != before[key] for key in SENT - episode.instance.half.allowed_writes)


@dataclass(slots=True)
class _Stopping:
    """An actor that stops when it is stuck and, if requested, when the episode is lost."""

    episode: Trial
    actor: Actor
    stops_when_lost: bool
    stuck: str = ""

    def act(self, observation: Observation) -> Action:
        if self.stops_when_lost and is_lost(self.episode):
            raise OutOfBudgetError("the episode can no longer succeed")
        if Channel.ELEMENTS in self.episode.setup.given:
            observation = replace(observation, elements=self.episode.elements)
        try:
            action = self.actor.act(observation)
        except ActionError as error:
            self.stuck = str(error)
            raise OutOfBudgetError(self.stuck) from error
        if self.stops_when_lost and would_lose(self.episode, action):
            raise OutOfBudgetError("the episode could no longer succeed")
        return action


def finish(episode: Trial, actor: Actor, *, stop_when_lost: bool = False) -> Played:
    """Plays an episode to its end, or with ``stop_when_lost`` until it is lost, and closes it."""
    channels: frozenset[Channel] = getattr(actor, "channels", SETUP.channels)
    episode.shows = channels - {Channel.ELEMENTS}
    stopping = _Stopping(episode, actor, stop_when_lost)
    play(episode, stopping)
    assert episode.verdict is not None
    played = Played(
        episode.verdict,
        tuple(episode.moments),
        episode.baseline_moments,
        cache(lambda: episode.counterfactual),
        episode.world.cockpit.given,
        tuple(episode.steps),
        stopping.stuck,
    )
    episode.close()
    return played
