"""The studies are a wing of their own: without their folder, the package imports, has its commands and runs."""

import os
import re
import subprocess
import sys
from pathlib import Path
from pkgutil import resolve_name

import pytest

import automotive_cosim
from automotive_cosim.run.extensions import extensions, kind_of

WING = "studies"
TESTS = Path(__file__).parent
IMPORTS_ALL = """
import importlib, pkgutil, automotive_cosim.errors
found = [each.name for each in pkgutil.walk_packages(automotive_cosim.__path__, "automotive_cosim.", onerror=print)]
assert len(found) > 500, len(found)
for name in found:
    try:
        importlib.import_module(name)
    except (ModuleNotFoundError, automotive_cosim.errors.SetupError) as error:  # of an extra that is not installed
        missing = error.__cause__ or error
        if not isinstance(missing, ModuleNotFoundError) or "automotive_cosim" in str(missing):
            raise
"""


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package without the wing, as an installation would have it."""
    home = tmp_path_factory.mktemp("core")
    (home / "automotive_cosim").mkdir()
    for each in Path(automotive_cosim.__file__).parent.iterdir():
        if each.name not in (WING, "__pycache__"):
            (home / "automotive_cosim" / each.name).symlink_to(each)
    return home


def python(home: Path, *words: str) -> str:
    environment = os.environ | {"PYTHONPATH": str(home)}
    command = [sys.executable, "-P", *words]
    done = subprocess.run(command, cwd=home, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


COMMAND = "from automotive_cosim.cli.main import app; app()"


@pytest.mark.slow
def test_every_module_of_the_core_imports_without_it(core: Path) -> None:
    python(core, "-c", IMPORTS_ALL)
    groups = {name: python(core, "-c", COMMAND, *name.split(), "--help") for name in ("", "scenarios")}
    assert "eval" in groups[""]
    assert not re.search(r"\bstudy\b.*Measure", groups[""])
    assert "import" in groups["scenarios"]
    assert "calibrate" not in groups["scenarios"]


@pytest.mark.slow
def test_an_episode_runs_without_it(sumo: None, core: Path, tmp_path: Path) -> None:
    words = ["run", "--task", "hvac_fan_max", "--scenario", "grid", "--agent", "oracle", "--out", str(tmp_path)]
    assert "success" in python(core, "-c", COMMAND, *words)
    assert (tmp_path / "trial.json").is_file()


def test_what_it_registers_is_there() -> None:
    kinds = [kind for each in extensions() for kind in each.kinds().values()]
    assert len(kinds) == 4
    for kind in kinds:
        assert all(map(callable, map(resolve_name, (kind.page, *kind.served.values()))))
    assert kind_of({"study": "days"}) in kinds
    assert kind_of({"agents": ["oracle"]}) is None


def test_the_tests_of_the_core_are_read_without_it() -> None:
    files = [each for each in TESTS.rglob("*.py") if each.relative_to(TESTS).parts[0] != WING]
    assert len(files) > 200
    begins = re.compile(rf"^(from|import) (automotive_cosim|tests)[.]{WING}[ .]", re.MULTILINE)
    assert [str(each) for each in files if begins.search(each.read_text(encoding="utf-8"))] == []
