"""Photos: they show what they are of, and no list of elements tells it."""

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.phone.state import Contact, Thread
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.photos import Photo, Shows, photo
from automotive_cosim.cockpit.signals import MOTION
from automotive_cosim.contracts import Element, FeedbackCode, RoadNetwork
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.episode.situation import PARKED

from .conftest import outside

KINDS = {
    Shows.ZONE: (Photo(Shows.ZONE, "A"), Photo(Shows.ZONE, "B"), Photo(Shows.ZONE, "A", struck=True)),
    Shows.CLOCK: (Photo(Shows.CLOCK, "15:45"), Photo(Shows.CLOCK, "16:45")),
    Shows.SEAT: (
        Photo(Shows.SEAT, "rear left"),
        Photo(Shows.SEAT, "driver"),
        Photo(Shows.SEAT, "driver", struck=True),
    ),
    Shows.WARMTH: (Photo(Shows.WARMTH, 19.0, "C"), Photo(Shows.WARMTH, 19.5, "C"), Photo(Shows.WARMTH, 66, "F")),
    Shows.PRESSURE: (Photo(Shows.PRESSURE, 2.3, "bar"), Photo(Shows.PRESSURE, 34, "psi")),
    Shows.LIMIT: (Photo(Shows.LIMIT, 30), Photo(Shows.LIMIT, 30, "mph"), Photo(Shows.LIMIT, 50)),
    Shows.BENCH: (Photo(Shows.BENCH, "left"), Photo(Shows.BENCH, "right"), Photo(Shows.BENCH, "left", struck=True)),
    Shows.LAMPS: (Photo(Shows.LAMPS, "Garage"), Photo(Shows.LAMPS, "Garage", struck=True)),
}


def with_photo(network: RoadNetwork, sent: Photo | None) -> Cockpit:
    """A parked car in which Isla has written, with a photo or without."""
    cockpit = Cockpit(
        network,
        rng=np.random.default_rng(1),
        signals=PARKED,
        belongings=Belongings(
            (Contact("Isla Brook", "555 31 40"),), (Thread("Isla Brook", "Today 08:10", ("See?",), True, sent),)
        ),
    )
    for second in range(3):
        cockpit.sense(outside(900.0 + second, 0.0), float(second > 0))
    return cockpit


def opened(cockpit: Cockpit) -> Cockpit:
    """The same with her messages on the screen, opened."""
    assert cockpit.open_app("phone").code is FeedbackCode.OK
    for name in ("phone.tab.messages", "Isla Brook", "thread.read"):
        box = next(
            element.bbox_pixels
            for element in cockpit.elements()
            if name in (key_of(element.resource_id), element.text) and element.is_clickable
        )
        cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2)
    return cockpit


def photos(cockpit: Cockpit) -> list[Element]:
    """The photos in the list."""
    return [element for element in cockpit.elements() if key_of(element.resource_id) == "thread.photo"]


def test_every_kind_is_tried() -> None:
    assert set(KINDS) == set(Shows)


@pytest.mark.parametrize("kind", Shows)
def test_photos_of_different_things_look_different_and_read_alike(kind: Shows, network: RoadNetwork) -> None:
    cockpits = [opened(with_photo(network, sent)) for sent in KINDS[kind]]
    assert len({repr(cockpit.elements()) for cockpit in cockpits}) == 1
    assert len({cockpit.screenshot().tobytes() for cockpit in cockpits}) == len(cockpits)


def test_a_photo_is_listed_as_one_and_comes_with_the_message(network: RoadNetwork) -> None:
    (listed,) = photos(opened(with_photo(network, KINDS[Shows.ZONE][0])))
    assert (listed.text, listed.content_description, listed.is_clickable) == ("", "Photo", False)
    without = opened(with_photo(network, None))
    assert photos(without) == []


def test_no_photo_is_shown_while_driving(network: RoadNetwork) -> None:
    cockpit = opened(with_photo(network, KINDS[Shows.ZONE][0]))
    cockpit.signals[MOTION.GEAR] = "D"
    cockpit.sense(outside(903.0, 48.0), 1.0)
    assert photos(cockpit) == []


@pytest.mark.parametrize("width", [320, 490, 735])
def test_a_photo_is_the_same_in_every_size(width: int) -> None:
    clock = KINDS[Shows.CLOCK][0]
    small, large = (np.asarray(photo(clock, wide, wide * 5 // 8).resize((96, 60)), int) for wide in (width, 980))
    assert np.abs(small - large).mean() < 6
