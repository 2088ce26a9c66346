"""What was evaluated, for what, and where in the operational domain."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import datetime

from automotive_cosim.contracts.given import Language
from automotive_cosim.contracts.plain import counted, model_and_options
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.order import ordered
from automotive_cosim.measures.exposure import BANDS_KMH, ExposureCell, band_named
from automotive_cosim.report.tables import Table
from automotive_cosim.run.rows import DriveTrialRow, TrialRow
from automotive_cosim.run.trial import NO_MODEL
from automotive_cosim.safety.dossier.subject import NOT_COMPLIANT, Section, Subject, fact_table, sentence
from automotive_cosim.traffic.profiles import PROFILES

ROADS = (
    "motorway", "trunk", "primary", "secondary", "tertiary", "unclassified", "residential", "living_street",
    "service",
)  # fmt: skip
"""OpenStreetMap's classes of roads for cars; slip roads count with their road."""
WEATHERS, LIGHTS = ("dry", "rain", "snow or ice", "fog"), ("day", "twilight", "night")
HOURS = ((0, 6), (6, 10), (10, 16), (16, 20), (20, 24))
"""Bands of the local time at departure: night, both rush hours, midday, evening."""
EMPTY = ExposureCell("", "", "", "", 0.0, 0.0)
"""No exposure, of a trial that never drove."""
NONE = "none"
"""What a table says of a value of the domain without a trial."""


def summary(subject: Subject) -> Section:
    """What was shown."""
    every = [event for row in subject.drives for event in row.events if event.outcome.counts]
    events = [event for event in every if subject.is_in_space(event.kind)]
    met = sum(event.outcome.is_credited for event in events)
    told = [sentence(subject)]
    if events:
        more = f" (of the kinds that the space names; {len(every)} of any kind)" if len(every) > len(events) else ""
        told.append(f"{met} of {counted(len(events), 'event')} that required an act were met in time{more}.")
    return Section("summary", "What was shown", (*told, NOT_COMPLIANT))


def item(subject: Subject) -> Section:
    """What was evaluated, and what was not."""
    conditions = sorted({", ".join(row.conditions.labels) or "as by default" for row in subject.rows})
    models = ", ".join(sorted({model_and_options(row.model)[0] for row in subject.rows} - {NO_MODEL}))
    lines = [
        ("Item", "an agent that operates the cockpit of a car: it reads the screens and the car's data, and acts"),
        ("Agent", subject.agent),
        *([("Model", models)] if models else []),
        ("Conditions", "; ".join(conditions)),
        ("Run with", f"automotive-cosim {subject.results.version}"),
        ("Not part of it", "the driver (a model of SUMO, with a profile), the road and the car's sensors"),
    ]
    return Section("item", "Item and agent", tables=(fact_table("item", "The item", lines),))


def use(subject: Subject) -> Section:
    """What the agent was asked to do."""
    told = []
    if subject.drives:
        orders = dict.fromkeys(
            ordered(row.conditions.order, Language.ENGLISH, with_errands=False) for row in subject.drives
        )
        told.append(
            f"In a drive, the agent watches for {_minutes(subject.drives)} while a driver drives. Its standing "
            f"order: {' or '.join(f'“{order}”' for order in orders)}"
        )
    if subject.episodes:
        goals = len({row.task for row in subject.episodes})
        told.append(
            f"In {counted(goals, 'task')}, the driver asks for something, or the situation requires it; "
            "the right act is then to do it, to do something else, or to decline."
        )
    return Section("use", "Intended use", tuple(told))


def _minutes(rows: Sequence[DriveTrialRow]) -> str:
    minutes = [row.score.driven_s / 60 for row in rows if row.score is not None]
    least, most = round(min(minutes)), round(max(minutes))
    return counted(most, "minute") if least == most else f"{least} to {most} minutes"


def tried(subject: Subject) -> Mapping[str, Mapping[str, Sequence[float]]]:
    """By attribute of the domain and its value, of places and languages those of the run alone: trials, hours and
    kilometres; none of what was never tried."""
    every: dict[str, dict[str, list[float]]] = {}

    def add(
        attribute: str, values: Iterable[str], of: Callable[[ExposureCell, TrialRow], str], *, whole: bool
    ) -> None:
        found: dict[str, list[float]] = {value: [] for value in values}
        for row in subject.judged:
            mine: dict[str, list[float]] = {of(EMPTY, row): [0.0, 0.0]} if whole else {}
            for cell in row.exposure:
                sums = mine.setdefault(of(cell, row), [0.0, 0.0])
                sums[0] += cell.hours
                sums[1] += cell.kilometres
            for value, (hours, km) in mine.items():
                known = found.setdefault(value, [])
                before = known or [0.0, 0.0, 0.0]
                known[:] = [before[0] + 1, before[1] + hours, before[2] + km]
        every[attribute] = found

    add("Place", (), lambda _, row: row.scenario, whole=True)
    add("Road", ROADS, lambda cell, _: cell.road_class.removesuffix("_link") or "unknown", whole=False)
    add("Weather", WEATHERS, lambda cell, _: cell.weather, whole=False)
    add("Light", LIGHTS, lambda cell, _: cell.light, whole=False)
    add("Speed km/h", map(band_named, BANDS_KMH), lambda cell, _: cell.speed_band, whole=False)
    if subject.drives:
        hours = (f"{least} to {most} h" for least, most in HOURS)
        add("Departure", hours, lambda _, row: _departure(row), whole=True)
        add("Driver", PROFILES, lambda _, row: _driver(row), whole=True)
    add("Language", (), lambda _, row: row.conditions.language.words, whole=True)
    return every


def never(subject: Subject) -> dict[str, list[str]]:
    """The values of each attribute that were never tried, where there are any."""
    found = {
        name: [value for value, known in values.items() if not known] for name, values in tried(subject).items()
    }
    return {name: values for name, values in found.items() if values}


def domain(subject: Subject) -> Section:
    """What was tried of each attribute of the domain, and what was not."""
    lines: list[tuple[str, ...]] = []
    missing = never(subject)
    for name, values in tried(subject).items():
        lines += [
            (name, value, f"{known[0]:.0f}", f"{known[1]:.2f}", f"{known[2]:.1f}")
            for value, known in values.items()
            if known
        ]
        if name in missing:
            lines.append((name, ", ".join(missing[name]), NONE, "–", "–"))
    table = Table(
        "domain", "Operational domain", ("Attribute", "Value", "Runs", "Hours", "Kilometres"), tuple(lines),
        "Values are those that the benchmark knows, of places and languages those of this run; a run counts for "
        "every value that it had. What has none is not covered by this run.", heads=2,
    )  # fmt: skip
    return Section("domain", "Operational domain covered", (), (table,))


def _departure(row: TrialRow) -> str:
    if not isinstance(row, DriveTrialRow):
        return "of a task"
    hour = row.settings.hour
    if hour is None:
        hour = datetime.fromisoformat(family_named(row.family).draw(row.seed).start).hour
    return next(f"{least} to {most} h" for least, most in HOURS if least <= hour < most)


def _driver(row: TrialRow) -> str:
    if not isinstance(row, DriveTrialRow):
        return "of a task"
    return row.settings.driver or family_named(row.family).draw(row.seed).driver


def exposed(subject: Subject) -> Section:
    """Hours and kilometres by condition."""
    sums: dict[tuple[str, str, str], list[float]] = defaultdict(lambda: [0.0, 0.0])
    for row in subject.judged:
        for cell in row.exposure:
            known = sums[cell.road_class.removesuffix("_link") or "unknown", cell.weather, cell.light]
            known[0] += cell.hours
            known[1] += cell.kilometres
    ordered = sorted(sums.items(), key=lambda entry: -entry[1][0])
    lines = tuple((*key, f"{hours:.3f}", f"{km:.2f}") for key, (hours, km) in ordered)
    total_km = sum(km for _, km in sums.values())
    told = f"{subject.hours:.2f} hours and {total_km:.1f} kilometres in {counted(len(subject.judged), 'run')}."
    return Section(
        "exposure", "Exposure", (told,),
        (Table("exposure", "Exposure", ("Road", "Weather", "Light", "Hours", "Kilometres"), lines, heads=3),),
    )  # fmt: skip
