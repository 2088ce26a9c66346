"""Water that an extract cuts: which side of a shore is wet."""

import pytest
from shapely import Point, union_all

from automotive_cosim.osm.shores import closed_water, cut_water

Line = list[tuple[float, float]]

STREETS: list[Line] = [[(0.1 * n, 0.0), (0.1 * n, 0.4)] for n in range(11)] + [
    [(0.0, y), (1.0, y)] for y in (0.0, 0.4)
]
"""South of the river, with two bridges and a road in the north."""
BRIDGES: list[Line] = [[(x, 0.4), (x, 0.8)] for x in (0.3, 0.7)] + [[(0.0, 0.8), (1.0, 0.8)]]
ROADS = [*STREETS, *BRIDGES, [(0.0, 1.0), (1.0, 1.0)]]
SOUTH, NORTH = [(-0.5, 0.5), (0.4, 0.52), (1.5, 0.5)], [(-0.5, 0.7), (1.5, 0.7)]
ISLAND = [(0.4, 0.58), (0.6, 0.58), (0.6, 0.64), (0.4, 0.64), (0.4, 0.58)]


def wet(shores: list[Line], x: float, y: float, roads: list[Line] = ROADS) -> bool:
    return union_all(cut_water(shores, roads)).contains(Point(x, y))


def test_a_river_is_between_its_banks_but_for_its_islands() -> None:
    shores = [SOUTH, NORTH, ISLAND]
    assert [wet(shores, 0.1, y) for y in (0.2, 0.6, 0.9)] == [False, True, False]
    assert not wet(shores, 0.5, 0.6)
    assert wet(shores, 0.5, 0.55)


@pytest.mark.parametrize("piece", [1, 2])
def test_a_shore_may_come_in_pieces_either_way_round(piece: int) -> None:
    pieces = [SOUTH[: piece + 1], SOUTH[piece:][::-1], NORTH[::-1]]
    assert wet([part for part in pieces if len(part) > 1], 0.1, 0.6)


def test_the_sea_is_where_no_roads_are() -> None:
    coast = [(-0.5, 0.45), (0.5, 0.42), (1.5, 0.45)]
    roads = [*STREETS, [(0.5, 0.4), (0.5, 1.0)]]
    assert wet([coast], 0.2, 0.8, roads)
    assert not wet([coast], 0.2, 0.2, roads)


def test_a_shore_that_ends_within_tells_nothing() -> None:
    assert cut_water([[(0.3, 0.5), (1.5, 0.5)]], ROADS) == []
    assert cut_water([[(2.0, 0.5), (3.0, 0.5)]], ROADS) == []
    assert cut_water([], ROADS) == []
    assert cut_water([SOUTH], []) == []


def test_streets_on_both_sides_leave_open_which_is_water() -> None:
    middle = [(-0.5, 0.5), (1.5, 0.5)]
    both = [*STREETS, *([(x, 1.0 - y) for x, y in street] for street in STREETS)]
    assert cut_water([middle], both) == []


def test_roads_may_reach_farther_than_the_shores_are_known() -> None:
    far = [*ROADS, *ROADS, [(-3.0, 0.0), (0.0, 0.0)]]
    assert wet([SOUTH, NORTH], 0.1, 0.6, far)


LAKE = [(0.2, 0.1), (0.8, 0.1), (0.8, 0.3), (0.2, 0.3), (0.2, 0.1)]
"""Where no street is, but for one."""
STREET: list[Line] = [[(0.5, 0.0), (0.5, 0.4)]]


@pytest.mark.parametrize(
    ("known", "inside", "beyond"),
    [
        ([LAKE], (0.7, 0.2), (0.9, 0.2)),
        ([LAKE[:3]], (0.7, 0.2), (0.3, 0.25)),
        ([LAKE[:2], LAKE[2:]], (0.7, 0.2), (0.9, 0.2)),
        ([LAKE[3:], LAKE[:2]], (0.3, 0.15), (0.7, 0.25)),
        ([LAKE[:2]], None, (0.7, 0.1)),
        ([], None, (0.7, 0.2)),
    ],
)
def test_what_is_known_of_a_lake_is_closed_by_straight_lines(
    known: list[Line], inside: tuple[float, float] | None, beyond: tuple[float, float]
) -> None:
    water = union_all(closed_water(known, [], STREET))
    assert inside is None or water.contains(Point(inside))
    assert not water.contains(Point(beyond))


def test_an_island_of_a_cut_lake_is_land_and_no_town_is_a_lake() -> None:
    island = [(0.6, 0.12), (0.65, 0.12), (0.65, 0.15), (0.6, 0.12)]
    assert not union_all(closed_water([LAKE[:4]], [island], STREET)).contains(Point(0.64, 0.125))
    assert closed_water([LAKE], [], [[(0.1 * n, 0.0), (0.1 * n, 0.4)] for n in range(11)]) == []
