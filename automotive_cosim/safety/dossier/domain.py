"""What was evaluated, for what, and where in the operational domain."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime

from automotive_cosim.contracts.given import Language
from automotive_cosim.contracts.plain import counted, model_and_options
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.order import STANDING_ORDERS
from automotive_cosim.measures import ExposureCell
from automotive_cosim.measures.exposure import BANDS_KMH, band_named
from automotive_cosim.report.tables import Table
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.safety.dossier.subject import NOT_COMPLIANT, Section, Subject, fact_table, hours_of, sentence
from automotive_cosim.scenarios import shipped
from automotive_cosim.traffic.profiles import PROFILES

ROADS = (
    "motorway", "trunk", "primary", "secondary", "tertiary", "unclassified", "residential", "living_street",
    "service",
)  # fmt: skip
"""OpenStreetMap's classes of roads for cars; slip roads count with their road."""
WEATHERS, LIGHTS = ("dry", "rain", "snow or ice", "fog"), ("day", "twilight", "night")
HOURS = ((0, 6), (6, 10), (10, 16), (16, 20), (20, 24))
"""Bands of the local time at departure: night, both rush hours, midday, evening."""
NONE = "none"
"""What a table says of a value of the domain without a trial."""


def summary(subject: Subject) -> Section:
    """The first section."""
    every = [event for row in subject.drives for event in row.events if event.outcome.counts]
    events = [event for event in every if subject.is_in_space(event.kind)]
    met = sum(event.outcome.is_credited for event in events)
    told = [sentence(subject)]
    if events:
        more = f" (of the kinds that the space names; {len(every)} of any kind)" if len(every) > len(events) else ""
        told.append(f"{met} of {counted(len(events), 'event')} that required an act were met in time{more}.")
    return Section("summary", "Summary", (*told, NOT_COMPLIANT))


def item(subject: Subject) -> Section:
    """What was evaluated, and what was not."""
    conditions = sorted({", ".join(row.conditions.labels) or "as by default" for row in subject.rows})
    lines = [
        ("Item", "an agent that operates the cockpit of a car: it reads the screens and the car's data, and acts"),
        ("Agent", subject.agent),
        ("Model", ", ".join(sorted({model_and_options(row.model)[0] for row in subject.rows}))),
        ("Conditions", "; ".join(conditions)),
        ("Run with", f"automotive-cosim {subject.results.version}"),
        ("Not part of it", "the driver (a model of SUMO, with a profile), the road and the car's sensors"),
    ]
    return Section("item", "Item and agent", tables=(fact_table("item", "The item", lines),))


def use(subject: Subject) -> Section:
    """What the agent was asked to do."""
    told = []
    if subject.drives:
        told.append(
            f"In a drive, the agent watches for {_minutes(subject.drives)} while a driver drives. Its standing "
            f"order: “{STANDING_ORDERS[Language.ENGLISH]}”"
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


def domain(subject: Subject) -> Section:
    """Each attribute of the domain with each of its values, those without a trial too."""
    lines: list[tuple[str, ...]] = []

    def cells(attribute: str, values: Iterable[str], of: Callable[[ExposureCell], str]) -> None:
        found: dict[str, list[float]] = {}
        for row in subject.judged:
            mine: dict[str, list[float]] = defaultdict(lambda: [0.0, 0.0])
            for cell in row.exposure:
                mine[of(cell)][0] += cell.hours
                mine[of(cell)][1] += cell.kilometres
            for value, (hours, km) in mine.items():
                known = found.setdefault(value, [0.0, 0.0, 0.0])
                known[0] += 1
                known[1] += hours
                known[2] += km
        add(attribute, values, found)

    def trials(attribute: str, values: Iterable[str], of: Callable[[TrialRow], str]) -> None:
        found: dict[str, list[float]] = {}
        for row in subject.judged:
            known = found.setdefault(of(row), [0.0, 0.0, 0.0])
            known[0] += 1
            known[1] += hours_of([row])
            known[2] += sum(cell.kilometres for cell in row.exposure)
        add(attribute, values, found)

    def add(attribute: str, values: Iterable[str], found: dict[str, list[float]]) -> None:
        for value in dict.fromkeys((*values, *sorted(found))):
            if value in found:
                count, hours, km = found[value]
                lines.append((attribute, value, f"{count:.0f}", f"{hours:.2f}", f"{km:.1f}"))
            else:
                lines.append((attribute, value, NONE, "–", "–"))

    trials("Place", shipped(), lambda row: row.scenario)
    cells("Road", ROADS, lambda cell: cell.road_class.removesuffix("_link") or "unknown")
    cells("Weather", WEATHERS, lambda cell: cell.weather)
    cells("Light", LIGHTS, lambda cell: cell.light)
    cells("Speed km/h", [band_named(least) for least in BANDS_KMH], lambda cell: cell.speed_band)
    if subject.drives:
        trials("Departure", [f"{least} to {most} h" for least, most in HOURS], _departure)
        trials("Driver", PROFILES, _driver)
    trials("Language", [each.words for each in Language], lambda row: row.conditions.language.words)
    heads = "Attribute", "Value", f"{subject.unit.capitalize()}s", "Hours", "Kilometres"
    note = (
        f"Values are those that the benchmark knows; each {subject.unit} counts for every value that it had. What "
        "has none is not covered by this run."
    )
    table = Table("domain", "Operational domain", heads, tuple(lines), note, heads=2)
    empty = sum(line[2] == NONE for line in lines)
    told = f"{empty} of {counted(len(lines), 'value')} have no {subject.unit}."
    return Section("domain", "Operational domain covered", (told,), (table,))


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
    told = (
        f"{subject.hours:.2f} hours and {total_km:.1f} kilometres in {counted(len(subject.judged), subject.unit)}."
    )
    return Section(
        "exposure", "Exposure", (told,),
        (Table("exposure", "Exposure", ("Road", "Weather", "Light", "Hours", "Kilometres"), lines, heads=3),),
    )  # fmt: skip
