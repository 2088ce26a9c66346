"""Containers divide a box without remainder, gap or overlap."""

from itertools import pairwise

import pytest

from automotive_cosim.cockpit.controls import BY_UNIT, CHOICES, CONTROLS
from automotive_cosim.cockpit.flow import BlockItem, card, fill, grid, line, natural, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.signals import CATALOGUE, LeafKind
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.widgets import Button, Card, Tile

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


def test_parts_stand_as_high_as_they_are_and_share_what_is_left() -> None:
    tile, button, low = Tile(icon=Icon.AUTO), Button(), Button()
    found = fill(Rect(0, 0, 200, 400), card(tile, 10, (REST, button), line((50, low), 5), padding=(20, 30)))
    assert [type(each) for each in found] == [Card]
    assert found[0].children == (tile, button, low)
    assert [each.rect for each in (found[0], tile, button, low)] == [
        Rect(0, 0, 200, 400),
        Rect(20, 30, 160, 60),
        Rect(20, 100, 160, 198),
        Rect(20, 298, 50, 72),
    ]
    with pytest.raises(ValueError, match="fit"):
        fill(Rect(0, 0, 200, 59), stack(Tile(icon=Icon.AUTO)))


@pytest.mark.parametrize(
    ("items", "height"),
    [((Button(), 8, Tile(icon=Icon.AUTO)), 140), ((Button(), REST), REST), ((grid(2, 10, *[Button()] * 3),), 154)],
)
def test_the_height_of_a_stack_is_that_of_its_parts(items: tuple[BlockItem, ...], height: int | None) -> None:
    assert natural(stack(*items)) == height


def test_every_switch_and_number_has_a_name_and_every_number_words() -> None:
    """A signal without them is commanded by other words: the lights by their switch, the source by its list."""
    actuators = {signal for signal in CATALOGUE.values() if signal.kind is LeafKind.ACTUATOR}
    named = CONTROLS.keys() | CHOICES.keys()
    assert named <= actuators
    assert {signal.path.removeprefix("Vehicle.") for signal in actuators - named} == {
        "Body.Lights.Parking.IsOn",
        "Cabin.Infotainment.HMI.CurrentLanguage",
        "Cabin.Infotainment.HMI.DayNightMode",
        "Cabin.Infotainment.HMI.IsDayNightAuto",
        "Cabin.Infotainment.Media.Action",
        "Cabin.Infotainment.Media.SelectedURI",
    }
    assert all(set(values) == set(signal.allowed) for signal, (_, values) in CHOICES.items())
    keys = [control.key for control in CONTROLS.values()] + [key for key, _ in CHOICES.values()]
    assert len(keys) == len(set(keys))
    numbers = [signal for signal in CONTROLS if isinstance(signal.default, float)]
    assert {signal.unit for signal in numbers if CONTROLS[signal].shown is None} <= BY_UNIT.keys()
