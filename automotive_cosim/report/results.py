"""The results of an evaluation, read back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from automotive_cosim.agents import NOT_RANKED
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import NEEDS_PICTURE, NEEDS_ROAD, Interface, See
from automotive_cosim.contracts.plain import counted, model_and_options
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.run.coverage import Coverage, coverage
from automotive_cosim.run.job_row import columns
from automotive_cosim.run.plan import languages_in_words, make_plan
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, TrialRow, read_trials
from automotive_cosim.run.store import read_evaluation
from automotive_cosim.run.versions import ran_with

if TYPE_CHECKING:
    import pandas as pd

STAND_IN = "rules (stand-in, no language model)"


@dataclass(frozen=True, slots=True, order=True)
class Contestant:
    """What is compared: an agent on a model, what it is given, and at what speed."""

    agent: str
    model: str
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen

    @property
    def base_model(self) -> str:
        """The model without its options, with ``rules`` labelled as a stand-in."""
        name, _ = model_and_options(self.model)
        return {"rules": STAND_IN}.get(name, name)

    @property
    def method(self) -> str:
        """The agent, with references and negative controls labelled, and what its model is told."""
        _, options = model_and_options(self.model)
        return ", ".join((self._agent, *options))

    @property
    def _agent(self) -> str:
        about = NOT_RANKED.get(self.agent)
        return f"{self.agent} ({about})" if about else self.agent

    @property
    def label(self) -> str:
        """Agent, model, conditions and speed on one short line."""
        name, options = model_and_options(self.model)
        model = {"rules": "rules stand-in", "none": ""}.get(name, name)
        return ", ".join(part for part in (self._agent, model, *options, *self.conditions.labels) if part)

    def under(self, name: str, value: Any) -> Contestant:
        """The same with another value of a condition."""
        return replace(self, conditions=replace(self.conditions, **{name: value}))


@dataclass(frozen=True, slots=True)
class Results:
    """An evaluation's manifest and its trials in the order of their ids."""

    folder: Path
    manifest: Json
    rows: tuple[EpisodeRow, ...]
    """Those of tasks."""
    coverage: Coverage
    drives: tuple[DriveTrialRow, ...] = ()

    @property
    def version(self) -> str:
        """The version of the package that ran it."""
        return ran_with(self.manifest)

    @property
    def unspoken(self) -> str:
        """How many of the tasks were left out for want of phrasings, as a sentence; empty if none was."""
        try:
            plan = make_plan(self.manifest["plan"])
            missing = len(plan.unspoken())
        except UserError:  # the catalogue has changed since
            return ""
        were = f"{counted(missing, 'task')} {'was' if missing == 1 else 'were'}"
        return f"{were} left out: no phrasings in {languages_in_words(plan.languages)}." if missing else ""

    @property
    def not_run(self) -> tuple[EpisodeRow, ...]:
        """The planned episodes without a row, with what is known about an episode before it runs."""
        return tuple(row for row in self.coverage.not_run if isinstance(row, EpisodeRow))

    @property
    def drives_not_run(self) -> tuple[DriveTrialRow, ...]:
        """The planned drives without a row."""
        return tuple(row for row in self.coverage.not_run if isinstance(row, DriveTrialRow))

    @property
    def contestants(self) -> tuple[Contestant, ...]:
        """The contestants, with or without episodes yet; references and negative controls come last."""
        found = {contestant(row) for row in (*self.rows, *self.not_run)}
        return tuple(sorted(found, key=lambda each: (each.agent in NOT_RANKED, each)))

    @property
    def beyond_the_list(self) -> tuple[str, ...]:
        """Tasks not given to contestants that see no pictures, or not the road, because they need that."""
        plan = self.manifest["plan"]
        sees, interfaces = set(plan.get("see", ())), plan.get("interface", ())
        hidden = {NEEDS_ROAD} if sees - {See.CAMERA} else set[str]()
        if {See.TREE, See.NOTHING} & sees or Interface.FUNCTIONS in interfaces:
            hidden.add(NEEDS_PICTURE)
        given = (row for row in (*self.rows, *self.not_run) if hidden & set(row.tags))
        return tuple(sorted({row.task for row in given}))

    def of(self, each: Contestant) -> tuple[EpisodeRow, ...]:
        return tuple(row for row in self.rows if contestant(row) == each)

    def planned_of(self, each: Contestant) -> tuple[EpisodeRow, ...]:
        """The same, including episodes that have not been run."""
        return (*self.of(each), *(row for row in self.not_run if contestant(row) == each))

    def shared(self) -> Results:
        """The same with only the instances that all contestants have run, on which they can be compared.

        An instance with an episode that ended in an error stays, so that no contestant can void another's episodes.
        """
        return replace(self, rows=tuple(row for row in self.rows if row.id in self.coverage.shared))


def contestant(row: TrialRow) -> Contestant:
    """The contestant that a trial belongs to."""
    return Contestant(row.agent, row.model, row.conditions)


def standings(results: Results) -> list[str]:
    """A line per contestant: what it won out of what was run, in all and in held-out phrasings, and what was
    not judged."""
    return [f"{each.label}: {_won(results.planned_of(each))}" for each in results.contestants]


def _won(rows: Sequence[EpisodeRow]) -> str:
    held_out = [row for row in rows if row.held_out]
    told = _count(rows)
    if 0 < len(held_out) < len(rows):
        return f"{told}; in held-out phrasings: {_count(held_out)}"
    return f"{told}, all in held-out phrasings" if held_out else told


def _count(rows: Sequence[EpisodeRow]) -> str:
    counts = []
    for unit, each in (("episode", rows), ("pair", [pair for pair, _ in pairs(rows)])):
        if each:
            beside = not_judged(sum(row.success is None and row.has_run for row in each), _waiting(each))
            won = sum(row.has_succeeded for row in each)
            counts.append(
                f"{won} of {counted(len(each) - _waiting(each), unit)}" + (f" ({beside})" if beside else "")
            )
    return ", ".join(counts)


def _waiting(rows: Iterable[EpisodeRow]) -> int:
    return sum(not row.has_run for row in rows)


def not_judged(errors: int, not_run: int) -> str:
    """For example ``1 error, 3 not run``; empty if everything was judged."""
    return ", ".join([counted(errors, "error")] * (errors > 0) + [f"{not_run:,} not run"] * (not_run > 0))


def read_results(folder: Path) -> Results:
    """Reads an evaluation's folder, a running one too.

    Raises UserError: it is not an evaluation's folder, or is damaged."""
    manifest = read_evaluation(folder)
    rows = read_trials(folder)
    ordered = [rows[name] for name in sorted(rows)]
    return Results(
        folder,
        manifest,
        tuple(row for row in ordered if isinstance(row, EpisodeRow)),
        coverage(manifest, rows),
        tuple(row for row in ordered if isinstance(row, DriveTrialRow)),
    )


def load_results(folder: Path | str) -> pd.DataFrame:
    """The trials as a data frame, one row per episode or drive by its id; ``part_goal`` and so on are a verdict's
    parts, ``drive_overspeed_m``, ``baseline_drive_overspeed_m`` and so on the figures of the drives.

    An episode that ended in an error has ``success`` missing.

    Raises:
        UserError: it is not an evaluation's folder, or is damaged.
        SetupError: pandas is not installed."""
    try:
        import pandas as pd
    except ImportError as error:
        raise SetupError(f"load_results needs pandas: {install_hint('reports')}") from error
    found = read_results(Path(folder))
    frame = pd.DataFrame([columns(row) for row in (*found.rows, *found.drives)]).set_index("id")
    judged = [name for name in frame.columns if name == "success" or name.startswith("part_")]
    return frame.astype(dict.fromkeys(judged, "boolean"))


def pair_instance(row: EpisodeRow) -> tuple[object, ...]:
    """The same for a pair, whichever half represents it."""
    return row.task, row.seed, row.repeat


def pairs(rows: Iterable[EpisodeRow]) -> list[tuple[EpisodeRow, Sequence[EpisodeRow]]]:
    """Each pair as one episode-like row, which succeeds if both halves do, with its two halves.

    If one half has not been run, the pair has not been run: those whose first half failed would else be lost, and
    those whose first half succeeded not counted. If one ended in an error, the pair is an error, unless the other
    half failed."""
    found: dict[str, list[EpisodeRow]] = {}
    for row in rows:
        if row.pair:
            found.setdefault(row.pair, []).append(row)
    joined: list[tuple[EpisodeRow, Sequence[EpisodeRow]]] = []
    for halves in found.values():
        if len(halves) == 2:
            outcomes = [half.success for half in halves]
            waiting = [half for half in halves if not half.has_run]
            success = None if waiting else False if False in outcomes else None if None in outcomes else True
            shown = max(halves, key=lambda half: half.error is not None) if success is None else halves[0]
            shown = waiting[0] if waiting else shown
            joined.append((replace(shown, success=success), halves))
    return joined
