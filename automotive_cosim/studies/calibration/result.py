"""The figures of a calibration; ``calibration.json`` in the scenario's folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.toml import dotted
from automotive_cosim.studies.calibration.counts import GOOD_GEH, geh

RECORD = "calibration.json"

TELEPORT_SHARE = 0.01
"""More of the vehicles than this may not be teleported: they stood for 300 s."""

BACKLOG_SHARE = 0.1
"""More of the vehicles than this may not be unable to enter the network at the end."""

HALTED_SHARE = 0.75
"""More of them may not stand in the last half hour."""

GOOD_TIME_S, GOOD_TIME_SHARE = 60.0, 0.15
"""A travel time counts as met within a minute or 15 %, whichever is more (UK TAG unit M3.1)."""


@dataclass(frozen=True, slots=True)
class SiteHour:
    """One site in one hour, in vehicles per hour."""

    site: str
    edge: str
    hour: int
    held_out: bool
    """Whether the fit did not know it."""
    counted: float
    unfitted: float
    """What the given demand carries."""
    fitted: float | None
    """What the fit says; None for sites that were held out."""
    simulated: float

    @property
    def geh(self) -> float:
        """Distance of simulated and counted flow."""
        return geh(self.simulated, self.counted)

    @property
    def geh_unfitted(self) -> float:
        """The same with the given demand."""
        return geh(self.unfitted, self.counted)


@dataclass(frozen=True, slots=True)
class Met:
    """How well some flows meet their counts."""

    count: int
    """Sites and hours."""
    good: int
    """Those with a GEH below 5."""
    mean_geh: float
    total: float
    """Sum of the flows as a share of that of the counts."""

    @classmethod
    def of(cls, flows: Sequence[tuple[float, float]]) -> Met:
        """Computes it from pairs of a flow and its count."""
        distances = [geh(flow, count) for flow, count in flows]
        counted = sum(count for _, count in flows)
        return cls(
            len(flows),
            sum(each < GOOD_GEH for each in distances),
            sum(distances) / max(1, len(flows)),
            sum(flow for flow, _ in flows) / counted if counted else 1.0,
        )

    @property
    def share(self) -> float:
        """Share with a GEH below 5."""
        return self.good / self.count if self.count else 0.0

    def __str__(self) -> str:
        return (
            f"GEH below {GOOD_GEH:g} in {self.good} of {self.count} ({self.share:.0%}), mean {self.mean_geh:.1f};"
            f" total {self.total:.1%} of the counts"
        )


@dataclass(frozen=True, slots=True)
class Carried:
    """What one simulation says of a demand as a whole."""

    vehicles: int
    routes: int
    """Different routes they take."""
    teleports: int
    backlog: int
    """Vehicles that could not enter the network by the end."""
    halted_share: float
    """Share of the vehicles that stand, mean of the last half hour."""

    @property
    def gridlock(self) -> str:
        """Why this is no traffic, in words; empty if it flows."""
        if self.teleports > TELEPORT_SHARE * self.vehicles:
            return f"{self.teleports} of {self.vehicles} vehicles stood until they were teleported"
        if self.backlog > BACKLOG_SHARE * self.vehicles:
            return f"{self.backlog} of {self.vehicles} vehicles could not enter the network"
        if self.halted_share > HALTED_SHARE:
            return f"{self.halted_share:.0%} of the vehicles stood in the last half hour"
        return ""


@dataclass(frozen=True, slots=True)
class Try:
    """One round of fit and simulation."""

    calibrated: Met
    carried: Carried


@dataclass(frozen=True, slots=True)
class TimeRow:
    """One measured travel time, which no fit uses."""

    from_edge: str
    to_edge: str
    hour: int
    measured_s: float
    unfitted_s: float | None
    """None if nobody drove both edges; so too the next."""
    simulated_s: float | None

    @property
    def is_met(self) -> bool:
        """Whether the simulated time is near."""
        limit_s = max(GOOD_TIME_S, GOOD_TIME_SHARE * self.measured_s)
        return self.simulated_s is not None and abs(self.simulated_s - self.measured_s) <= limit_s


@dataclass(frozen=True, slots=True)
class Calibration:
    """The result."""

    source: str
    """Name of the scenario that was calibrated."""
    counts: str
    """A description of the source of the counts."""
    hours: tuple[int, ...]
    """Local hours, in a row."""
    rows: tuple[SiteHour, ...]
    times: tuple[TimeRow, ...]
    unmapped: Mapping[str, str]
    """Site that was left out -> reason."""
    doubts: tuple[str, ...]
    tries: tuple[Try, ...]
    kept: int
    """Index of the round whose demand is the scenario's."""
    given: Carried
    """The given demand, in the same simulation."""
    again: Met
    """The kept demand with another seed of SUMO, at the calibrated sites."""
    seed: int

    def met(self, *, held_out: bool, unfitted: bool = False) -> Met:
        """How well the calibrated or the held-out sites are met."""
        rows = [row for row in self.rows if row.held_out == held_out]
        return Met.of([(row.unfitted if unfitted else row.simulated, row.counted) for row in rows])

    @property
    def is_worse_elsewhere(self) -> bool:
        """Whether fewer of the held-out counts are met than before the fit."""
        return self.met(held_out=True).good < self.met(held_out=True, unfitted=True).good

    @property
    def carried(self) -> Carried:
        """The kept demand, driven."""
        return self.tries[self.kept].carried

    @property
    def gridlock(self) -> str:
        """Why it is no traffic, in words; empty if it flows."""
        return self.carried.gridlock

    def record(self) -> Json:
        """The result as JSON values."""
        return asdict(self)


def read_calibration(folder: Path) -> Calibration:
    """Reads a scenario folder's ``calibration.json``. Raises ScenarioError: there is none, or it is invalid."""
    path = folder / RECORD
    try:
        table = read_json(path)
    except (OSError, ValueError) as error:
        raise ScenarioError(f"{path} was not written by `automotive-cosim scenarios calibrate`: {error}") from error
    return checked(
        Calibration, table, lambda steps: (f"{path} of `scenarios calibrate`", dotted(steps)), ScenarioError
    )
