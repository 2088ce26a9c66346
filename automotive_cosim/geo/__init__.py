"""Where the car is: place, law, sky, weather, and the context an agent reads.

``geo.violations(states)`` tells judges and reports what was broken on a drive. It is looked up when first asked
for, so that nothing an agent can reach loads it.
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
