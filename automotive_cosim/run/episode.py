"""One episode: an agent, a task, a seed; and the result.

find -> take over -> brief -> (act -> step)* -> verdict -> aftermath
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import asdict, dataclass, replace
from math import inf
from typing import Any

from automotive_cosim import geo
from automotive_cosim.agents import Agent, Learner, Privileged
from automotive_cosim.contracts import Json
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observers
from automotive_cosim.episode.situation import HandOver, SituationFinder
from automotive_cosim.episode.specification import End, EpisodeSpec, SeedSource
from automotive_cosim.errors import InfrastructureError, TriggerNotReachedError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.geo.breaches import Violation
from automotive_cosim.run.estimates import PositionEstimate, estimates
from automotive_cosim.run.harm import DriveFigures, drive_figures
from automotive_cosim.run.load import DriverLoad, driver_load
from automotive_cosim.run.observer import Answers, TrialObserver, play_observed
from automotive_cosim.run.timeline import Sample, TimelineEntry, samples, timeline
from automotive_cosim.tasking.policy import Breach
from automotive_cosim.tasking.verdict import Verdict
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

AFTERMATH_S = 12.0
"""The car drives on for this long after the end: enough for a driver to react and to brake from 80 to 50 km/h."""


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

    @property
    def about(self) -> Json:
        """What is run, by name, as the file of its road tells it."""
        return {
            "task": self.task,
            "half": self.half,
            "scenario": self.scenario or CATALOGUE[self.task].half(self.half).start.scenario,
            "agent": self.agent,
            "model": self.model,
            "seed": self.seed,
        }


def read_setup(values: Mapping[str, Any], where: str) -> EpisodeSetup:
    """A setup from its JSON form.

    Raises:
        UserError: it is not one; the message says what is wrong where.
    """
    return checked(EpisodeSetup, values, lambda steps: (where, dotted(steps)))


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
    baseline_drive: DriveFigures | None = None
    """The same figures of the baseline run, over the same time."""

    def as_json(self) -> Json:
        """The result as a JSON object; ``row.from_json`` reads it back."""
        return asdict(self) | {"verdict": self.verdict and self.verdict.as_json()}


EpisodeObserver = TrialObserver[Episode, EpisodeResult]
"""Observes an episode. ``finished`` is called after its aftermath, and after an error or an interruption too."""


def run_episode(
    setup: EpisodeSetup,
    agent: Agent,
    observers: Sequence[EpisodeObserver] = (),
    *,
    simulations: Simulations | None = None,
    wall_s: float = inf,
) -> EpisodeResult:
    """Runs an episode to its end and judges it.

    Args:
        setup: what to run; ``agent`` and ``model`` are only written into the result.
        agent: the agent that acts.
        observers: notified of everything as it happens.
        simulations: warm simulations to use; by default its own, closed with the episode.
        wall_s: wall seconds from the hand-over after which it is judged as it is.

    Raises:
        UserError: something in the setup does not exist or is invalid; no observer has seen a hand-over.
        KeyboardInterrupt: passed on after the observers have received the result so far.
    """
    with ExitStack() as ends:
        own = simulations or ends.enter_context(closing(Simulations()))
        finder = SituationFinder(setup, own, observer=Observers(observers))
        run = _Run(setup, finder, agent, observers)
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
        self, setup: EpisodeSetup, finder: SituationFinder, agent: Agent, observers: Sequence[EpisodeObserver]
    ) -> None:
        self._setup = setup
        self._finder = finder
        self._agent = agent
        self._observers = observers
        self._episode: Episode | None = None
        self._traffic_seed: int | None = None
        self._answers = Answers(agent, setup.conditions)
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
        episode = self._episode = Episode.take_over(hand_over, session, Observers(self._observers))
        agent.reset(episode.goal)
        if isinstance(agent, Privileged):
            agent.brief(episode.instance, drawn=episode.world.cockpit.drawn, branch=episode.branch)
        end = play_observed(episode, agent, self._answers, self._observers, wall_s)
        if isinstance(agent, Learner) and episode.verdict is not None:
            agent.learn(episode.verdict.success)
        self._drive_on(episode)
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
        for observer in self._observers:
            observer.finished(result)
        return result

    def _drive_on(self, episode: Episode) -> None:
        try:
            for _ in range(int(AFTERMATH_S)):
                self._after += episode.aftermath(1.0)
            if episode.instance.task.second is not None:
                self._baseline = episode.baseline.until(self._driven(episode)[-1].time_s)
        except InfrastructureError:
            # The figures of the row count the aftermath: without it they would not be those of another run.
            episode.verdict = None
            raise

    def _driven(self, episode: Episode) -> list[Moment]:
        """Moments from the hand-over to the end of the aftermath."""
        return [*episode.moments, *self._after]

    def _result(self, end: End, error: InfrastructureError | None) -> EpisodeResult:
        setup, episode, usage = self._setup, self._episode, self._answers.usage
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
            "tokens_in": usage.tokens_in,
            "tokens_out": usage.tokens_out,
            "model_seconds": usage.model_seconds,
            "cost_usd": usage.cost_usd,
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
        driven = self._driven(episode)
        hand_over_s, end_s = driven[0].time_s, driven[-1].time_s
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
            drive=drive_figures(driven, end_s) if self._baseline else None,
            baseline_drive=drive_figures(self._baseline, end_s) if self._baseline else None,
            breaches=episode.breaches,
            estimates=estimates(episode.steps, before),
            violations=tuple(
                replace(found, from_s=round(found.from_s - hand_over_s, 3), to_s=round(found.to_s - hand_over_s, 3))
                for found in geo.violations(moments)
            ),
        )
