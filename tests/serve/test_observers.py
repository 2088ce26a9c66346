"""The mark that tells a running program that somebody watches."""

import time
from pathlib import Path

from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.serve.observers import StudyObservers


def test_a_mark_holds_while_somebody_asks_and_goes_by_itself(tmp_path: Path) -> None:
    path = tmp_path / "watched"
    path.touch()
    observers = StudyObservers(patience_s=0.2)
    for _ in range(3):
        observers.observe(path)
        assert is_being_written(path)
        time.sleep(0.1)
    assert is_being_written(path)
    deadline_s = time.monotonic() + 10
    while is_being_written(path) and time.monotonic() < deadline_s:
        time.sleep(0.02)
    assert not is_being_written(path)


def test_two_servers_watch_the_same_and_one_of_them_ends(tmp_path: Path) -> None:
    path = tmp_path / "watched"
    path.touch()
    one, other = StudyObservers(), StudyObservers()
    one.observe(path)
    other.observe(path)
    one.close()
    assert not is_being_written(path)
    other.observe(path)
    assert is_being_written(path)
    other.close()
    assert not is_being_written(path)
    assert path.read_bytes() == b""
