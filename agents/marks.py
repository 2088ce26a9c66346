"""Set-of-mark: the screenshot with every element framed and numbered as in the element list."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from automotive_cosim.cockpit.theme import Weight, font
from automotive_cosim.contracts import BoundingBox, Element

FRAME = (255, 64, 160)
GROUND = (255, 255, 255)
INK = (0, 0, 0)
LABEL_PX = 15


@dataclass(frozen=True, slots=True)
class Mark:
    """A number and the element it belongs to."""

    index: int
    """Index in the element list, which is also an action's ``index``."""
    box: BoundingBox
    label: BoundingBox
    """Position of the number: the box's upper left corner, inside the picture."""


def listed(elements: tuple[Element, ...]) -> tuple[tuple[int, Element], ...]:
    """The visible elements with their indices: those that a prompt lists and a picture marks."""
    return tuple((index, element) for index, element in enumerate(elements) if element.is_visible)


def marks(elements: tuple[Element, ...], width: int, height: int) -> tuple[Mark, ...]:
    """The marks of a picture of that size."""
    found = []
    for index, element in listed(elements):
        tag = label(index)
        box = element.bbox_pixels
        left = max(0, min(box.x_min, width - tag.width))
        top = max(0, min(box.y_min, height - tag.height))
        found.append(Mark(index, box, BoundingBox(left, top, left + tag.width, top + tag.height)))
    return tuple(found)


def marked(screenshot: npt.NDArray[np.uint8], elements: tuple[Element, ...]) -> npt.NDArray[np.uint8]:
    """A copy of the screenshot, (height, width, 3), with its marks; numbers are drawn above all frames."""
    picture = Image.fromarray(screenshot)
    draw = ImageDraw.Draw(picture)
    found = marks(elements, picture.width, picture.height)
    for mark in found:
        box = mark.box
        if box.x_max > box.x_min and box.y_max > box.y_min:
            draw.rectangle((box.x_min, box.y_min, box.x_max - 1, box.y_max - 1), outline=FRAME)
    for mark in found:
        picture.paste(label(mark.index), (mark.label.x_min, mark.label.y_min))
    return np.array(picture, dtype=np.uint8)


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


def _font() -> ImageFont.FreeTypeFont:
    return font(Weight.BOLD, LABEL_PX)
