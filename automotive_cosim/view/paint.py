"""Paints a scene: sky and ground first, then everything that stands up, the farthest first, and the glass last."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache, partial
from itertools import pairwise
from random import Random

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageChops, ImageDraw, ImageFilter

from automotive_cosim.cockpit.theme import Colour
from automotive_cosim.view import bodies
from automotive_cosim.view.bodies import Face
from automotive_cosim.view.lens import FINE, HEIGHT, NEAR_M, WIDTH, FromLens
from automotive_cosim.view.roads import Areas, Paving, Stand, along, length_of
from automotive_cosim.view.scene import SIGHT_M, Board, Head, Outside, Posted, Scene
from automotive_cosim.view.signs import board

BUILDING_M, TUNNEL_M, POLE_M = 9.0, 5.0, 2.2
"""Height of every building, of a tunnel, and of a sign's lower edge: maps hold none."""
BAY_M = 8.0
"""From one lamp of a tunnel to where the next is not."""
MARKS_TO_M = 110.0
"""Markings farther away are finer than a pixel."""

LAND, BUILDING = (134, 138, 118), (168, 156, 142)
COVERS: dict[int, Colour] = {
    Paving.GREEN: (104, 132, 78),
    Paving.WATER: (92, 128, 158),
    Paving.CROSSING: (92, 94, 98),
    Paving.FOOT: (158, 156, 152),
    Paving.ROAD: (92, 94, 98),
    Paving.BUS: (104, 88, 84),
    Paving.BICYCLE: (122, 84, 76),
    Paving.RAIL: (112, 106, 98),
    Paving.KERB: (184, 182, 176),
    Paving.STEEL: (70, 72, 76),
    Paving.WHITE: (236, 236, 234),
    Paving.YELLOW: (236, 236, 234),
}
"""Lines between two directions are white, but for these countries, where they are yellow."""
YELLOW_LINES = ("US", "CA", "NO", "CN", "BR", "MX")
SKIES: tuple[tuple[float, Colour, Colour, float], ...] = (
    (-18.0, (6, 9, 18), (13, 17, 28), 0.07),
    (-9.0, (14, 22, 48), (44, 52, 82), 0.13),
    (-3.0, (46, 66, 112), (196, 140, 116), 0.38),
    (2.0, (96, 134, 186), (240, 194, 150), 0.72),
    (10.0, (104, 154, 214), (206, 218, 228), 1.0),
    (90.0, (86, 142, 212), (202, 220, 234), 1.0),
)
"""By the sun's elevation: the sky overhead and at the horizon, and how much light there is."""
LAMPS: dict[str, tuple[str, ...]] = {"G": ("green",), "g": ("green",), "y": ("amber",), "Y": ("amber",)} | {
    "u": ("red", "amber"), "r": ("red",), "R": ("red",), "s": ("red",), "o": ("amber",), "O": (),
}  # fmt: skip
"""Lit lamps of a signal, by SUMO's letter."""
LAMP_COLOURS: dict[str, Colour] = {"red": (255, 44, 36), "amber": (255, 182, 36), "green": (44, 232, 128)}


def picture(scene: Scene) -> npt.NDArray[np.uint8]:
    """The view, (360, 640, 3), RGB; read-only."""
    return np.asarray(_Painter(scene).painted())


def _mixed(one: Colour, other: Colour, share: float) -> Colour:
    """One colour with a share of another, in whole steps."""
    parts = round(256 * share)
    r, g, b = ((a * (256 - parts) + c * parts) >> 8 for a, c in zip(one, other, strict=True))
    return r, g, b


def _sky(outside: Outside) -> tuple[Colour, Colour, float]:
    """Overhead and at the horizon, and how much light there is, from 0 to 1."""
    if outside.in_tunnel:
        return (26, 27, 29), (44, 44, 44), 0.62
    sun_deg = 45.0 if outside.sun_deg is None else outside.sun_deg
    above = next((at for at, stop in enumerate(SKIES) if stop[0] >= sun_deg), len(SKIES) - 1)
    before, after = SKIES[max(0, above - 1)], SKIES[above]
    span = after[0] - before[0]
    share = 1.0 if span == 0 else min(1.0, max(0.0, (sun_deg - before[0]) / span))
    top, low = _mixed(before[1], after[1], share), _mixed(before[2], after[2], share)
    light = before[3] + share * (after[3] - before[3])
    cloud = outside.weather.cloud_cover / 100
    if outside.weather.precipitation > 0.1 or outside.weather.visibility < 1000:
        cloud = max(cloud, 0.9)
    grey = round(40 + 158 * light) if light > 0.2 else round(150 * light + 8)
    flat = (grey, min(255, grey + 3), min(255, grey + 8))
    return _mixed(top, flat, 0.85 * cloud), _mixed(low, flat, 0.8 * cloud), light * (1 - 0.25 * cloud)


class _Painter:
    def __init__(self, scene: Scene) -> None:
        self._scene, self._lens, self._outside = scene, scene.lens, scene.outside
        self._top, self._low, light = _sky(scene.outside)
        self._light = max(light, 0.34) if scene.outside.lit and light < 0.34 else light
        self._is_even = self._light >= 0.6
        """Whether it is so bright that headlights change nothing."""
        self._dark = light < 0.5 or scene.outside.in_tunnel
        weather = scene.outside.weather
        self._lights_on = self._dark or weather.visibility < 1000 or weather.precipitation > 0.5
        self._haze_m = max(20.0, weather.visibility) if not scene.outside.in_tunnel else 2000.0
        self._horizon = round(self._lens.horizon * HEIGHT * FINE)

    def painted(self) -> Image.Image:
        scene = self._scene
        self._image = _backdrop(
            self._top, self._low, self._horizon, _mixed((0, 0, 0), LAND, self._light if self._is_even else 1.0)
        ).copy()
        self._draw = ImageDraw.Draw(self._image)
        self._celestial()
        self._surface()
        self._air()
        self._standing()
        small = self._image.reduce(FINE)
        _weather(small, self._outside, scene.time_s, self._light)
        _glass(small, scene)
        return small

    # --- the sky and the ground ----------------------------------------------------------------------------

    def _celestial(self) -> None:
        """The sun, where it stands in the picture and is not behind clouds."""
        out = self._outside
        if out.sun_deg is None or out.sun_azimuth_deg is None or out.in_tunnel or not -1.0 < out.sun_deg < 40.0:
            return
        off = (out.sun_azimuth_deg - self._lens.heading_deg + 180.0) % 360.0 - 180.0
        if abs(off) > 50.0 or out.weather.cloud_cover > 60 or out.weather.visibility < 1000:
            return
        scale = self._lens.focal * WIDTH * FINE
        right = math.tan(math.radians(off)) * (-1 if self._lens.mirrored else 1)
        x = round(WIDTH * FINE / 2 + right * scale)
        y = self._horizon - round(math.tan(math.radians(out.sun_deg)) * scale)
        glow = _glow(220, 200)
        self._image.paste((255, 246, 214), (x - 220, y - 220), glow)
        self._draw.ellipse((x - 22, y - 22, x + 22, y + 22), (255, 252, 236))

    def _flat(self, areas: Sequence[Areas], colours: Mapping[int, Colour]) -> None:
        """Areas on the road, in the order of their covers."""
        counts = np.array([count for each in areas for count in each.counts], dtype=np.int64)
        if not len(counts):
            return
        covers = np.array([cover for each in areas for cover in each.covers])
        right, ahead = self._lens.all(np.concatenate([each.corners_m for each in areas]))
        ends = np.cumsum(counts)
        starts = ends - counts
        first, last = np.minimum.reduceat(ahead, starts), np.maximum.reduceat(ahead, starts)
        wide = 0.5 / self._lens.focal * last + 1.0
        is_seen = (last > NEAR_M) & (first < np.where(covers >= Paving.KERB, MARKS_TO_M, SIGHT_M + 60.0))
        is_seen &= (np.minimum.reduceat(right, starts) < wide) & (np.maximum.reduceat(right, starts) > -wide)
        seen = np.flatnonzero(is_seen)
        pixels, polygon = self._lens.pixels(right, ahead), self._draw.polygon
        for at in seen[np.argsort(covers[seen], kind="stable")].tolist():
            begin, end = starts[at], ends[at]
            if first[at] >= NEAR_M:
                shape = pixels[begin:end]
            else:
                near = zip(right[begin:end].tolist(), ahead[begin:end].tolist(), strict=True)
                shape = self._lens.shape([(x, y, 0.0) for x, y in near], FINE)
            if len(shape) > 2:
                polygon(shape, colours[int(covers[at])])

    def _surface(self) -> None:
        scene, wet = self._scene, self._outside.weather.precipitation > 0.1 and not self._outside.in_tunnel
        colours = dict(COVERS)
        if self._outside.country in YELLOW_LINES:
            colours[Paving.YELLOW] = (232, 186, 60)
        if wet:
            for cover in (Paving.CROSSING, Paving.FOOT, Paving.ROAD, Paving.BUS, Paving.BICYCLE):
                colours[cover] = _mixed(colours[cover], (44, 50, 60), 0.4)
        if self._is_even:
            colours = {cover: _mixed((0, 0, 0), colour, self._light) for cover, colour in colours.items()}
        self._flat((scene.ground, *(street.areas for street in scene.streets)), colours)
        for vehicle in (*scene.vehicles, *scene.people):
            shape = self._lens.shape(bodies.shadow(vehicle, self._lens), FINE)
            if len(shape) > 2:
                self._draw.polygon(shape, _mixed(COVERS[Paving.ROAD], (20, 22, 26), 0.6))

    def _air(self) -> None:
        """Light and haze over the ground, which both depend on the distance."""
        box = (0, self._horizon, WIDTH * FINE, HEIGHT * FINE)
        size = (WIDTH * FINE, HEIGHT * FINE - self._horizon)
        if not self._is_even:
            ground = self._image.crop(box)
            car = self._scene.car
            beam = 0 if car.reverse else 2 if car.high_beam else 1 if car.low_beam else 0
            light = _lit_ground(size, self._lens.up_m, self._lens.focal, beam, round(self._light * 50))
            ground = ImageChops.multiply(ground, light)
            self._image.paste(ground, box)
        haze = _hazed(size, self._lens.up_m, self._lens.focal, round(self._haze_m))
        self._image.paste(self._low, (0, self._horizon), haze)

    # --- what stands up ------------------------------------------------------------------------------------

    def _shade(self, colour: Colour, ahead_m: float, right_m: float = 0.0) -> Colour:
        """A colour in the light that there is, behind the air in between."""
        car, light = self._scene.car, self._light
        if not self._is_even and not car.reverse:
            beam = 2 if car.high_beam else 1 if car.low_beam else 0
            light = min(1.0, light + _beam(beam, ahead_m, right_m))
        return _mixed(_mixed((0, 0, 0), colour, light), self._low, _haze(ahead_m, self._haze_m))

    def _put(self, face: Face) -> None:
        shape = self._lens.shape(face.corners, FINE)
        if len(shape) > 2:
            x, y, _ = face.corners[0]
            colour = face.colour
            if face.shines:
                colour = _mixed(colour, self._low, _haze(y, self._haze_m) ** 3)  # lamps reach farther
            else:
                colour = self._shade(colour, max(y, NEAR_M), x)
            self._draw.polygon(shape, colour)
            if face.shines and self._lights_on:
                self._halo(face, colour)

    def _put_all(self, faces: Iterable[Face]) -> None:
        for face in faces:
            self._put(face)

    def _halo(self, face: Face, colour: Colour) -> None:
        """The glow around a lamp in the dark or in the fog."""
        xs, ys, ups = (sum(part) / len(face.corners) for part in zip(*face.corners, strict=True))
        if ys < 2.0:
            return
        x, y = self._lens.pixel((xs, ys, ups), FINE)
        radius = min(120, max(6, round(0.5 * self._lens.focal * WIDTH * FINE / ys)))
        radius -= radius % 3
        self._image.paste(colour, (x - radius, y - radius), _glow(radius, 130))

    def _standing(self) -> None:
        """Everything with a height, by distance."""
        scene, lens = self._scene, self._lens
        things: list[tuple[float, Callable[[], None]]] = []

        def add(place: FromLens, paint: Callable[[], None]) -> None:
            if place[1] > NEAR_M and abs(place[0]) < 0.5 / lens.focal * place[1] + 15.0:
                things.append((place[1], paint))

        things += self._walls()
        for vehicle in (*scene.vehicles, *scene.people):
            angle = math.radians(vehicle.heading_deg)
            back_m = vehicle.length_m / 2
            middle = lens.sees(vehicle.x_m - back_m * math.sin(angle), vehicle.y_m - back_m * math.cos(angle))
            faces = bodies.faces(vehicle, lens, dark=self._lights_on)
            things.append((middle[1], partial(self._put_all, faces)))
        for posted in scene.posted:
            place = lens.sees(posted.place.x_m, posted.place.y_m)
            add(place, partial(self._post, posted, place))
        for head in scene.heads:
            place = lens.sees(head.place.x_m, head.place.y_m)
            add(place, partial(self._signal, head, place))
        for _, paint in sorted(things, key=lambda each: -each[0]):
            paint()

    def _turned(self, place: Stand) -> float:
        """1 for what is made for who drives as the lens looks, -1 for who comes towards it."""
        return math.cos(math.radians(place.heading_deg - self._lens.heading_deg))

    def _walls(self) -> Iterator[tuple[float, Callable[[], None]]]:
        for outline in self._scene.buildings:
            yield from self._building(outline)
        for street in self._scene.tunnels:
            length_m = max(math.dist(line[0], line[-1]) for line in street.sides)
            steps = max(1, round(length_m / BAY_M))
            rows = []
            for at in range(steps + 1):
                ends = [
                    along(line, at / steps * line_m)
                    for line, line_m in zip(street.sides, map(length_of, street.sides), strict=True)
                ]
                rows.append([self._lens.sees(end.x_m, end.y_m) for end in ends])
            for at, (here, there) in enumerate(pairwise(rows)):
                middle = sum(corner[1] for corner in (*here, *there)) / 4
                if max(corner[1] for corner in (*here, *there)) > NEAR_M:
                    stands = (street.beyond[0] == "", street.beyond[1] == "")
                    yield middle, self._bay(here, there, stands, bright=at % 2 == 0)

    def _bay(
        self, here: list[FromLens], there: list[FromLens], walls: tuple[bool, bool], *, bright: bool
    ) -> Callable[[], None]:
        """A piece of a tunnel: its roof with a lamp, and its walls."""

        def band(one: FromLens, two: FromLens, low: float, high: float, colour: Colour) -> None:
            self._put(Face(((*one[:2], low), (*one[:2], high), (*two[:2], high), (*two[:2], low)), colour))

        def paint() -> None:
            roof = tuple((*corner[:2], TUNNEL_M) for corner in (here[0], here[1], there[1], there[0]))
            self._put(Face(roof, (84, 84, 82) if bright else (76, 76, 74)))
            lamps = [_between(here, 0.42), _between(here, 0.58), _between(there, 0.58), _between(there, 0.42)]
            if bright:
                self._put(Face(tuple(lamps), (255, 236, 190), shines=True))
            for one, two, stands in zip(here, there, walls, strict=True):
                if stands:
                    band(one, two, 0.0, TUNNEL_M, (150, 150, 144) if bright else (142, 142, 136))
                    band(one, two, 1.0, 1.25, (178, 172, 150))

        return paint

    def _building(self, outline: npt.NDArray[np.float64]) -> Iterator[tuple[float, Callable[[], None]]]:
        right, ahead = self._lens.all(outline)
        last = float(ahead.max())
        if last < 2.0 or float(np.abs(right).min()) > 0.5 / self._lens.focal * last + 5.0:
            return
        points = list(zip(right.tolist(), ahead.tolist(), strict=True))
        around = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1], strict=True))
        for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True):
            if max(ay, by) < NEAR_M or ((ax * by - bx * ay) > 0) == (around > 0):
                continue
            if max(abs(ax), abs(bx)) > 8.0 * max(ay, by) + 60.0:
                continue
            slope = abs(ax - bx) / (math.hypot(ax - bx, ay - by) or 1.0)
            colour = _mixed(BUILDING, (96, 90, 86), 0.55 * (1.0 - slope))
            face = Face(((ax, ay, 0.0), (ax, ay, BUILDING_M), (bx, by, BUILDING_M), (bx, by, 0.0)), colour)
            yield (ay + by) / 2, partial(self._put, face)

    def _pole(self, place: FromLens, up_m: float) -> None:
        self._put(bodies.upright(place, 0.05, 0.0, up_m, (122, 126, 130)))

    def _post(self, posted: Posted, place: FromLens) -> None:
        lens = self._lens
        if posted.board is Board.CONE:
            self._put_all(bodies.cone(place))
            return
        if posted.board is Board.BARRIER:
            angle, half_m = math.radians(posted.place.heading_deg), posted.width_m / 2 - 0.2
            ends = [
                lens.sees(
                    posted.place.x_m + side * half_m * math.cos(angle),
                    posted.place.y_m - side * half_m * math.sin(angle),
                )
                for side in (-1, 1)
            ]
            if min(ends[0][1], ends[1][1]) > NEAR_M:
                self._put_all(bodies.barrier(ends[0], ends[1]))
            return
        size_m = 0.9
        turned = self._turned(posted.place)
        up_m = POLE_M + (size_m + 0.05) * posted.above
        self._pole(place, up_m + 0.2)
        side = round(size_m * lens.focal * WIDTH * FINE / place[1])
        if side < 3 or side > 400:
            return
        x, y = lens.pixel((place[0], place[1], up_m + size_m / 2), FINE)
        if turned < 0.35:
            wide = max(2, round(side * max(0.12, abs(turned)))) // 2
            self._draw.rectangle(
                (x - wide, y - side // 2, x + wide, y + side // 2), self._shade((112, 116, 120), place[1], place[0])
            )
            return
        face = board(posted.board, posted.figure, side, self._outside.country)
        bright = min(1.0, self._light + 1.2 * _beam(2 if self._scene.car.low_beam else 0, place[1], place[0]))
        seen = Image.blend(Image.new("RGB", face.size), Image.merge("RGB", face.split()[:3]), bright)
        seen = Image.blend(seen, Image.new("RGB", face.size, self._low), _haze(place[1], self._haze_m))
        self._image.paste(seen, (x - side // 2, y - side // 2), face.getchannel("A"))

    def _signal(self, head: Head, place: FromLens) -> None:
        lens, turned = self._lens, self._turned(head.place)
        x0, y0 = place[0] + head.aside_m * turned, place[1]
        if head.aside_m <= 0 and head.up_m < 4:
            self._pole(place, head.up_m - 0.5)
        elif head.up_m >= 4:
            x, y = lens.pixel((x0, y0, head.up_m + 0.55), FINE)
            half = max(1, round(0.05 * lens.focal * WIDTH * FINE / y0))
            arm = self._shade((96, 100, 104), y0, x0)
            wide = round(1.7 * lens.focal * WIDTH * FINE / y0 * abs(turned))
            self._draw.rectangle((x - wide, y - half, x + wide, y + half), arm)
        metre = lens.focal * WIDTH * FINE / y0
        x, y = lens.pixel((x0, y0, head.up_m), FINE)
        tall, wide = round(0.52 * metre), max(1, round(0.19 * metre))
        if tall < 2 or tall > 600:
            return
        box_colour = (214, 170, 40) if self._outside.country in ("US", "CA") and turned < 0 else (28, 30, 32)
        if abs(turned) < 0.5:
            wide = max(1, wide // 2)
        self._draw.rectangle((x - wide, y - tall, x + wide, y + tall), self._shade(box_colour, y0, x0))
        if turned < 0.5:
            return
        lit, radius = LAMPS.get(head.state, ()), max(1, round(0.14 * metre))
        for at, name in enumerate(("red", "amber", "green")):
            middle = y + (at - 1) * round(0.34 * metre)
            shines = name in lit
            colour = LAMP_COLOURS[name] if shines else self._shade((54, 54, 52), y0, x0)
            if shines:
                colour = _mixed(colour, self._low, _haze(y0, self._haze_m) ** 3)
                radius_glow = min(90, max(6, radius * 3))
                radius_glow -= radius_glow % 3
                if self._lights_on:
                    self._image.paste(colour, (x - radius_glow, middle - radius_glow), _glow(radius_glow, 110))
            r = max(radius, 2) if shines else radius
            self._draw.ellipse((x - r, middle - r, x + r, middle + r), colour)


def _between(row: list[FromLens], share: float) -> FromLens:
    """A point of a tunnel's roof between its two walls."""
    (ax, ay, _), (bx, by, _) = row
    return ax + share * (bx - ax), ay + share * (by - ay), TUNNEL_M


# --- light, air and glass ----------------------------------------------------------------------------------


def _haze(ahead_m: float, visibility_m: float) -> float:
    """The share of the air's own light: 95 % of what is as far away as can be seen (Koschmieder)."""
    return 1.0 - math.exp(-3.0 * ahead_m / visibility_m)


def _beam(beam: int, ahead_m: float, right_m: float) -> float:
    """The light of dipped (1) or full headlights (2) on a spot, from 0 to 1."""
    if beam == 0 or ahead_m <= 0:
        return 0.0
    reach_m, spread = (70.0, 0.34) if beam == 1 else (160.0, 0.3)
    far, aside = 1.0 - ahead_m / reach_m, 1.0 - abs(right_m) / (2.6 + spread * ahead_m)
    if far <= 0 or aside <= 0:
        return 0.0
    return 0.82 * min(1.0, ahead_m / 9.0 + 0.25) * far * min(1.0, 1.5 * aside)


@lru_cache(maxsize=64)
def _backdrop(top: Colour, low: Colour, horizon: int, land: Colour) -> Image.Image:
    """The empty sky and land."""
    ramp = Image.new("RGB", (1, horizon))
    for row in range(horizon):
        ramp.putpixel((0, row), _mixed(top, low, (row / horizon) ** 2))
    picture = Image.new("RGB", (WIDTH * FINE, HEIGHT * FINE), land)
    picture.paste(ramp.resize((WIDTH * FINE, horizon)), (0, 0))
    return picture


@lru_cache(maxsize=32)
def _lit_ground(size: tuple[int, int], up_m: float, focal: float, beam: int, light: int) -> Image.Image:
    """How much light each pixel of the road gets."""
    width, height = size[0] // 4, size[1] // 4
    picture = Image.new("L", (width, height))
    values = []
    for row in range(height):
        ahead = up_m * focal * WIDTH / ((row + 0.5) * 4 / FINE)
        for column in range(width):
            right = ((column + 0.5) * 4 / FINE - WIDTH / 2) * ahead / (focal * WIDTH)
            values.append(round(255 * min(1.0, light / 50 + _beam(beam, ahead, right))))
    picture.putdata(values)
    mask = picture.resize(size, Image.Resampling.BILINEAR)
    return Image.merge(
        "RGB",
        (
            mask,
            mask.point([value * 97 // 100 for value in range(256)]),
            mask.point([value * 88 // 100 for value in range(256)]),
        ),
    )


@lru_cache(maxsize=32)
def _hazed(size: tuple[int, int], up_m: float, focal: float, visibility_m: int) -> Image.Image:
    """How much of each row of the road the air hides."""
    shares = [_haze(up_m * focal * WIDTH / ((row + 0.5) / FINE), visibility_m) for row in range(size[1])]
    values = [round(255 * share) for share in shares if share > 0.004]
    column = Image.new("L", (1, max(1, len(values))))
    column.putdata(values or [0])
    return column.resize((size[0], column.height))


@lru_cache(maxsize=64)
def _glow(radius: int, strength: int) -> Image.Image:
    """A soft round spot."""
    small = min(radius, 24)
    mask = Image.new("L", (2 * small, 2 * small))
    values = []
    for y in range(2 * small):
        for x in range(2 * small):
            away = math.sqrt((x + 0.5 - small) ** 2 + (y + 0.5 - small) ** 2) / small
            values.append(round(strength * max(0.0, 1.0 - away) ** 2))
    mask.putdata(values)
    return mask.resize((2 * radius, 2 * radius), Image.Resampling.BILINEAR)


_SNOW = frozenset((71, 73, 75, 77, 85, 86))


@lru_cache(maxsize=32)
def _falling(level: int, phase: int, *, snow: bool) -> Image.Image:
    """Rain or snow before the windshield."""
    mask, rng = Image.new("L", (WIDTH, HEIGHT)), Random(1000 * level + phase)
    draw = ImageDraw.Draw(mask)
    for _ in range(60 * level):
        x, y, size = int(rng.random() * WIDTH), int(rng.random() * HEIGHT), 1 + int(rng.random() * 3)
        if snow:
            draw.ellipse((x, y, x + size, y + size), 190)
        else:
            draw.line((x, y, x + (x - WIDTH // 2) // 60, y + 5 + 4 * size), 46 + 20 * size)
    return mask


def _weather(small: Image.Image, outside: Outside, time_s: float, light: float) -> None:
    rain = outside.weather.precipitation
    if rain > 0.05 and not outside.in_tunnel:
        level = 1 if rain < 1.0 else 2 if rain < 2.5 else 4 if rain < 7.6 else 7
        grey = round(70 + 150 * light)
        mask = _falling(level, int(time_s) % 8, snow=outside.weather.weather_code in _SNOW)
        small.paste((grey, grey, min(255, grey + 6)), (0, 0), mask)


@lru_cache(maxsize=1)
def _bonnet() -> Image.Image:
    """Where the own car is, below the windshield."""
    mask = Image.new("L", (WIDTH * FINE, 30 * FINE))
    ImageDraw.Draw(mask).ellipse((-160 * FINE, 2 * FINE, 800 * FINE, 190 * FINE), 255)
    return mask.reduce(FINE)


@lru_cache(maxsize=24)
def _blind(tenths: int, *, drops: bool) -> Image.Image:
    """Fogged or wet glass."""
    mask = Image.new("L", (WIDTH, HEIGHT), min(235, 22 * tenths))
    if drops:
        draw, rng = ImageDraw.Draw(mask), Random(tenths)
        for _ in range(40 * tenths):
            x, y, r = int(rng.random() * WIDTH), int(rng.random() * HEIGHT), 1 + int(rng.random() * 3)
            draw.ellipse((x - r, y - r, x + r, y + r + 1), 90)
    return mask


def _glass(small: Image.Image, scene: Scene) -> None:
    """What is on the windshield, and the bonnet behind it; behind the car, the lines of the rear camera."""
    car, light = scene.car, _sky(scene.outside)[2]
    if car.reverse:
        draw = ImageDraw.Draw(small)
        for ahead, colour in ((1.0, (224, 60, 60)), (2.0, (240, 190, 60)), (4.0, (80, 200, 120))):
            ends = [scene.lens.pixel((side * 1.0, ahead, 0.0)) for side in (-1, 1)]
            draw.line(ends, colour, 2)
        return
    bonnet = _bonnet()
    shade = round(20 + 50 * light)
    small.paste((shade, shade + 3, shade + 8), (0, HEIGHT - bonnet.height), bonnet)
    film, fog = round(10 * car.windshield_film), round(10 * car.windshield_fog)
    grey = round(50 + 150 * light)
    if film > 0:
        soft = small.filter(ImageFilter.BoxBlur(1 + film // 2))
        small.paste(soft, (0, 0))
        small.paste((grey, grey, grey), (0, 0), _blind(film // 4, drops=True))
    if fog > 0:
        small.paste((grey, grey + 4, grey + 8), (0, 0), _blind(fog, drops=False))
