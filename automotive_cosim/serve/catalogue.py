"""What the pages show of the catalogue and of the scenarios, as plain values."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from automotive_cosim import scenarios
from automotive_cosim.contracts import Json
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.geo.place import shipped
from automotive_cosim.proof import trail
from automotive_cosim.run.difficulty import rated
from automotive_cosim.serve.records import NotHereError
from automotive_cosim.tasking.parameters import FromCockpit
from automotive_cosim.tasking.task import Basis, Half, Task
from automotive_cosim.tasking.words import choices_in_words, half_in_words
from automotive_cosim.tasks import CATALOGUE


def tasks() -> Json:
    """The catalogue, a line for each task."""
    return {"tasks": [rated(task) | {"said": _said(task)} for task in CATALOGUE.values()]}


def _said(found: Task) -> str:
    """What the driver may say, with the first choice of each parameter; what is drawn from the cockpit's content is
    named by its kind."""
    values = {
        name: f"‹{choices.kind.replace('_', ' ')}›" if isinstance(choices, FromCockpit) else choices[0]
        for name, choices in found.parameters.items()
    }
    return found.templates[0].format(**values)


def task(name: str) -> Json:
    """One task with both halves in words, and the law on which it is based.

    Raises:
        UnknownNameError: there is none.
    """
    found = CATALOGUE[name]
    halves = []
    for half_name in found.halves:
        half = found.half(half_name)
        words = [*half_in_words(half), *trail.of_half(found, half_name)]
        halves.append({"name": half_name, "words": words, "laws": _laws(half)})
    return {
        **rated(found),
        "values": {each: choices_in_words(choices) for each, choices in found.parameters.items()},
        "trail": list(trail.of_task(found)),
        "halves": halves,
    }


def drives() -> Json:
    """The families of drives, a line for each."""
    return {
        "drives": [
            {"id": family.id, "season": family.season, "scenario": family.scenario, "about": family.about}
            for family in FAMILIES.values()
        ]
    }


@cache
def all_scenarios() -> Json:
    """The shipped scenarios."""
    return {"scenarios": [_scenario(name) for name in scenarios.shipped()]}


def scenario_map(name: str) -> Path:
    """The picture of a shipped scenario's network.

    Raises:
        NotHereError: there is none.
    """
    path = scenarios.load(name).folder / "map.webp" if name in scenarios.shipped() else None
    if path is None or not path.is_file():
        raise NotHereError(f"there is no map of a scenario {name!r}")
    return path


def _scenario(name: str) -> Json:
    found = scenarios.load(name)
    return {
        "name": name,
        "title": found.title,
        "about": found.about.strip(),
        "country": found.country,
        "starts": f"{found.start:%A %Y-%m-%d %H:%M}",
        "trips": [[trip.name, trip.about or f"{trip.from_edge} to {trip.to_edge}"] for trip in found.ego.trips],
        "has_map": (found.folder / "map.webp").is_file(),
        "tasks": [task.id for task in CATALOGUE.values() if name in task.runs_in],
    }


def _laws(half: Half) -> list[Json]:
    """The rules that a half rests on: their text, law, date and status; none if it rests on something else."""
    if half.basis is not Basis.LAW:
        return []
    ids = half.rule.split(", ")
    rules = {rule.id: rule for name in ids for layer in shipped().country(name[:2]) for rule in layer.rules}
    return [
        {"text": rule.text, "law": rule.law, "as_of": rule.as_of.isoformat(), "status": str(rule.status)}
        for rule in (rules[name] for name in ids)
    ]
