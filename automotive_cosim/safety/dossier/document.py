"""Puts the sections together."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.safety.dossier.claims import CLAIMS, claims
from automotive_cosim.safety.dossier.domain import domain, exposed, item, summary, use
from automotive_cosim.safety.dossier.happened import events, failures, measured
from automotive_cosim.safety.dossier.provenance import limits, provenance
from automotive_cosim.safety.dossier.subject import Section, Subject, sentence
from automotive_cosim.safety.dossier.unseen import areas, unseen


@dataclass(frozen=True, slots=True)
class Dossier:
    """The whole document."""

    title: str
    sentence: str
    sections: tuple[Section, ...]


def dossier(subject: Subject) -> Dossier:
    """The document about an agent's trials."""
    sections = (
        summary(subject),
        item(subject),
        use(subject),
        domain(subject),
        exposed(subject),
        events(subject),
        failures(subject),
        measured(subject),
        unseen(subject),
        areas(subject),
        provenance(subject),
        limits(subject),
        Section("claims", "Claims and evidence", (CLAIMS,), claims=(claims(subject),)),
    )
    return Dossier(f"Safety report: {subject.label}", sentence(subject), sections)
