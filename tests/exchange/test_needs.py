"""What a format needs is told before any work."""

from __future__ import annotations

from pathlib import Path

import pytest

from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.exchange import needs
from automotive_cosim.exchange.settings import ExportFormats


def test_all_that_is_missing_is_told_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> Path:
        raise SetupError(f"no {name}")

    monkeypatch.setattr(needs, "find_spec", lambda name: None)
    monkeypatch.setattr(needs, "program", missing)
    needs.check_formats(ExportFormats(openscenario="1.3"))
    with pytest.raises(SetupError) as told:
        needs.check_formats(ExportFormats(opendrive=True, osi=True, parquet=True))
    assert told.value.args == ("OpenDRIVE: no netconvert", needs.OSI, needs.PARQUET)
    with pytest.raises(UserError, match=r"give one of 1\.2, 1\.3"):
        needs.check_formats(ExportFormats(openscenario="2.0"))
