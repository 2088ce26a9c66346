"""Cars that take the ego's other way: where it parts and rejoins, and whose routes can take it."""

import pytest

from automotive_cosim.studies.calls.divert import diverted, section

OLD = ("a", "b", "c", "d", "e")


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        (("a", "b", "x", "y", "d", "e"), (("b", "c", "d"), ("b", "x", "y", "d"))),
        (("a", "x", "e"), (("a", "b", "c", "d", "e"), ("a", "x", "e"))),
        (("a", "b", "x"), ((), ())),
        (("x", "c", "d", "e"), ((), ())),
        (OLD, ((), ())),
    ],
)
def test_the_section_lies_between_edges_in_common(
    new: tuple[str, ...], expected: tuple[tuple[str, ...], tuple[str, ...]]
) -> None:
    assert section(OLD, new) == expected


@pytest.mark.parametrize(
    ("route", "expected"),
    [
        (("z", "b", "c", "d", "w"), ("z", "b", "x", "y", "d", "w")),
        (("b", "q", "d"), ("b", "x", "y", "d")),
        (("c", "d", "e"), None),
        (("b", "c"), None),
        (("d", "b", "c"), None),
        (("b", "x", "y", "d", "e"), None),
    ],
)
def test_a_route_takes_the_other_way_only_if_it_passes_both_ends(
    route: tuple[str, ...], expected: tuple[str, ...] | None
) -> None:
    assert diverted(route, ("b", "c", "d"), ("b", "x", "y", "d")) == expected
