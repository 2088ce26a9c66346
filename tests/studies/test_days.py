"""From day to day: who is advised, what is remembered, when it has settled, and what is said of it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.errors import CosimError
from automotive_cosim.run.executor import tried
from automotive_cosim.studies.days.days import (
    WEEK,
    DaysJob,
    DaysPlan,
    DaysRow,
    DaysStudy,
    StudyDay,
    has_settled,
    run_chain,
)
from automotive_cosim.studies.days.page import answer, charts, tables, warnings
from automotive_cosim.studies.equilibrium.gap import DrivenTrip, EdgeTimes

Draw = Callable[..., Path]
PLAN = DaysPlan("grid", shares=(0.0, 1.0), seeds=(0, 1))


def day(mean_s: float, **more: object) -> StudyDay:
    made = StudyDay(
        mean_s=mean_s, advised_s=None, others_s=mean_s, relative_gap=0.1, changed=5, unfinished=0, teleports=0
    )
    return replace(made, **more)  # type: ignore[arg-type]


def row(share: float | None, seed: int, *means_s: float) -> DaysRow:
    days = tuple(map(day, means_s))
    return DaysRow(id=f"{share}-{seed}", scenario="grid", share=share, seed=seed, days=days)


def study() -> DaysStudy:
    """Advised drivers come down from 200 to 150 s, to 3 % above the equilibrium."""
    down = [200.0, 180.0, 160.0, *[150.0] * 2 * WEEK]
    rows = [
        each
        for seed in (0, 1)
        for each in (
            replace(row(0.0, seed), days=(day(200.0, changed=0),)),
            row(1.0, seed, *down),
            replace(row(None, seed), days=(day(190.0), day(145.6, relative_gap=0.01), day(150.0))),
            replace(row(None, seed, 190.0, 120.0, 130.0), optimum=True),
        )
    ]
    return DaysStudy(Path(), {}, PLAN, tuple(rows))


def test_it_settles_when_a_week_is_as_the_week_before() -> None:
    assert not has_settled([100.0] * (2 * WEEK - 1))
    assert has_settled([100.0] * 2 * WEEK)
    assert not has_settled([100.0] * WEEK + [98.0] * WEEK)
    assert has_settled([100.0] * WEEK + [99.5] * WEEK)
    nobody, advised, *_ = study().rows
    assert nobody.settled == 0, "nobody changes anything"
    assert advised.settled == 12, "two even weeks after three days of change"


@pytest.mark.slow
def test_the_answer_compares_with_nobody_and_with_the_equilibrium() -> None:
    found = study()
    assert answer(found) == (
        "A trip is shortest with 100% of the drivers advised: 150 s, 25.0% less than with nobody advised, 3.0% "
        "more than in the user equilibrium and 25.0% more than in the system optimum; traffic settles by "
        "day 12, over 2 seeds."
    )
    alone = replace(found, rows=tuple(each for each in found.rows if each.share != 0.0))
    assert answer(alone).startswith("A trip takes, with 100% of the drivers advised, 150 s, 3.0% more than in the")
    (table,) = tables(found)
    assert [str(each[0]) for each in table.rows] == [
        *("0% advised", "100% advised"),
        *("user equilibrium", "system optimum"),
    ]
    assert [str(each[6]) for each in table.rows] == ["–", "−50.0", "−54.4", "−80.0"]
    assert [str(each[8]) for each in table.rows] == ["+80.0", "+30.0", "+25.6", "–"]
    assert set(charts(found)) == {"days", "shares"}
    assert warnings(found) == ["2 seeds: no interval of a mean below 10 seeds."]
    lines = list(found.lines())
    assert len(lines) == sum(len(each.days) for each in found.rows)
    assert {line["seed"] for line in lines} == {0, 1}
    assert lines[1]["mean_s"] == 200.0
    far = replace(found, rows=(*found.rows[:2], row(None, 0, 150.0), *found.rows[4:6], row(None, 1, 150.0)))
    assert any("relative gap of 10.0%, more than 2%" in each for each in warnings(far))
    restless = replace(found, rows=(*found.rows[:5], row(1.0, 1, 200.0, 100.0), found.rows[6]))
    assert any("Not settled in every seed: 100% advised" in each for each in warnings(restless))
    vain = replace(
        found, rows=tuple(replace(each, days=(day(200.0),)) if each.optimum else each for each in found.rows)
    )
    assert any(
        "optimum is not known: trips take no longer with 0% advised or with 100%" in each for each in warnings(vain)
    )
    assert "optimum" not in answer(vain)


def test_what_is_remembered_is_smoothed() -> None:
    def times(seconds: float, *edges: str) -> EdgeTimes:
        exits = tuple(10.0 + seconds * number for number in range(len(edges)))
        return EdgeTimes(dict.fromkeys("abc", 1.0), [DrivenTrip("t", "car", 0.0, edges, exits)])

    memory = times(100.0, "a", "b").blended(times(200.0, "a", "b", "c"), 0.75)
    assert memory.at("b", 0) == pytest.approx(0.75 * 100 + 0.25 * 200)
    assert memory.at("c", 0) == pytest.approx(200.0), "what was never driven before is taken as it is"


CARS = """<routes>
    <vType id="car" vClass="passenger" sigma="0" speedFactor="1" speedDev="0"/>
    <vType id="lorry" vClass="truck" maxSpeed="2" sigma="0" speedFactor="1" speedDev="0"/>
    <route id="main" edges="access main exit"/>
    <route id="slowly" edges="main leave"/>
    <flow id="lorries" type="lorry" route="slowly" begin="0" end="900" period="60" departPos="100"/>
    <flow id="cars" type="car" route="main" begin="0" end="900" period="20" departSpeed="max"/>
</routes>"""


def test_advised_drivers_learn_the_way_around_lorries(two_ways: Draw) -> None:
    plan = DaysPlan(str(two_ways(CARS)), compliance=1.0, memory=0.0, days=2, minutes=5.0, warm_up_s=300.0)
    half, nobody = (run_chain(DaysJob(plan, share, 0), Path()) for share in (0.5, 0.0))
    assert half.error is None, half.error
    first, second = half.days[:2]
    assert first.changed > 0
    assert first.advised_s is not None
    assert second.advised_s is not None
    assert second.advised_s < first.advised_s - 100, "from behind lorries at 2 m/s to the free way"
    assert second.relative_gap < first.relative_gap
    assert [each.changed for each in nobody.days] == [0]
    assert nobody.days[0].mean_s == pytest.approx(first.mean_s), "the first day is the same for all shares"


def test_an_adviser_of_ones_own_is_followed_and_its_faults_are_told(
    two_ways: Draw, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "advisers.py").write_text(ADVISERS, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    plan = DaysPlan(str(two_ways(CARS)), compliance=1.0, memory=0.0, days=2, minutes=5.0, warm_up_s=300.0)

    def days(adviser: str) -> DaysRow:
        own = replace(plan, adviser=f"advisers:{adviser}")
        own.check()
        return tried(run_chain)(DaysJob(own, 1.0, 0), Path())

    stays = days("Stays")
    assert stays.error is None, stays.error
    assert [each.changed for each in stays.days] == [0, 0, 0], "it may change its mind on any day"
    leads = days("Leads")
    assert leads.error is None, leads.error
    assert leads.days[0].changed > 0
    assert leads.days[1].mean_s < leads.days[0].mean_s - 100
    for adviser, told in [
        ("Strays", "does not lead from 'access'"),
        ("Jumps", "has no way from 'access' to 'exit'"),
        ("Dreams", "'nobody', which is no trip of day.trips"),
        ("Fails", "raised ZeroDivisionError"),
    ]:
        assert told in str(days(adviser).error), adviser
    for adviser, told in [
        ("Mute", r"lacks advise\(day\)"),
        ("Missing", "has no Missing"),
        ("Raw", "raised TypeError"),
    ]:
        with pytest.raises(CosimError, match=told):
            days(adviser)


ADVISERS = """
class Stays:
    def __init__(self, seed): ...
    def advise(self, day):
        return {trip.id: trip.edges for trip in day.trips}

class Leads(Stays):
    def advise(self, day):
        return {name: list(way) for name, way in day.quickest.items()}

class Strays(Stays):
    def advise(self, day):
        return {trip.id: ["main"] for trip in day.trips}

class Jumps(Stays):
    def advise(self, day):
        return {trip.id: ["access", "exit"] for trip in day.trips}

class Dreams(Stays):
    def advise(self, day):
        return {"nobody": ["access", "exit"]}

class Fails(Stays):
    def advise(self, day):
        return 1 / 0

class Mute:
    def __init__(self, seed): ...

class Raw:
    def advise(self, day): ...
"""
