"""The space that is searched: factors with their values, each with a nominal one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from math import exp, isfinite, log
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Le

from automotive_cosim.contracts.plain import rounded
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.staging import BRINGS
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import Document, read_toml
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.plan import families_named

FactorValue = str | float | bool
SearchPoint = Mapping[str, FactorValue]
"""A value of every factor."""
PointKey = tuple[tuple[str, FactorValue], ...]

CONDITIONS = tuple(each.name for each in TABLE)
SETTINGS = tuple(entry.name for entry in fields(DriveSettings) if entry.name != "cars")
TRIAL = ("task", "half", "drive", "scenario", "seed", "held_out")
FACTORS = (*TRIAL, *CONDITIONS, *SETTINGS)
"""Every factor that a space may have."""
NAMES = tuple(dict.fromkeys((*KINDS, *BRINGS)))
"""Of all that may happen on a drive: kinds of events, and stagings that bring about several."""
LIBRARY = {file.stem: file for file in sorted((Path(__file__).parent / "spaces").glob("*.toml"))}
"""The named logical scenarios that are shipped, by name."""
BINS = 4
"""Parts of a range in tables and in the coverage."""
DIGITS = 4
"""Significant digits of a number in a range."""


@dataclass(frozen=True, slots=True)
class FactorChoices:
    """A factor with a list of values; the first is the nominal one."""

    name: str
    values: tuple[FactorValue, ...]

    @property
    def nominal(self) -> FactorValue:
        """The value of an ordinary trial."""
        return self.values[0]

    @property
    def levels(self) -> tuple[str, ...]:
        """Its values in words."""
        return tuple(map(told, self.values))

    def at(self, unit: float) -> FactorValue:
        """The value at a coordinate from 0 to 1."""
        return self.values[min(len(self.values) - 1, int(unit * len(self.values)))]

    def unit(self, value: FactorValue) -> float:
        """A coordinate of a value."""
        return (self.values.index(value) + 0.5) / len(self.values)

    def level(self, value: FactorValue) -> str:
        return told(value)

    def distance(self, one: FactorValue, other: FactorValue) -> float:
        """How far two values are apart, from 0 to 1."""
        return float(one != other)


@dataclass(frozen=True, slots=True)
class FactorRange:
    """A factor with every number between two."""

    name: str
    least: float
    most: float
    nominal: float
    whole: bool = False
    logarithmic: bool = False

    @property
    def is_ordered(self) -> bool:
        """Whether near numbers mean similar trials: seeds only name them."""
        return self.name != "seed"

    @property
    def levels(self) -> tuple[str, ...]:
        """Its parts in words; each number of a few whole ones."""
        if self._few:
            return tuple(told(number) for number in range(round(self.least), round(self.most) + 1))
        edges = [self.at(step / BINS) for step in range(BINS + 1)]
        return tuple(f"{told(edges[step])} to {told(edges[step + 1])}" for step in range(BINS))

    @property
    def _few(self) -> bool:
        return self.whole and self.most - self.least < 2 * BINS

    def at(self, unit: float) -> float:
        """The number at a coordinate from 0 to 1."""
        if self.logarithmic:
            value = exp(log(self.least) + unit * (log(self.most) - log(self.least)))
        else:
            value = self.least + unit * (self.most - self.least)
        if self.whole:
            return round(value)
        return min(self.most, max(self.least, float(f"{value:.{DIGITS}g}")))

    def unit(self, value: FactorValue) -> float:
        """The coordinate of a number."""
        number = float(value)
        if self.logarithmic:
            return (log(number) - log(self.least)) / (log(self.most) - log(self.least))
        return (number - self.least) / (self.most - self.least)

    def level(self, value: FactorValue) -> str:
        """The part in which a number lies, in words."""
        if self._few:
            return told(value)
        return self.levels[min(BINS - 1, int(self.unit(value) * BINS))]

    def distance(self, one: FactorValue, other: FactorValue) -> float:
        """How far two numbers are apart, as a share of the range."""
        return abs(self.unit(one) - self.unit(other)) if self.is_ordered else float(one != other)


Factor = FactorChoices | FactorRange


@dataclass(frozen=True, slots=True)
class FailureRule:
    """``[failure]``: which trials count as failures. A task fails without its verdict's success."""

    drive_value_below: Annotated[float, Le(100)] | None = None
    """A drive fails if its value is below this; None: if an event was not met in time or an act was a nuisance."""
    events: tuple[str, ...] = ()
    """Kinds of events that count, and nuisances only where they outnumber the right acts while something is due:
    such events were met by chance. Empty for all of both."""
    ttc_below_s: Annotated[float, Ge(0)] | None = None
    """Fails too if the time to collision with the vehicle in front was ever below this."""

    @property
    def words(self) -> str:
        """What counts as a failure of a drive, in words."""
        kinds = ", ".join(self.events).replace("_", " ")
        of_kinds = f"an event that was not met in time, or met amid more nuisances than right acts, of: {kinds}"
        every = of_kinds if self.events else "an event of any kind that was not met in time, or a nuisance"
        if self.drive_value_below is not None:
            every = f"a value below {self.drive_value_below:g}"
        near = f", or a time to collision below {self.ttc_below_s:g} s" if self.ttc_below_s is not None else ""
        return f"{every}{near}"


@dataclass(frozen=True, slots=True)
class Space:
    """What is searched."""

    factors: tuple[Factor, ...]
    rule: FailureRule = field(default_factory=FailureRule)
    about: str = ""
    """What happens, for human readers."""
    sources: tuple[str, ...] = ()
    """Where the situation and its figures come from; the rest of the ranges is our choice."""

    @property
    def nominal(self) -> SearchPoint:
        """Every factor at its nominal value."""
        return {each.name: each.nominal for each in self.factors}

    @property
    def dimensions(self) -> int:
        """Number of factors."""
        return len(self.factors)

    def at(self, units: Sequence[float]) -> SearchPoint:
        """The point at coordinates from 0 to 1."""
        return {each.name: each.at(unit) for each, unit in zip(self.factors, units, strict=True)}

    def units(self, point: SearchPoint) -> list[float]:
        return [each.unit(point[each.name]) for each in self.factors]

    def factor(self, name: str) -> Factor:
        return next(each for each in self.factors if each.name == name)

    def distance(self, one: SearchPoint, other: SearchPoint) -> float:
        """The sum over the factors."""
        return sum(each.distance(one[each.name], other[each.name]) for each in self.factors)


@dataclass(frozen=True, slots=True)
class _RangeTable:
    """A range as a file has it."""

    least: float
    most: float
    nominal: float | None = None
    whole: bool = False
    logarithmic: bool = False


@dataclass(frozen=True, slots=True)
class _SpaceTable:
    """A ``space.toml``."""

    factors: dict[str, Any]
    failure: FailureRule = field(default_factory=FailureRule)
    about: str = ""
    sources: tuple[str, ...] = ()


def space_file(name: str) -> Path:
    """The file of a space: a path, or the name of one of the library.

    Raises UserError: there is neither such a file nor such a name."""
    if Path(name).is_file():
        return Path(name)
    if (known := name.replace("_", "-")) in LIBRARY:
        return LIBRARY[known]
    if name.endswith(".toml"):
        raise UserError(f"there is no file {name}")
    raise UnknownNameError("space", name, LIBRARY, whole=True)


def read_space(path: Path) -> Space:
    """The space in a TOML file.

    Raises UserError: it cannot be read, or a factor does not exist or has no such values."""
    document = read_toml(path)
    table = document.read(_SpaceTable)
    if not table.factors:
        raise UserError(f"{path} has no factors; give [factors] with at least a task or a drive")
    made = tuple(_factor(document, name, given) for name, given in table.factors.items())
    names = {each.name for each in made}
    if ("task" in names) == ("drive" in names):
        raise UserError(f"{path}: a space has the factor 'task' or the factor 'drive'; give one of the two")
    misplaced = sorted(names & (set(SETTINGS) if "task" in names else {"half", "held_out", "language"}))
    if misplaced:
        of = "drives" if "task" in names else "tasks"
        raise UserError(f"{path}: {', '.join(misplaced)} can be varied for {of} alone; remove it")
    for name in table.failure.events:
        if name not in NAMES:
            unknown = UnknownNameError("event or staging", name, NAMES, "automotive-cosim show events", whole=True)
            raise UserError(f"{document.refused(('failure', 'events'), 'has an unknown kind')}: {unknown}")
    kinds = dict.fromkeys(kind for name in table.failure.events for kind in BRINGS.get(name, (name,)))
    rule = replace(table.failure, events=tuple(kinds))
    return Space(made, rule, table.about, table.sources)


def _factor(document: Document, name: str, given: Any) -> Factor:
    steps = ("factors", name)
    if name not in FACTORS:
        raise UserError(f"{document.refused(steps, 'is no factor')}: {UnknownNameError('factor', name, FACTORS)}")
    if isinstance(given, dict):
        return _range(document, steps, name, given)
    values = list(given) if isinstance(given, list) else [given]
    try:
        if name == "task":
            values = [task for word in values for task in choose((str(word),), "all")]
        elif name == "drive":
            values = [family for word in values for family in families_named((str(word),))]
        elif name in CONDITIONS:
            values = [next(each for each in TABLE if each.name == name).value(value) for value in values]
            values = [str(value) if isinstance(value, str) else value for value in values]
    except UserError as error:
        raise document.refused(steps, f"has a value that does not exist: {error}") from error
    if name == "seed" and not all(type(value) is int and value >= 0 for value in values):
        raise document.refused(steps, "has a value that is no seed; give whole numbers from 0")
    if not values or not all(map(_is_level, values)):
        raise document.refused(steps, "is neither a list of values nor { least, most }; give one of the two")
    return FactorChoices(name, tuple(dict.fromkeys(values)))


def _is_level(value: object) -> bool:
    return isinstance(value, str) or (isinstance(value, int | float) and isfinite(value))


def _range(document: Document, steps: tuple[str, str], name: str, given: dict[str, Any]) -> FactorRange:
    made = checked(_RangeTable, given, lambda inner: document.place((*steps, *inner)), document.error)
    default = next((each.default for each in TABLE if each.name == name), made.least)
    nominal = float(default if made.nominal is None else made.nominal)
    if not made.least < made.most or (made.logarithmic and made.least <= 0):
        raise document.refused(steps, "is empty; give a least below the most, above 0 if it is logarithmic")
    if name == "seed" and made.least < 0:
        raise document.refused(steps, "has a least that is no seed; give whole numbers from 0")
    whole = made.whole or name == "seed"
    nominal = round(nominal) if whole else nominal
    if not made.least <= nominal <= made.most:
        raise document.refused(steps, f"has its nominal value {nominal:g} outside; give one from least to most")
    return FactorRange(name, float(made.least), float(made.most), nominal, whole, made.logarithmic)


def key_of(point: SearchPoint) -> PointKey:
    """A point as something that can be looked up."""
    return tuple(sorted(point.items()))


def told(value: FactorValue) -> str:
    """A value in words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return rounded(value, 6).replace(",", "") if isinstance(value, int | float) else str(value)


UNITS = {"_mm_h": "mm/h", "_min": "min", "_m": "m", "_s": "s", "_c": "°C"}
"""Units at the end of a factor's name."""


def label_of(name: str) -> tuple[str, str]:
    """A factor's name in words, and its unit; empty without one."""
    if name == "stage_s":  # beside the factor ``stage``
        return "stage time", "s"
    end = next((end for end in UNITS if name.endswith(end)), "")
    return name.removesuffix(end).replace("_", " "), UNITS.get(end, "")


def said(name: str, value: FactorValue, bound: str = "") -> str:
    """A factor's value in words with its unit: ``visibility at most 118 m``."""
    words, unit = label_of(name)
    return " ".join(filter(None, (words, bound, told(value), unit)))
