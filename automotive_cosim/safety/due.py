"""Whether anything comes due at a point, driven with nobody at the cockpit: cheap, since no agent is asked."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path

import numpy as np

from automotive_cosim.contracts.plain import counted
from automotive_cosim.cosim.simulation import TICK_S
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.events import KINDS, DriveEvent, Tracker
from automotive_cosim.drives.judge import BACK, CHANCE_S, judge
from automotive_cosim.drives.settings import NOTHING, STAGE_S
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.episode.specification import ROUNDING_S
from automotive_cosim.errors import CosimError, UserError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.run.plan import Plan
from automotive_cosim.safety.space import FactorChoices, FactorRange, FactorValue, SearchPoint, Space, said
from automotive_cosim.safety.trying import job_of, trial_of
from automotive_cosim.traffic.fork import Simulations

FILE = "due.json"
"""Of a search's folder: by trial, why nothing comes due in it; empty if something does."""
TIMES_S = (STAGE_S, 30.0, 90.0, 120.0, 150.0)
"""When something is staged, if a space with a stage does not say: what comes too suddenly at one instant, or never,
comes in time at another."""
WHAT = ("drive", "scenario", "stage")
"""The factors that decide whether something can come about at all."""
TRIES, MOST_KINDS = 5, 16
"""Drives after which something is said not to come about, and how many such combinations are tried."""
STEPS = (0.4, 0.8, 0.2)
"""By how much of their ranges instant and seed are moved where nothing comes due."""
MENDS: tuple[tuple[str, FactorValue], ...] = (
    ("ahead_m", 300.0), ("ahead_m", 800.0), ("driver", "hurried"), ("density", 2.0), ("minutes", 12.0),
)  # fmt: skip
"""What is tried, one by one, where nothing comes due."""


def why_not(spec: DriveSpec, kinds: Collection[str], simulations: Simulations) -> str:
    """Why nothing comes due on a drive with nobody at the cockpit; empty if something does.

    It is driven up to the first deadline, without screens and observations.

    Args:
        spec: the drive.
        kinds: of events; all if it is empty.
        simulations: warm traffic, shared with others.
    """
    tracker = Tracker({name: KINDS[name] for name in kinds or KINDS})
    try:
        script = spec.script
        with closing(depart(script, simulations)) as world:
            drive = [world.moment]
            tracker.see(drive)
            until_s = drive[0].time_s + script.duration_s - ROUNDING_S
            while world.moment.driving.end is None and drive[-1].time_s < until_s:
                for moment in world.advance(TICK_S):
                    drive.append(moment)
                    tracker.see(drive[-BACK:])
                if any(
                    _is_due(event) for event in tracker.events if drive[-1].time_s >= (event.deadline_s or until_s)
                ):
                    return ""
    except CosimError as error:
        return f"it cannot be driven: {error}"
    real = [event for event in tracker.events if not event.lookalike]
    if any(map(_is_due, real)):
        return ""
    obliged = [event for event in real if event.obliged_s is not None and event.deadline_s is not None]
    sudden = any((event.deadline_s or 0.0) - (event.obliged_s or 0.0) < CHANCE_S for event in obliged)
    return (
        "it came too suddenly for anybody" if sudden
        else "it passed by itself" if obliged
        else "it came and asked for no act" if real
        else "it never came"
    )  # fmt: skip


def _is_due(event: DriveEvent) -> bool:
    (judged,) = judge(KINDS, [event], (), {}, lambda kind, time_s: None).events
    return judged.outcome.counts


def with_times(space: Space) -> Space:
    """The space, in which what is staged comes at several instants, if it does not say when."""
    levels = {each.name: set(each.levels) for each in space.factors}
    if "stage_s" in levels or levels.get("stage", {NOTHING}) == {NOTHING}:
        return space
    return replace(space, factors=(*space.factors, FactorChoices("stage_s", TIMES_S)))


@dataclass(slots=True)
class DueScreen:
    """Knows, or tries, whether anything comes due at a point; what was tried is kept in the search's folder."""

    space: Space
    plan: Plan
    simulations: Simulations
    folder: Path
    tried: int = 0
    """Drives since this start."""
    _known: dict[str, str] = field(default_factory=dict)
    _never: list[Mapping[str, FactorValue]] = field(default_factory=list)
    """What cannot come about where."""

    def __post_init__(self) -> None:
        """Reads what is known."""
        path = self.folder / FILE
        self._known = dict(read_json(path)) if path.is_file() else {}

    @property
    def screens(self) -> bool:
        """Whether the space has trials in which nothing is due: drives that are not judged by distances too."""
        return "drive" in self.space.nominal and self.space.rule.ttc_below_s is None

    def why_not(self, point: SearchPoint) -> str:
        """Why nothing comes due at a point; empty if something does, or if it cannot be run."""
        if not self.screens:
            return ""
        if any(fixed.items() <= point.items() for fixed in self._never):
            return "it does not come about there"
        try:
            job = job_of(self.plan, trial_of(point))
        except UserError:
            return ""
        assert isinstance(job, DriveSpec)
        name = replace(job, agent="silent", model="none").id
        if name not in self._known:
            self.tried += 1
            self._known[name] = why_not(job, self.space.rule.events, self.simulations)
            write_whole(make_folder(self.folder) / FILE, json.dumps(self._known, indent=1) + "\n")
        return self._known[name]

    def is_due(self, point: SearchPoint) -> bool:
        """Whether something comes due at a point, or nobody can tell."""
        return not self.why_not(point)

    def placed(self, point: SearchPoint) -> SearchPoint | None:
        """The point, or one with another instant and seed, at which something comes due; None if none was found."""
        others = [
            {**point, **{name: self.space.factor(name).at((self.space.factor(name).unit(point[name]) + step) % 1.0)
                         for name in ("stage_s", "seed") if name in point}}
            for step in STEPS
        ]  # fmt: skip
        return next(filter(self.is_due, [point, *others]), None)

    def check(self, seed: int) -> Iterator[str]:
        """Tries what the space stages where, and says what cannot come about, and how to mend it.

        The space's nominal point becomes one at which something is due, by another seed or time, if there is one.

        Args:
            seed: of the points at which it is tried.

        Raises:
            UserError: nothing comes due anywhere.
        """
        rng = np.random.default_rng(seed)
        several = [each for each in self.space.factors if each.name in WHAT and isinstance(each, FactorChoices)]
        combined = list(product(*(each.values for each in several)))[:MOST_KINDS] if self.screens else []
        there: list[SearchPoint] = []
        for values in combined:
            fixed = dict(zip((each.name for each in several), values, strict=True))
            points = [{**self.space.nominal, **fixed}]
            points += [
                {**self.space.at(rng.random(self.space.dimensions).tolist()), **fixed} for _ in range(TRIES - 1)
            ]
            due = next(filter(self.is_due, points), None)
            if due is not None:
                there.append(due)
            else:
                yield f"{', '.join(map(str, values))}: {self._told(points)}; {self._mended(points)}"
                self._never.append(fixed)
        if combined and not there:
            raise UserError(
                "nothing comes due anywhere in this space, so that it says nothing about any agent; mend it"
            )
        if combined and not self.is_due(self.space.nominal):
            near = next(filter(self.is_due, self._beside(there)), None)
            if near is not None:
                changed = ", ".join(
                    said(name, near[name]) for name in near if near[name] != self.space.nominal[name]
                )
                self.space = nominal_at(self.space, near)
                yield f"the nominal point has {changed}: as written, nothing is due there"

    def _told(self, points: Sequence[SearchPoint]) -> str:
        reasons = [self.why_not(point) for point in points]
        counts = {reason: reasons.count(reason) for reason in reasons}
        parts = ", ".join(f"{reason} ({count})" for reason, count in counts.items())
        return f"nothing came due in {counted(len(points), 'drive')} without an agent: {parts}"

    def _mended(self, points: Sequence[SearchPoint]) -> str:
        for name, value in MENDS:
            if any(self.is_due({**point, name: value}) for point in points[:2]):
                return f"with {said(name, value)} it does: set that, or leave it out"
        return f"nor with {', '.join(said(*mend) for mend in MENDS)}: leave it out"

    def _beside(self, there: Sequence[SearchPoint]) -> Iterator[SearchPoint]:
        """The nominal point with the place, the seed and the instant of points at which something is due."""
        for point in there[:TRIES]:
            yield {
                **self.space.nominal,
                **{name: point[name] for name in (*WHAT, "seed", "stage_s") if name in point},
            }
        yield there[0]


def nominal_at(space: Space, point: SearchPoint) -> Space:
    """The space with another nominal point."""
    return replace(
        space,
        factors=tuple(
            replace(each, nominal=round(float(point[each.name])) if each.whole else float(point[each.name]))
            if isinstance(each, FactorRange)
            else replace(each, values=tuple(dict.fromkeys((point[each.name], *each.values))))
            for each in space.factors
        ),
    )
