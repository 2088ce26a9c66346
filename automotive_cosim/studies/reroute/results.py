"""Reads the results of a study: its drives, its decisions, and the policies' choices."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.run.job_row import columns
from automotive_cosim.studies.content import StudyContent
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.reroute.policies import Policy, drawn_choices, hindsight, parse_policy
from automotive_cosim.studies.reroute.rows import (
    NOBODY,
    Decision,
    DecisionPoint,
    News,
    PolicyChoice,
    Totals,
    TripRow,
)

NOISE = 0.95
"""The noise floor is this quantile of the differences caused by chance alone."""


@dataclass(frozen=True)
class Study(StudyContent[StudyPlan, TripRow]):
    """The content of a rerouting study's folder, with a row per drive."""

    plan_type = StudyPlan
    row_type = TripRow
    line_is = "decision, policy, age of the news and compliance"

    def lines(self) -> Iterator[Json]:
        """The choices of every policy at every decision."""
        return (columns(choice) for choice in self.all_choices)

    @property
    def planned(self) -> int:
        """Number of drives in the plan; if it may stop early (``half_width_s``), those of the seeds begun."""
        begun = {row.seed for row in self.rows}
        return sum(self.plan.half_width_s is None or job.seed in begun for job in self.plan.jobs())

    @property
    def decisions(self) -> tuple[DecisionPoint, ...]:
        """Decisions that count, each with its drive."""
        return tuple(point for point in all_decisions(self.rows) if not point.decision.excluded)

    @property
    def excluded(self) -> Counter[tuple[str, str]]:
        """Numbers of excluded drives and decisions, by kind and reason."""
        found: Counter[tuple[str, str]] = Counter()
        for row in self.rows:
            if row.excluded:
                found["drive", row.excluded] += 1
            for decision in row.decisions:
                if decision.excluded:
                    found["decision", decision.excluded] += 1
        return found

    @property
    def choices(self) -> tuple[PolicyChoice, ...]:
        """The choice of every policy at every decision, with news of every age, at the first compliance."""
        return self.at_compliance(self.plan.compliance[0])

    @property
    def all_choices(self) -> tuple[PolicyChoice, ...]:
        """The same at every compliance."""
        return tuple(each for level in self.plan.compliance for each in self.at_compliance(level))

    def at_compliance(self, compliance: float) -> tuple[PolicyChoice, ...]:
        """The same if the driver follows the advice with that probability."""
        return tuple(choices(self.rows, self.plan.policies, compliance))

    def noise(self) -> Noise:
        """The effect of chance."""
        return noise(point.decision for point in self.decisions)


@dataclass(frozen=True, slots=True)
class Noise:
    """The noise floor: differences between two futures of the same choice, caused by chance alone."""

    placebos: int
    time_s: float
    """``NOISE`` of them change the ego's travel time by no more than this. Gains of single draws within it
    are ties."""
    others_s: float
    """The same for the sum over the others."""

    @property
    def is_known(self) -> bool:
        """Whether any placebo moved anything; if none did, nothing tells a gain from chance."""
        return self.placebos > 0 and (self.time_s > 0 or self.others_s > 0)


def all_decisions(rows: Iterable[TripRow]) -> Iterator[DecisionPoint]:
    """The decisions of every drive, including those that do not count."""
    for row in rows:
        for number, decision in enumerate(row.decisions):
            yield DecisionPoint(f"{row.id}-{number}", row, decision)


def choices(rows: Iterable[TripRow], policies: Sequence[str], compliance: float = 1.0) -> Iterator[PolicyChoice]:
    """The choice of each policy at each decision that counts, with news of each age, and its gain."""
    for point in all_decisions(rows):
        if not point.decision.excluded:
            yield from choices_at(point, policies, compliance)


def choices_at(point: DecisionPoint, policies: Sequence[str], compliance: float = 1.0) -> Iterator[PolicyChoice]:
    """The choice of each policy at a decision, with news of each age, and its gain."""
    for policy in map(parse_policy, policies):
        for news in point.decision.news:
            yield _choice(point, policy, news, compliance)


def _choice(point: DecisionPoint, policy: Policy, news: News, compliance: float) -> PolicyChoice:
    drive, decision = point.drive, point.decision
    numbers = drawn_choices(policy, decision, news.age_s, compliance)[: len(decision.scored)]
    complies = decision.complies(compliance)
    draws = decision.scored
    gains = [decision.gain(draw, number) for draw, number in enumerate(numbers)]
    ideal = hindsight(decision)
    regrets_s = [decision.gain(draw, ideal[draw]).time_s - gains[draw].time_s for draw in draws]
    branch, _ = Counter(numbers).most_common(1)[0]
    driven = [decision.drawn(draw, number) for draw, number in enumerate(numbers)]
    others = [NOBODY if each is None else each.others for each in driven]
    hits = [_is_same(decision, *each) for each in zip(numbers, ideal, strict=False)]
    signs = [_sign(decision, draw, number) for draw, number in enumerate(numbers)] if decision.draws > 1 else []
    assert drive.stay is not None, "it has a decision"
    return PolicyChoice(
        **point.line,
        time_index=round(decision.time_index, 3),
        lost_ahead_s=_lost_ahead_s(point),
        age_s=news.age_s,
        policy=policy.text,
        compliance=compliance,
        complies=complies,
        # an agent's branch, in which it may do anything, need not have left the route
        rerouted=complies and policy.agent in decision.agents_rerouted if policy.agent else branch is not None,
        branch=branch,
        promised_s=None if news.promised_s is None else round(news.promised_s, 1),
        stay=drive.stay,
        gain=Totals.mean(gains),
        regret_s=round(fmean(regrets_s), 3),
        others=max(each.count for each in others),
        others_gain_s=_mean(each.gain_s for each in others),
        others_changed=_mean(each.changed for each in others),
        unfinished_stay=_mean(each.unfinished_stay for each in others),
        unfinished=_mean(each.unfinished for each in others),
        draws=decision.draws,
        gain_error_s=standard_error([decision.gain(draw, branch).time_s for draw in range(decision.draws)]),
        won=signs.count(1) / len(signs) if signs else None,
        lost=signs.count(-1) / len(signs) if signs else None,
        chose_best=_mean(hits) if signs else None,
    )


def _lost_ahead_s(point: DecisionPoint) -> float | None:
    """The mean over the scored draws; None in rows of earlier versions."""
    drive, decision = point.drive, point.decision
    kept = [decision.replicates[draw - 1].stay.totals if draw else drive.stay for draw in decision.scored]
    lost_s = [each.lost_s for each in kept if each is not None and each.lost_s is not None]
    return round(fmean(lost_s) - decision.lost_s, 3) if lost_s and decision.lost_s is not None else None


def _sign(decision: Decision, draw: int, number: int | None) -> int:
    """1 if a draw gained time and the mean of the others did too, -1 if both lost time, else 0."""
    elsewhere_s = fmean(decision.gain(other, number).time_s for other in range(decision.draws) if other != draw)
    here_s = decision.gain(draw, number).time_s
    return int(here_s > 0 and elsewhere_s > 0) - int(here_s < 0 and elsewhere_s < 0)


def _is_same(decision: Decision, one: int | None, other: int | None) -> bool:
    """Whether two choices lead to the same future, such as that of an agent that keeps the route."""
    draws = range(decision.draws)
    return one == other or all(decision.gain(draw, one) == decision.gain(draw, other) for draw in draws)


def standard_error(values: Sequence[float]) -> float | None:
    """Standard error of the mean of independent values; None for a single one."""
    return round(stdev(values) / len(values) ** 0.5, 3) if len(values) > 1 else None


def _mean(values: Iterable[float]) -> float:
    """The mean; a whole number stays one."""
    listed = list(values)
    return listed[0] if len(listed) == 1 else round(fmean(listed), 3)


def noise(decisions: Iterable[Decision]) -> Noise:
    """Differences between futures of the same choice."""
    placebos = [unchanged for each in decisions for unchanged in each.unchanged]
    if not placebos:
        return Noise(0, 0.0, 0.0)
    times = [abs(each.gains.time_s) for each in placebos]
    others = [abs(each.others.gain_s) for each in placebos]
    return Noise(len(placebos), float(np.quantile(times, NOISE)), float(np.quantile(others, NOISE)))
