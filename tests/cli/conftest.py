"""The command line in this process: what it prints, and the code it ends with."""

import signal
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest

from automotive_cosim.cli.main import main
from automotive_cosim.traffic.fork import Simulations


@dataclass
class Ran:
    code: int
    out: str
    err: str


@pytest.fixture
def cli(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path
) -> Iterator[Callable[..., Ran]]:
    """Runs ``automotive-cosim`` in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("AUTOMOTIVE_COSIM_DEBUG", raising=False)
    terminated = signal.getsignal(signal.SIGTERM)

    def run(*arguments: object) -> Ran:
        monkeypatch.setattr(sys, "argv", ["automotive-cosim", *map(str, arguments)])
        capfd.readouterr()
        with pytest.raises(SystemExit) as ended:
            main()
        printed = capfd.readouterr()
        return Ran(int(ended.value.code or 0), printed.out, printed.err)

    yield run
    signal.signal(signal.SIGTERM, terminated)


@pytest.fixture
def warm(simulations: Simulations, monkeypatch: pytest.MonkeyPatch) -> None:
    """``automotive-cosim run`` takes the warm simulations that all tests share, instead of its own."""

    class Lent:
        held = staticmethod(simulations.held)

        def close(self) -> None:
            """They stay warm."""

    monkeypatch.setattr("automotive_cosim.run.episode.Simulations", Lent)
