"""Whether anything comes due at a point, driven with nobody at the cockpit: cheap, since no agent is asked."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path

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
from automotive_cosim.formats.layout import DUE
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.run.plan import Plan
from automotive_cosim.safety.space import FactorChoices, FactorRange, FactorValue, SearchPoint, Space, said
from automotive_cosim.safety.trying import job_of, trial_of
from automotive_cosim.traffic.fork import Simulations

TIMES_S = (STAGE_S, 30.0, 90.0, 120.0, 150.0)
"""When something is staged, if a space with a stage does not say: what comes too suddenly at one instant, or never,
comes in time at another."""
WHAT = ("drive", "scenario", "stage")
"""The factors that decide whether something can come about at all."""
MOST_KINDS = 16
"""How many of their combinations are tried before the start."""
MOVES: tuple[tuple[str, ...], ...] = (("stage_s",), ("stage_s",), ("stage_s", "seed"))
STEP = 0.4
"""What is moved, one after the other, where nothing comes due, and by how much of its range; the traffic of another
seed must be warmed up first."""
MENDS: tuple[tuple[str, FactorValue], ...] = (
    ("ahead_m", 300.0), ("ahead_m", 800.0), ("driver", "hurried"), ("minutes", 12.0),
)  # fmt: skip
"""What is tried, one by one, where nothing comes due even so."""


def why_not(spec: DriveSpec, kinds: Collection[str], simulations: Simulations) -> str:
    """Why nothing comes due on a drive with nobody at the cockpit; empty if something does.

    It is driven up to the first deadline, without screens and observations.

    Args:
        kinds: of events; all if it is empty.
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
        path = self.folder / DUE
        try:
            found = read_json(path) if path.is_file() else {}
        except ValueError:
            found = {}
        if isinstance(found, dict):  # what is not there, or cannot be read, is tried again
            self._known = {name: why for name, why in found.items() if isinstance(why, str)}

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
            write_whole(make_folder(self.folder) / DUE, json.dumps(self._known, indent=1) + "\n")
        return self._known[name]

    def is_due(self, point: SearchPoint) -> bool:
        """Whether something comes due at a point, or nobody can tell."""
        return not self.why_not(point)

    def placed(self, point: SearchPoint) -> SearchPoint | None:
        """The point, or one with another instant and seed, at which something comes due; None if none was found."""
        return next(filter(self.is_due, self._near(point)), None)

    def check(self) -> Iterator[str]:
        """Tries what the space stages where, and says what cannot come about, how to mend it, and where how much
        comes due.

        The space's nominal point becomes one at which something is due, by place, time or seed, if there is one.

        Raises UserError: nothing comes due anywhere."""
        if not self.screens:
            yield "nothing has to be tried first: every run of this space can be judged"
            return
        nominal = self.space.nominal
        several = [each for each in self.space.factors if each.name in WHAT and isinstance(each, FactorChoices)]
        there: list[SearchPoint] = []
        tried = list(product(*(each.values for each in several)))[:MOST_KINDS]
        for values in tried:
            fixed = dict(zip((each.name for each in several), values, strict=True))
            point = {**nominal, **fixed}
            near = [*self._near(point), *self._elsewhere(point)]
            if (due := next(filter(self.is_due, near), None)) is not None:
                there.append(due)
                continue
            reasons = [self.why_not(each) for each in near]
            told = ", ".join(f"{reason} ({reasons.count(reason)})" for reason in dict.fromkeys(reasons))
            mend = next((mend for mend in MENDS if self.is_due({**point, mend[0]: mend[1]})), None)
            mended = (
                f"nor with {', '.join(said(*each) for each in MENDS)}: leave it out"
                if mend is None
                else f"with {said(*mend)} it does: set that, or leave it out"
            )
            drives = counted(len(reasons), "drive")
            yield f"{', '.join(map(str, values))}: nothing came due in {drives} without an agent: {told}; {mended}"
            self._never.append(fixed)
        if not there:
            raise UserError("nothing comes due in this space, so that it says nothing about any agent; mend it")
        changed = ", ".join(said(name, value) for name, value in there[0].items() if value != nominal[name])
        if changed:
            self.space = nominal_at(self.space, there[0])
            yield f"as written, nothing is due with everything nominal; taken as nominal: {changed}"
        of = " and ".join(each.name for each in several)
        many = f"{len(there)} of {counted(len(tried), 'choice')} of {of}"
        yield f"driven without an agent: something comes due in {many}"

    def _elsewhere(self, point: SearchPoint) -> Iterator[SearchPoint]:
        """Two points in which all is another but the traffic, and what is staged where."""
        moving = [each for each in self.space.factors if each.name not in (*WHAT, "seed", "density")]
        for step in (STEP, 2 * STEP):
            moved = {each.name: each.at((each.unit(point[each.name]) + step) % 1.0) for each in moving}
            if moved.items() - point.items():
                yield {**point, **moved}

    def _near(self, point: SearchPoint) -> list[SearchPoint]:
        """The point and those beside it, each once."""
        near = [dict(point)]
        for names in MOVES:
            moved = [self.space.factor(name) for name in names if name in point]
            last = near[-1]
            near.append(last | {each.name: each.at((each.unit(last[each.name]) + STEP) % 1.0) for each in moved})
        return [each for number, each in enumerate(near) if each not in near[:number]]


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
