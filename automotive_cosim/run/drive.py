"""A drive by name, what its session comes to, and its row."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from automotive_cosim.agents import Agent
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Order
from automotive_cosim.drives.elsewhere import name_of
from automotive_cosim.drives.events import KINDS, DriveAct, DriveEvent, EventKind
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.judge import ORDER, JudgedAct, JudgedEvent, facts_of, judge, known_to
from automotive_cosim.drives.result import figures, judged_since
from automotive_cosim.drives.score import Score
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.timeline import timeline
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.specification import End
from automotive_cosim.interface.trace import digests, plain
from automotive_cosim.run.moments import JudgeInput
from automotive_cosim.run.rows import DriveTrialRow, TrialRow
from automotive_cosim.run.trial import NO_MODEL, Answers, Limits, TrialSetup
from automotive_cosim.tasking.sets import Split
from automotive_cosim.tasking.split import split_of_seed
from automotive_cosim.traffic.fork import Simulations


@dataclass(frozen=True, kw_only=True)
class DriveSetup(DriveSpec, TrialSetup):  # pyright: ignore[reportIncompatibleVariableOverride]
    """One agent on one drive, by name; the same setup gives the same trace."""

    limits: Limits = field(default_factory=lambda: Limits().of_drives)
    car: int = 0
    """Its number in its fleet, to which also its seed has been counted."""

    @property
    def cars(self) -> Sequence[DriveSetup]:
        return [replace(self, car=number, seed=self.seed + number) for number in range(self.settings.cars or 1)]

    @property
    def fleet(self) -> Sequence[DriveSetup]:
        """All cars of its fleet, itself among them; none of a drive alone."""
        return replace(self, car=0, seed=self.seed - self.car).cars if self.settings.cars else ()

    @property
    def wall_s(self) -> float:
        return self.limits.longest_s * (self.settings.cars or 1)

    @property
    def in_scenario(self) -> str:
        return self.scenario or family_named(self.family).scenario

    @property
    def about(self) -> Json:
        names = ("agent", "model", "seed")
        told = {"task": name_of(self.family, self.in_scenario), "scenario": self.in_scenario}
        return told | {name: getattr(self, name) for name in names}

    @property
    def split(self) -> Split:
        """The public set that it belongs to, by its seed; of a fleet's car, by the fleet's."""
        return split_of_seed(self.seed - self.car)

    @property
    def kind(self) -> Hashable:
        """Agent and model, which determine how long it takes; of agents without a model, the drive itself does."""
        return "drive", self.model, "" if self.model == NO_MODEL else self.agent

    @property
    def instance(self) -> tuple[Hashable, ...]:
        return self.family, self.in_scenario, self.settings, self.seed, self.repeat, self.car

    @property
    def id(self) -> str:
        scenario = [self.scenario] if self.scenario else []
        number = [f"car{self.car}"] if self.car else []
        return self.id_of(self.family, rest=(*scenario, *self.settings.tags, *number))

    def planned(self) -> DriveTrialRow:
        season = family_named(self.family).season
        return DriveTrialRow(**self.named, family=self.family, season=season, settings=self.settings, car=self.car)

    def started(self, simulations: Simulations, agent: Agent, observer: Observer) -> DriveSession:
        return self.begin(simulations, agent.channels, observer)

    def row(self, session: DriveSession | None, end: End, answers: Answers) -> DriveTrialRow:
        row = replace(self.planned(), end=end)
        if session is None or not session.is_judged:
            return row
        return replace(
            row,
            country=session.moments[0].context.country,
            channels=tuple(sorted(session.setup.channels)),
            calls=answers.calls,
            thought_s=round(answers.thought_s, 3),
            **answers.costs,
            **figures(session),
        )

    def told(self, session: DriveSession) -> Json | None:
        return timeline(session) if session.is_judged else None

    def lines(self, session: DriveSession, row: TrialRow, told: Json, thoughts: Sequence[Json]) -> list[Json]:
        begun_s = session.moments[0].time_s
        steps: list[Json] = [
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
        return [*steps, {"result": {"timeline": told}}]

    def judged(self, session: DriveSession) -> JudgedDrive | None:
        return JudgedDrive.of(session) if session.is_judged else None


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
    order: Order = Order.FULL
    """What the driver asked for; ``facts`` are those that count against who was told that."""
    harmed_s: float = 0.0
    """For how much longer than the do-nothing drive it was near a collision, where attention is limited."""

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
            order=self.order,
        )
        return judged_since(judged, self.begun_s, self.seconds, self.harmed_s)

    @classmethod
    def of(cls, session: DriveSession) -> JudgedDrive:
        """The input of a drive's judgement that is over."""
        order = session.setup.conditions.order
        against = known_to(order, facts_of(session.moments))
        times_s = sorted({act.time_s for act in session.acts})
        facts = {(kind.name, time_s): against(kind, time_s) for kind in KINDS.values() for time_s in times_s}

        def noted(kind: EventKind, time_s: float) -> str | None:
            if (kind.name, time_s) not in facts:
                facts[kind.name, time_s] = against(kind, time_s)
            return facts[kind.name, time_s]

        events, acts, due_anyway = tuple(session.events), tuple(session.acts), dict(session.due_anyway)
        commands, untouched = session.moments[0].commands, session.untouched
        judge(KINDS, events, acts, due_anyway, noted, commands, untouched, order=order)  # asks between alerts too
        return cls(
            events,
            acts,
            due_anyway,
            commands,
            tuple((name, time_s, fact) for (name, time_s), fact in facts.items()),
            untouched,
            session.moments[0].time_s,
            session.seconds,
            order,
            session.harmed_s,
        )
