"""One episode: an agent, a task, a seed; and the result.

find -> take over -> brief -> (act -> step)* -> verdict -> aftermath
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import asdict, dataclass, replace
from math import inf
from typing import Annotated, Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from automotive_cosim import geo
from automotive_cosim.agents import Agent, Learner, Privileged, Stage, StageName, Thinker
from automotive_cosim.contracts import Element, Json
from automotive_cosim.contracts.given import Clock
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.listener import Listener, Listeners
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.situation import HandOver, SituationFinder
from automotive_cosim.episode.specification import End, EpisodeSpec, SeedSource
from automotive_cosim.errors import InfrastructureError, TriggerNotReachedError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.geo.breaches import Violation
from automotive_cosim.interface import trace
from automotive_cosim.models import ModelReply
from automotive_cosim.run.estimates import PositionEstimate, estimates
from automotive_cosim.run.former import setup_values
from automotive_cosim.run.harm import DriveFigures, drive_figures
from automotive_cosim.run.load import DriverLoad, driver_load
from automotive_cosim.run.row import formerly
from automotive_cosim.run.timeline import Sample, TimelineEntry, samples, timeline
from automotive_cosim.tasking.policy import Breach
from automotive_cosim.tasking.verdict import Verdict
from automotive_cosim.traffic.fork import Simulations

AFTERMATH_S = 12.0
"""The road is watched this long after the end: enough for a driver to react and to brake from 80 to 50 km/h."""


@dataclass(frozen=True, slots=True)
class EpisodeSetup(EpisodeSpec):
    """A specification and an agent, by name; the same setup gives the same trace."""

    agent: str = "asurada"
    model: str = "rules"
    without: tuple[str, ...] = ()
    """Parts of the agent that are switched off, for the record."""
    spare_traffic: tuple[int, ...] = ()
    """Seeds of traffic to try in turn, with the same instance, if the situation does not occur in the seed's own
    traffic. No agent acts before it does, so every agent gets the same traffic."""


def read_setup(values: Mapping[str, Any], where: str) -> EpisodeSetup:
    """A setup from its JSON form, one of an earlier version too.

    Raises:
        UserError: it is not one; the message says what is wrong where.
    """
    return checked(EpisodeSetup, setup_values(values, where), lambda steps: (where, dotted(steps)))


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """The result of one episode. Without a verdict, ``success`` is None and ``reward`` 0."""

    task: str
    half: str
    scenario: str
    agent: str
    model: str
    seed: int
    goal: str
    """What the driver said."""
    success: bool | None
    reward: float
    steps: int
    """Number of actions, including unreadable ones."""
    sim_seconds: float
    """Simulated seconds from the hand-over to the end."""
    trace_sha256: str | None
    """Hash of the steps so far; None before the hand-over."""
    verdict: Verdict | None
    timeline: tuple[TimelineEntry, ...]
    path: tuple[Sample, ...]
    """The drive, once per second, from departure to the end of the aftermath."""
    end: End
    error: str | None = None
    error_kind: str | None = None
    """Name of the error's class in ``automotive_cosim.errors``."""
    agent_error: str | None = None
    """How the agent's side failed, if that ended the episode; ``success`` is then False."""
    violations: tuple[Violation, ...] = ()
    """Traffic law violations from departure to the end of the aftermath; seconds since the hand-over."""
    breaches: tuple[Breach, ...] = ()
    """What the agent did against the house rules, told or not."""
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What the agent was given, and at what speed."""
    without: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    """Assumptions where the scenario says nothing, e.g. that there is no GPS."""
    held_out: bool = False
    """Whether the driver's phrasing is held out from the rule model."""
    traffic_seed: int | None = None
    """Seed of the traffic in which the situation occurred: the seed, or a spare one; None without a hand-over."""
    tokens_in: int = 0
    """Total tokens sent to the model; estimated for ``rules``."""
    tokens_out: int = 0
    model_seconds: float = 0.0
    """Total wait for the model; 0 for one that runs in this process."""
    cost_usd: float = 0.0
    estimates: tuple[PositionEstimate, ...] = ()
    """The agent's position estimates while GPS was out."""
    load: DriverLoad | None = None
    """Visual and manual load on the driver while the car moved; None without a hand-over."""
    drive: DriveFigures | None = None
    """Figures of the drive from the hand-over to the end of the aftermath; only of judged safety tasks."""
    baseline_drive: Annotated[DriveFigures | None, formerly("untouched_drive", "baseline_drive")] = None
    """The same figures of the baseline run, over the same time."""

    def as_json(self) -> Json:
        """The result as a JSON object; ``row.from_json`` reads it back."""
        return asdict(self) | {"verdict": self.verdict and self.verdict.as_json()}


@dataclass(frozen=True, slots=True)
class Shot:
    """One step as passed to a watcher."""

    step: trace.Step
    seen: tuple[Element, ...]
    """The elements the agent saw when it acted."""
    screenshot: npt.NDArray[np.uint8]
    """The cockpit after the step, (height, width, 3)."""
    thought: str
    """The agent's own reason for the action; empty if it gives none."""
    stages: tuple[Stage, ...] = ()
    """The stages of the agent's reasoning, for agents that report them."""


@runtime_checkable
class Timed(Protocol):
    """An agent whose answers are timed from outside, so that it cannot influence the measurement."""

    @property
    def answer_s(self) -> float:
        """Wall seconds that its last answer took."""
        ...


@runtime_checkable
class Replayed(Protocol):
    """An agent that repeats a recording, including the time that each answer took."""

    @property
    def thought_s(self) -> float:
        """Simulated seconds that the answer it gave last took."""
        ...


class EpisodeObserver(Listener):
    """Observes a trial while it runs, e.g. to show or record it. It sees everything and changes nothing."""

    def handed_over(self, episode: Episode, shot: Shot) -> None:
        """The trigger holds; the agent begins."""

    def stepped(self, shot: Shot) -> None:
        """The agent has acted."""

    def finished(self, result: EpisodeResult) -> None:
        """The episode is over, its aftermath too; also called after an error or an interruption."""


def run_episode(
    setup: EpisodeSetup,
    agent: Agent,
    watchers: Sequence[EpisodeObserver] = (),
    *,
    simulations: Simulations | None = None,
    wall_s: float = inf,
) -> EpisodeResult:
    """Runs an episode to its end and judges it.

    Args:
        setup: what to run; ``agent`` and ``model`` are only written into the result.
        agent: the agent that acts.
        watchers: notified of everything as it happens.
        simulations: warm simulations to use; by default its own, closed with the episode.
        wall_s: wall seconds from the hand-over after which it is judged as it is.

    Raises:
        UserError: something in the setup does not exist or is invalid; no watcher has been notified of a hand-over.
        KeyboardInterrupt: passed on after the watchers have received the result so far.
    """
    with ExitStack() as ends:
        own = simulations or ends.enter_context(closing(Simulations()))
        finder = SituationFinder(setup, own, listener=Listeners(watchers))
        run = _Run(setup, finder, agent, watchers)
        ends.callback(run.close)
        try:
            end = run.play(wall_s)
        except InfrastructureError as error:
            return run.finish(End.ERROR, error)
        except KeyboardInterrupt:
            run.finish(End.INTERRUPTED)
            raise
        return run.finish(end)


class _Run:
    """One episode and the data collected along with it."""

    def __init__(
        self, setup: EpisodeSetup, finder: SituationFinder, agent: Agent, watchers: Sequence[EpisodeObserver]
    ) -> None:
        self._setup = setup
        self._finder = finder
        self._agent = agent
        self._watchers = watchers
        self._episode: Episode | None = None
        self._traffic_seed: int | None = None
        self._replies: list[ModelReply] = []
        self._after: list[Moment] = []
        self._baseline: tuple[Moment, ...] = ()

    def play(self, wall_s: float) -> End:
        agent = self._agent
        hand_over = self._find()
        try:
            session = self._setup.session(agent.channels)
        except BaseException:  # its process cannot be started
            hand_over.world.close()
            raise
        episode = self._episode = Episode.take_over(hand_over, session, Listeners(self._watchers))
        agent.reset(episode.goal)
        if isinstance(agent, Privileged):
            agent.brief(episode.instance, drawn=episode.world.cockpit.drawn)
        first = Shot(episode.steps[0], (), episode.screenshot(), "")
        for watcher in self._watchers:
            watcher.handed_over(episode, first)
        end = play(episode, agent, (self._stepped,), self._thought_s, wall_s)
        if end in (End.OUT_OF_BUDGET, End.AGENT_FAILED):
            self._stages()  # of the turn that it did not finish
        if isinstance(agent, Learner) and episode.verdict is not None:
            agent.learn(episode.verdict.success)
        self._watch_aftermath(episode)
        return end

    def _find(self) -> HandOver:
        seeds = SeedSource(self._setup.seed).next()
        missed: TriggerNotReachedError | None = None
        for traffic in (seeds.traffic, *self._setup.spare_traffic):
            try:
                hand_over = self._finder.find(replace(seeds, traffic=traffic))
            except TriggerNotReachedError as error:
                missed = missed or error
            else:
                self._traffic_seed = traffic
                return hand_over
        assert missed is not None
        raise missed

    def close(self) -> None:
        if self._episode is not None:
            self._episode.close()

    def finish(self, end: End, error: InfrastructureError | None = None) -> EpisodeResult:
        result = self._result(end, error)
        for watcher in self._watchers:
            watcher.finished(result)
        return result

    def _stepped(self, episode: Episode, seen: Sequence[Element]) -> None:
        stages = self._stages()
        shot = Shot(episode.steps[-1], tuple(seen), episode.screenshot(), _thought(stages), stages)
        for watcher in self._watchers:
            watcher.stepped(shot)

    def _thought_s(self) -> float:
        """Simulated seconds that the agent's last answer took."""
        if isinstance(self._agent, Replayed):
            return self._agent.thought_s
        seconds = self._setup.conditions.latency_s
        if self._setup.conditions.clock is Clock.MODEL and isinstance(self._agent, Timed):
            seconds += self._agent.answer_s
        elif self._setup.conditions.clock is Clock.MODEL and isinstance(self._agent, Thinker):
            seconds += sum(stage.reply.seconds for stage in self._agent.stages if stage.reply is not None)
        return round(seconds, 1)  # the shortest step of a scenario

    def _stages(self) -> tuple[Stage, ...]:
        stages = tuple(self._agent.stages) if isinstance(self._agent, Thinker) else ()
        self._replies += [stage.reply for stage in stages if stage.reply is not None]
        return stages

    def _watch_aftermath(self, episode: Episode) -> None:
        try:
            for _ in range(int(AFTERMATH_S)):
                self._after += episode.aftermath(1.0)
            if episode.instance.task.second is not None:
                self._baseline = episode.baseline.until(self._watched(episode)[-1].time_s)
        except InfrastructureError:
            # The figures of the row count the aftermath: without it they would not be those of another run.
            episode.verdict = None
            raise

    def _watched(self, episode: Episode) -> list[Moment]:
        """Moments from the hand-over to the end of the aftermath."""
        return [*episode.moments, *self._after]

    def _result(self, end: End, error: InfrastructureError | None) -> EpisodeResult:
        setup, episode = self._setup, self._episode
        named: dict[str, Any] = {
            "task": setup.task,
            "half": setup.half,
            "scenario": self._finder.scenario.name,
            "notes": self._finder.scenario.notes,
            "agent": setup.agent,
            "model": setup.model,
            "seed": setup.seed,
            "traffic_seed": self._traffic_seed,
            "end": end,
            "error": None if error is None else str(error),
            "error_kind": None if error is None else type(error).__name__,
            "conditions": setup.conditions,
            "without": setup.without,
            "tokens_in": sum(reply.tokens_in for reply in self._replies),
            "tokens_out": sum(reply.tokens_out for reply in self._replies),
            "model_seconds": round(sum(reply.seconds for reply in self._replies), 3),
            "cost_usd": sum(reply.cost_usd for reply in self._replies),
        }
        if episode is None:
            return EpisodeResult(
                **named,
                goal="",
                success=None,
                reward=0.0,
                steps=0,
                sim_seconds=0.0,
                trace_sha256=None,
                verdict=None,
                timeline=(),
                path=(),
                held_out=setup.held_out,
            )
        judged = episode.verdict
        before = [*episode.drive, *episode.moments[1:]]
        moments = [*before, *self._after]
        watched = self._watched(episode)
        hand_over_s, end_s = watched[0].time_s, watched[-1].time_s
        return EpisodeResult(
            **named,
            goal=episode.goal,
            success=None if judged is None else judged.success,
            reward=float(judged is not None and judged.success),
            steps=len(episode.steps) - 1,
            sim_seconds=round(episode.seconds, 3),
            trace_sha256=episode.trace_sha256,
            agent_error=episode.failure,
            verdict=judged,
            timeline=timeline(moments, episode.steps, None if judged is None else judged.goal_s),
            path=samples(moments, hand_over_s),
            held_out=episode.instance.held_out,
            load=driver_load(episode.steps),
            drive=drive_figures(watched, end_s) if self._baseline else None,
            baseline_drive=drive_figures(self._baseline, end_s) if self._baseline else None,
            breaches=episode.breaches,
            estimates=estimates(episode.steps, before),
            violations=tuple(
                replace(found, from_s=round(found.from_s - hand_over_s, 3), to_s=round(found.to_s - hand_over_s, 3))
                for found in geo.violations(moments)
            ),
        )


def _thought(stages: Sequence[Stage]) -> str:
    """The agent's action, or what was wrong with its answer."""
    said = {stage.name: stage.text for stage in stages}
    return said.get(StageName.INTERPRET, said.get(StageName.ACT, ""))
