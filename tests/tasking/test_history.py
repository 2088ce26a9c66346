"""Checks over time and of records, on traces made by hand."""

from datetime import datetime, timedelta
from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.tasking.checks import (
    AppDataIs,
    app_data_at,
    app_data_includes,
    app_data_without,
    entered_all,
    says_figure,
    wrote,
)
from automotive_cosim.tasking.history import after, lasted, not_before, while_

A, B = AppDataIs("a", (True,)), AppDataIs("b", (True,))


def trace(*seconds: str) -> list[Any]:
    """A moment per text, at 21:59:50 and each second after it: which of ``a`` and ``b`` hold."""
    return [
        SimpleNamespace(
            time_s=float(at),
            local_time=datetime(2026, 5, 12, 21, 59, 50) + timedelta(seconds=at),
            commands={name: name in text for name in "ab"},
        )
        for at, text in enumerate(seconds)
    ]


def holds(check: Any, moments: list[Any]) -> bool:
    return check.holds(moments[0], moments[-1], moments)


@pytest.mark.parametrize(
    ("check", "right", "wrong"),
    [
        (after(A, B), ["", "a", "ab"], ["", "b", "ab"]),
        (after(A, B), ["", "a", "b"], ["", "b", "a", "b"]),
        (after(A, B), ["", "ab"], ["", "a"]),
        (lasted(A, 2.0, 4.0), ["", "a", "a", "a", ""], ["", "a", "", "a", ""]),
        (lasted(A, 2.0, 4.0), ["a", "a", "a", ""], ["a", "a", "a"]),
        (lasted(A, 2.0, 4.0), ["a"] * 5 + [""], ["a"] * 6 + [""]),
        (not_before(A, "22:00"), [""] * 10 + ["a"], [""] * 9 + ["a", "a"]),
        (not_before(A, "22:00"), [""] * 12 + ["a"], [""] * 13),
        (while_(A, B, 2.0), ["b", "ab", "ab", ""], ["b", "ab", "a", "b"]),
        (while_(A, B, 2.0), ["", "ab", "ab"], ["", "ab", ""]),
    ],
)
def test_checks_over_time(check, right, wrong):
    assert holds(check, trace(*right))
    assert not holds(check, trace(*wrong))
    assert str(check)


def now(**commands: Any) -> Any:
    return SimpleNamespace(commands=commands)


def judged(check: Any, before: Any, after: Any) -> bool:
    return check.holds(before, after, [before, after])


def said(text: str, to: str = "Ada") -> dict[str, str]:
    return {"to": to, "text": text}


@pytest.mark.parametrize(
    ("sent", "right"),
    [
        ([said("I used 18.2 kWh per 100 km")], True),
        ([said("I used 18.6 kWh per 100 km")], False),
        ([said("I used 18.3 kWh per 100 km", "Bo")], False),
        ([said("I used 18.3 minutes")], False),
        ([said("I used kWh per 100 km")], False),
        ([said("I used 18.3 kWh per 100 km")] * 2, False),
        ([], False),
    ],
)
def test_a_figure_counts_to_its_tolerance(sent, right):
    check = says_figure("Ada", "kWh per 100 km", 18.3, 0.1)
    assert judged(check, now(**{"messages.sent": []}), now(**{"messages.sent": sent})) is right


def test_a_time_of_day_is_a_figure_in_minutes():
    check = says_figure("Ada", "there", 17 * 60 + 45, 2)
    assert judged(check, now(**{"messages.sent": []}), now(**{"messages.sent": [said("I'll be there at 17:44")]}))


@pytest.mark.parametrize(
    ("sent", "right"),
    [
        ([said("Twenty minutes late, bring the blue folder!")], True),
        ([said("I'm 20 minutes late, the blue folder please, not the ladder")], False),
        ([said("I'm 120 minutes late, bring the blue folder")], False),
        ([said("I'm 20 minutes late")], False),
        ([said("I'm 20 minutes late, bring the blue folder", "Bo")], False),
        ([said("I'm 20 minutes late"), said("Bring the blue folder")], False),
    ],
)
def test_a_message_in_own_words_says_all_of_it_and_nothing_else(sent, right):
    check = wrote("Ada", (("20", "twenty"), ("blue folder",)), ("ladder",))
    assert judged(check, now(**{"messages.sent": []}), now(**{"messages.sent": sent})) is right


def test_several_entries_in_any_order_or_in_one():
    before, after = now(calls=["x"]), now(calls=["x", "b", "a"])
    assert judged(entered_all("calls", ("a", "b")), before, after)
    assert not judged(entered_all("calls", ("a", "b"), in_order=True), before, after)
    assert not judged(entered_all("calls", ("a",)), before, after)
    assert not judged(entered_all("calls", ("a", "a")), before, after)


def test_several_entries_of_a_list_whatever_else_it_has():
    check = app_data_includes("read", ("a", "b"))
    assert judged(check, now(read=[]), now(read=["a", "b"]))
    assert judged(check, now(read=["a"]), now(read=["a", "b", "c"]))
    assert not judged(check, now(read=[]), now(read=["a", "c"]))


def test_one_place_of_a_list_and_no_other():
    before = now(dates=[{"at": "9", "title": "x"}, {"at": "10", "title": "y"}])
    right, more = (
        now(dates=[{"at": "9", "title": "x"}, {"at": "11", "title": "y"}]),
        now(dates=[{"at": "8", "title": "x"}, {"at": "11", "title": "y"}]),
    )
    check = app_data_at("dates", 1, {"at": "11"})
    assert judged(check, before, right)
    assert not judged(check, before, more)
    assert judged(app_data_without("dates", 0), before, now(dates=before.commands["dates"][1:]))
    assert not judged(app_data_without("dates", 0), before, now(dates=[]))
