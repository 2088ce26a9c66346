"""The program on the path, as a reader has it."""

import os
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).parents[2]


@pytest.fixture
def on_path(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """``automotive-cosim`` is this checkout's, whatever else is installed, also for a client that hands on the path
    alone."""
    program = tmp_path_factory.mktemp("bin") / "automotive-cosim"
    found = os.pathsep.join(filter(None, (str(TOP), os.environ.get("PYTHONPATH"))))
    code = f'exec {sys.executable} -c "from automotive_cosim_main import main; main()" "$@"'
    program.write_text(f"#!/bin/sh\nexport PYTHONPATH='{found}'\n{code}\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent), prepend=os.pathsep)
