"""An episode by name, what its session comes to, and its row."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from typing import Any

from automotive_cosim import geo
from automotive_cosim.agents import Agent
from automotive_cosim.cockpit.actions import position
from automotive_cosim.contracts import ActionType, Json
from automotive_cosim.cosim.exposed import states_of, stretches
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.specification import End, EpisodeSpec
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.geo.breaches import Violation
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east
from automotive_cosim.geo.reckoning import reckon
from automotive_cosim.interface.trace import Step
from automotive_cosim.measures.exposure import exposure
from automotive_cosim.measures.following import following_figures
from automotive_cosim.run.figures import (
    DriverLoad,
    alerts,
    compliance,
    drive_figures,
    driver_load,
    pixel_taps,
    questioned,
)
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.moments import Judged
from automotive_cosim.run.rows import EpisodeRow, PartsHeld, TrialRow
from automotive_cosim.run.timeline import Sample, TimelineEntry, samples, timeline
from automotive_cosim.run.trial import Answers, TrialSetup
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasking.policy import Breach
from automotive_cosim.tasking.sets import Split
from automotive_cosim.tasking.split import split_of
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasking.verdict import Verdict
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations


@dataclass(frozen=True, slots=True)
class PositionEstimate:
    """One estimate with both errors, in metres on the ground."""

    step: int
    age_s: float
    """Seconds since the last fix."""
    error_m: float
    dead_reckoning_error_m: float
    """Error of dead reckoning from the last fix, by compass and speedometer, at the same instant."""


def estimates(steps: Sequence[Step], moments: Sequence[Moment]) -> tuple[PositionEstimate, ...]:
    """The estimates of an episode, in order, except those made while there was a fix.

    Args:
        moments: from departure to its end, in order."""
    found = []
    for before, step in pairwise(steps):
        action = step.action
        if action is None or action.action_type is not ActionType.ESTIMATE_POSITION:
            continue
        now = before.moment
        said = position(action.text or "")
        reckoned = reckon([moment for moment in moments if moment.time_s <= now.time_s])
        if said is None or reckoned is None or now.gps is None or now.gps.has_fix:
            continue
        found.append(
            PositionEstimate(
                step.number, now.gps.age_s, _off_m(now, *said), _off_m(now, reckoned.lon_deg, reckoned.lat_deg)
            )
        )
    return tuple(found)


def _off_m(moment: Moment, lon_deg: float, lat_deg: float) -> float:
    truth = moment.driving
    assert truth.lon_deg is not None
    assert truth.lat_deg is not None
    east_m = ((lon_deg - truth.lon_deg + 180) % 360 - 180) * metres_per_degree_east(truth.lat_deg)
    north_m = (lat_deg - truth.lat_deg) * METRES_PER_DEGREE
    return float((east_m**2 + north_m**2) ** 0.5)


IN_RESULT = (
    "task", "half", "scenario", "agent", "model", "conditions", "seed", "traffic_seed", "success", "reward",
    "steps", "sim_seconds", "end", "error", "error_kind", "agent_error", "held_out", "trace_sha256", "tokens_in",
    "tokens_out", "model_seconds", "cost_usd", "drive", "baseline_drive",
)  # fmt: skip
"""Fields of a row that the result at the end of a trace repeats."""


@dataclass(frozen=True, kw_only=True)
class EpisodeSetup(EpisodeSpec, TrialSetup):  # pyright: ignore[reportIncompatibleVariableOverride]
    """One agent on one half of a task, by name; the same setup gives the same trace."""

    agent: str = "asurada"
    model: str = "rules"
    without: tuple[str, ...] = ()
    """Parts of the agent that are switched off, for the record."""
    spare_traffic: tuple[int, ...] = ()
    """Seeds of traffic to try in turn, with the same instance, if the situation does not occur in the seed's own
    traffic. No agent acts before it does, so every agent gets the same traffic."""

    @property
    def entry(self) -> Task:
        """The catalogue's entry."""
        return CATALOGUE[self.task]

    @property
    def in_scenario(self) -> str:
        return self.scenario or self.entry.half(self.half).start.scenario

    @property
    def about(self) -> Json:
        names = ("task", "half", "agent", "model", "seed")
        return {"scenario": self.in_scenario} | {name: getattr(self, name) for name in names}

    @property
    def split(self) -> Split:
        """The public set that it belongs to, by its seed and its phrasing."""
        return split_of(self.entry, self.seed, held_out=self.held_out, redrawn=self.redrawn)

    @property
    def kind(self) -> Hashable:
        """The agent and its model, which determine how long it takes."""
        return self.agent, self.model

    @property
    def situation(self) -> Hashable:
        """The drive up to the hand-over, on which no agent acts."""
        given = self.conditions
        before = Conditions(language=given.language, make=given.make, attention=given.attention)
        return replace(self, agent="", model="", without=(), conditions=before, repeat=0)

    @property
    def instance(self) -> tuple[Hashable, ...]:
        return self.task, self.half, self.in_scenario, self.seed, self.repeat

    @property
    def id(self) -> str:
        return self._id(self.half)

    @property
    def pair(self) -> str:
        """Name that both halves of a pair share; empty for a task with one half."""
        return self._id("pair") if self.entry.second else ""

    def planned(self) -> EpisodeRow:
        task, half = self.entry, self.entry.half(self.half)
        return EpisodeRow(
            **self.named,
            task=task.id,
            half=self.half,
            pair=self.pair,
            half_digest=fingerprint(task, self.half),
            dimension=task.dimension,
            module=task.module,
            basis=half.basis,
            suite=task.suite,
            tags=tuple(sorted(task.tags)),
            skills=tuple(sorted(task.skills)),
            ability=task.ability,
            declines=not half.moves,
            held_out=self.held_out,
        )

    def started(self, simulations: Simulations, agent: Agent, observer: Observer) -> Episode:
        return Episode.begin_at(self, simulations, lambda: agent.channels, observer, self.spare_traffic)

    def row(self, session: Episode | None, end: End, answers: Answers) -> EpisodeRow:
        row = replace(self.planned(), end=end, **answers.costs)
        if session is None:
            return replace(row, scenario=open_scenario(self.in_scenario).name)
        verdict, hand_over = session.verdict, session.moments[0]
        row = replace(
            row,
            scenario=session.scenario.name,
            parameters=dict(session.instance.parameters),
            traffic_seed=session.traffic_seed,
            country=hand_over.context.country,
            agent_error=session.failure,
            steps=len(session.steps) - 1,
            malformed=len(session.malformed),
            malformed_why=next(iter(session.malformed), ""),
            sim_seconds=round(session.seconds, 3),
            thought_s=round(sum(step.thought_s for step in session.steps), 1),
            prompt_tokens=answers.prompts,
            held_out=session.instance.held_out,
            trace_sha256=session.trace_sha256,
        )
        if verdict is not None:
            row = replace(
                row,
                success=verdict.success,
                reward=float(verdict.success),
                parts=PartsHeld.of(verdict),
                breaches=session.breaches,
                goal_s=verdict.goal_s,
                reason_fits=verdict.reason_fits,
            )
        driven, end_s, load = session.driven, session.driven[-1].time_s, driver_load(session.steps)
        measured = following_figures(states_of(driven))
        return replace(
            row,
            alerts=alerts(hand_over, session.moments[-1]),
            **questioned(session.questions),
            speed_compliance=compliance(driven),
            min_time_to_collision_s=measured.min_ttc_s,
            measures=measured,
            exposure=exposure(stretches(driven)),
            drive=drive_figures(driven, end_s) if session.compared else None,
            baseline_drive=drive_figures(session.compared, end_s) if session.compared else None,
            interaction_s=load.interaction_s,
            within_guideline=load.within_guideline,
            taps=pixel_taps(session.steps),
        )

    def told(self, session: Episode) -> EpisodeResult:
        before = [*session.drive, *session.moments[1:]]
        moments, begun_s = [*before, *session.after], session.moments[0].time_s
        goal_s = session.verdict.goal_s if session.verdict else None
        return EpisodeResult(
            goal=session.goal,
            verdict=session.verdict,
            timeline=timeline(moments, session.steps, goal_s),
            path=samples(moments, begun_s),
            violations=tuple(
                replace(found, from_s=round(found.from_s - begun_s, 3), to_s=round(found.to_s - begun_s, 3))
                for found in geo.violations(moments)
            ),
            breaches=session.breaches,
            without=self.without,
            notes=session.scenario.notes,
            estimates=estimates(session.steps, before),
            load=driver_load(session.steps),
        )

    def lines(self, session: Episode, row: TrialRow, told: EpisodeResult, thoughts: Sequence[Json]) -> list[Json]:
        steps = [step.as_json() | thought for step, thought in zip(session.steps, thoughts, strict=False)]
        return [*steps, {"result": told.as_json(row)}]

    def judged(self, session: Episode) -> Judged | None:
        if session.verdict is None:
            return None
        last = session.steps[-1].action
        return Judged(
            session.instance.goal,
            session.instance.parameters,
            last.goal_status if last else None,
            last.reason if last else None,
            tuple(session.moments),
            session.baseline_moments,
            session.counterfactual,
            session.instance.half.allowed_writes,
            session.said,
        )

    def _id(self, half: str) -> str:
        held_out = ["held_out"] if self.held_out else []
        redrawn = [f"redrawn{self.redrawn}"] if self.redrawn else []
        return self.id_of(self.task, half, rest=(self.scenario or "own", *held_out, *redrawn))


def read_setup(values: Mapping[str, Any], where: str) -> EpisodeSetup:
    """A setup from its JSON form. Raises UserError: it is not one; the message says what is wrong where."""
    return checked(EpisodeSetup, values, lambda steps: (where, dotted(steps)))


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """What the result at the end of an episode's trace tells besides its row."""

    goal: str
    """What the driver said."""
    verdict: Verdict | None
    timeline: tuple[TimelineEntry, ...]
    path: tuple[Sample, ...]
    """The drive, once per second, from departure to the end of the aftermath."""
    violations: tuple[Violation, ...] = ()
    """Traffic law violations from departure to the end of the aftermath; seconds since the hand-over."""
    breaches: tuple[Breach, ...] = ()
    """What the agent did against the house rules, told or not."""
    without: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    """Assumptions where the scenario says nothing, e.g. that there is no GPS."""
    estimates: tuple[PositionEstimate, ...] = ()
    """The agent's position estimates while GPS was out."""
    load: DriverLoad | None = None
    """Visual and manual load on the driver while the car moved."""

    def as_json(self, row: TrialRow) -> Json:
        """The result as a JSON object, with the fields of the row that it repeats; ``row.from_json`` reads it
        back."""
        of_the_row = as_json(row)
        told = asdict(self) | {"verdict": self.verdict and self.verdict.as_json()}
        return {name: of_the_row[name] for name in IN_RESULT} | told
