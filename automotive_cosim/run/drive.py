"""Runs one drive with an agent, from departure to its row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import asdict, dataclass, fields, replace
from math import inf
from typing import Any

from automotive_cosim.agents import Agent
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Json
from automotive_cosim.drives.events import KINDS, DriveAct, DriveEvent, EventKind
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.judge import ORDER, JudgedAct, JudgedEvent, facts_of, judge
from automotive_cosim.drives.result import DriveResult, judged_since, result_of
from automotive_cosim.drives.score import Score
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.timeline import timeline
from automotive_cosim.episode.observer import Observers
from automotive_cosim.episode.specification import End
from automotive_cosim.interface.observe import Channel
from automotive_cosim.interface.trace import digests, plain
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.moments import JudgeInput
from automotive_cosim.run.observer import Answers, TrialObserver, play_observed
from automotive_cosim.traffic.fork import Simulations


@dataclass(frozen=True, slots=True)
class DriveSetup(DriveSpec):
    """A specification of a drive and an agent, by name; the same setup gives the same trace."""

    agent: str = ""
    model: str = "none"

    @property
    def about(self) -> Json:
        """What is run, by name, as the file of its road tells it."""
        return {
            "task": self.family,
            "scenario": self.scenario or family_named(self.family).scenario,
            "agent": self.agent,
            "model": self.model,
            "seed": self.seed,
        }


@dataclass(frozen=True, slots=True)
class JudgedDrive(JudgeInput):
    """The input of a drive's judgement; times are simulation times."""

    events: tuple[DriveEvent, ...]
    acts: tuple[DriveAct, ...]
    due_anyway: Mapping[int, float | None]
    """By number of an event, when its obligation arose in its do-nothing copy."""
    commands: Mapping[str, Any]
    """What was commanded at departure."""
    facts: tuple[tuple[str, float, str | None], ...]
    """What speaks against an act, by kind of event, at its time and when else the judge looks; None for nothing."""
    untouched: tuple[DriveEvent, ...]
    """Events of the do-nothing run, if an act of the agent holds something back."""
    begun_s: float
    seconds: float
    """Duration of the drive."""

    def judgement(self) -> tuple[tuple[JudgedEvent, ...], tuple[JudgedAct, ...], Score]:
        """Events, acts and score by the current checks; their times are seconds since departure."""
        facts = {(kind, time_s): fact for kind, time_s, fact in self.facts}
        judged = judge(
            KINDS,
            self.events,
            self.acts,
            self.due_anyway,
            lambda kind, time_s: facts.get((kind.name, time_s), ORDER),
            self.commands,
            self.untouched,
        )
        return judged_since(judged, self.begun_s, self.seconds)

    @classmethod
    def of(cls, session: DriveSession) -> JudgedDrive:
        """The input of a drive's judgement that is over."""
        against = facts_of(session.moments)
        times_s = sorted({act.time_s for act in session.acts})
        facts = {(kind.name, time_s): against(kind, time_s) for kind in KINDS.values() for time_s in times_s}

        def noted(kind: EventKind, time_s: float) -> str | None:
            if (kind.name, time_s) not in facts:
                facts[kind.name, time_s] = against(kind, time_s)
            return facts[kind.name, time_s]

        events, acts, due_anyway = tuple(session.events), tuple(session.acts), dict(session.due_anyway)
        commands, untouched = session.moments[0].commands, session.untouched
        judge(KINDS, events, acts, due_anyway, noted, commands, untouched)  # which also asks between two alerts
        return cls(
            events,
            acts,
            due_anyway,
            commands,
            tuple((name, time_s, fact) for (name, time_s), fact in facts.items()),
            untouched,
            session.moments[0].time_s,
            session.seconds,
        )


@dataclass(frozen=True, slots=True)
class DriveRecord:
    """What is kept of a drive."""

    row: DriveTrialRow
    timeline: Json
    """Speed, limit and the do-nothing run's speed, one value per second."""
    steps: tuple[Json, ...]
    """Action, thinking time and result of each step, with hashes of the state that followed."""
    judged: JudgedDrive
    """The judge's input."""

    @property
    def lines(self) -> list[Json]:
        """Its trace: the steps, then the result."""
        return [*self.steps, {"result": {"timeline": self.timeline}}]


DriveObserver = TrialObserver[DriveSession, DriveRecord]
"""Observes a drive."""


def judged_row(
    planned: DriveTrialRow, end: End, channels: tuple[Channel, ...], result: DriveResult, **totals: Any
) -> DriveTrialRow:
    """The row of a drive that is over.

    Args:
        planned: its row before it had run.
        end: why it ended.
        channels: what the agent was given.
        result: how it was judged.
        totals: fields of the row about the agent's model.
    """
    found = {entry.name: getattr(result, entry.name) for entry in fields(result)}
    return replace(planned, end=end, channels=channels, **found, **totals)


def run_drive(
    planned: DriveTrialRow,
    setup: DriveSetup,
    agent: Agent,
    *,
    simulations: Simulations | None = None,
    observers: Sequence[DriveObserver] = (),
    plan: DriveScript | None = None,
    wall_s: float = inf,
) -> DriveRecord:
    """Runs a drive to its end and judges it.

    Args:
        planned: its row before it has run.
        setup: what to run.
        agent: the agent that watches.
        simulations: warm simulations to use; by default its own, closed with the drive.
        observers: notified of everything as it happens.
        plan: used instead of the family's plan for the seed.
        wall_s: wall seconds from departure after which nobody watches.

    Raises:
        UserError: something in the setup does not exist.
        InfrastructureError: traffic or model failed.
    """
    with ExitStack() as ends:
        own = simulations or ends.enter_context(closing(Simulations()))
        session = setup.begin(own, agent.channels, Observers(observers), plan)
        ends.callback(session.close)
        answers, channels = Answers(agent, setup.conditions), tuple(sorted(agent.channels))
        agent.reset(session.goal)
        end = play_observed(session, agent, answers, observers, wall_s)
        result = result_of(session)
        record = DriveRecord(
            row=judged_row(planned, end, channels, result, **asdict(answers.usage)),
            timeline=timeline(session),
            steps=tuple(_steps(session)),
            judged=JudgedDrive.of(session),
        )
        for observer in observers:
            observer.finished(record)
        return record


def _steps(session: DriveSession) -> list[Json]:
    begun_s = session.moments[0].time_s
    return [
        {
            "step": step.number,
            "time_s": round(step.moment.time_s - begun_s, 3),
            "action": None if step.action is None else to_json(step.action),
            "thought_s": step.thought_s,
            "feedback": plain(step.feedback),
            "sha256": digests(step.state),
        }
        for step in session.steps
    ]
