"""Vehicles, people and what stands on the road, as a few plane faces each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from zlib import crc32

from automotive_cosim.cockpit.theme import Colour
from automotive_cosim.contracts import SeenVehicle, SumoSignal
from automotive_cosim.view.lens import FromLens, Lens

Profile = tuple[tuple[float, float, float], ...]
"""Points of the side view from the lower rear over the roof to the lower front: share of the length from the rear,
height in metres, and half the width there as a share of half the vehicle's."""

PAINTS: tuple[Colour, ...] = (
    (196, 200, 206), (52, 58, 68), (232, 234, 236), (120, 26, 34),
    (34, 64, 112), (88, 96, 104), (60, 84, 76), (168, 132, 84),
)  # fmt: skip
"""A vehicle's own for as long as it is seen, by its id: SUMO knows none, and none means anything."""
GLASS, TYRE, UNDER = (38, 48, 58), (24, 26, 28), (30, 32, 34)
RED_ON, RED, AMBER, WHITE, BLUE = (255, 40, 36), (122, 18, 22), (255, 168, 30), (255, 248, 226), (60, 130, 255)


@dataclass(frozen=True, slots=True)
class Face:
    """A plane face."""

    corners: tuple[FromLens, ...]
    colour: Colour
    shines: bool = False
    """Whether it gives light, so that darkness does not change it."""


@dataclass(frozen=True, slots=True)
class _Form:
    profile: Profile
    glass: tuple[int, ...]
    """Which of the quadrilaterals between two points of the profile are of glass."""
    windows: tuple[float, float, float, float] | None
    """Those of the side: from and to as shares of the length, and from and to in metres above the road."""
    colour: Colour | None = None


def _profile(text: str) -> Profile:
    """From its numbers, three for each point."""
    numbers = [float(each) for each in text.split()]
    return tuple(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))


_CAR = _Form(
    _profile("0 .3 1  0 .9 1  .03 1 .94  .17 1.46 .72  .56 1.48 .72  .73 1 .94  1 .78 .94  1 .3 1"),
    (2, 4),
    (0.2, 0.66, 1.0, 1.38),
)
_VAN = _Form(
    _profile("0 .35 1  0 1.1 1  0 1.85 .96  .02 2.4 .9  .74 2.42 .9  .9 1.3 .98  1 1.05 .98  1 .35 1"),
    (1, 4),
    (0.68, 0.84, 1.3, 1.95),
    (226, 228, 230),
)
_LORRY = _Form(
    _profile("0 .5 1  0 3.7 1  .78 3.7 1  .8 3.1 .98  .985 3 .96  1 1.7 .98  1 .5 1"), (4,), (0.84, 0.97, 1.75, 2.6)
)
_BUS = _Form(
    _profile("0 .35 1  0 1.6 1  0 2.5 1  .01 3.1 .96  .98 3.1 .96  1 2.8 1  1 1.1 1  1 .35 1"),
    (1, 5),
    (0.04, 0.95, 1.35, 2.6),
    (176, 44, 48),
)
_FORMS = {
    **dict.fromkeys(("delivery",), _VAN),
    **dict.fromkeys(("truck", "trailer"), _LORRY),
    **dict.fromkeys(("bus", "coach"), _BUS),
    **dict.fromkeys(("tram", "rail", "rail_urban", "rail_electric", "rail_fast", "subway", "cable_car"), _BUS),
}
TWO_WHEELS = ("bicycle", "moped", "motorcycle", "scooter")
ON_FOOT = ("pedestrian", "wheelchair")


def shadow(vehicle: SeenVehicle, lens: Lens) -> tuple[FromLens, ...]:
    """The road under a vehicle."""
    place = _placed(vehicle, lens)
    w = vehicle.width_m / 2
    return tuple(
        place(a, s, 0.0) for a, s in ((-0.05, -w), (-0.05, w), (vehicle.length_m, w), (vehicle.length_m, -w))
    )


def faces(vehicle: SeenVehicle, lens: Lens, *, dark: bool) -> Iterator[Face]:
    """The faces of a vehicle or a person that can be seen from here, those behind first; then its lamps."""
    if vehicle.kind in ON_FOOT:
        yield from _person(vehicle, lens, 0.0)
    elif vehicle.kind in TWO_WHEELS:
        yield from _rider(vehicle, lens, dark=dark)
    else:
        yield from _car(vehicle, lens, dark=dark)


def paint_of(vehicle: SeenVehicle) -> Colour:
    """The colour of its body."""
    return PAINTS[crc32(vehicle.vehicle_id.encode()) % len(PAINTS)]


class _placed:  # noqa: N801, it is used as a function
    """From a vehicle's own measures (from its rear, to its right, above the road) to what the lens sees."""

    def __init__(self, vehicle: SeenVehicle, lens: Lens) -> None:
        angle = math.radians(vehicle.heading_deg)
        self._east, self._north = math.sin(angle), math.cos(angle)
        self._x = vehicle.x_m - vehicle.length_m * self._east
        self._y = vehicle.y_m - vehicle.length_m * self._north
        self._lens = lens

    def __call__(self, along_m: float, right_m: float, up_m: float) -> FromLens:
        return self._lens.sees(
            self._x + along_m * self._east + right_m * self._north,
            self._y + along_m * self._north - right_m * self._east,
            up_m,
        )


def _faces_lens(corners: tuple[FromLens, ...], lens: Lens) -> bool:
    """Whether the outside of a face is turned to the lens: its corners run clockwise as seen from there."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners[:3]
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    facing = nx * ax + ny * ay + nz * (az - lens.up_m)
    return (facing > 0) != lens.mirrored


def _car(vehicle: SeenVehicle, lens: Lens, *, dark: bool) -> Iterator[Face]:
    place, long, wide = _placed(vehicle, lens), vehicle.length_m, vehicle.width_m / 2
    blue = vehicle.kind == "emergency"
    form = _FORMS.get(vehicle.kind, (_VAN if vehicle.length_m > 5.5 else _CAR) if blue else _CAR)
    colour = (236, 238, 240) if blue else form.colour or paint_of(vehicle)
    if vehicle.kind == "taxi":
        colour = (240, 196, 60)
    points = form.profile
    ring = [[place(a * long, side * w * wide, up) for a, up, w in points] for side in (-1, 1)]
    found: list[tuple[float, list[Face]]] = []
    for at in range(len(points) - 1):
        corners = (ring[0][at], ring[0][at + 1], ring[1][at + 1], ring[1][at])
        if _faces_lens(corners, lens):
            found.append(
                (
                    _depth(corners),
                    [Face(corners, GLASS if at in form.glass else _lit(colour, 96 if at == 0 else 108))],
                )
            )
    for at, side in ((0, -1), (1, 1)):
        outline = tuple(ring[at] if side > 0 else reversed(ring[at]))
        if _faces_lens(outline, lens):
            own = [Face(outline, _lit(colour, 84))]
            own += _side(vehicle, place, form, side)
            found.append((_depth(outline), own))
    found.sort(key=lambda each: -each[0])
    for _, group in found:
        yield from group
    yield from _lamps(vehicle, place, lens, form, dark=dark)


def _lit(colour: Colour, percent: int) -> Colour:
    """So many per cent of a colour: the rear and the roof are a little brighter than the sides."""
    r, g, b = (min(255, part * percent // 100) for part in colour)
    return r, g, b


def _depth(corners: tuple[FromLens, ...]) -> float:
    return sum(corner[1] for corner in corners) / len(corners)


def _side(vehicle: SeenVehicle, place: _placed, form: _Form, side: int) -> Iterator[Face]:
    long, wide = vehicle.length_m, side * vehicle.width_m / 2
    if form.windows is not None:
        a, b, low, high = form.windows
        w = [0.9 if form is _CAR else 1.0, 0.75 if form is _CAR else 1.0]
        yield Face(
            tuple(
                place(along * long, wide * share, up)
                for along, share, up in (
                    (a, w[0], low),
                    (a + 0.03, w[1], high),
                    (b - 0.1, w[1], high),
                    (b, w[0], low),
                )
            ),
            GLASS,
        )
    for axle in (0.17, 0.8) if long < 7 else (0.14, 0.26, 0.84):
        radius = 0.33 if long < 7 else 0.48
        yield Face(
            tuple(
                place(axle * long + radius * math.cos(turn), wide * 1.01, radius + radius * math.sin(turn))
                for turn in (math.pi * step / 4 for step in range(8))
            ),
            TYRE,
        )


def _lamps(vehicle: SeenVehicle, place: _placed, lens: Lens, form: _Form, *, dark: bool) -> Iterator[Face]:
    """Those of the end that is turned to the lens, and the blue lights."""
    long, wide, signals = vehicle.length_m, vehicle.width_m / 2, vehicle.signals
    is_rear = _faces_lens((place(0, -wide, 0), place(0, -wide, 1), place(0, wide, 1)), lens)
    end = -0.02 if is_rear else long + 0.02
    low, sill = 0.66 if form is _CAR else 0.8, form.profile[0][1]
    is_front = _faces_lens((place(long, wide, 0), place(long, wide, 1), place(long, -wide, 1)), lens)

    def lamp(inner: float, outer: float, bottom: float, top: float, colour: Colour, *, shines: bool) -> Face:
        corners = ((inner, bottom), (inner, top), (outer, top), (outer, bottom))
        return Face(tuple(place(end, right * wide, up) for right, up in corners), colour, shines)

    if is_rear or is_front:
        for side in (-1, 1):
            yield lamp(side * 0.66, side * 0.96, 0.0, sill + 0.04, TYRE, shines=False)
        if is_rear:
            brakes = bool(signals & SumoSignal.BRAKE)
            for side in (-1, 1):
                colour = RED_ON if brakes else (200, 26, 28) if dark else RED
                yield lamp(side * 0.62, side * 0.96, low, low + 0.22, colour, shines=brakes or dark)
            if brakes and form is _CAR:
                yield lamp(-0.16, 0.16, 0.94, 1.0, RED_ON, shines=True)
            yield lamp(-0.28, 0.28, sill + 0.16, sill + 0.28, (206, 206, 196), shines=False)
        else:
            for side in (-1, 1):
                colour = WHITE if dark else (196, 200, 204)
                yield lamp(side * 0.58, side * 0.9, low - 0.06, low + 0.12, colour, shines=dark)
            yield lamp(-0.3, 0.3, sill + 0.1, sill + 0.22, (206, 206, 196), shines=False)
        for side, bit in ((-1, SumoSignal.LEFT), (1, SumoSignal.RIGHT)):
            if signals & (bit | SumoSignal.HAZARD):
                top = low + (0.36 if is_rear else 0.3)
                yield lamp(side * 0.7, side * 0.98, top - 0.2, top, AMBER, shines=True)
    if vehicle.kind == "emergency":
        lit, roof = bool(signals & SumoSignal.BLUE), 1.48 if form is _CAR else 2.4
        for side in (-1, 1):
            at = 0.4 * long if form is _CAR else 0.6 * long
            corners = ((0.15, roof), (0.15, roof + 0.22), (0.65, roof + 0.22), (0.65, roof))
            colour = BLUE if lit else (40, 60, 110)
            yield Face(tuple(place(at, side * right * wide, up) for right, up in corners), colour, lit)


def upright(middle: FromLens, half_m: float, low: float, high: float, colour: Colour) -> Face:
    """A flat figure that is turned to the lens."""
    x, y, _ = middle
    return Face(((x - half_m, y, low), (x - half_m, y, high), (x + half_m, y, high), (x + half_m, y, low)), colour)


def _round(middle: FromLens, radius: float, up: float, colour: Colour, *, shines: bool = False) -> Face:
    x, y, _ = middle
    turns = [math.pi * step / 5 for step in range(10)]
    return Face(tuple((x + radius * math.cos(t), y, up + radius * math.sin(t)) for t in turns), colour, shines)


def _person(vehicle: SeenVehicle, lens: Lens, lift_m: float) -> Iterator[Face]:
    middle = _placed(vehicle, lens)(vehicle.length_m / 2, 0.0, 0.0)
    coat = paint_of(vehicle)
    step = 0.09 if crc32(vehicle.vehicle_id.encode()) % 2 else 0.06
    for side in (-1, 1):
        leg = (middle[0] + side * step, middle[1], 0.0)
        yield upright(leg, 0.07, lift_m, lift_m + 0.85, (44, 50, 64))
    yield upright(middle, 0.23, lift_m + 0.8, lift_m + 1.45, coat)
    yield _round(middle, 0.12, lift_m + 1.6, (206, 164, 138))


def _rider(vehicle: SeenVehicle, lens: Lens, *, dark: bool) -> Iterator[Face]:
    place, long = _placed(vehicle, lens), vehicle.length_m
    for axle in (0.2, 0.8):
        hub = [
            place(axle * long + 0.32 * math.cos(t), 0.0, 0.33 + 0.33 * math.sin(t))
            for t in (math.pi * step / 5 for step in range(10))
        ]
        yield Face(tuple(hub), TYRE)
    middle = place(long / 2, 0.0, 0.0)
    is_motor = vehicle.kind != "bicycle"
    yield upright(place(long * 0.4, 0.0, 0.0), 0.04 if not is_motor else 0.16, 0.1, 0.75, TYRE)
    frame = ((0.2, 0.35), (0.35, 0.85), (0.75, 0.85), (0.8, 0.35))
    yield Face(tuple(place(a * long, 0.0, up) for a, up in frame), paint_of(vehicle))
    yield upright(middle, 0.22, 0.8, 1.4, (40, 44, 52) if is_motor else paint_of(vehicle))
    yield _round(middle, 0.14, 1.58, (230, 232, 236) if is_motor else (206, 164, 138))
    is_rear = place(0.0, 0.0, 0.0)[1] < place(long, 0.0, 0.0)[1]
    brakes = bool(vehicle.signals & SumoSignal.BRAKE) and is_motor
    if brakes or dark:
        colour = RED_ON if is_rear else WHITE
        yield _round(place(0.0 if is_rear else long, 0.0, 0.0), 0.08, 0.72, colour, shines=True)


def cone(middle: FromLens) -> Iterator[Face]:
    """A cone on the road."""
    x, y, _ = middle
    yield Face(((x - 0.2, y, 0.0), (x, y, 0.75), (x + 0.2, y, 0.0)), (240, 96, 30))
    yield Face(((x - 0.12, y, 0.3), (x - 0.07, y, 0.48), (x + 0.07, y, 0.48), (x + 0.12, y, 0.3)), (244, 244, 244))


def barrier(left: FromLens, right: FromLens) -> Iterator[Face]:
    """A board across a lane with red and white stripes."""
    steps = 8
    for at in range(steps):
        a, b = at / steps, (at + 1) / steps
        ends = [
            (left[0] + share * (right[0] - left[0]), left[1] + share * (right[1] - left[1])) for share in (a, b)
        ]
        (ax, ay), (bx, by) = ends
        colour = (204, 30, 36) if at % 2 else (244, 244, 244)
        yield Face(((ax, ay, 0.7), (ax, ay, 1.05), (bx, by, 1.05), (bx, by, 0.7)), colour)
    for x, y, _ in (left, right):
        yield Face(
            ((x - 0.05, y, 0.0), (x - 0.05, y, 0.7), (x + 0.05, y, 0.7), (x + 0.05, y, 0.0)), (120, 124, 128)
        )
