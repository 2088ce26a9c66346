"""One episode: an agent, a task, a seed; what came of it.

reset -> brief -> (act -> step)* -> verdict -> aftermath
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from automotive_cosim import geo
from automotive_cosim.agents import Agent, Learner, Privileged, Stage, StageName, Thinker
from automotive_cosim.cockpit.actions import check
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Element, Json
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import ActionError, InfrastructureError, OutOfBudgetError
from automotive_cosim.geo.breaches import Violation
from automotive_cosim.interface import trace
from automotive_cosim.models import Reply
from automotive_cosim.run.estimates import PositionEstimate, estimates
from automotive_cosim.run.harm import DriveFigures, drive_figures
from automotive_cosim.run.load import DriverLoad, driver_load
from automotive_cosim.run.timeline import Entry, Sample, samples, timeline
from automotive_cosim.scenarios import Scenario
from automotive_cosim.tasking import verdict
from automotive_cosim.tasking.task import Mode
from automotive_cosim.traffic.fork import Simulations

AFTERMATH_S = 12.0
"""The road is watched this long after the end: a driver's reaction and the braking from 80 to 50 km/h fit in."""


@dataclass(frozen=True, slots=True)
class EpisodeSetup:
    """What is to be run, by names: the same setup gives the same trace."""

    task: str = "road_speed_80_in_50"
    half: str = "first"
    agent: str = "asurada"
    model: str = "rules"
    scenario: str | None = None
    """A name, a folder, a ``.sumocfg`` or a network; None takes the task's own."""
    origin: tuple[float, float] | None = None
    """Longitude and latitude that the middle of its network is moved to."""
    gps: bool = True
    """False: no GPS, so that no place is known."""
    from_place: str = ""
    """Where the ego's way begins and ends, in place of the task's trip (``CockpitEnv``)."""
    to_place: str = ""
    seed: int = 0
    max_steps: int = 20
    max_sim_s: float | None = None
    """Simulated seconds from the hand-over after which it is cut off; None leaves that to ``max_steps``."""
    geo: str = "full"
    """What the agent is told of where it is (``interface.controls.GeoInput``)."""
    mode: str = str(Mode.PROMPTED)
    """When the agent is called (``tasking.task.Mode``)."""
    without: tuple[str, ...] = ()
    """Parts of the agent that are switched off, for the record."""
    held_out: bool = False
    """Whether the driver is to use the task's held-out phrasing; else any is drawn."""


class End(StrEnum):
    """Why an episode ended."""

    DECLARED = "declared"
    DRIVE_ENDED = "drive_ended"
    WATCH_OVER = "watch_over"
    """A watch's window is over."""
    OUT_OF_STEPS = "out_of_steps"
    OUT_OF_TIME = "out_of_time"
    """The simulated time it may take is over."""
    OUT_OF_BUDGET = "out_of_budget"
    """The agent has spent its tokens or its time."""
    INTERRUPTED = "interrupted"
    """By the user: no verdict."""
    ERROR = "error"
    """By the machinery, not by the agent: no verdict, never counted as a failure."""


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """What one episode came to. Without a verdict ``success`` is None and ``reward`` 0."""

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
    """Actions, the unreadable ones included."""
    sim_seconds: float
    """Simulated seconds from the hand-over to the end."""
    trace_sha256: str | None
    """Over the steps there were; None before the hand-over."""
    verdict: Json | None
    timeline: tuple[Entry, ...]
    path: tuple[Sample, ...]
    """The drive, once a second, from departure to the end of the aftermath."""
    end: End
    error: str | None = None
    error_kind: str | None = None
    """Name of the error's class in ``automotive_cosim.errors``."""
    violations: tuple[Violation, ...] = ()
    """Traffic law broken from departure to the end of the aftermath; seconds from the hand-over."""
    geo: str = "full"
    without: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    """What the scenario leaves open and was assumed, e.g. that there is no GPS."""
    held_out: bool = False
    """Whether the driver's phrasing is one that the rule model was not made on."""
    tokens_in: int = 0
    """To the model, in all; estimated for ``rules``."""
    tokens_out: int = 0
    model_seconds: float = 0.0
    """Waited for the model, in all; 0 for one that runs here."""
    cost_usd: float = 0.0
    estimates: tuple[PositionEstimate, ...] = ()
    """Where the agent said the car is, while GPS was out."""
    load: DriverLoad | None = None
    """What it asked of the driver while the car moved; None without a hand-over."""
    drive: DriveFigures | None = None
    """Of a judged safety task, from the hand-over to the end of the aftermath."""
    untouched_drive: DriveFigures | None = None
    """Over the same time had nobody touched the cockpit."""

    def as_json(self) -> Json:
        """The result as a JSON object."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class Shot:
    """One step as a watcher gets it."""

    step: trace.Step
    seen: tuple[Element, ...]
    """The elements the agent saw when it acted."""
    screenshot: npt.NDArray[np.uint8]
    """The cockpit afterwards, (height, width, 3)."""
    thought: str
    """Why the agent did it, in its own words; empty if it does not say."""
    stages: tuple[Stage, ...] = ()
    """How the agent came to it, for agents that tell."""


class Watcher:
    """Sees an episode as it comes about, e.g. to show or to record it. It sees everything and changes nothing."""

    def loading(self, scenario: Scenario) -> None:
        """SUMO loads the scenario; its ``notes`` say what was assumed."""

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """The scenario's traffic is being warmed up, in simulated seconds."""

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Another simulated second has passed: of the drive up, of a step, or of the aftermath."""

    def handed_over(self, env: CockpitEnv, shot: Shot) -> None:
        """The trigger holds; the agent begins."""

    def stepped(self, shot: Shot) -> None:
        """The agent has acted."""

    def finished(self, result: EpisodeResult) -> None:
        """The episode is over, its aftermath too; also called after an error or an interruption."""


def run_episode(
    setup: EpisodeSetup,
    agent: Agent,
    watchers: Sequence[Watcher] = (),
    *,
    simulations: Simulations | None = None,
) -> EpisodeResult:
    """Runs an episode to its end and judges it.

    Args:
        setup: what to run; ``agent`` and ``model`` are only written into the result.
        agent: the one that acts.
        watchers: told of everything as it happens.
        simulations: warm simulations to take; by default its own, ended with the episode.

    Raises:
        UserError: something in the setup does not exist or is broken; no watcher has been told of a hand-over.
        KeyboardInterrupt: passed on after the watchers got what there is.
    """
    env = CockpitEnv(
        setup.task,
        setup.half,
        mode=setup.mode,
        scenario=setup.scenario,
        origin=setup.origin,
        gps=setup.gps,
        from_place=setup.from_place,
        to_place=setup.to_place,
        channels=agent.channels,
        geo=setup.geo,
        held_out=setup.held_out,
        max_steps=setup.max_steps,
        render_mode="rgb_array",
        simulations=simulations,
        listener=_All(watchers),
    )
    episode = _Episode(setup, env, agent, watchers)
    try:
        episode.play()
    except InfrastructureError as error:
        return episode.finish(End.ERROR, error)
    except KeyboardInterrupt:
        episode.finish(End.INTERRUPTED)
        raise
    else:
        return episode.finish(episode.end)
    finally:
        env.close()


class _Episode:
    def __init__(self, setup: EpisodeSetup, env: CockpitEnv, agent: Agent, watchers: Sequence[Watcher]) -> None:
        self.setup = setup
        self.env = env
        self.agent = agent
        self.watchers = watchers
        self.end = End.OUT_OF_STEPS
        self._begun = False
        self._reward = 0.0
        self._replies: list[Reply] = []
        self._after: list[Moment] = []
        self._untouched: tuple[Moment, ...] = ()

    def play(self) -> None:
        env, agent = self.env, self.agent
        env.reset(seed=self.setup.seed)
        self._begun = True
        agent.reset(env.instance.goal)
        if isinstance(agent, Privileged):
            agent.brief(env.instance)
        first = self._shot((), "")
        for watcher in self.watchers:
            watcher.handed_over(env, first)
        over = False
        while not over:
            over = self._step()
        if isinstance(agent, Learner) and env.verdict is not None:
            agent.learn(env.verdict.success)
        self._watch_aftermath()

    def _step(self) -> bool:
        env = self.env
        seen = env.observed_elements
        try:
            action = check(self.agent.act(env.observation))
        except ActionError as error:
            _, self._reward, terminated, truncated, _ = env.refuse(str(error))
        except OutOfBudgetError:
            self._stages()
            self.end = End.OUT_OF_BUDGET
            _, self._reward, _, _, _ = env.cut_off()
            return True
        else:
            _, self._reward, terminated, truncated, _ = env.step(action)
        stages = self._stages()
        shot = self._shot(seen, _thought(stages), stages)
        for watcher in self.watchers:
            watcher.stepped(shot)
        if terminated:
            ended = env.moments[-1].driving.end is not None
            self.end = End.DRIVE_ENDED if ended else End.DECLARED if env.has_declared else End.WATCH_OVER
        elif not truncated and self._is_late():
            self.end = End.OUT_OF_TIME
            _, self._reward, _, truncated, _ = env.cut_off()
        return terminated or truncated

    def _is_late(self) -> bool:
        most_s, moments = self.setup.max_sim_s, self.env.moments
        return most_s is not None and moments[-1].time_s - moments[0].time_s >= most_s

    def _stages(self) -> tuple[Stage, ...]:
        stages = tuple(self.agent.stages) if isinstance(self.agent, Thinker) else ()
        self._replies += [stage.reply for stage in stages if stage.reply is not None]
        return stages

    def _watch_aftermath(self) -> None:
        # The verdict is made: a road that fails now is no error of the episode.
        with suppress(InfrastructureError):
            for _ in range(int(AFTERMATH_S)):
                self._after += self.env.aftermath(1.0)
            if self.env.instance.task.second is not None:
                self._untouched = self.env.untouched(self._watched[-1].time_s)

    @property
    def _watched(self) -> list[Moment]:
        """From the hand-over to the end of the aftermath."""
        return [*self.env.moments, *self._after]

    def _shot(self, seen: tuple[Element, ...], thought: str, stages: tuple[Stage, ...] = ()) -> Shot:
        screenshot = self.env.render()
        assert screenshot is not None
        return Shot(self.env.steps[-1], seen, screenshot, thought, stages)

    def finish(self, end: End, error: InfrastructureError | None = None) -> EpisodeResult:
        result = self._result(end, error)
        for watcher in self.watchers:
            watcher.finished(result)
        return result

    def _result(self, end: End, error: InfrastructureError | None) -> EpisodeResult:
        setup, env = self.setup, self.env
        named: dict[str, Any] = {
            "task": setup.task,
            "half": setup.half,
            "scenario": env.scenario.name,
            "notes": env.scenario.notes,
            "agent": setup.agent,
            "model": setup.model,
            "seed": setup.seed,
            "end": end,
            "error": None if error is None else str(error),
            "error_kind": None if error is None else type(error).__name__,
            "geo": setup.geo,
            "without": setup.without,
            "tokens_in": sum(reply.tokens_in for reply in self._replies),
            "tokens_out": sum(reply.tokens_out for reply in self._replies),
            "model_seconds": round(sum(reply.seconds for reply in self._replies), 3),
            "cost_usd": sum(reply.cost_usd for reply in self._replies),
        }
        if not self._begun:
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
        judged = env.verdict
        moments = [*env.drive, *env.moments[1:], *self._after]
        hand_over_s, end_s = env.moments[0].time_s, self._watched[-1].time_s
        return EpisodeResult(
            **named,
            goal=env.instance.goal,
            success=None if judged is None else judged.success,
            reward=self._reward if judged else 0.0,
            steps=len(env.steps) - 1,
            sim_seconds=round(env.moments[-1].time_s - hand_over_s, 3),
            trace_sha256=trace.sha256([step.as_json() for step in env.steps]),
            verdict=None if judged is None else verdict.as_json(judged),
            timeline=timeline(moments, env.steps, None if judged is None else judged.goal_s),
            path=samples(moments, hand_over_s),
            held_out=env.instance.held_out,
            load=driver_load(env.steps),
            drive=drive_figures(self._watched, end_s) if self._untouched else None,
            untouched_drive=drive_figures(self._untouched, end_s) if self._untouched else None,
            estimates=estimates(env.steps, [*env.drive, *env.moments[1:]]),
            violations=tuple(
                replace(found, from_s=round(found.from_s - hand_over_s, 3), to_s=round(found.to_s - hand_over_s, 3))
                for found in geo.violations(moments)
            ),
        )


class _All:
    """The environment's listener: passes on to every watcher."""

    def __init__(self, watchers: Sequence[Watcher]) -> None:
        self._watchers = watchers

    def loading(self, scenario: Scenario) -> None:
        for watcher in self._watchers:
            watcher.loading(scenario)

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        for watcher in self._watchers:
            watcher.warming(scenario, done_s, total_s)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        for watcher in self._watchers:
            watcher.moved(moment, cockpit)


def _thought(stages: Sequence[Stage]) -> str:
    """What the agent made of what it saw, or what was wrong with its answer."""
    said = {stage.name: stage.text for stage in stages}
    return said.get(StageName.INTERPRET, said.get(StageName.ACT, ""))
