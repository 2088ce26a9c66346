"""Set-of-mark: the screenshot with every element framed and numbered as in the element list."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from automotive_cosim.cockpit.theme import Weight, font
from automotive_cosim.contracts import BoundingBox, Element, Observation

FRAME = (255, 64, 160)
GROUND = (255, 255, 255)
INK = (0, 0, 0)
LABEL_PX = 15
STEPS = 6
"""Steps of a number along each side of its box."""
EDGE = 40
"""Leap of brightness, of 255, that is a letter's edge rather than that of a surface."""


@dataclass(frozen=True, slots=True)
class Mark:
    """A number and the element it belongs to."""

    index: int
    """Index in the element list, which is also an action's ``index``."""
    box: BoundingBox
    label: BoundingBox
    """Place of the number: beside the box, inside the picture, on no letter and no other number."""


def listed(elements: Sequence[Element]) -> tuple[tuple[int, Element], ...]:
    """The visible elements with their indices: those that a prompt lists and a picture marks."""
    return tuple((index, element) for index, element in enumerate(elements) if element.is_visible)


def marks(screenshot: npt.NDArray[np.uint8], elements: Sequence[Element]) -> tuple[Mark, ...]:
    """The marks of a screenshot, (height, width, 3).

    A number stands at the first place around its box that is free. On a crowded screen it stands inside the box
    where that is free, else where it hides least."""
    height, width, _ = screenshot.shape
    ink = Leaps(screenshot)
    found: list[Mark] = []
    for index, element in listed(elements):
        tag, box = label(index), element.bbox_pixels
        spots = [_within(spot, width, height) for spot in _around(box, tag.width, tag.height)]

        def faults(spot: BoundingBox, box: BoundingBox = box) -> tuple[bool, bool, bool, int]:
            leaps = ink.under(spot)
            return any(overlap(spot, mark.label) for mark in found), leaps > 0, overlap(spot, box), leaps

        spot = next((spot for spot in spots if not any(faults(spot))), None) or min(spots, key=faults)
        found.append(Mark(index, box, spot))
    return tuple(found)


def marked(screenshot: npt.NDArray[np.uint8], elements: Sequence[Element]) -> npt.NDArray[np.uint8]:
    """A copy of the screenshot, (height, width, 3), with its marks; numbers are drawn above all frames."""
    picture = Image.fromarray(screenshot)
    draw = ImageDraw.Draw(picture)
    found = marks(screenshot, elements)
    for mark in found:
        box = mark.box
        if box.x_max > box.x_min and box.y_max > box.y_min:
            draw.rectangle((box.x_min, box.y_min, box.x_max - 1, box.y_max - 1), outline=FRAME)
    for mark in found:
        picture.paste(label(mark.index), (mark.label.x_min, mark.label.y_min))
    return np.array(picture, dtype=np.uint8)


class Leaps:
    """How much is drawn in any part of a picture, from sums over its upper left parts."""

    def __init__(self, picture: npt.NDArray[np.uint8]) -> None:
        brightness = picture[:, :, 0].astype(np.int16) + picture[:, :, 1] + picture[:, :, 2]  # of 765
        self._sums = sums = np.zeros([side + 1 for side in brightness.shape], np.int32)
        sums[1:, 2:] += np.abs(np.diff(brightness, axis=1)) > 3 * EDGE
        sums[2:, 1:] += np.abs(np.diff(brightness, axis=0)) > 3 * EDGE
        for axis in (0, 1):
            np.cumsum(sums, axis=axis, out=sums)

    def under(self, box: BoundingBox) -> int:
        """Number of leaps of brightness in the box, as at the edges of letters and lines."""
        sums = self._sums
        right = sums[box.y_max, box.x_max] - sums[box.y_min, box.x_max]
        return int(right - sums[box.y_max, box.x_min] + sums[box.y_min, box.x_min])


def _around(box: BoundingBox, width: int, height: int) -> Iterator[BoundingBox]:
    """Places for a number of that size: outside the box, then in its corners."""
    across = [box.x_min + step * (box.x_max - width - box.x_min) // STEPS for step in range(STEPS + 1)]
    down = [box.y_min + step * (box.y_max - height - box.y_min) // STEPS for step in range(STEPS + 1)]
    corners = [(x, y) for y in (box.y_min - height, box.y_max) for x in across]
    corners += [(x, y) for x in (box.x_min - width, box.x_max) for y in down]
    corners += [(x, y) for y in down for x in across]
    for x, y in corners:
        yield BoundingBox(x, y, x + width, y + height)


def _within(spot: BoundingBox, width: int, height: int) -> BoundingBox:
    """The place moved into the picture."""
    x = max(0, min(spot.x_min, width - (spot.x_max - spot.x_min)))
    y = max(0, min(spot.y_min, height - (spot.y_max - spot.y_min)))
    return BoundingBox(x, y, x + spot.x_max - spot.x_min, y + spot.y_max - spot.y_min)


def overlap(one: BoundingBox, other: BoundingBox) -> bool:
    """Whether two boxes share a pixel."""
    across = min(one.x_max, other.x_max) > max(one.x_min, other.x_min)
    return across and min(one.y_max, other.y_max) > max(one.y_min, other.y_min)


def label(index: int) -> Image.Image:
    """The picture of a number."""
    letters = _font()
    left, top, right, bottom = letters.getbbox(str(index))
    tag = Image.new("RGB", (round(right - left) + 6, round(bottom - top) + 6), GROUND)
    draw = ImageDraw.Draw(tag)
    draw.text((3 - left, 3 - top), str(index), INK, font=letters)
    draw.rectangle((0, 0, tag.width - 1, tag.height - 1), outline=FRAME)
    return tag


def png(picture: npt.NDArray[np.uint8]) -> bytes:
    """The picture as a PNG file."""
    file = io.BytesIO()
    Image.fromarray(picture).save(file, "PNG")
    return file.getvalue()


def road(seen: Observation) -> tuple[bytes, ...]:
    """The view through the windshield as a PNG file, for who is given it."""
    return () if seen.camera is None else (png(seen.camera),)


def _font() -> ImageFont.FreeTypeFont:
    return font(Weight.BOLD, LABEL_PX)
