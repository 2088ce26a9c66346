"""How large the house may be: a ceiling of lines, public classes and options for each folder.

Whoever goes over a ceiling lowers another in the same change, or argues the new number in the commit. What a
deletion frees is taken off the ceiling, which may stand only a little above what there is.
``python -m tests.test_house`` prints the table as it stands.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

from automotive_cosim.cli.main import app

TOP = Path(__file__).parents[1]
PACKAGE = TOP / "automotive_cosim"
COLUMNS = ("lines", "public classes", "options")
ROOM = (60, 2, 2)
"""How far a ceiling may stand above what there is."""
OTHERS = "beside them"

CEILINGS = {
    "agents": (6398, 65, 0),
    "benchmarks": (3344, 19, 0),
    "cli": (4782, 14, 170),
    "cockpit": (18_802, 184, 0),
    "contracts": (1494, 67, 0),
    "cosim": (721, 5, 0),
    "doors": (1657, 14, 0),
    "drives": (7343, 82, 0),
    "envs": (1884, 13, 0),
    "episode": (2128, 20, 0),
    "exchange": (3436, 11, 0),
    "formats": (2800, 38, 0),
    "geo": (3470, 39, 0),
    "interface": (1461, 5, 0),
    "measures": (898, 8, 0),
    "models": (2302, 25, 0),
    "osm": (6267, 43, 0),
    "proof": (3259, 18, 0),
    "publish": (1715, 9, 0),
    "replay": (180, 1, 0),
    "report": (5524, 25, 0),
    "run": (8833, 84, 0),
    "safety": (4173, 28, 0),
    "scenarios": (1930, 8, 0),
    "schemas": (76, 0, 0),
    "serve": (2665, 21, 0),
    "service": (385, 4, 0),
    "studies": (13_496, 119, 79),
    "tasking": (5442, 61, 0),
    "tasks": (15, 0, 0),
    "tests": (65_191, 112, 0),
    "traffic": (12_697, 87, 0),
    "view": (1761, 15, 0),
    "voice": (565, 0, 0),
    "beside them": (329, 15, 0),
}
"""Lines of Python, public classes and options of commands by folder: those of the package, and those at the top."""


DATA_LINES, WIDTH = 18_237, 130
"""Lines of the tasks' files, with every phrasing, and characters of the longest."""


def folders() -> Iterator[tuple[str, list[Path]]]:
    """Every folder that counts, with its Python files."""
    homes = [each for each in PACKAGE.iterdir() if each.is_dir() and not each.is_symlink()]
    homes += [TOP / name for name in ("agents", "benchmarks", "tasks", "tests")]
    for home in sorted(homes, key=lambda each: each.name):
        if files := sorted(home.rglob("*.py")):
            yield home.name, files
    yield OTHERS, [*PACKAGE.glob("*.py"), *TOP.glob("*.py")]


def options() -> Counter[str]:
    """How many options the commands have that a folder defines."""
    counted: Counter[str] = Counter()

    def count(command: Any) -> None:
        folder = getattr(command.callback, "__module__", "").removeprefix("automotive_cosim.").partition(".")[0]
        counted[folder] += sum(each.param_type_name == "option" for each in command.params)
        for each in getattr(command, "commands", {}).values():
            count(each)

    count(typer.main.get_command(app))
    return counted


def standing() -> dict[str, tuple[int, int, int]]:
    """Lines of Python, public classes and options by folder, as they are."""
    by_folder, found = options(), {}
    for name, files in folders():
        texts = [file.read_text(encoding="utf-8") for file in files]
        classes = [each for text in texts for each in ast.walk(ast.parse(text)) if isinstance(each, ast.ClassDef)]
        public = sum(not each.name.startswith("_") for each in classes)
        found[name] = (sum(text.count("\n") for text in texts), public, by_folder[name])
    return found


@pytest.mark.slow
def test_no_folder_is_larger_than_its_ceiling_and_no_ceiling_far_above() -> None:
    if not (TOP / "benchmarks").is_dir():
        pytest.skip("not run from a checkout")
    now = standing()
    assert now.keys() == CEILINGS.keys(), "a folder has come or gone: the table says how large each may be"
    wrong = []
    for name, counts in now.items():
        for what, count, ceiling, room in zip(COLUMNS, counts, CEILINGS[name], ROOM, strict=True):
            if count > ceiling:
                wrong.append(
                    f"{name} has {count} {what}, {count - ceiling} too many: lower another ceiling as much"
                )
            elif count + room < ceiling:
                wrong.append(f"{name} has {count} {what}: take its ceiling of {ceiling} down")
    assert not wrong, "\n".join(wrong)


def test_the_tasks_files_stay_below_their_ceiling_and_are_not_wide() -> None:
    files = sorted((TOP / "tasks").rglob("*.toml"))
    lines = [line for file in files for line in file.read_text(encoding="utf-8").splitlines()]
    assert DATA_LINES - ROOM[0] <= len(lines) <= DATA_LINES
    assert max(map(len, lines)) <= WIDTH
    assert sum(len(line) > 120 for line in lines) < len(lines) / 100


if __name__ == "__main__":
    for folder, has in standing().items():
        print(f'    "{folder}": ({", ".join(map(str, has))}),')
