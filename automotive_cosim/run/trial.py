"""A trial by name, and its run: one spec goes in, a session runs, one row comes out.

run_trial:  started -> reset, brief -> begun -> (act -> step -> stepped)* -> judged -> drive on -> row -> finished
"""

from __future__ import annotations

import hashlib
import re
from abc import abstractmethod
from collections.abc import Hashable, Iterable, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from math import inf
from pathlib import Path
from typing import Annotated, Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
from annotated_types import Ge, Gt, Le

from automotive_cosim.agents import Agent, Learner, Privileged, Stage, StageName, Thinker
from automotive_cosim.contracts import Element, Json
from automotive_cosim.contracts.given import Clock, GeoInput
from automotive_cosim.drives.specification import MOST_STEPS
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observer, Observers
from automotive_cosim.episode.session import JudgedSession, Session, TakesTime, driven, playing
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import InfrastructureError, TrafficError
from automotive_cosim.interface.trace import Step, canonical
from automotive_cosim.models import ModelReply
from automotive_cosim.run.executor import Job
from automotive_cosim.run.moments import JudgeInput
from automotive_cosim.run.outside import EPISODE_S, STEP_S
from automotive_cosim.run.rows import TrialRow
from automotive_cosim.tasking.sets import Split, Suite
from automotive_cosim.traffic.fork import Simulations

NO_MODEL = "none"
WARM_UPS_S: Mapping[str, float] = {
    "alpine_pass": 3.6, "autobahn": 4.2, "beauce": 2.2, "border": 2.0, "grid": 1.6, "gulf": 4.5, "inntal": 2.0,
    "london": 4.3, "new_york": 3.8, "nordic": 2.9, "paris_centre": 7.4, "peripherique": 7.5, "sydney": 3.4,
    "tokyo": 7.2,
}  # fmt: skip
"""Processor seconds of loading and warming up each shipped scenario, with the process that does (November 2026)."""
WARM_UP_S = 10.0
"""The same of another scenario: an import of a town has more roads than most of these."""
HUMAN = "human"
"""The agent that is a person; a code name replaces the model."""


def warm_up_s(scenario: str) -> float:
    """Seconds of one worker on an idle machine for loading and warming up a scenario."""
    return WARM_UPS_S.get(scenario, WARM_UP_S)


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one episode."""

    steps: Annotated[int, Ge(1), Le(100_000)] = Suite.STANDARD.max_steps
    """Number of actions, including unreadable ones."""
    hard_steps: Annotated[int, Ge(1), Le(100_000)] = Suite.HARD.max_steps
    """The same for the suites hard and people."""
    sim_s: Annotated[float, Gt(0)] = 600.0
    """Simulated seconds from the hand-over, after which the episode is judged as it is."""
    wall_s: Annotated[float, Gt(0)] = 900.0
    """Wall seconds of all but the agent and its model, warm-up included; exceeding them is an infrastructure
    error."""
    agent_s: Annotated[float, Gt(0)] = EPISODE_S
    """Wall seconds that the agent's process may take; exceeding them is a failure of the agent."""
    agent_step_s: Annotated[float, Gt(0)] = STEP_S
    """The same for one step."""
    model_s: Annotated[float, Gt(0)] = 1800.0
    """Wall seconds to wait for the model in all, after which the episode is judged as it is."""
    tokens: Annotated[int, Ge(1)] = 2_000_000
    """Tokens to and from the model, after which the episode is judged as it is."""
    drive_steps: Annotated[int, Ge(1), Le(MOST_STEPS)] = MOST_STEPS
    """``steps`` of a drive, waits among them."""
    drive_wall_s: Annotated[float, Gt(0)] = 7200.0
    """``wall_s`` of a drive, which lasts ten to thirty simulated minutes."""
    drive_agent_s: Annotated[float, Gt(0)] = 7200.0
    """``agent_s`` of a drive."""
    drive_model_s: Annotated[float, Gt(0)] = 14_400.0
    """``model_s`` of a drive: a slow model is asked hundreds of times, for up to a minute each."""
    drive_tokens: Annotated[int, Ge(1)] = 20_000_000
    """``tokens`` of a drive."""

    @property
    def of_drives(self) -> Limits:
        """The limits of a drive, which goes on unwatched when one of them is reached; its time ends with it."""
        return replace(
            self,
            steps=self.drive_steps,
            wall_s=self.drive_wall_s,
            agent_s=self.drive_agent_s,
            model_s=self.drive_model_s,
            tokens=self.drive_tokens,
        )

    def within(self, tokens: int | None = None, model_s: float | None = None) -> Limits:
        """The same with another budget for the model; None keeps what there is."""
        return replace(
            self,
            tokens=self.tokens if tokens is None else tokens,
            model_s=self.model_s if model_s is None else float(model_s),
        )

    @property
    def longest_s(self) -> float:
        """Wall seconds of everything."""
        return self.wall_s + self.agent_s + self.model_s


@runtime_checkable
class _Timed(Protocol):
    """An agent whose answers are timed from outside, so that it cannot influence the measurement."""

    @property
    def answer_s(self) -> float:
        """Wall seconds that its last answer took."""
        ...


@runtime_checkable
class _Replayed(Protocol):
    """An agent that repeats a recording, including the time that each answer took."""

    @property
    def thought_s(self) -> float:
        """Simulated seconds that the answer it gave last took."""
        ...


class Answers:
    """An agent's answers so far."""

    def __init__(self, agent: Agent, conditions: Conditions) -> None:
        self._agent, self._conditions = agent, conditions
        self._replies: list[ModelReply] = []
        self.prompts: tuple[int, ...] = ()
        """Tokens of each question to the model, those of an unfinished turn left out."""
        self.thought_s = 0.0
        """Simulated seconds that all answers took."""

    def took_s(self) -> float:
        """Simulated seconds that the last answer took; asked once for each."""
        seconds = self._seconds()
        self.thought_s += seconds
        return seconds

    def stages(self, *, finished: bool = True) -> tuple[Stage, ...]:
        """The stages of the last turn, whose replies are counted; asked once for each.

        Args:
            finished: whether the turn came to an answer."""
        stages = tuple(self._agent.stages) if isinstance(self._agent, Thinker) else ()
        replies = [stage.reply for stage in stages if stage.reply is not None]
        self._replies += replies
        self.prompts += tuple(reply.tokens_in for reply in replies if finished)
        return stages

    @property
    def calls(self) -> int:
        """How often the model answered."""
        return len(self._replies)

    @property
    def costs(self) -> Json:
        """The fields of a row about what the agent's model took; a model in this process took no time."""
        replies = self._replies
        return {
            "tokens_in": sum(reply.tokens_in for reply in replies),
            "tokens_out": sum(reply.tokens_out for reply in replies),
            "cost_usd": sum(reply.cost_usd for reply in replies),
            "model_seconds": round(sum(reply.seconds for reply in replies), 3),
        }

    def _seconds(self) -> float:
        agent, seconds = self._agent, self._conditions.latency_s
        if isinstance(agent, _Replayed):
            return agent.thought_s
        if self._conditions.clock is Clock.MODEL and isinstance(agent, _Timed):
            seconds += agent.answer_s
        elif self._conditions.clock is Clock.MODEL and isinstance(agent, Thinker):
            seconds += sum(stage.reply.seconds for stage in agent.stages if stage.reply is not None)
        return round(seconds, 1)  # the shortest step of a scenario


@dataclass(frozen=True, kw_only=True)
class TrialSetup(Job):
    """What one agent does once, by name: on a task's half (``EpisodeSetup``) or on a drive (``DriveSetup``).

    The same trial gives the same trace."""

    agent: str = ""
    model: str = NO_MODEL
    repeat: int = 0
    """Which run of the same it is."""
    limits: Limits = field(default_factory=Limits)

    @property
    @abstractmethod
    def seed(self) -> int:
        """Seed of the traffic, and of everything that is drawn."""

    @property
    @abstractmethod
    def conditions(self) -> Conditions:
        """What the agent is given, and at what speed."""

    @property
    def asked_model(self) -> str:
        """The model, as given to ``make_agent``."""
        return "rules" if self.model == NO_MODEL else self.model

    @property
    @abstractmethod
    def in_scenario(self) -> str:
        """Name or folder of the scenario that it runs in."""

    @property
    @abstractmethod
    def about(self) -> Json:
        """What is run, by name, as the file of its road tells it."""

    @property
    @abstractmethod
    def split(self) -> Split:
        """The public set that it belongs to."""

    @property
    @abstractmethod
    def instance(self) -> tuple[Hashable, ...]:
        """What an instance is identified by; the same for every contestant."""

    @abstractmethod
    def planned(self) -> TrialRow:
        """Its row, as far as it is known before it runs."""

    @property
    def cars(self) -> Sequence[TrialSetup]:
        """Itself; of a fleet the trial of every car, its own first. Each has a row."""
        return (self,)

    @property
    def row_ids(self) -> Sequence[str]:
        return [car.id for car in self.cars]

    @abstractmethod
    def started(self, simulations: Simulations, agent: Agent, observer: Observer) -> JudgedSession:
        """Its session, at the instant at which the agent takes over; whoever asks for it closes it.

        Raises:
            UserError: something in it does not exist.
            InfrastructureError: the situation did not arise, or the road failed."""

    @abstractmethod
    def row(self, session: Any, end: End, answers: Answers) -> TrialRow:
        """Its row, once it is over; ``session`` is None if the agent never took over."""

    @abstractmethod
    def told(self, session: Any) -> Any:
        """What the end of its trace tells besides the row; None if there is nothing to tell."""

    @abstractmethod
    def lines(self, session: Any, row: TrialRow, told: Any, thoughts: Sequence[Json]) -> list[Json]:
        """Its trace: the steps, each with what the agent thought, then the result."""

    @abstractmethod
    def judged(self, session: Any) -> JudgeInput | None:
        """The judge's input; None without a judgement."""

    @property
    def simulation(self) -> tuple[str, int]:
        """The warm simulation that it starts from: scenario and seed."""
        return self.in_scenario, self.seed

    @property
    def warm_up_weight(self) -> float:
        """How long the warm-up of its simulation takes, as a share of that of a large town."""
        return warm_up_s(self.in_scenario) / WARM_UP_S

    @property
    def wall_s(self) -> float:
        """Limit of its wall time."""
        return self.limits.longest_s

    @property
    def named(self) -> Json:
        """What its row says of it before it runs, whatever its kind."""
        names = ("id", "agent", "model", "conditions", "seed", "repeat", "split")
        return {"scenario": self.in_scenario} | {name: getattr(self, name) for name in names}

    def id_of(self, *what: str, rest: Iterable[str]) -> str:
        """A file name from what is run, by whom and how: readable words, then a digest of everything.

        Args:
            what: what is run, which comes first.
            rest: what distinguishes it besides agent, model, seed, repeat and conditions."""
        conditions = self.conditions
        others = replace(conditions, geo=GeoInput.FULL).tags
        return file_name(
            (*what, self.agent, self.model, conditions.geo, f"s{self.seed}", f"r{self.repeat}", *rest, *others)
        )


def file_name(exactly: Iterable[str]) -> str:
    """Readable words, then a digest of everything."""
    exactly = tuple(exactly)
    return f"{'-'.join(map(_readable, exactly))[:150]}-{digest(exactly)[:8]}"


@lru_cache(4096)
def _readable(word: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.]+", "_", Path(word).name)


def digest(value: object) -> str:
    """A digest of plain values."""
    return hashlib.sha256(canonical(value)).hexdigest()


@dataclass(frozen=True)
class Shot:
    """One step as observers see it."""

    session: Session
    step: Step
    seen: tuple[Element, ...] = ()
    """The elements the agent saw when it acted."""
    stages: tuple[Stage, ...] = ()
    """The stages of the agent's reasoning, for agents that report them."""

    @cached_property
    def thought(self) -> str:
        """The agent's own reason for the action, or what was wrong with its answer; empty if it gives none."""
        said = {stage.name: stage.text for stage in self.stages}
        return said.get(StageName.INTERPRET, said.get(StageName.ACT, ""))

    @cached_property
    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The cockpit after the step, (height, width, 3); drawn when an observer first asks for it, which must be
        before the next step."""
        return self.session.screenshot()


class TrialObserver(Observer):
    """Observes trials: their sessions and what comes of them."""

    def begun(self, session: Any, shot: Shot) -> None:
        """The agent takes over: at the hand-over of a task, or when a drive departs."""

    def stepped(self, shot: Shot) -> None:
        """The agent has acted."""

    def finished(self, row: Any, told: Any) -> None:
        """The trial is over, or was broken off: its row, and what else its trace tells (``TrialSetup.told``)."""


def run_trial(
    trial: TrialSetup,
    agent: Agent,
    observers: Sequence[TrialObserver] = (),
    *,
    simulations: Simulations | None = None,
    wall_s: float = inf,
) -> TrialRow:
    """Runs a trial to its end and judges it.

    Args:
        trial: what to run; its ``agent`` and ``model`` are only written into the row.
        observers: notified of everything as it happens.
        simulations: warm simulations to use; by default its own, closed with the trial.
        wall_s: wall seconds from the hand-over or departure after which it is cut off.

    Returns:
        Its row, without the fields that a batch adds; of an infrastructure error, the row says which.

    Raises:
        UserError: something in the trial does not exist or is invalid; no observer has seen the agent take over.
        KeyboardInterrupt: passed on after the observers have received the row so far."""
    run = TrialRun(trial, agent, observers)
    with ExitStack() as ends:
        own = simulations or ends.enter_context(closing(Simulations()))
        try:
            session = trial.started(own, agent, run.observer)
            ends.callback(session.close)
            return driven(run.playing(session, wall_s))
        except InfrastructureError as error:
            return run.over(End.ERROR, error)
        except KeyboardInterrupt:
            run.over(End.INTERRUPTED)
            raise


class TrialRun:
    """A trial that is run: who acts, who observes, and what comes of it."""

    def __init__(self, trial: TrialSetup, agent: Agent, observers: Sequence[TrialObserver] = ()) -> None:
        """Nothing has begun; arguments as of ``run_trial``."""
        self.trial, self.agent = trial, agent
        self.observer = Observers(observers)
        """Notifies all of what happens on the road."""
        self._observers = [*observers]
        self._answers = Answers(agent, trial.conditions)
        self._session: JudgedSession | None = None

    def over(self, end: End, error: InfrastructureError | None = None) -> TrialRow:
        """The row, of which the observers are told; with an error, it says which."""
        session = self._session
        row = self.trial.row(session, end, self._answers)
        told = None if session is None else self.trial.told(session)
        if error is not None:
            row = replace(row, error=str(error), error_kind=type(error).__name__)
        for observer in self._observers:
            observer.finished(row, told)
        return row

    def playing(
        self, session: JudgedSession, wall_s: float, observers: Sequence[TrialObserver] = ()
    ) -> TakesTime[TrialRow]:
        """Lets the agent act until the session is over; the row, which may be that of an error of its own.

        Args:
            observers: more of them, from now on.

        Raises TrafficError: the traffic simulation failed."""
        self._session = session
        self._observers += observers
        try:
            end = yield from self._played(session, wall_s)
        except TrafficError:
            raise
        except InfrastructureError as error:
            return self.over(End.ERROR, error)
        return self.over(end)

    def _played(self, session: JudgedSession, wall_s: float) -> TakesTime[End]:
        agent, answers, observers = self.agent, self._answers, self._observers

        def stepped(session: JudgedSession, seen: Sequence[Element]) -> None:
            shot = Shot(session, session.steps[-1], tuple(seen), answers.stages())
            for observer in observers:
                observer.stepped(shot)

        agent.reset(session.observation.goal)
        if isinstance(agent, Privileged) and isinstance(session, Episode):
            agent.brief(session.instance, drawn=session.world.cockpit.drawn, branch=session.branch)
        first = Shot(session, session.steps[0])
        for observer in observers:
            observer.begun(session, first)
        end = yield from playing(session, agent, stepped, answers.took_s, wall_s)
        if end in (End.OUT_OF_BUDGET, End.AGENT_FAILED):
            answers.stages(finished=False)
        if isinstance(agent, Learner) and isinstance(session, Episode) and session.verdict is not None:
            agent.learn(session.verdict.success)
        session.drive_on()
        return end
