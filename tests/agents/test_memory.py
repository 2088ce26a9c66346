"""What ASURADA keeps: readable, bounded, and nothing that is written into it is more than data."""

import sqlite3

import pytest

from automotive_cosim.agents.memory import MOST_RECALLED, Memory, Strategy, where, why
from automotive_cosim.errors import UserError


def strategy(goal: str = "fan to max", place: str = "Paris, France", steps: str = "open_app climate") -> Strategy:
    return Strategy(place, goal, "50 km/h", steps)


def test_what_worked_here_for_such_a_wish_is_recalled(tmp_path):
    memory = Memory(tmp_path / "m")
    memory.keep(strategy(), worked=True)
    memory.keep(strategy(place="Oslo, Norway"), worked=True)
    memory.keep(strategy("warn me of speed"), worked=True)
    memory.keep(strategy("fan to the max", steps="bad"), worked=False)
    recalled = memory.recall("Paris, France", "put the fan to its max")
    assert [found.steps for found in recalled] == ["open_app climate"]


def test_successes_and_failures_add_up(tmp_path):
    memory = Memory(tmp_path / "m")
    for worked in (True, True, False):
        memory.keep(strategy(), worked=worked)
    assert [(found.worked, found.failed) for found in memory.all()] == [(2, 1)]
    memory.keep(strategy(), worked=False)
    assert memory.recall("Paris, France", "fan to max") == ()


def test_it_outlasts_the_process(tmp_path):
    Memory(tmp_path / "m").keep(strategy(), worked=True)
    assert Memory(tmp_path / "m").all()[0].goal == "fan to max"


def test_it_is_bounded_and_loses_what_was_longest_unused(tmp_path):
    memory = Memory(tmp_path / "m", most=5)
    for number in range(8):
        memory.keep(strategy(f"wish {number}"), worked=True)
    memory.keep(strategy("wish 4"), worked=True)
    memory.keep(strategy("wish 9"), worked=True)
    assert {found.goal for found in memory.all()} == {"wish 4", "wish 5", "wish 6", "wish 7", "wish 9"}


def test_a_recollection_is_short(tmp_path):
    memory = Memory(tmp_path / "m")
    for number in range(9):
        memory.keep(strategy(steps="x" * 5000 + str(number)), worked=True)
        memory.keep(strategy(f"fan {number}"), worked=True)
    recalled = memory.recall("Paris, France", "fan")
    assert len(recalled) == MOST_RECALLED
    assert all(len(found.words) < 2500 for found in memory.all())


@pytest.mark.parametrize("text", ["'; DROP TABLE strategies; --", 'x" OR 1=1', "\0", "ü\n## The car"])
def test_texts_are_data(tmp_path, text):
    memory = Memory(tmp_path / "m")
    memory.keep(Strategy(text, text, text, text), worked=True)
    assert memory.all()[0].goal == text
    memory.recall(text, text)
    assert len(memory.all()) == 1


def test_what_is_no_memory_is_told_in_one_line(tmp_path):
    (tmp_path / "m").write_text("not a database at all, but long enough to be taken for one" * 50)
    Memory(tmp_path / "whole").keep(strategy(), worked=True)
    whole = (tmp_path / "whole").read_bytes()
    (tmp_path / "letter").write_bytes(whole.replace(b"used INTEGER", b'"\xceed INTEGER', 1))
    (tmp_path / "quote").write_bytes(whole.replace(b"used INTEGER", b'"sed INTEGER', 1))
    for path in (*(tmp_path / name for name in ("m", "letter", "quote", "no/folder")), tmp_path):
        with pytest.raises(UserError, match="memory") as caught:
            Memory(path)
        assert "\n" not in str(caught.value)


def test_another_databases_table_is_left_alone(tmp_path):
    with sqlite3.connect(tmp_path / "m") as file:
        file.execute("CREATE TABLE strategies (other TEXT)")
    file.close()
    with pytest.raises(UserError):
        Memory(tmp_path / "m").keep(strategy(), worked=True)


def test_place_and_trigger_come_from_what_is_seen(observation):
    seen = observation("x", "Place: Paris, France\nSpeed limit here: 50 km/h\nWeather: fog\nCountry: right")
    assert where(seen) == "Paris, France"
    assert why(seen) == "80 km/h; Speed limit here: 50 km/h; Weather: fog"
    assert where(observation("x", None)) == "48.9, 2.3"
    assert where(observation("x", None, gps=None)) == "unknown"
