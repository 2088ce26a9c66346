"""A test that is not marked ``sumo`` cannot start SUMO, in this process or in a child (``conftest.py``)."""

import subprocess
import sys
from collections.abc import Callable

import pytest

from automotive_cosim.scenarios import load
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.sumo import load_library

STARTS: dict[str, Callable[[], object]] = {
    "library": load_library,
    "process": lambda: Forked(load("grid")),
    "program": lambda: sumo_programs.run("netconvert", ["--version"]),
}


@pytest.mark.parametrize("start", STARTS.values(), ids=STARTS)
def test_what_starts_sumo_fails(start: Callable[[], object], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "libsumo", raising=False)  # another test may have loaded it
    with pytest.raises(pytest.fail.Exception, match="this test starts SUMO"):
        start()


def test_a_child_finds_no_libsumo() -> None:
    done = subprocess.run([sys.executable, "-c", "import libsumo"], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "this test starts SUMO" in done.stderr
