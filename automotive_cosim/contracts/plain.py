"""Factors between units, JSON, and how progress is told."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

KMH_PER_MPS = 3.6
MPH_PER_MPS = 3600 / 1609.344

Json = dict[str, Any]
"""A JSON object: the edge of the package, where types end."""

Tell = Callable[[str, float | None], None]
"""Told what is being done, and the share of it that is done (0 to 1), None where that is not known."""
