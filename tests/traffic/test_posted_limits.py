"""Limits that hold at certain hours: read as the map writes them, and followed by the road, the car and its map."""

import re
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from datetime import datetime, time, timedelta
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from automotive_cosim.contracts import KMH_PER_MPS, EgoEnd, LimitSource
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan, Traffic
from automotive_cosim.traffic.detours import Detours
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.posted_limits import (
    in_force,
    is_open,
    is_understood,
    names_holidays,
    read_hours,
    sign_mps,
    timed_access,
    timed_limits,
)
from tests.laws import over

Edit = Callable[[Path], None]
Variant = Callable[[Edit], Scenario]

SCHOOL = "30 @ (Mo-Fr 08:00-08:31,14:30-16:00; SH off; PH off)"
MONDAY = datetime(2026, 3, 9)
DAYS = ("Mo", "Tu", "We", "Th", "Fr", "Sa", "Su")


def at(day: int, clock: str) -> datetime:
    """An instant of the week, 1 is Monday."""
    return datetime.combine(MONDAY + timedelta(days=day - 1), time.fromisoformat(clock))


@pytest.mark.parametrize(
    ("sign", "kmh"), [("50", 50), ("50 km/h", 50), ("20 mph", 32.187), ("7.5", 7.5), ("none", None)]
)
def test_signs(sign: str, kmh: float | None) -> None:
    assert sign_mps(sign) == (None if kmh is None else pytest.approx(kmh / 3.6, rel=1e-4))


@pytest.mark.parametrize("sign", ["", "fast", "-30", "nan", "inf", "1e9", "30 knots", "50;70"])
def test_what_is_no_sign(sign: str) -> None:
    with pytest.raises(ValueError, match="is not a maxspeed"):
        sign_mps(sign)


@pytest.mark.parametrize(
    ("conditional", "words"),
    [
        (SCHOOL, ["30 km/h Mo-Fr 08:00-08:31, 14:30-16:00"]),
        ("20 mph @ (Mo,We 7:30-16:00)", ["20 mph Mo, We 7:30-16:00"]),
        ("30 @ (22:00-06:00)", ["30 km/h 22:00-06:00"]),
        ("none @ (19:00-07:00); 80 @ wet", ["no limit 19:00-07:00", "80 km/h when wet"]),
        ("30 @ (Sa 10:00-12:00; Su)", ["30 km/h Sa 10:00-12:00", "30 km/h Su"]),
        ("80 @ (wet)", ["80 km/h when wet"]),
        ("60 @ (22:00-06:00 AND wet)", ["60 km/h 22:00-06:00 when wet"]),
        ("60 @ (snow)", ["60 km/h in snow"]),
        ("60 @ (wet AND snow)", []),
        ("30mph @ (22:00-06:00)", ["30 mph 22:00-06:00"]),
        ("walk @ (10:00-18:00)", ["walking pace 10:00-18:00"]),
        ("30 @ 24/7", ["30 km/h"]),
        ("30 @ (Mo-Fr 07:00-17:00, Sa 08:00-12:00)", ["30 km/h Mo-Fr 07:00-17:00", "30 km/h Sa 08:00-12:00"]),
        ("30 @ (07:00-17:00; Sa,Su off)", ["30 km/h 07:00-17:00 but Sa,Su"]),
        ("110 @ Apr-Oct", ["110 km/h Apr-Oct"]),
        ("80 @ (Nov 15-Mar 15 20:00-06:00)", ["80 km/h Nov 15-Mar 15 20:00-06:00"]),
        ("80 @ (Nov 40-Mar)", []),
        ("30 @ (May-Sep 09:00-18:00)", ["30 km/h May-Sep 09:00-18:00"]),
        ("30 @ (May-Sep: 09:00-18:00)", ["30 km/h May-Sep 09:00-18:00"]),
        ("30 @ (week 10-20 Mo-Fr 08:00-18:00)", ["30 km/h week 10-20 Mo-Fr 08:00-18:00"]),
        ("30 @ (week 60)", []),
        ("30 @ (Sa,Su,PH 10:00-12:00)", ["30 km/h Sa, Su 10:00-12:00"]),
        ("30 @ (PH 10:00-12:00)", []),
        ("30 @ (Mo-Fr 08:00-16:00; Jul-Aug off)", ["30 km/h Mo-Fr 08:00-16:00 but Jul-Aug"]),
        ("60 @ (weight>7.5)", []),
        ("20 mph @ children_present", []),
        ("30 @ (sunset-sunrise)", []),
        ("30 @ (25:00-26:00)", []),
        ("", []),
    ],
)
def test_hours_in_words(conditional: str, words: list[str]) -> None:
    limits, unread = timed_limits(conditional)
    assert [limit.text for limit in limits] == words
    assert bool(unread) == (conditional.count("@") != len({limit.limit_mps for limit in limits}))


def test_nothing_is_lost_in_silence() -> None:
    """What is neither understood nor told as not understood would be a sign that vanished."""
    rng = np.random.default_rng(0)
    parts = ("40 @ (Mo-Fr 08:00-09:00)", "80 @ wet", "rubbish", "@", "50 @ ()", "30 @ (22:00-06:00)", "(", ";;")
    for _ in range(300):
        chosen = [parts[index] for index in rng.integers(0, len(parts), int(rng.integers(1, 4)))]
        limits, unread = timed_limits("; ".join(chosen))
        assert limits or unread or set(chosen) <= {";;"}, chosen


@pytest.mark.parametrize(
    ("instant", "holds"),
    [
        (at(1, "07:59:59"), False),
        (at(1, "08:00"), True),
        (at(5, "08:30:59"), True),
        (at(5, "08:31"), False),
        (at(3, "15:59"), True),
        (at(6, "08:10"), False),
        (at(7, "15:00"), False),
    ],
)
def test_school_hours(instant: datetime, holds: bool) -> None:
    assert (in_force(timed_limits(SCHOOL)[0], instant) is not None) == holds


def test_a_span_past_midnight_belongs_to_the_day_it_begins_on() -> None:
    limits, _ = timed_limits("30 @ (Fr 22:00-06:00)")
    assert [
        bool(in_force(limits, at(day, clock))) for day, clock in [(5, "21:59"), (5, "23:00"), (6, "05:59")]
    ] == [False, True, True]
    assert not in_force(limits, at(5, "03:00")), "Thursday's night is not meant"
    assert not in_force(limits, at(6, "06:00"))


CLOCK = (
    # a season before a time, with and without a colon
    ("May-Sep 09:00-18:00", "2026-07-01T12:00 2026-09-30T17:59", "2026-11-01T12:00 2026-07-01T08:59"),
    ("May-Sep: 09:00-18:00", "2026-07-01T12:00 2026-09-30T17:59", "2026-11-01T12:00 2026-07-01T08:59"),
    ("Nov-Mar 22:00-06:00", "2026-12-01T23:00 2026-04-01T05:00", "2026-11-01T05:00 2026-07-01T23:00"),
    ("Nov 9:00-10:00", "2026-11-09T09:30", "2026-11-09T11:00 2026-12-01T09:30"),
    # the night of the last day belongs to that day, and the night before the first does not
    ("Apr 01-Oct 31 22:00-06:00", "2026-11-01T02:00 2026-04-01T22:00", "2026-04-01T02:00 2026-11-01T22:00"),
    ("Apr-Oct 22:00-06:00", "2026-11-01T02:00", "2026-04-01T02:00"),
    ("Dec 31 22:00-06:00", "2027-01-01T02:00", "2026-12-31T02:00 2027-01-01T22:00"),
    ("Feb 22:00-06:00", "2026-03-01T05:59 2028-02-29T23:00", "2026-02-01T05:59"),
    ("Fr[1] 22:00-06:00", "2026-08-08T02:00", "2026-08-07T02:00 2026-08-15T02:00"),
    # over New Year
    ("Dec 24-Jan 02 10:00-12:00", "2026-12-24T10:00 2027-01-02T11:59", "2026-12-23T11:00 2027-01-03T11:00"),
    ("Dec 24-Jan 02: 22:00-06:00", "2027-01-03T05:00", "2026-12-24T05:00"),
    ("Nov 15-Mar 15", "2026-11-15T00:00 2026-03-15T23:59", "2026-03-16T00:00 2026-11-14T23:59"),
    # weeks of the year
    ("week 1-10 Mo-Fr 08:00-18:00", "2026-01-02T09:00 2026-03-06T09:00", "2026-03-09T09:00 2026-01-03T09:00"),
    ("week 53", "2027-01-03T12:00 2026-12-28T12:00", "2027-01-04T12:00"),
    ("week 1-53/2", "2026-01-12T12:00", "2026-01-05T12:00"),
    # parts of the year in which it does not hold
    ("Mo-Fr 08:00-16:00; Jul-Aug off", "2026-06-30T09:00", "2026-07-01T09:00 2026-08-31T09:00"),
    ("22:00-06:00; Dec 24-Jan 02 off", "2026-12-23T23:00 2027-01-03T05:00", "2026-12-24T05:00 2026-12-24T22:00"),
    # holidays have no calendar
    ("Sa,Su,PH 08:00-20:00", "2026-12-26T09:00", "2026-12-25T09:00"),
)
"""Conditions, instants at which they hold, and at which they do not."""


@over(CLOCK)
def test_seasons_weeks_and_nights(condition: str, holds: str, not_then: str) -> None:
    limits, unread = timed_limits(f"30 @ ({condition})")
    assert not unread
    for instants, wanted in ((holds, True), (not_then, False)):
        for instant in map(datetime.fromisoformat, instants.split()):
            assert (in_force(limits, instant) is not None) is wanted, instant


def test_a_week_as_a_whole_is_what_the_days_say() -> None:
    """Every hour of a week for every run of days, against plain arithmetic."""
    for first in range(7):
        for last in range(7):
            limits, unread = timed_limits(f"30 @ ({DAYS[first]}-{DAYS[last]} 06:00-22:00)")
            assert not unread
            meant = {(first + step) % 7 for step in range((last - first) % 7 + 1)}
            for hour in range(7 * 24):
                instant = MONDAY + timedelta(hours=hour)
                assert (in_force(limits, instant) is not None) == (hour // 24 in meant and 6 <= hour % 24 < 22), (
                    first,
                    last,
                    instant,
                )


@pytest.mark.parametrize(
    ("conditional", "held"),
    [
        ("110 @ Apr-Oct", {4, 5, 6, 7, 8, 9, 10}),
        ("110 @ Oct-Apr", {10, 11, 12, 1, 2, 3, 4}),
        ("110 @ May", {5}),
        ("110 @ Nov 15-Mar 9", {12, 1, 2}),
        ("110 @ 24/7", set(range(1, 13))),
    ],
)
def test_months_and_dates(conditional: str, held: set[int]) -> None:
    limits, _ = timed_limits(conditional)
    assert {month for month in range(1, 13) if in_force(limits, datetime(2026, month, 10, 12))} == held


def test_the_weather_decides_where_the_sign_says_so() -> None:
    limits, _ = timed_limits("110 @ wet; 50 @ snow; 90 @ (22:00-06:00 AND wet)")
    for weather, clock, kmh in (
        ("", "12:00", None),
        ("wet", "12:00", 110),
        ("snow", "23:00", 50),
        ("wet", "23:00", 90),
    ):
        held = in_force(limits, at(1, clock), weather)
        assert (held and round((held.limit_mps or 0) * KMH_PER_MPS)) == kmh


def test_days_off_are_taken_from_the_week() -> None:
    limits, _ = timed_limits("30 @ (07:00-17:00; Sa,Su off)")
    assert [bool(in_force(limits, at(day, "12:00"))) for day in range(1, 8)] == [True] * 5 + [False] * 2


def test_the_first_sunday_of_the_month_by_season() -> None:
    """As on an avenue in Paris that is closed to cars then; every instant of a year."""
    closed = timed_access("no @ (Jan-Mar,Oct-Dec Su[1] 10:00-17:00; Apr-Sep Su[1] 11:00-18:00)")
    shut = [
        day
        for day in (datetime(2026, 1, 1, 17, 30) + timedelta(days=number) for number in range(365))
        if not is_open(closed, day)
    ]
    assert [(day.month, day.isoweekday(), day.day <= 7) for day in shut] == [
        (month, 7, True) for month in range(4, 10)
    ]
    assert not is_open(closed, datetime(2026, 11, 1, 10, 0))
    assert is_open(closed, datetime(2026, 11, 8, 10, 0))
    spaced, plain = "no @ (We 06:30 - 14:30; Sa 06:30 – 14:30)", "no @ (We 06:30-14:30; Sa 06:30-14:30)"
    assert timed_access(spaced) == timed_access(plain) != ()
    (last,) = timed_access("no @ (Fr[-1] 22:00-06:00)")
    assert [last.hours.holds(datetime(2026, 10, day, 23)) for day in (23, 30)] == [False, True]
    assert last.hours.holds(datetime(2026, 10, 31, 5))
    assert not timed_access("no @ (Mo-Fr[1] 08:00-09:00)")


def test_of_several_the_last_written_holds() -> None:
    limits, _ = timed_limits("80 @ (06:00-20:00); 60 @ (08:00-09:00)")
    held = in_force(limits, at(2, "08:30"))
    assert held is not None
    assert held.limit_mps == pytest.approx(60 / 3.6)


# --- on the road ------------------------------------------------------------------------------------------


@pytest.fixture
def school(sumo: None, variant: Variant) -> Iterator[Forked]:
    """The grid with a school zone on the middle of its avenue."""

    def edit(folder: Path) -> None:
        edges = folder / "grid.edg.xml"
        text = edges.read_text()
        start = text.index('<edge id="c1c2"')
        end = text.index("</edge>", start)
        zone = f'<param key="hazard" value="school_zone"/><param key="maxspeed:conditional" value="{SCHOOL}"/>'
        edges.write_text(text[:end] + zone + text[end:])
        built, printed = sumo_programs.run(
            "netconvert", ["-n", folder / "grid.nod.xml", "-e", edges, "--proj.utm", "-o", folder / "grid.net.xml"]
        )
        assert built, printed
        (folder / "grid.rou.xml").write_text("<routes/>")

    with closing(Forked(variant(edit), seed=1)) as simulation:
        yield simulation


def test_the_posted_limit_follows_the_clock_of_the_drive(school: Forked, grid: Scenario) -> None:
    tuesday = grid.start
    plan = EgoPlan(grid.trip("avenue"), "average", seed=1)
    seen = {}
    for name, start in {
        "school": tuesday,
        "evening": tuesday.replace(hour=20),
        "saturday": tuesday + timedelta(days=4),
    }.items():
        with closing(school.depart(replace(plan, start=start.replace(minute=0)))) as traffic:
            states = traffic.advance(300.0).states
        inside = [state.road for state in states if state.road.edge_id == "c1c2"]
        assert inside
        assert all(road.school_zone and road.limit.source is LimitSource.POSTED for road in inside)
        assert {road.limit_hours for road in inside} == {"30 km/h Mo-Fr 08:00-08:31, 14:30-16:00"}
        before = next(state for state in states if state.road.edge_id == "c0c1")
        limits = {round((road.limit.mps or 0) * KMH_PER_MPS) for road in inside}
        warned = before.ahead.next_limit is not None
        fastest_kmh = max(state.speed_mps for state in states if state.road.edge_id == "c1c2") * KMH_PER_MPS
        behind = [state for state in states if state.road.edge_id.startswith(":c2")]
        across_kmh = max(state.speed_mps for state in behind) * KMH_PER_MPS
        assert {round((state.road.limit.mps or 0) * KMH_PER_MPS) for state in behind} == limits
        assert across_kmh < 40 or limits == {50}, "the sign counts across the junction"
        seen[name] = limits, {road.limit_by_clock for road in inside}, warned, fastest_kmh > 40
    assert seen == {
        "school": ({30}, {True}, True, False),
        "evening": ({50}, {False}, False, True),
        "saturday": ({50}, {False}, False, True),
    }


def seconds_to_school(traffic: Traffic) -> float:
    """Drives to where the zone's limit holds; returns the simulated seconds since the first step."""
    begun_s = traffic.advance(0.1).states[0].time_s
    while not traffic.state.road.limit_by_clock:
        assert traffic.advance(0.1).states
    return traffic.state.time_s - begun_s


def test_a_limit_ends_while_the_car_is_in_it(school: Forked, grid: Scenario) -> None:
    """At 8:31 the sign goes dark: the ego sees it within a second and drives on at 50; a branch sees the same."""
    plan = EgoPlan(grid.trip("avenue"), "average", seed=1)
    with closing(school.depart(plan)) as traffic:
        way_s = seconds_to_school(traffic)
    start = grid.start.replace(hour=8, minute=31) - timedelta(seconds=way_s + 6)
    with closing(school.depart(replace(plan, start=start))) as traffic:
        seconds_to_school(traffic)
        with closing(traffic.branch()) as branch:
            states = traffic.advance(60.0).states
            assert branch.advance(60.0).states == states
    inside = [state for state in states if state.road.edge_id == "c1c2"]
    by_clock = [state for state in inside if state.road.limit_by_clock]
    assert 0 < len(by_clock) < len(inside)
    assert by_clock[-1].time_s - states[0].time_s == pytest.approx(6.0, abs=1.1)
    assert inside[-1].road.limit_hours
    assert not inside[-1].road.limit_by_clock
    assert inside[-1].speed_mps > by_clock[-1].speed_mps


@pytest.fixture
def shut(sumo: None, variant: Variant) -> Iterator[Forked]:
    """The grid, whose avenue is closed in its middle from 8 to 9, and barred to those who drive on from 7 to 8."""

    def edit(folder: Path) -> None:
        edges = folder / "grid.edg.xml"
        text = edges.read_text().replace('<edge id="nwn0"', '<edge id="nwn0" disallow="tram"', 1)
        for edge, param in (
            ("c1c2", '<param key="access:conditional" value="no @ (Mo-Fr 08:00-09:00)"/>'),
            ("c2c3", '<param key="restriction:conditional:c3c4" value="no @ (Mo-Fr 07:00-08:00)"/>'),
        ):
            end = text.index("</edge>", text.index(f'<edge id="{edge}"'))
            text = text[:end] + param + text[end:]
        edges.write_text(text)
        built, printed = sumo_programs.run(
            "netconvert", ["-n", folder / "grid.nod.xml", "-e", edges, "--proj.utm", "-o", folder / "grid.net.xml"]
        )
        assert built, printed

    with closing(Forked(variant(edit), seed=1)) as simulation:
        yield simulation


def test_roads_and_turns_are_closed_at_the_hours_of_the_drive(shut: Forked, grid: Scenario) -> None:
    tuesday, driven = grid.start, {}
    for hour in (7, 8, 9):
        plan = EgoPlan(grid.trip("avenue"), "average", seed=3, start=tuesday.replace(hour=hour, minute=20))
        with closing(shut.depart(plan)) as traffic:
            states = traffic.advance(600.0).states
        assert states[-1].end is EgoEnd.ARRIVED
        driven[hour] = [edge for edge in dict.fromkeys(state.road.edge_id for state in states) if edge[0] != ":"]
    assert driven[9] == ["cwc0", "c0c1", "c1c2", "c2c3", "c3c4", "c4ce"]
    assert "c1c2" not in driven[8]
    assert ("c2c3", "c3c4") not in pairwise(driven[7])


def test_who_stands_on_a_road_that_has_closed_drives_on() -> None:
    """Also if the next road is closed, too: from the first, SUMO searches no way."""

    def refuses(*_: object) -> None:
        raise RuntimeError("not allowed to depart on any lane")

    sumo = SimpleNamespace(
        refusals=(RuntimeError,),
        vehicle=SimpleNamespace(isRouteValid=lambda vehicle: False),
        reroute=refuses,
        find_route=refuses,
        route=lambda vehicle: ("a", "b"),
        route_index=lambda vehicle: 0,
        type_of=lambda vehicle: "car",
    )
    network = SimpleNamespace(crossings={"a": {"b": ()}})
    detours = Detours(sumo, network)  # type: ignore[arg-type]
    detours.follow(frozenset({"a", "b"}), frozenset())
    detours.send_round("other")
    assert detours.cut_short == 0


PAGE = Path(__file__).parents[2] / "docs" / "reference" / "scenarios.md"
BESIDE = re.findall(
    r"^\| `([^`]+)` \| (\d{4}-[\d-]+ [\d:]+) \| (\w+) \| (\w+) \| (\w+) \|$", PAGE.read_text("utf-8"), re.MULTILINE
)
"""Conditions beside two libraries of opening hours: an instant, what each says of it, and the page's word."""


@over(BESIDE)
def test_hours_are_as_other_libraries_read_them_or_listed(
    condition: str, at: str, one: str, other: str, here: str
) -> None:
    assert is_understood(condition) is (here != "listed")
    if here != "listed":
        assert any(hours.holds(datetime.fromisoformat(at)) for hours in read_hours(condition)) is (here == "yes")
        assert here in (one, other) or names_holidays(condition), "a holiday is listed anyway"
