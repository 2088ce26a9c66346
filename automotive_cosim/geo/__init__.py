"""Where the car is: place, law, sky, weather, and the context an agent reads.

``geo.violations(states)`` lists the violations of a drive, for judges and reports. It is loaded on first use, so
nothing that an agent can reach loads it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from automotive_cosim.geo.breaches import violations

__all__ = ["violations"]


def __getattr__(name: str) -> object:
    if name == "violations":
        from automotive_cosim.geo.breaches import violations

        return violations
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
