"""What studies read from a simulation: the state of the traffic, the ego's consumption, how a future ended."""

from __future__ import annotations

from dataclasses import dataclass, field

HALTED_MPS = 0.1
"""SUMO counts a vehicle as halted up to this speed (SUMO_const_haltingSpeed)."""

STUCK_S = 300.0
"""A vehicle that waits this long without interruption is stuck: SUMO's own time to teleport."""

QUEUE_PERIOD_S = 10.0
"""Simulated time between two measurements of the queues."""

LOUD_DB = 65.0
"""Level in dB(A) in whose seconds noise is counted: that of a car at 50 km/h in SUMO's model (Harmonoise)."""


@dataclass(frozen=True, slots=True)
class TrafficSummary:
    """The state of the traffic as a whole. Counts of events begin when the ledger is opened."""

    time_s: float
    running: int
    """Vehicles on the road."""
    halted: int
    """Vehicles slower than ``HALTED_MPS``."""
    stuck: int
    """Vehicles waiting for ``STUCK_S`` or longer."""
    backlog: int
    """Vehicles that are due but found no room to enter."""
    departed: int
    teleported: int
    collided: int = 0
    """Vehicles that a collision has taken off the road."""


@dataclass(frozen=True, slots=True)
class Account:
    """Figures of the ego's drive since its departure, counted as in SUMO's tripinfo."""

    departed_s: float
    """Simulation time at the end of the step in which it was inserted."""
    stops: int
    """Number of stops."""
    standing_s: float
    co2_g: float
    fuel_g: float
    """Both from SUMO's emission model for the vehicle's class."""
    energy_wh: float = 0.0
    """From the battery, of an electric one."""
    lost_s: float = 0.0
    """SUMO's ``timeLoss``: the time by which it was slower than the limit of each lane and its driver allow, at
    signals too; the rest of its time is what its way takes on an empty road."""


@dataclass(frozen=True, slots=True)
class Consumption:
    """What one vehicle has emitted and consumed since it entered, by SUMO's model for its emission class."""

    emission_class: str
    """SUMO's name, as ``HBEFA4/PC_petrol_Euro-4``."""
    co2_g: float
    nox_g: float
    fuel_g: float
    energy_wh: float
    noise_s: float
    """Sound energy at the vehicle by Harmonoise, as seconds of ``LOUD_DB``: levels do not add up, energies do."""


TrackPoint = tuple[float, float, float, float, str]
"""Time in s, x and y in m, speed in m/s, and the edge, of one step of the ego."""


@dataclass(frozen=True, slots=True)
class Settled:
    """How a future ended."""

    time_s: float
    """When it ended: enough vehicles had arrived, or its time was over."""
    is_complete: bool
    """False if the time was over first."""
    arrivals_s: dict[str, float]
    """Simulation time at which each awaited vehicle arrived, without those that have not."""
    ego: Account
    summary: TrafficSummary
    consumptions: dict[str, Consumption] = field(default_factory=dict)
    """Of each awaited vehicle and the ego, if the ledger keeps them."""
    track: tuple[TrackPoint, ...] = ()
    """Where the ego was after every step since its departure, if the ledger keeps it."""
