"""Puts the sections together, of which versions, hashes and limits of the run are the last."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.contracts.plain import counted
from automotive_cosim.formats.files import file_sha256
from automotive_cosim.formats.layout import PACKED_STEPS, STEPS, TRIAL
from automotive_cosim.report.tables import Table
from automotive_cosim.safety.dossier.claims import CLAIMS, claims
from automotive_cosim.safety.dossier.domain import domain, exposed, item, summary, use
from automotive_cosim.safety.dossier.happened import events, failures, measured
from automotive_cosim.safety.dossier.subject import Section, Subject, fact_table
from automotive_cosim.safety.dossier.unseen import areas, exposure_told, residual, unseen
from automotive_cosim.safety.page import FINDINGS


def hashes(folder: Path) -> list[tuple[str, str]]:
    """SHA-256 of the files of a run, and one for all traces together."""
    names = "manifest.json", "episodes.jsonl", "search.json", FINDINGS, TRIAL, STEPS, PACKED_STEPS
    found = [(name, file_sha256(folder / name)) for name in names if (folder / name).is_file()]
    traces = sorted((folder / "traces").glob("*"))
    if traces:
        listed = "".join(f"{file_sha256(path)}  {path.name}\n" for path in traces)
        found.append((f"traces/ ({counted(len(traces), 'file')})", hashlib.sha256(listed.encode()).hexdigest()))
    return found


def provenance(subject: Subject) -> Section:
    """Versions, starts and hashes."""
    starts = subject.results.manifest["starts"]
    versions = starts[0]["versions"] if starts else subject.results.manifest.get("versions", {})
    lines: list[tuple[str, str]] = [(name, str(value)) for name, value in versions.items()]
    for start in starts:
        git = start.get("git")
        commit = f", commit {git['commit'][:12]}{', changed' if git['is_changed'] else ''}" if git else ""
        lines.append(("started", f"{start['started']}, {start['platform']}{commit}"))
    files = tuple(hashes(subject.results.folder))
    tables = (
        fact_table("versions", "Versions", lines),
        Table(
            "hashes", "Files", ("File", "SHA-256"), files,
            "Of all traces: of the lines that sha256sum prints for them, by name. automotive-cosim replay "
            "repeats a run bit for bit; automotive-cosim publish verify checks a folder.", heads=2,
        ),
    )  # fmt: skip
    return Section("versions", "Versions and hashes", tables=tables)


def limits(subject: Subject) -> Section:
    """What the run cannot say."""
    errors = sum(row.error is not None for row in subject.rows)
    unwatched = sum(row.unwatched_from_s is not None for row in subject.drives)
    told = [
        "The road, the other vehicles and the driver are simulated by SUMO. Its drivers avoid collisions by "
        "construction, react to alerts by a model, and do not misuse the system as people do.",
        "What is right in an event follows from verified rules of the place and from cited figures; rules that "
        "are not verified require nothing. What no kind of event describes is not judged.",
        f"{counted(errors, 'run')} ended in an infrastructure error, and "
        f"{len(subject.results.coverage.not_run)} of the plan were not run; neither counts in any figure.",
    ]
    if unwatched:
        told.append(f"In {counted(unwatched, 'drive')}, the agent failed or its budget was spent before the end.")
    if any(row.model == "rules" for row in subject.rows):
        told.append("The model “rules” is a deterministic stand-in: it says nothing about a language model.")
    return Section("limits", "Limits", tuple(told))


@dataclass(frozen=True, slots=True)
class Dossier:
    """The whole document."""

    title: str
    sentence: str
    """What it leaves open."""
    sections: tuple[Section, ...]


def dossier(subject: Subject) -> Dossier:
    """The document about an agent's trials."""
    sections = (
        unseen(subject),
        summary(subject),
        item(subject),
        use(subject),
        domain(subject),
        exposed(subject),
        events(subject),
        failures(subject),
        measured(subject),
        areas(subject),
        provenance(subject),
        limits(subject),
        Section("claims", "Claims and evidence", (CLAIMS,), claims=(claims(subject),)),
    )
    return Dossier(f"Safety report: {subject.label}", f"{exposure_told(subject)} {residual(subject)}", sections)
