"""What a format needs is told before any work."""

from __future__ import annotations

from pathlib import Path

import pytest

from automotive_cosim.errors import SetupError, UnknownNameError
from automotive_cosim.exchange import needs


def test_all_that_is_missing_is_told_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> Path:
        raise SetupError(f"no {name}")

    monkeypatch.setattr(needs, "find_spec", lambda name: None)
    monkeypatch.setattr(needs, "program", missing)
    needs.check_formats(["openscenario-1.3"])
    with pytest.raises(SetupError) as told:
        needs.check_formats(["opendrive", "osi", "parquet"])
    assert told.value.args == ("OpenDRIVE: no netconvert", needs.OSI, needs.PARQUET)
    with pytest.raises(UnknownNameError, match=r"openscenario-1\.3"):
        needs.check_formats(["openscenario-2.0"])
