"""What the rear and the door camera show: the road behind, its lanes, and the vehicles that are there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.theme import Colour
from automotive_cosim.contracts import DrivingState, OtherVehicle

_FINE = 2
LANE_M, FAR_M, LENS_M = 3.3, 160.0, 3.0
"""Width of a lane, how far the road is drawn, and how far behind the picture's lower edge the lens is."""
MARK_M, MARKS_M = 3.0, 9.0
"""Length of a lane marking, and from one to the next."""


@dataclass(frozen=True, slots=True)
class CameraScene:
    """What is in sight behind the car."""

    lanes: tuple[int, int]
    """Lanes beside the car's own, as the camera has them: on its left and on its right."""
    behind_m: int | None
    """The vehicle behind, in whole metres."""
    blue_m: int | None
    """An emergency vehicle behind."""
    night: bool
    beside: bool = False
    """Whether it looks along the car's side, from the door, rather than from the middle of the rear."""


def scene(driving: DrivingState | None, *, night: bool, beside: bool, left_hand: bool) -> CameraScene:
    """What there is to see; a mirrored picture, so that right stays right."""
    if driving is None:
        return CameraScene((0, 0), None, None, night, beside)
    road, around = driving.road, driving.around
    inner = max(0, road.lane_count - 1 - road.lane_index)
    left, right = (road.lane_index, inner) if left_hand else (inner, road.lane_index)
    return CameraScene(
        (left, right), _metres(around.follower), _metres(around.emergency_behind), night or road.in_tunnel, beside
    )


def _metres(other: OtherVehicle | None) -> int | None:
    return None if other is None else min(int(FAR_M), round(other.gap_m))


class _View:
    """The perspective of one picture."""

    def __init__(self, draw: ImageDraw.ImageDraw, width: int, height: int, aside_m: float) -> None:
        self._draw, self._height = draw, height
        self._middle, self._horizon = width / 2, height * 0.34
        self._aside_m = aside_m

    def at(self, across_m: float, behind_m: float, up_m: float = 0.0) -> tuple[float, float]:
        """Pixel of a point on the road, or above it."""
        near = self._height * 0.66 * LENS_M / (behind_m + LENS_M)
        return self._middle + (across_m + self._aside_m) * near * 0.55, self._horizon + near - up_m * near * 0.55

    def strip(self, left_m: float, right_m: float, from_m: float, to_m: float, fill: Colour) -> None:
        """A piece of road."""
        corners = ((left_m, from_m), (left_m, to_m), (right_m, to_m), (right_m, from_m))
        self._draw.polygon([self.at(across, behind) for across, behind in corners], fill)

    def body(self, across_m: float, behind_m: float, size_m: tuple[float, float], fill: Colour) -> float:
        """The front of a vehicle; returns pixels per metre there."""
        wide, high = size_m
        left, top = self.at(across_m - wide / 2, behind_m, high)
        right, bottom = self.at(across_m + wide / 2, behind_m, 0.25)
        metre = (right - left) / wide
        self._draw.rounded_rectangle((left, top, right, bottom), 0.25 * metre, fill)
        self._draw.rectangle(
            (left + 0.2 * metre, top + 0.15 * metre, right - 0.2 * metre, top + 0.55 * metre), (40, 52, 66)
        )
        for lamp in (left + 0.12 * metre, right - 0.42 * metre):
            self._draw.rectangle(
                (lamp, bottom - 0.6 * metre, lamp + 0.3 * metre, bottom - 0.42 * metre), (255, 244, 214)
            )
        return metre


@lru_cache(maxsize=16)
def camera(view: CameraScene, width: int, height: int) -> Image.Image:
    """The picture of that size in pixels."""
    sky, ground, asphalt, mark = (
        ((14, 18, 26), (22, 26, 30), (44, 48, 54), (150, 154, 160))
        if view.night
        else ((176, 202, 226), (122, 138, 110), (96, 100, 106), (236, 238, 240))
    )
    picture = Image.new("RGB", (width * _FINE, height * _FINE), sky)
    draw = ImageDraw.Draw(picture)
    draw.rectangle((0, round(height * _FINE * 0.34), width * _FINE, height * _FINE), ground)
    road = _View(draw, width * _FINE, height * _FINE, 1.4 if view.beside else 0.0)
    left_m, right_m = -(view.lanes[0] + 0.5) * LANE_M, (view.lanes[1] + 0.5) * LANE_M
    road.strip(left_m - 0.4, right_m + 0.4, 0, FAR_M, asphalt)
    for edge in (left_m, right_m):
        road.strip(edge - 0.08, edge + 0.08, 0, FAR_M, mark)
    for lane in range(1, sum(view.lanes) + 1):
        border = left_m + lane * LANE_M
        for piece in range(int(FAR_M / MARKS_M)):
            road.strip(border - 0.08, border + 0.08, piece * MARKS_M, piece * MARKS_M + MARK_M, mark)
    _vehicles(road, draw, view)
    if view.beside:
        wide, high = picture.size
        draw.polygon(((0, 0), (wide * 0.1, 0), (wide * 0.26, high), (0, high)), (60, 68, 80))
        draw.line(((wide * 0.07, high * 0.3), (wide * 0.16, high * 0.36)), (110, 118, 130), 6 * _FINE)
    else:
        for behind_m, colour in ((0.4, (224, 60, 60)), (1.4, (240, 190, 60)), (3.0, (80, 200, 120))):
            draw.line([road.at(-1.0, behind_m), road.at(1.0, behind_m)], colour, 2 * _FINE)
    return picture.reduce(_FINE)


def _vehicles(road: _View, draw: ImageDraw.ImageDraw, view: CameraScene) -> None:
    """The farther first; the emergency vehicle has its blue lights on."""
    both = [(view.behind_m, False), (view.blue_m, True)]
    for gap_m, blue in sorted(((gap_m, blue) for gap_m, blue in both if gap_m is not None), reverse=True):
        size_m = (2.1, 2.4) if blue else (1.8, 1.5)
        metre = road.body(0.0, gap_m + 1.0, size_m, (240, 240, 240) if blue else (150, 44, 52))
        if blue:
            x, y = road.at(0.0, gap_m + 1.0, 2.6)
            for side in (-1, 1):
                middle = x + side * 0.6 * metre
                draw.ellipse(
                    (middle - 0.35 * metre, y - 0.3 * metre, middle + 0.35 * metre, y + 0.3 * metre), (40, 110, 255)
                )
