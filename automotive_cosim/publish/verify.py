"""Checks an evaluation or a bundle: is it complete and consistent, and can its drives be reproduced.

Nothing here trusts what a file says about itself: rows are compared with the plan and the catalogue, steps with the
stored moments, verdicts with new ones from these moments, and a sample of the drives with replays.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from importlib.metadata import version
from itertools import pairwise, zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from automotive_cosim import __version__
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import CosimError, NoRoomError, UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import file_sha256
from automotive_cosim.formats.limited import LimitedProcesses
from automotive_cosim.publish import archive
from automotive_cosim.publish.contents import NAME, Contents, counts, read_contents
from automotive_cosim.publish.episodes import check_trial
from automotive_cosim.publish.problems import ROWS, Problem, differences
from automotive_cosim.publish.replays import Replayed, replay, replay_fleet
from automotive_cosim.run.coverage import Coverage, coverage
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.hidden import COMMITTED, commitment
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.moments import judged_file
from automotive_cosim.run.plan import Plan, make_plan
from automotive_cosim.run.rows import TrialRow, read_trials
from automotive_cosim.run.settings import HIDDEN
from automotive_cosim.run.store import read_evaluation, trace_file
from automotive_cosim.run.trial import TrialSetup
from automotive_cosim.run.versions import ran_with
from automotive_cosim.traffic.fork import Simulations

MANIFEST = "manifest.json"
PLAN_ON_TRUST = frozenset({"models", "everywhere", "limits", "spare_traffic", "rephrase"})
"""Fields of a plan that may not show in its episodes: models that no agent uses, limits that none reached, another
phrasing of repeats where there is one run of each, ..."""
STARTS_ON_TRUST = frozenset({"started", "platform", "git", "versions", "own_code", "own_scenarios"})
"""Fields of a start that nothing else records, except the version of the package."""
UNKNOWN = (
    "whether the named agent and model gave these actions: a drive shows what was done, but not by whom",
    "whether these are the first attempts: evaluations with worse results may have been discarded",
    "whether a model gave the answers on record and how many tokens they had; costs and wall times",
    "when, where and with which versions it ran, and limits that no episode reached",
    "whether infrastructure errors were genuine; each rate counts them as no success, and says how many there were",
)
"""Facts that no check can establish."""
UNKNOWN_WITHOUT_REPLAY = (
    "for drives that were not replayed: whether the traffic was SUMO's, the baseline run, the counterfactual, the "
    "cockpit's answers, prompts and thoughts, and what is measured after the end (speed-limit compliance, time to "
    "collision, harm, path, violations)"
)
UNKNOWN_WITHOUT_HASHES = "whether files were changed afterwards: a folder has no hashes, but a bundle has"


@dataclass(frozen=True, slots=True)
class Verified:
    """The outcome of a check."""

    coverage: Coverage
    facts: tuple[str, ...]
    """What was checked, one line each."""
    problems: tuple[Problem, ...]
    unknown: tuple[str, ...]
    """What cannot be known from it."""


def verify(
    path: Path,
    *,
    replays: int = 0,
    seed: int = 0,
    key: bytes | None = None,
    workers: int = 1,
    tell: Callable[[int, int], None] = lambda done, planned: None,
) -> Verified:
    """Checks an evaluation's folder or a bundle; nothing is written.

    Args:
        path: of the folder or the bundle.
        replays: how many judged episodes to drive again.
        seed: draws them; the author of the evaluation must not know it, or could leave these drives unforged.
        key: what the trials were drawn from, if they are of the hidden split.
        tell: called with the number of episodes judged so far and of all.

    Raises UserError: it is neither, or it cannot be read."""
    with ExitStack() as ends:
        processes = ends.enter_context(LimitedProcesses(path, workers))
        bundle, folder = None, path
        if not path.is_dir():
            bundle = path
            folder = Path(ends.enter_context(tempfile.TemporaryDirectory(prefix="automotive-cosim-bundle-")))
            processes.call(archive.unpack, bundle, folder)
        read = processes.call(_read, folder, bundle, key)
        names = sorted(read.rows)
        jobs, rows = [read.jobs[name] for name in names], [read.rows[name] for name in names]
        problems = [*read.problems]
        for number, found in enumerate(processes.map(partial(check_trial, folder), jobs, rows), start=1):
            problems += found
            tell(number, len(names))
        groups = _sample(read.jobs, read.rows, replays, seed)
        again = [_replayed(folder, group, read.rows) for group in groups]
        drawn = [job.id for group in groups for job in group if read.rows[job.id].outcome is not None]
        problems += [problem for each in again for problem in each.problems]
    judged = sum(row.outcome is not None for row in read.rows.values())
    contents = read.contents
    facts = [
        *([f"{counted(len(contents.files), 'file')}, sha256 of {NAME} {contents.sha256}"] if contents else []),
        str(read.coverage),
        f"{counted(judged, 'verdict')} recomputed",
        f"{counted(len(drawn), 'drive')} replayed" + (f", drawn with seed {seed}" if drawn else ""),
        *_asked(again),
        *(f"  {name}" for name in drawn),
        *read.versions,
    ]
    unknown = [*UNKNOWN]
    if len(drawn) < judged:
        unknown.append(UNKNOWN_WITHOUT_REPLAY)
    if contents is None:
        unknown.append(UNKNOWN_WITHOUT_HASHES)
    return Verified(read.coverage, tuple(facts), tuple(problems), tuple(unknown))


@dataclass(frozen=True, slots=True)
class _Read:
    """What the files that list the episodes say, and what is wrong with it."""

    contents: Contents | None
    coverage: Coverage
    jobs: Mapping[str, TrialSetup]
    """Those with a row."""
    rows: Mapping[str, TrialRow]
    """Those that the plan has."""
    versions: tuple[str, ...]
    problems: tuple[Problem, ...]


def _read(folder: Path, bundle: Path | None, key: bytes | None = None) -> _Read:
    contents = None if bundle is None else read_contents(folder)
    problems = [] if contents is None else hash_problems(folder, contents)
    problems += [] if bundle is None else _archive_problems(folder, bundle)
    manifest, rows = read_evaluation(folder), read_trials(folder)
    found = coverage(manifest, rows)
    plan = make_plan(manifest["plan"])
    jobs = plan.trials_by_id()
    problems += _manifest_problems(manifest, jobs)
    problems += _line_problems(folder, rows, strict=contents is not None)
    problems += [Problem(ROWS, name, "is not in the plan") for name in rows if name not in jobs]
    problems += _file_problems(folder, rows)
    if contents is not None:
        problems += [] if "episodes" in manifest else [Problem(MANIFEST, "episodes", "is missing")]
        problems += _count_problems(contents, manifest, found, rows)
    planned = {name: row for name, row in rows.items() if name in jobs}
    known = {name: jobs[name] for name in planned}
    return _Read(contents, found, known, planned, (*_versions(manifest), *_drawn(plan, key)), tuple(problems))


# --- the parts ------------------------------------------------------------------------------------------------


def hash_problems(folder: Path, contents: Contents) -> list[Problem]:
    """The files of an unpacked bundle whose hash differs, that are missing, or that have no hash."""
    present = set(archive.members(folder)) - {NAME}
    found = []
    for name in sorted(present | set(contents.files)):
        if name not in present:
            found.append(Problem(name, "", "is missing"))
        elif name not in contents.files:
            found.append(Problem(name, "", f"is not in {NAME}"))
        elif file_sha256(folder / name) != contents.files[name]:
            found.append(Problem(name, "", f"has a different hash from that in {NAME}: it was changed"))
    if (folder / NAME).read_text(encoding="utf-8") != contents.text():
        found.append(Problem(NAME, "", "is not in its only valid form"))
    return found


def _archive_problems(folder: Path, bundle: Path) -> Iterator[Problem]:
    with tempfile.TemporaryFile() as again, archive.content(bundle) as file:
        archive.lay_out(folder, again)
        again.seek(0)
        pieces = (iter(partial(each.read, bounds.CHUNK_BYTES), b"") for each in (again, file))
        if any(one != other for one, other in zip_longest(*pieces)):
            yield Problem(
                bundle.name, "", "is not, to the byte, the archive that `publish bundle` makes of its files"
            )


def _manifest_problems(manifest: Json, jobs: Mapping[str, TrialSetup]) -> Iterator[Problem]:
    plan, starts = manifest["plan"], manifest.get("starts") or []
    for name in manifest.keys() - {"format", "plan", "episodes", "starts"}:
        yield Problem(MANIFEST, name, "is not a field of a manifest")
    yield from differences(
        MANIFEST, "plan", plan, make_plan(plan).as_json(), {**plan, **make_plan(plan).as_json()}, "reading it"
    )
    if manifest.get("episodes", len(jobs)) != len(jobs):
        yield Problem(MANIFEST, "episodes", f"is {manifest['episodes']}, but the plan has {len(jobs)}")
    if not starts:
        yield Problem(MANIFEST, "starts", "is empty")
    for number, start in enumerate(starts):
        if start.keys() - {"own_code", "own_scenarios"} != {"started", "versions", "platform", "git"}:
            yield Problem(MANIFEST, f"starts[{number}]", "lacks a field or has an unknown one")
            return
        yield from differences(
            MANIFEST, f"starts[{number}]", start, starts[0], ("versions", "git"), "the first start"
        )
        code = start.get("own_code", {})  # not in bundles of 0.2
        if not isinstance(code, dict) or not code.keys() <= {*plan["agents"]}:
            yield Problem(MANIFEST, f"starts[{number}].own_code", "names an agent that the plan does not have")
        own = start.get("own_scenarios", {})  # not in earlier bundles
        if not isinstance(own, dict) or not own.keys() <= {*plan["scenarios"]}:
            yield Problem(
                MANIFEST, f"starts[{number}].own_scenarios", "names a scenario that the plan does not have"
            )
        try:
            datetime.fromisoformat(start["started"])
        except (TypeError, ValueError):
            yield Problem(MANIFEST, f"starts[{number}].started", "is not a time")
    if any(before["started"] > after["started"] for before, after in pairwise(starts)):
        yield Problem(MANIFEST, "starts", "are not in order")


def _as_of(today: Any, found: Any) -> Any:
    """A row, or a part of one, without what its line had no key for when it was written."""
    if isinstance(today, dict) and isinstance(found, dict):
        return {name: value for name, value in today.items() if name in found}
    return today


def _line_problems(folder: Path, rows: Mapping[str, TrialRow], *, strict: bool) -> Iterator[Problem]:
    """Lines with unknown fields or about an episode that has a verdict already; in a bundle, also any second line
    of an episode, and lines that are not in their only valid form."""
    known = {name for row in rows.values() for name in as_json(row)}
    texts = (folder / ROWS).read_text(encoding="utf-8").splitlines() if (folder / ROWS).is_file() else []
    names: list[str] = []
    final: set[str] = set()
    for number, text in enumerate(texts, start=1):
        line = json.loads(text)
        names.append(line["id"])
        if line["id"] in final:
            yield Problem(ROWS, f"line {number}", f"is about {line['id']} again, which was judged before")
        if strict or line.get("success") is not None:  # an episode that ended in an error may have been run again
            final.add(line["id"])
        for name in line.keys() - known:
            yield Problem(ROWS, f"line {number} {name}", "is not a field of a row")
        row = _as_of(as_json(rows[line["id"]]), line)
        written = {name: _as_of(value, line[name]) for name, value in row.items()}
        if strict and text != json.dumps(written, ensure_ascii=False):
            yield Problem(ROWS, f"line {number}", "is not in the form in which `publish bundle` writes it")
    if strict and names != sorted(names):
        yield Problem(ROWS, "", "is not sorted by id")


def _file_problems(folder: Path, rows: Mapping[str, TrialRow]) -> Iterator[Problem]:
    """Files in ``traces`` that belong to no judged episode."""
    known = {path.name for name in rows for path in (trace_file(folder, name), judged_file(folder, name))}
    for path in sorted((folder / "traces").glob("*")):
        if path.name not in known:
            yield Problem(f"traces/{path.name}", "", "belongs to no episode")


def _count_problems(
    contents: Contents, manifest: Json, found: Coverage, rows: Mapping[str, TrialRow]
) -> Iterator[Problem]:
    told = json.loads(contents.text())
    whole = json.loads(
        Contents(
            contents.format,
            ran_with(manifest),
            counts(found, sum(row.has_succeeded for row in rows.values())),
            contents.files,
        ).text()
    )
    yield from differences(NAME, "", told, whole, ("suite", "counts"), f"{MANIFEST} and {ROWS}")


def _sample(
    jobs: Mapping[str, TrialSetup], rows: Mapping[str, TrialRow], count: int, seed: int
) -> list[Sequence[TrialSetup]]:
    """Judged episodes, drawn with this seed; of fleets all cars together, if they left what it takes."""
    groups: dict[str, Sequence[TrialSetup]] = {}
    for job in jobs.values():
        cars = job.fleet if isinstance(job, DriveSetup) and job.fleet else (job,)
        has_gone = (rows[car.id].error_kind == NoRoomError.__name__ for car in cars[1:] if car.id in rows)
        ended = [car.id in rows and rows[car.id].outcome is not None for car in cars]
        if sum(ended) + sum(has_gone) == len(cars):
            groups[cars[0].id] = cars
    names = sorted(groups)
    drawn = np.random.default_rng(seed).permutation(len(names))[:count]
    return [groups[names[number]] for number in sorted(drawn)]


def _replayed(folder: Path, jobs: Sequence[TrialSetup], rows: Mapping[str, TrialRow]) -> Replayed:
    """What comes of an episode, or of all cars of a fleet."""
    first, cars = jobs[0], [job for job in jobs if isinstance(job, DriveSetup) and job.fleet]
    try:
        with closing(Simulations()) as simulations:
            if cars:
                return replay_fleet(folder, cars, rows, simulations)
            return replay(folder, first, rows[first.id], simulations)
    except CosimError as error:
        return Replayed((Problem(f"traces/{first.id}", "", f"cannot be replayed: {error}"),), None)


def _asked(again: Sequence[Replayed]) -> Iterator[str]:
    """How many agents put the recorded questions to their models again, and acted on the recorded answers."""
    same, otherwise = (sum(each.has_asked is so for each in again) for so in (True, False))
    if same:
        yield f"  {counted(same, 'drive')} with the recorded questions and answers of a model"
    if otherwise:
        yield (
            f"  {counted(otherwise, 'drive')} by the actions alone: this version asks the model otherwise, so "
            "prompts and thoughts were not compared"
        )


def _drawn(plan: Plan, key: bytes | None) -> list[str]:
    """What was published before, to be compared.

    Raises UserError: there is a key, and the trials were drawn from none."""
    if key is None:
        return []
    if plan.split != HIDDEN:
        raise UserError(f"its runs were drawn from no key: the split is {plan.split}; leave --key out")
    return [f"{name} {digest}" for name, digest in zip(COMMITTED, commitment(key, plan), strict=True)]


def _versions(manifest: Json) -> list[str]:
    start = manifest["starts"][0]
    versions = start["versions"]
    ran = f"automotive-cosim {versions['automotive-cosim']}, libsumo {versions['libsumo']}"
    told = [f"run with {ran}; checked with automotive-cosim {__version__}, libsumo {version('libsumo')}"]
    git = start["git"]
    if git is not None:
        changed = " with uncommitted changes" if git["is_changed"] else ""
        told.append(f"run from commit {git['commit']}{changed}")
    return told
