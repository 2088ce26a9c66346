"""Containers divide a box without remainder, gap or overlap."""

from __future__ import annotations

from itertools import pairwise

import pytest

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row

BOX = Rect(10, 20, 101, 203)


@pytest.mark.parametrize("parts", [(REST,), (40, REST, 8), (REST, 7, REST, REST), (101, REST), (0, REST, 0)])
def test_the_parts_fill_the_box_in_their_order(parts: tuple[int | None, ...]) -> None:
    across, down = row(BOX, *parts), column(BOX, *parts)
    assert across[0].x == BOX.x
    assert across[-1].right == BOX.right
    assert all(one.right == other.x for one, other in pairwise(across))
    assert all(one.bottom == other.y for one, other in pairwise(down))
    assert down[-1].bottom == BOX.bottom
    assert {(each.y, each.height) for each in across} == {(BOX.y, BOX.height)}
    assert {(each.x, each.width) for each in down} == {(BOX.x, BOX.width)}
    for part, box in zip(parts, across, strict=True):
        assert part is REST or box.width == part
    rest = [box.width for part, box in zip(parts, across, strict=True) if part is REST]
    assert max(rest) - min(rest) <= 1


def test_parts_may_leave_something_but_not_exceed_the_box() -> None:
    assert column(BOX, 40, 8) == (Rect(10, 20, 101, 40), Rect(10, 60, 101, 8))
    with pytest.raises(ValueError, match="102 pixels do not fit into 101"):
        row(BOX, 100, 2)
