"""Laws over words: what readers have stumbled over, wherever it can be computed."""

import re
from collections import Counter
from collections.abc import Iterator
from datetime import datetime

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.phone.state import directory
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.contracts import GoalStatus
from automotive_cosim.tasking.instance import Instance, draw
from automotive_cosim.tasking.task import Half, Task
from automotive_cosim.tasks import CATALOGUE
from tests.cockpit.conftest import town
from tests.laws import over
from tests.tasks.test_starts import time_of

HALVES = [(task, name) for task in CATALOGUE.values() for name in task.halves]
SEEDS = 3
WAVERING = re.compile(r"\b(in case|just in case|maybe|perhaps|to be (on the )?safe)\b", re.IGNORECASE)
"""What leaves open whether the act is wanted where its condition fails: "in case it rains" is also a precaution."""
STANDING = re.compile(
    r"\b(keep an eye on|keep (a lookout|watch)|watch (my|the|over|how|me)|as soon as"
    r"|(warn|alert|tell) me (when|once|as)|(sound off|speak up) when|count the)\b",
    re.IGNORECASE,
)
"""Wishes to be watched over: nobody can say at once that there is no need for it."""
AT_ONCE_S = 30.0
GONE = re.compile(r"\bI('ve| have) (just )?(left the seat|got out)\b")
"""The car shows the driver in the seat as long as a task runs."""
HOURS = {
    r"it's noon|middle of the day": range(10, 15),
    r"since breakfast|long day": range(12, 24),
    r"too late to get home|that's it for today": range(17, 24),
}
"""What drivers say of the hour, and at which hours it is true."""
DATED = re.compile(r"^(Mon|Tue|Wed|Thu|Fri|Sat|Sun) (\d{1,2} [A-Z][a-z]{2}):")
"""How a memo says of which day it is."""


def drawn(task: Task, name: str) -> Iterator[Instance]:
    for seed in range(SEEDS):
        yield draw(task, name, seed)


def people(instance: Instance) -> set[str]:
    """Everybody whom a start brings: contacts, who has written, and who will write or ring."""
    start = instance.half.start
    brought = start.belongings
    names = (
        *(each.name for each in brought.contacts),
        *(each.who for each in brought.threads),
        *(each.who for each in start.arrivals),
    )
    return {name for name in names if name}


@pytest.fixture(scope="session")
def first_names() -> frozenset[str]:
    """Of the people that are drawn for the phone."""
    contacts = (each for seed in range(100) for each in directory(np.random.default_rng(seed)).contacts)
    return frozenset(contact.name.split()[0] for contact in contacts)


@over(CATALOGUE.values())
def test_no_wish_wavers(task):
    said = [*task.templates, *(line.text for name in task.halves for line in task.half(name).says)]
    assert not [text for text in map(str, said) if WAVERING.search(text)]


def needs_nothing_soon(half: Half) -> bool:
    return half.declares is GoalStatus.NOT_NEEDED and half.deadline.seconds <= AT_ONCE_S


@over([task for task in CATALOGUE.values() if any(needs_nothing_soon(task.half(name)) for name in task.halves)])
def test_no_wish_to_be_watched_over_ends_at_once(task):
    assert not [text for text in map(str, task.templates) if STANDING.search(text)]


@over(CATALOGUE.values())
def test_no_driver_has_got_out(task):
    assert not [text for text in map(str, task.templates) if GONE.search(text)]


@over(HALVES)
def test_the_hour_is_as_the_driver_says(task, name):
    said = [hours for words, hours in HOURS.items() if re.search(words, " ".join(map(str, task.templates)), re.I)]
    assert not said or all(time_of(draw(task, name, 0).half.start).hour in hours for hours in said)


@over(HALVES)
def test_a_first_name_is_that_of_one_person(task, name, first_names):
    """Unless the start brings several of that name, between whom its papers decide."""
    for instance in drawn(task, name):
        counts = Counter(who.split()[0] for who in people(instance))
        assert not [first for first, count in counts.items() if first in first_names and count == 1]


@over([(task, name) for task, name in HALVES if task.half(name).start.belongings.memos])
def test_a_dated_memo_is_of_a_day_before_the_start(task, name):
    start = draw(task, name, 0).half.start
    for memo in map(str, start.belongings.memos):
        if found := DATED.match(memo):
            assert start.start is not None, "a dated memo wants a date of the start"
            now = datetime.fromisoformat(start.start)
            day = datetime.strptime(f"{found[2]} {now.year}", "%d %b %Y")
            assert f"{day:%a}" == found[1]
            assert day.date() < now.date()


def test_no_name_of_a_place_is_part_of_another():
    for seed in range(20):
        names = [
            place.name for place in Cockpit(town(), rng=np.random.default_rng(seed)).state.of(Gazetteer).places
        ]
        assert not [(one, other) for one in names for other in names if one != other and one in other]
