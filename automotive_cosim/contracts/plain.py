"""Factors between units, and JSON."""

from __future__ import annotations

from typing import Any

KMH_PER_MPS = 3.6
MPH_PER_MPS = 3600 / 1609.344

Json = dict[str, Any]
"""A JSON object: the edge of the package, where types end."""
