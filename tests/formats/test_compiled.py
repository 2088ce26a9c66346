"""What is made of shipped files is made anew only when something has changed, and is the same as ever."""

import sys
from functools import partial
from pathlib import Path

import pytest

from automotive_cosim.formats import compiled as home
from automotive_cosim.formats.compiled import compiled
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasking.own_files import shipped_files, shipped_tasks
from automotive_cosim.tasks import CATALOGUE


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)
    path = tmp_path / "numbers.toml"
    path.write_text("a = 1", encoding="utf-8")
    return path


def test_it_is_made_once_for_the_same_content_and_program(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert [compiled([file], partial(str, said)) for said in ("first", "second")] == ["first", "first"]
    file.write_text("a = 2", encoding="utf-8")
    assert compiled([file], lambda: "third") == "third"
    monkeypatch.setattr(home, "program", lambda: b"another")
    assert compiled([file], lambda: "fourth") == "fourth"


@pytest.mark.parametrize("prevents", ["bytecode", "file"])
def test_where_nothing_may_be_written_it_is_made_each_time(
    file: Path, monkeypatch: pytest.MonkeyPatch, prevents: str
) -> None:
    if prevents == "bytecode":
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
    else:
        (file.parent / "__pycache__").write_text("", encoding="utf-8")
    assert [compiled([file], partial(str, said)) for said in ("first", "second")] == ["first", "second"]


@pytest.mark.slow
def test_kept_tasks_are_those_that_are_read() -> None:
    assert CATALOGUE.folder is not None
    for path in shipped_files(CATALOGUE.folder):
        for task in shipped_tasks(path):
            kept = CATALOGUE[task.id]
            assert kept == task
            assert [fingerprint(kept, half) for half in kept.halves] == [
                fingerprint(task, half) for half in task.halves
            ]
