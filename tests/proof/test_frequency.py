"""How often situations come about: what is on record, and how it is measured on."""

from dataclasses import replace

import pytest

from automotive_cosim.proof import frequency
from automotive_cosim.tasking.fingerprint import situation
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE

TASK = "road_speed_80_in_50"
NAMES = {f"{task.id}/{half}" for task in CATALOGUE.values() for half in task.halves}


@pytest.fixture
def tried(monkeypatch):
    """What was tried; ``second`` is never reached with seed 7."""
    found = []

    def drive_up(task_id, half, seed, simulations):
        found.append((half, seed))
        return (half, seed) != ("second", 7)

    monkeypatch.setattr(frequency, "_is_reached", drive_up)
    return found


def test_at_most_one_half_in_five_hundred_is_not_reached():
    record = frequency.read(frequency.RECORD)
    assert record.keys() <= NAMES
    standard = [name for name in NAMES if CATALOGUE[name.split("/")[0]].suite is Suite.STANDARD]
    told = [name for name in standard if frequency.measured(*name.split("/")) is not None]
    assert len(told) >= len(standard) * 0.6, "what is on record is of the tasks as they are"
    assert (
        sum(len(each.missed) for each in record.values()) <= sum(len(each.seeds) for each in record.values()) / 500
    )


def test_only_what_is_missing_is_measured_and_what_has_changed_again(tried, tmp_path, monkeypatch):
    path = tmp_path / "frequency.json"
    assert list(frequency.measure([TASK], [6, 7], path)) == [
        (f"{TASK}/{half}", seed, (half, seed) != ("second", 7)) for seed in (6, 7) for half in ("second", "first")
    ]
    tried.clear()
    assert len(list(frequency.measure([TASK], [6, 7, 8], path))) == len(tried) == 2
    kept = frequency.read(path)
    assert (kept[f"{TASK}/second"].reached, kept[f"{TASK}/second"].missed) == ((6, 8), (7,))
    assert str(kept[f"{TASK}/second"]) == "2 of 3 seeds (6 to 8); not with 7"
    tried.clear()
    monkeypatch.setattr(frequency, "situation", lambda half: "another")
    assert len(list(frequency.measure([TASK], [6], path))) == len(tried) == 2
    assert frequency.read(path)[f"{TASK}/second"].seeds == (6,)


def test_what_has_changed_since_is_not_told(monkeypatch):
    known = frequency.Reach(situation(CATALOGUE[TASK].first), (1, 2))
    monkeypatch.setattr(frequency, "_shipped", lambda: {f"{TASK}/first": known})
    assert frequency.measured(TASK, "first") == known
    monkeypatch.setattr(frequency, "situation", lambda half: "another")
    assert frequency.measured(TASK, "first") is None


def test_the_digest_follows_the_situation_and_nothing_else():
    half = CATALOGUE[TASK].first
    same = replace(half, deadline=replace(half.deadline, seconds=99.0))
    assert situation(same) == situation(half)
    for changed in (
        replace(half, start=replace(half.start, driver="calm")),
        replace(half, trigger=replace(half.trigger, for_s=9.0)),
    ):
        assert situation(changed) != situation(half)
