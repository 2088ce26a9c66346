"""Makes a bundle of an evaluation: everything that a check needs, and nothing private.

The newest line of each episode, with error texts cleaned of this machine's folders, and the traces of judged
episodes; no screenshots. A file that still contains a key of the
environment or the path of a home folder is refused.
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

from automotive_cosim.contracts import FeedbackCode, Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import file_sha256, read_unpacked
from automotive_cosim.formats.keys import letters, spelled
from automotive_cosim.formats.layout import TRACES
from automotive_cosim.formats.writing import copy, drafted, make_folder, write_whole
from automotive_cosim.publish import archive
from automotive_cosim.publish.contents import FORMAT, NAME, Contents, counts
from automotive_cosim.run.coverage import coverage
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.moments import judged_file
from automotive_cosim.run.rows import TrialRow, read_trials
from automotive_cosim.run.store import read_evaluation, read_trace, trace_file, write_trace
from automotive_cosim.run.versions import ran_with

SECRET = r"KEY|TOKEN|SECRET|PASSWORD"
"""In the name of a variable whose value is not published."""
_PATH = re.compile(r"""(?<![\w.:/\\<])(?:[A-Za-z]:)?[/\\](?=[\w.~])[^\s'"<>|,;()\[\]]+""")
"""An absolute path in a text."""
_HOME = re.compile(r"/home/\w|/Users/\w|/root/|[A-Za-z]:\\{1,2}Users\\{1,2}\w")


def write_bundle(folder: Path, out: Path) -> Contents:
    """Writes the bundle of an evaluation; the same folder gives the same bytes.

    Raises UserError: the folder is not an evaluation's, is damaged, has no episodes, or contains what must not be
    published; or the file cannot be written."""
    manifest, rows = read_evaluation(folder), read_trials(folder)
    found = coverage(manifest, rows)
    manifest["episodes"] = found.planned  # which older evaluations do not record
    if not rows:
        raise UserError(f"{folder} has no episodes yet ({found}); rerun its `eval` command")
    if found.problem:
        raise UserError(
            f"{folder} cannot be bundled: {found.problem}; set AUTOMOTIVE_COSIM_TASKS to the folder it was run with"
        )
    for name in (*manifest["plan"]["scenarios"], *manifest["plan"]["agents"]):
        if PurePosixPath(name).is_absolute() or PureWindowsPath(name).is_absolute():
            raise UserError(f"the plan of {folder} names {name!r} by an absolute path; run it with a relative one")
    try:
        make_folder(out.parent)
        with drafted(out) as file, tempfile.TemporaryDirectory(prefix="automotive-cosim-bundle-") as name:
            staged = Path(name)
            kept = [_stage(folder, rows[name], staged) for name in sorted(rows)]
            write_whole(staged / "manifest.json", json.dumps(manifest, indent=1).encode())
            lines = "".join(json.dumps(as_json(row), ensure_ascii=False) + "\n" for row in kept)
            write_whole(staged / "episodes.jsonl", lines.encode())
            _unpack(staged, os.environ)
            contents = Contents(
                FORMAT,
                ran_with(manifest),
                counts(found, sum(row.has_succeeded for row in kept)),
                {name: file_sha256(staged / name) for name in archive.members(staged)},
            )
            write_whole(staged / NAME, contents.text().encode())
            archive.pack(staged, file)
    except OSError as error:
        raise UserError(f"cannot write {out}: {error.strerror or error}; give --out another file") from error
    return contents


def cleaned(text: str) -> str:
    """A text with the last names of absolute paths instead of the whole."""
    home = Path.home()
    text = text.replace(str(home), "~") if len(home.parts) > 1 else text
    return _PATH.sub(lambda found: re.split(r"[/\\]", found[0].rstrip("/\\"))[-1], text)


def _stage(folder: Path, row: TrialRow, staged: Path) -> TrialRow:
    """Copies the files of a judged episode; returns its row as it is published."""
    clean = replace(
        row,
        error=None if row.error is None else cleaned(row.error),
        agent_error=None if row.agent_error is None else cleaned(row.agent_error),
        malformed_why=cleaned(row.malformed_why),
        failed_attempts=tuple(map(cleaned, row.failed_attempts)),
    )
    if row.outcome is not None:
        for path in (folder / TRACES, trace_file(folder, row.id), judged_file(folder, row.id)):
            if path.is_symlink():
                raise UserError(
                    f"{path} is a link, and may lead to what is not to be published; copy the file there"
                )
            if path.is_file():
                copy(path, make_folder(staged, TRACES) / path.name, archive.MOST_BYTES)
        if trace_file(staged, row.id).is_file():
            lines = read_trace(staged, row.id)
            if (published := list(map(_cleaned_line, lines))) != lines:
                write_trace(staged, row.id, published)
    return clean


def _cleaned_line(line: Json) -> Json:
    """A line of a trace without folders in the texts from an agent's side; nothing else in it may name one."""
    if "result" in line:
        result = _without_homes(line["result"])
        if result.get("agent_error") is not None:
            declared = result["verdict"]["parts"]["declared"]
            result["agent_error"], declared["why"] = cleaned(result["agent_error"]), cleaned(declared["why"])
        return {"result": result}
    said: Json = {name: _without_homes(line[name]) for name in ("thought", "stages") if name in line}
    if line["feedback"]["code"] == FeedbackCode.MALFORMED:
        said["feedback"] = line["feedback"] | {"text": cleaned(line["feedback"]["text"])}
    return line | said


def _without_homes(value: Any) -> Any:
    """A copy of JSON with home folders removed from its texts."""
    match value:
        case str():
            return cleaned(value) if _HOME.search(value) else value
        case dict():
            return {key: _without_homes(inner) for key, inner in value.items()}
        case list():
            return list(map(_without_homes, value))
    return value


def _unpack(staged: Path, environment: Mapping[str, str]) -> None:
    """Unpacks the files, since they are packed together.

    Raises UserError: a file contains a key of the environment or the path of a home folder, or cannot be
    unpacked."""
    secrets = {value: name for name, value in environment.items() if re.search(SECRET, name, re.IGNORECASE)}
    for name in archive.members(staged):
        try:
            data = read_unpacked(staged / name)
        except (OSError, ValueError) as error:
            raise UserError(f"{name} cannot be read: {error}; rerun its episode, or leave it out") from error
        write_whole(staged / name, data)
        text = data.decode(errors="replace")
        told = letters(text)
        for secret, variable in secrets.items():
            if any(spelled(told, secret)):
                raise UserError(f"{name} contains the value of {variable}; remove it from the evaluation first")
        if found := _HOME.search(text):
            told = text[found.start() : found.end() + 20]
            raise UserError(
                f"{name} contains the path of a home folder: {told!r}; remove it from the evaluation first"
            )
