"""Puts the sections together."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.safety.dossier.claims import CLAIMS, claims
from automotive_cosim.safety.dossier.domain import domain, exposed, item, summary, use
from automotive_cosim.safety.dossier.happened import events, failures, measured
from automotive_cosim.safety.dossier.provenance import limits, provenance
from automotive_cosim.safety.dossier.subject import Section, Subject
from automotive_cosim.safety.dossier.unseen import areas, exposure_told, residual, unseen


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
