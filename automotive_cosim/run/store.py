"""The folder of an evaluation, written so that a kill at any moment loses at most the running episodes.

manifest.json     plan and its number of episodes, versions, state of the code, one entry per start
episodes.jsonl    one line per episode, appended and synced as it ends; of several lines of one id the last counts
traces/           <id>.jsonl.gz: one line per step and one with the whole result
pictures/         <id>/: the folders of the selected trials (``formats.layout``)
lock              held while an evaluation writes here
"""

from __future__ import annotations

import gzip
import hashlib
import json
import platform
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from datetime import datetime
from importlib.machinery import PathFinder
from io import FileIO
from pathlib import Path
from typing import Generic, cast

import automotive_cosim
from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats import files
from automotive_cosim.formats.layout import DUE, PICTURES, TRACES
from automotive_cosim.formats.writing import add_line, growing, locked, make_folder, write_whole
from automotive_cosim.run.job_row import R, as_json, from_line
from automotive_cosim.run.versions import PACKAGE, STAMPED, installed
from automotive_cosim.scenarios.opening import own_files


def own_code(agents: Iterable[str]) -> dict[str, str]:
    """The hash of the code of each ``package.module:Class`` among the names of agents.

    It covers the module's file, or all modules of its top-level package, and not what these import from elsewhere.
    Agents behind an address and those that are not found have none."""
    found: dict[str, str] = {}
    for name in agents:
        module, colon, made = name.partition(":")
        files = _files(module.partition(".")[0]) if colon and made.isidentifier() else []
        if files:
            found[name] = _sha256(files)
    return found


def own_scenarios(plan: Json) -> dict[str, dict[str, str]]:
    """The hashes of the files of each scenario of one's own that a plan names, by name of the file.

    Args:
        plan: with one ``scenario`` or several ``scenarios``. Those that cannot be read have none."""
    found: dict[str, dict[str, str]] = {}
    for name in (plan.get("scenario"), *(plan.get("scenarios") or ())):
        with suppress(UserError, OSError):
            named: dict[str, list[Path]] = {}
            for file in own_files(name) if name else ():
                named.setdefault(file.name, []).append(file)
            if named:
                found[str(name)] = {file: _sha256(paths) for file, paths in named.items()}
    return found


def _files(module: str) -> list[Path]:
    """The files of a top-level module, looked for as an import would, from the working folder on."""
    try:
        spec = PathFinder.find_spec(module, [str(Path.cwd()), *sys.path])
    except (ImportError, ValueError):
        return []
    if spec is None:
        return []
    if spec.submodule_search_locations is not None:
        return sorted(path for folder in spec.submodule_search_locations for path in Path(folder).rglob("*.py"))
    return [Path(spec.origin)] if spec.origin is not None and Path(spec.origin).is_file() else []


def _sha256(files: Iterable[Path]) -> str:
    hashed = hashlib.sha256()
    for path in files:
        with path.open("rb") as file:
            hashed.update(hashlib.file_digest(file, "sha256").digest())
    return hashed.hexdigest()


FORMAT = 1
"""Format of the folder; any other is refused."""
ALSO_STAMPED = ("openai", "pyproj", "shapely")


RowKind = type[R] | Callable[[bytes], type[R]]
"""A kind of row, or what tells it from a line."""


class Store(Generic[R]):
    """An evaluation's folder, open for writing; ``rows`` are the newest by id."""

    def __init__(self, folder: Path, rows: dict[str, R], lines: FileIO) -> None:
        self.folder = folder
        self.rows = rows
        self._lines = lines

    def append(self, row: R) -> None:
        """Adds its line, or lines, and waits until they are on the disk.

        Raises UserError: it cannot be written, e.g. because the disk is full; earlier lines are kept."""
        try:
            for each in row.stored:
                add_line(self._lines, json.dumps(as_json(each), ensure_ascii=False), lasting=True)
                self.rows[each.id] = cast("R", each)
        except OSError as error:
            raise cannot_write(self.folder, error) from error


@contextmanager
def opened(
    folder: Path,
    plan: Json,
    kind: RowKind[R],
    parts: Sequence[str] = (TRACES, PICTURES),
    *,
    planned: int | None = None,
    grows: bool = False,
) -> Iterator[Store[R]]:
    """Creates or resumes an evaluation's folder, and locks it until it is closed.

    Args:
        plan: the plan; a folder that was started with a different one is refused.
        planned: how many jobs the plan has, for the manifest.
        grows: the plan may differ from the earlier one, for runs that are not known in advance; see ``replan``.

    Raises UserError: it cannot be written, is not an evaluation's, is in use, or was started with a different plan
    or different versions."""
    _check(folder)
    try:
        for name in ("", *parts):
            make_folder(folder, name)
        with locked(folder / "lock", f"to {folder}"):
            _manifest(folder, plan, planned, grows=grows)
            with growing(folder / "episodes.jsonl") as lines:
                yield Store(folder, read_rows(folder, kind), lines)
    except OSError as error:
        raise cannot_write(folder, error) from error


def replan(folder: Path, plan: Json, planned: int) -> None:
    """Writes a new plan into the manifest of an open folder whose plan grows.

    Raises UserError: it cannot be written."""
    manifest = read_manifest(folder) | {"plan": plan, "episodes": planned}
    try:
        write_whole(folder / "manifest.json", json.dumps(manifest, indent=1))
    except OSError as error:
        raise cannot_write(folder, error) from error


def cannot_write(folder: Path, error: OSError) -> UserError:
    """The error for a full disk or a folder that cannot be written."""
    why = error.strerror or str(error)
    return UserError(f"cannot write to {folder}: {why}; its contents are intact; rerun the command to resume")


def read_rows(folder: Path, kind: RowKind[R]) -> dict[str, R]:
    """The newest row of each job by its id; a last line that a kill cut short is ignored.

    Args:
        folder: of an evaluation, a study or proofs; without any line, it has no rows.
        kind: kind of its rows, or what tells it from a line.

    Raises UserError: another line cannot be read."""
    rows: dict[str, R] = {}
    path = folder / "episodes.jsonl"
    if not path.is_file():
        return rows
    with files.open_file(path) as file:
        *lines, last = file.read().split(b"\n")
    lines += [last] if files.is_whole(last) else []
    for number, line in enumerate(lines, start=1):
        try:
            of = cast("type[R]", kind if isinstance(kind, type) else kind(line))
            row = from_line(of, line)
        except ValueError as error:
            raise UserError(
                f"{path}, line {number} cannot be read: {error}; read it with the version that wrote it"
                f"{_writer(folder)}, or remove that line to rerun the episode"
            ) from error
        rows[row.id] = row
    return rows


def read_manifest(folder: Path) -> Json:
    """The manifest of an evaluation. Raises UserError: there is none, or it has another format."""
    path = folder / "manifest.json"
    try:
        manifest: Json = files.read_json(path)
    except FileNotFoundError as error:
        lacks = "it has no manifest.json" if folder.is_dir() else "there is no such folder"
        raise UserError(f"{folder} is not an evaluation: {lacks}; `automotive-cosim eval` creates one") from error
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error
    found = manifest.get("format") if isinstance(manifest, dict) else None
    if found != FORMAT:
        raise UserError(
            f"{path} has format {found!r}, and this version reads {FORMAT}; read it with the version that wrote it"
        )
    if not isinstance(manifest.get("plan"), dict):
        raise UserError(f"{path} has no plan; give a results folder as `automotive-cosim eval` wrote it")
    return manifest


def read_evaluation(folder: Path) -> Json:
    """The manifest of an evaluation of agents; studies and proofs keep theirs in the same form.

    Raises UserError: there is none, or it is not an evaluation's, or of another format."""
    manifest = read_manifest(folder)
    if "agents" not in manifest["plan"]:
        raise UserError(f"{folder} holds no agents' episodes; give a results folder of `automotive-cosim eval`")
    return manifest


def trace_file(folder: Path, episode: str) -> Path:
    """Path of an episode's trace."""
    return folder / TRACES / f"{episode}.jsonl.gz"


def write_trace(folder: Path, episode: str, lines: Iterable[Json]) -> None:
    """Writes a trace, completely or not at all; the same lines give the same bytes."""
    make_folder(folder, TRACES)
    text = "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines)
    write_whole(trace_file(folder, episode), gzip.compress(text.encode(), compresslevel=1, mtime=0))


def read_trace(folder: Path, episode: str) -> list[Json]:
    """The lines of a stored trace, the last of them the result.

    Raises UserError: there is none, or it is damaged."""
    path = trace_file(folder, episode)
    try:
        lines = files.read_json_lines(path)
        if not lines or not all(isinstance(line, dict) for line in lines):
            raise ValueError("it has no steps")
        return lines
    except FileNotFoundError as error:
        raise UserError(f"there is no trace of episode {episode!r} in {folder}") from error
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error


def stamp() -> Json:
    """What the results depend on besides the plan: versions, platform and state of the code."""
    versions = {"python": platform.python_version(), **installed((*STAMPED, *ALSO_STAMPED))}
    return {"versions": versions, "platform": platform.platform(), "git": _git()}


def keep_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Writes an episode's files from another node, each completely or not at all.

    Args:
        files: contents by path below it, with ``/`` between its parts.

    Raises OSError: they cannot be written."""
    for name, content in files.items():
        inner, _, file = name.rpartition("/")
        write_whole(make_folder(folder, inner) / file, content)


def megabytes(folder: Path) -> float:
    """Total size of the files in a folder, in megabytes."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


# --- inside -----------------------------------------------------------------------------------------------


def _writer(folder: Path) -> str:
    """The version that a folder was begun with, in brackets; empty if that is not known."""
    try:
        return f" ({PACKAGE} {files.read_json(folder / 'manifest.json')['starts'][0]['versions'][PACKAGE]})"
    except (OSError, ValueError, LookupError, TypeError):
        return ""


def _check(folder: Path) -> None:
    if folder.exists() and not folder.is_dir():
        raise UserError(f"{folder} is a file; give --out a folder")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "manifest.json").exists():
        begun = {TRACES, PICTURES, DUE, "lock"}
        if not {path.name for path in folder.iterdir()} <= begun:
            raise UserError(f"{folder} contains other files; give --out an empty folder or an evaluation's")


def _manifest(folder: Path, plan: Json, planned: int | None, *, grows: bool) -> None:
    """Writes the manifest, or adds this start to an existing one."""
    now = {"started": datetime.now().astimezone().isoformat(timespec="seconds"), **stamp()}
    now["own_code"] = own_code((*plan.get("agents", ()), plan.get("adviser", "")))
    now["own_scenarios"] = own_scenarios(plan)
    if not (folder / "manifest.json").exists():
        count = {} if planned is None else {"episodes": planned}
        manifest: Json = {"format": FORMAT, "plan": plan, **count, "starts": [now]}
    else:
        manifest = read_manifest(folder)
        if not grows:
            _same("plan", manifest["plan"], plan, folder)
        try:
            before = dict(manifest["starts"][0]["versions"])
        except (LookupError, TypeError, ValueError) as error:
            raise UserError(
                f"{folder / 'manifest.json'} does not list the versions; give --out another folder"
            ) from error
        _same("version", before, now["versions"], folder)
        first = manifest["starts"][0]  # one of an earlier version lacks what it did not keep
        _unchanged(_code(first), _code(now), folder)
        _unchanged(_scenario_files(first), _scenario_files(now), folder)
        manifest["starts"].append(now)
    write_whole(folder / "manifest.json", json.dumps(manifest, indent=1))


def _same(what: str, before: Json, now: Json, folder: Path) -> None:
    changed = [name for name in {**before, **now} if before.get(name) != now.get(name)]
    if changed:
        told = "; ".join(f"{name} was {before.get(name)!r} and is {now.get(name)!r}" for name in sorted(changed))
        raise UserError(f"{folder} was started with a different {what}: {told}. Give --out another folder")


def _code(start: Json) -> dict[str, str]:
    return {f"the code of {name}": code for name, code in start.get("own_code", {}).items()}


def _scenario_files(start: Json) -> dict[str, str]:
    return {
        name if file == Path(name).name else f"{file} of {name}": digest
        for name, files_ in start.get("own_scenarios", {}).items()
        for file, digest in files_.items()
    }


def _unchanged(before: Mapping[str, str], now: Mapping[str, str], folder: Path) -> None:
    changed = sorted(what for what in before if before[what] != now.get(what, before[what]))
    if changed:
        raise UserError(
            f"{', '.join(changed)} {'has' if len(changed) == 1 else 'have'} changed since the runs in {folder} "
            "were run. Give --out another folder, or delete that one"
        )


def _git() -> Json | None:
    """State of the checkout that the package runs from; None if it is installed."""
    here = Path(automotive_cosim.__file__).parent

    def ask(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=here, capture_output=True, text=True, check=True).stdout.strip()

    try:
        if Path(ask("rev-parse", "--show-toplevel")) != here.parent:
            return None
        return {"commit": ask("rev-parse", "HEAD"), "is_changed": bool(ask("status", "--porcelain", "--", "."))}
    except (OSError, subprocess.CalledProcessError):
        return None
