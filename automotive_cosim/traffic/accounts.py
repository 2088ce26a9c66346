"""What studies read of a simulation: how the traffic is doing, what the ego used up, how a future ended."""

from __future__ import annotations

from dataclasses import dataclass

HALTED_MPS = 0.1
"""SUMO counts a vehicle as halted up to this speed (SUMO_const_haltingSpeed)."""

STUCK_S = 300.0
"""Waiting this long without a break is being stuck: SUMO's own time to teleport."""


@dataclass(frozen=True, slots=True)
class Pulse:
    """How the traffic as a whole is doing. Counts of events begin when the ledger was opened."""

    time_s: float
    running: int
    """Vehicles on the road."""
    halted: int
    """Of them, slower than ``HALTED_MPS``."""
    stuck: int
    """Of them, waiting for ``STUCK_S`` or longer."""
    backlog: int
    """Vehicles that are due and found no room to enter."""
    departed: int
    teleported: int


@dataclass(frozen=True, slots=True)
class Account:
    """What the ego's drive came to since its departure, counted as SUMO's tripinfo counts it."""

    departed_s: float
    """Simulation time at the end of the step it was inserted in."""
    stops: int
    """How often it came to a halt."""
    standing_s: float
    co2_g: float
    fuel_g: float
    """Both by SUMO's emission model for the vehicle's class."""


@dataclass(frozen=True, slots=True)
class Settled:
    """How a future ended."""

    time_s: float
    """When it was left alone: enough of everybody had arrived, or its time was over."""
    is_complete: bool
    """False if the time was over first."""
    arrivals_s: dict[str, float]
    """Simulation time at which each vehicle that was waited for arrived; who has not is missing."""
    ego: Account
    pulse: Pulse
