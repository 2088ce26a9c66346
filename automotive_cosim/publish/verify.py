"""Checks an evaluation or a bundle: is it complete and consistent, and can its drives be reproduced.

Nothing here trusts what a file says about itself: rows are compared with the plan and the catalogue, steps with the
stored moments, verdicts with new ones from these moments, and a sample of the drives with replays.
"""

from __future__ import annotations

import filecmp
import json
import tempfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, closing
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path

import numpy as np

from automotive_cosim import __version__
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import CosimError, UserError
from automotive_cosim.publish import archive
from automotive_cosim.publish.contents import NAME, Contents, counts, file_sha256, read_contents
from automotive_cosim.publish.episodes import check_trial
from automotive_cosim.publish.problems import ROWS, Problem, differences
from automotive_cosim.publish.replays import replay
from automotive_cosim.run.coverage import Coverage, coverage
from automotive_cosim.run.jobs import TrialJob
from automotive_cosim.run.moments import judged_file
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.row import as_json
from automotive_cosim.run.rows import read_trials
from automotive_cosim.run.store import read_evaluation, trace_file
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.run.versions import ran_with
from automotive_cosim.traffic.fork import Simulations

MANIFEST = "manifest.json"
PLAN_ON_TRUST = frozenset({"models", "everywhere", "limits", "spare_traffic"})
"""Fields of a plan that may not show in its episodes: models that no agent uses, limits that none reached, ..."""
STARTS_ON_TRUST = frozenset({"started", "platform", "git", "versions"})
"""Fields of a start that nothing else records, except the version of the suite."""
UNKNOWN = (
    "whether the named agent and model gave these actions: a drive shows what was done, but not by whom",
    "whether these are the first attempts: evaluations with worse results may have been discarded",
    "thoughts, prompts, answers, token counts, costs and wall times",
    "when, where and with which versions it ran, and limits that no episode reached",
    "whether infrastructure errors were genuine; each rate counts them as no success, and says how many there were",
)
"""Facts that no check can establish."""
UNKNOWN_WITHOUT_REPLAY = (
    "for drives that were not replayed: whether the traffic was SUMO's, the baseline run, the counterfactual, the "
    "cockpit's answers, and what is measured after the end (speed-limit compliance, time to collision, harm, path, "
    "violations)"
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
    workers: int = 1,
    tell: Callable[[int, int], None] = lambda done, planned: None,
) -> Verified:
    """Checks an evaluation's folder or a bundle; nothing is written.

    Args:
        path: of the folder or the bundle.
        replays: how many judged episodes to drive again.
        seed: draws them; the author of the evaluation must not know it, or could leave these drives unforged.
        workers: processes that judge.
        tell: called with the number of episodes judged so far and of all.

    Raises:
        UserError: it is neither, or it cannot be read.
    """
    with ExitStack() as ends:
        bundle = None if path.is_dir() else path
        folder = path if bundle is None else ends.enter_context(archive.unpacked(bundle))
        try:
            return _verified(folder, bundle, replays, seed, workers, tell)
        except (LookupError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise UserError(f"{path} is incomplete or malformed: {error!r:.200}") from error


def _verified(
    folder: Path, bundle: Path | None, replays: int, seed: int, workers: int, tell: Callable[[int, int], None]
) -> Verified:
    contents = None if bundle is None else read_contents(folder)
    problems = [] if contents is None else hash_problems(folder, contents)
    problems += [] if bundle is None else _archive_problems(folder, bundle)
    manifest, rows = read_evaluation(folder), read_trials(folder)
    found = coverage(manifest, rows)
    jobs = {job.id: job for job in make_plan(manifest["plan"]).jobs()}
    problems += _manifest_problems(manifest, jobs)
    problems += _line_problems(folder, rows, strict=contents is not None)
    problems += [Problem(ROWS, name, "is not a trial of the plan") for name in rows if name not in jobs]
    problems += _file_problems(folder, rows)
    if contents is not None:
        problems += [] if "episodes" in manifest else [Problem(MANIFEST, "episodes", "is missing")]
        problems += _count_problems(contents, manifest, found, rows)
    planned = {name: row for name, row in rows.items() if name in jobs}
    problems += _episode_problems(folder, jobs, planned, workers, tell)
    drawn = _sample(planned, replays, seed)
    again = [each for name in drawn for each in _replayed(folder, jobs[name], rows[name])] if drawn else []
    facts = [
        *([f"{counted(len(contents.files), 'file')}, sha256 of {NAME} {contents.sha256}"] if contents else []),
        str(found),
        f"{counted(sum(row.outcome is not None for row in planned.values()), 'verdict')} recomputed",
        f"{counted(len(drawn), 'drive')} replayed" + (f", drawn with seed {seed}" if drawn else ""),
        *(f"  {name}" for name in drawn),
        *_versions(manifest),
    ]
    unknown = [*UNKNOWN]
    if len(drawn) < sum(row.outcome is not None for row in planned.values()):
        unknown.append(UNKNOWN_WITHOUT_REPLAY)
    if contents is None:
        unknown.append(UNKNOWN_WITHOUT_HASHES)
    return Verified(found, tuple(facts), (*problems, *again), tuple(unknown))


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
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-bundle-") as name:
        again = Path(name) / bundle.name
        archive.pack(folder, again)
        if not filecmp.cmp(again, bundle, shallow=False):
            yield Problem(bundle.name, "", "is not, to the byte, the archive that `bundle` makes of its files")


def _manifest_problems(manifest: Json, jobs: Mapping[str, TrialJob]) -> Iterator[Problem]:
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
        if start.keys() != {"started", "versions", "platform", "git"}:
            yield Problem(MANIFEST, f"starts[{number}]", "lacks a field or has an unknown one")
            return
        yield from differences(
            MANIFEST, f"starts[{number}]", start, starts[0], ("versions", "git"), "the first start"
        )
        try:
            datetime.fromisoformat(start["started"])
        except (TypeError, ValueError):
            yield Problem(MANIFEST, f"starts[{number}].started", "is not a time")
    if any(before["started"] > after["started"] for before, after in pairwise(starts)):
        yield Problem(MANIFEST, "starts", "are not in order")


def _line_problems(folder: Path, rows: Mapping[str, TrialRow], *, strict: bool) -> Iterator[Problem]:
    """Lines with unknown fields; in a bundle, also lines that are there twice or not in their only valid form."""
    known = {"untouched_drive", *(name for row in rows.values() for name in as_json(row))}
    texts = (folder / ROWS).read_text(encoding="utf-8").splitlines() if (folder / ROWS).is_file() else []
    names: list[str] = []
    for number, text in enumerate(texts, start=1):
        line = json.loads(text)
        names.append(line["id"])
        for name in line.keys() - known:
            yield Problem(ROWS, f"line {number} {name}", "is not a field of a row")
        if strict and text != json.dumps(as_json(rows[line["id"]]), ensure_ascii=False):
            yield Problem(ROWS, f"line {number}", "is there twice, or not in the form in which `bundle` writes it")
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


def _episode_problems(
    folder: Path,
    jobs: Mapping[str, TrialJob],
    rows: Mapping[str, TrialRow],
    workers: int,
    tell: Callable[[int, int], None],
) -> list[Problem]:
    names = sorted(rows)
    found: list[Problem] = []
    check, theirs, mine = (
        partial(check_trial, folder),
        [jobs[name] for name in names],
        [rows[name] for name in names],
    )
    with ExitStack() as ends:
        checked: Iterator[tuple[Problem, ...]] = map(check, theirs, mine)
        if workers > 1:
            checked = ends.enter_context(ProcessPoolExecutor(workers)).map(check, theirs, mine, chunksize=8)
        for number, problems in enumerate(checked, start=1):
            found += problems
            tell(number, len(names))
    return found


def _sample(rows: Mapping[str, TrialRow], count: int, seed: int) -> list[str]:
    """Judged episodes, drawn with this seed."""
    names = sorted(name for name, row in rows.items() if row.outcome is not None)
    drawn = np.random.default_rng(seed).permutation(len(names))[:count]
    return [names[number] for number in sorted(drawn)]


def _replayed(folder: Path, job: TrialJob, row: TrialRow) -> list[Problem]:
    try:
        with closing(Simulations()) as simulations:
            return list(replay(folder, job, row, simulations))
    except CosimError as error:
        return [Problem(f"traces/{row.id}", "", f"cannot be replayed: {error}")]


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
