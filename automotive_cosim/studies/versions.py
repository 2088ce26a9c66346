"""Compares two runs of one study: whether another version of the program gives the same answer.

Every seed is run by both, so differences are paired by seed, and most rows should be the same to the last digit.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.report.tables import Table, TableRow
from automotive_cosim.run.job_row import JobRow, steady
from automotive_cosim.run.store import read_manifest
from automotive_cosim.studies.congestion.results import CongestionStudy, delay_h
from automotive_cosim.studies.congestion.words import name_of
from automotive_cosim.studies.intervals import seed_mean
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.tables import NONE, groups, told, told_mean
from automotive_cosim.studies.settings import CongestionSettings

AnyStudy = Study | CongestionStudy


@dataclass(frozen=True, slots=True)
class Pair:
    """Two runs of one study."""

    name: str
    """Both folders; of studies on several networks, what the study is called in each."""
    first: AnyStudy
    second: AnyStudy

    @property
    def rows(self) -> tuple[int, int, int]:
        """Rows that both have, how many of these are the same, and how many only one has."""
        one, two = ({row.id: _result(row) for row in study.rows} for study in (self.first, self.second))
        both = one.keys() & two.keys()
        return len(both), sum(agree(one[each], two[each]) for each in both), len(one.keys() ^ two.keys())

    @property
    def is_same(self) -> bool:
        """Whether all rows are the same."""
        both, same, single = self.rows
        return both == same and not single

    @property
    def changed(self) -> tuple[str, ...]:
        """What differs between the two runs besides their rows, in words."""
        found = []
        for what, one, two in (
            ("plan", self.first.manifest["plan"], self.second.manifest["plan"]),
            ("version", _versions(self.first), _versions(self.second)),
        ):
            for name in sorted(one.keys() | two.keys()):
                if name in one and name in two and one[name] != two[name]:
                    found.append(f"{what} of {name}: {one[name]} and {two[name]}" if what == "version" else name)
        return tuple(found)


def pairs(first: Path, second: Path) -> tuple[Pair, ...]:
    """The studies of two folders; of several networks, those of the same one, wherever it stands in the list.

    Raises UserError: a folder has no study, or the two have none in common."""
    if (first / "manifest.json").is_file() or (second / "manifest.json").is_file():
        return (_pair(f"{first} and {second}", first, second),)
    ones, twos = _networks(first), _networks(second)
    common = [name for name in ones if name in twos]
    if not common:
        raise UserError(f"{first} and {second} have no study in common; give two folders of `study`")
    return tuple(_pair(name, ones[name], twos[name]) for name in common)


def _networks(folder: Path) -> dict[str, Path]:
    """The studies by the name of their network; with its place in the list, if there are several of it."""
    paths = sorted(path.parent for path in folder.glob("*/manifest.json"))
    short = {path: path.name.lstrip("0123456789").removeprefix("_") for path in paths}
    often = Counter(short.values())
    return {path.name if often[short[path]] > 1 else short[path]: path for path in paths}


def _pair(name: str, first: Path, second: Path) -> Pair:
    kinds = [read_manifest(folder)["plan"].get("study") for folder in (first, second)]
    if kinds[0] != kinds[1]:
        raise UserError(f"{first} is a study of {kinds[0]}, {second} one of {kinds[1]}; give two of one kind")
    read: Callable[[Path], AnyStudy] = CongestionStudy.read if kinds[0] == CongestionSettings.kind else Study.read
    return Pair(name, read(first), read(second))


def _result(row: JobRow) -> Json:
    """A row without where its scenario's files were: a copy of them elsewhere gives the same result."""
    return {name: value for name, value in steady(row).items() if name != "scenario"}


def _versions(study: AnyStudy) -> Json:
    start = study.manifest["starts"][0]
    commit = {"commit": start["git"]["commit"]} if start.get("git") else {}
    return dict(start["versions"]) | commit


def agree(one: object, two: object) -> bool:
    """Whether two values are the same as far as both are known: a version may have fields that the other lacks."""
    if one is None or two is None:
        return True
    if isinstance(one, Mapping) and isinstance(two, Mapping):
        return all(agree(one[key], two[key]) for key in one.keys() & two.keys())
    if isinstance(one, list) and isinstance(two, list):
        return len(one) == len(two) and all(map(agree, one, two))
    return one == two


def compared(found: tuple[Pair, ...]) -> Table:
    """The figures of both runs, and their difference, seed by seed."""
    rows: list[TableRow] = []
    for pair in found:
        for what, one, two in _figures(pair):
            both = sorted(one.keys() & two.keys())
            cells = (
                seed_mean((seed, value) for (_, seed), value in sorted(figures.items())) for figures in (one, two)
            )
            change = seed_mean((seed, two[key, seed] - one[key, seed]) for key, seed in both)
            means = [NONE if mean is None else told(mean.value, "+.2f") for mean in cells]
            rows.append((pair.name, what, *means, told_mean(change, "+.2f"), str(len(both))))
    columns = ("Study", "Figure", "First", "Second", "Difference", "Pairs")
    note = (
        "Rerouting: seconds that a policy saves, over the decisions that both have. Congestion: vehicle-hours of "
        "delay per hour. In brackets 95 % t intervals over seeds, if there are enough."
    )
    return Table("compared", "Two runs of the same study", columns, tuple(rows), note, heads=2)


VersionFigures = dict[tuple[str, int], float]
"""A figure by what it is of and seed."""


def _figures(pair: Pair) -> Iterator[tuple[str, VersionFigures, VersionFigures]]:
    first, second = pair.first, pair.second
    if isinstance(first, CongestionStudy) and isinstance(second, CongestionStudy):
        for intervention in first.interventions:
            one, two = (
                {("", seed): delay_h(study.plan, outcome) for seed, outcome in study.outcomes(intervention)}
                for study in (first, second)
            )
            yield f"delay, {name_of(intervention)}", one, two
    elif isinstance(first, Study) and isinstance(second, Study):
        before, after = _gains(first), _gains(second)
        for name, figures in before.items():
            yield name, figures, after.get(name, {})


def _gains(study: Study) -> dict[str, VersionFigures]:
    """What each policy saves, by what it is called in the table."""
    return {
        f"{policy}, {share:.0%} reroute, news {age_s:g} s old": {
            (each.id, each.seed): each.gain.time_s for each in chosen
        }
        for share, policy, age_s, chosen in groups(study)
    }


def answer(found: tuple[Pair, ...]) -> str:
    """Whether the two give the same answer, in a sentence or two."""
    same = [pair for pair in found if pair.is_same]
    if len(same) == len(found):
        rows = sum(pair.rows[0] for pair in found)
        return (
            f"The same question, twice the same answer: all {counted(rows, 'row')} are the same to the last digit."
        )
    told_ = []
    for pair in found:
        both, agreeing, single = pair.rows
        if not pair.is_same:
            alone = f", and {counted(single, 'row')} only one has" if single else ""
            told_.append(f"{pair.name}: {both - agreeing} of {counted(both, 'row')} differ{alone}")
    return f"The two do not give the same answer. {'; '.join(told_)}."
