"""Which versions a result was made with, and which results may be compared."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version

from automotive_cosim import __version__
from automotive_cosim.contracts import Json

PACKAGE = "automotive-cosim"
STAMPED = (PACKAGE, "libsumo", "gymnasium", "numpy", "pillow")
"""Distributions on which the result of a trial may depend."""


def installed(names: Iterable[str]) -> dict[str, str]:
    """The versions of distributions by name, ``not installed`` for those that are missing; this package's own is
    that of the running code, even if an editable install recorded another one."""
    found: dict[str, str] = {}
    for name in names:
        try:
            found[name] = __version__ if name == PACKAGE else version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found


def ran_with(manifest: Json) -> str:
    """The version of the package that ran an evaluation or one trial; ``unknown`` if its manifest does not say."""
    try:
        return str((manifest["starts"] or [manifest])[0]["versions"][PACKAGE])
    except (LookupError, TypeError):
        return "unknown"


def minor(release: str) -> str:
    """The minor version of a release: ``0.2`` of ``0.2.3``. Tasks, draws and verdicts are the same within it."""
    return ".".join(release.split(".")[:2])
