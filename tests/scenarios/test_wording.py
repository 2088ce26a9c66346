"""Incidents in one line."""

from dataclasses import replace

import pytest

from automotive_cosim.errors import CosimError, UnknownNameError
from automotive_cosim.formats.incidents import Breakdown, Closure, Incident, Jam
from automotive_cosim.scenarios import load
from automotive_cosim.scenarios.wording import KINDS, read_line


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("breakdown edge=7 position_m=12 aside=true", Breakdown(edge="7", position_m=12.0, aside=True)),
        ("jam edges=a,b length_m=200 from_s=-30 trip=", Jam(edges=("a", "b"), length_m=200.0, from_s=-30.0)),
        ("jam edge=a length_m=200", Jam(edges=("a",), length_m=200.0)),
        ("closure edges=a", Closure(edge="a")),
    ],
)
def test_a_line_is_the_table_it_stands_for(text: str, expected: Incident) -> None:
    assert read_line(text, KINDS, "--incident") == expected


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "no kind in --incident named ''"),
        ("jm edges=a", "did you mean 'jam'?"),
        ("jam edges=a", "--incident lacks 'length_m'"),
        ("jam edges=a length_m=far", "length_m is 'far'; it must be a number above 0"),
        ("closure edge", "give fields as name=value"),
        ("closure edge=a from_s=10 to_s=4", "is not before"),
        ("closure edge=a lenght_m=4", "'lenght_m'"),
    ],
)
def test_what_is_none_is_refused_in_a_line(text: str, told: str) -> None:
    with pytest.raises(CosimError) as refused:
        read_line(text, KINDS, "--incident")
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


LONG = "avenue-rené-descartes-to-rue-péguy"


@pytest.mark.parametrize("wanted", ["2", "avenue-rene", "AVENUE-RENÉ-DESCARTES-to", LONG])
def test_a_trip_is_found_by_number_and_by_the_beginning_of_its_name(wanted: str) -> None:
    grid = load("grid")
    trips = tuple(replace(grid.ego.trips[0], name=each) for each in ("avenue", LONG, "avenue-de-la-paix"))
    found = replace(grid, ego=replace(grid.ego, trips=trips))
    assert found.trip(wanted).name == LONG
    assert found.trip("avenue").name == "avenue", "a whole name is one name, whatever others begin so"
    for unclear in ("aven", "avenue-", "0", "4", "", "paix"):
        with pytest.raises(UnknownNameError):
            found.trip(unclear)
