"""The moving map: what is drawn where."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from automotive_cosim.cockpit import mapdraw
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import EGO_DOWN, Camera, RoadMap
from automotive_cosim.cockpit.mapdraw import MapScene
from automotive_cosim.cockpit.theme import DAY, NIGHT, Colour, Palette
from automotive_cosim.contracts import GroundArea, GroundKind, LimitSource, Road, RoadNetwork

SIZE = 400
EGO = (SIZE // 2, round(SIZE * EGO_DOWN))


def road(edge_id: str, *points: tuple[float, float], name: str = "", kind: str = "residential") -> Road:
    return Road(edge_id, name, kind, 1, 100.0, 13.9, LimitSource.POSTED, False, points)


def network(*roads: Road, ground: tuple[GroundArea, ...] = ()) -> RoadNetwork:
    return RoadNetwork(roads, (-500, -500, 500, 500), None, (0, 0), False, ground)


def square(kind: GroundKind, x: float, y: float, side: float) -> GroundArea:
    return GroundArea(kind, ((x, y), (x + side, y), (x + side, y + side), (x, y + side)))


def draw(
    roads: RoadMap, heading: float = 0.0, route: tuple[str, ...] = (), palette: Palette = DAY, scale: float = 1.0
) -> npt.NDArray[np.uint8]:
    side = round(SIZE * scale)
    scene = MapScene(Camera(0.0, 0.0, heading, 0.5), (0.0, 0.0, heading), route)
    return np.asarray(mapdraw.draw(roads, scene, side, side, scale, palette))


def is_at(picture: npt.NDArray[np.uint8], x: float, y: float, colour: Colour) -> bool:
    return tuple(int(value) for value in picture[round(y), round(x)]) == colour


def test_a_road_north_of_the_car_lies_above_it_when_heading_north() -> None:
    roads = RoadMap(network(road("n", (-90, 60), (90, 60))))
    assert is_at(draw(roads), EGO[0], EGO[1] - 120, DAY.street)
    assert is_at(draw(roads, heading=180.0), EGO[0], EGO[1] + 120, DAY.street)
    assert is_at(draw(roads, heading=90.0), EGO[0] - 120, EGO[1], DAY.street)


def test_route_tunnel_and_class_have_colours_of_their_own() -> None:
    north = road("north", (0, 30), (0, 100))
    plain = RoadMap(network(north))
    at = (EGO[0], EGO[1] - 130)
    assert is_at(draw(plain), *at, DAY.street)
    assert is_at(draw(plain, route=("north", "unknown")), *at, DAY.route)
    assert is_at(draw(RoadMap(network(replace(north, in_tunnel=True)))), *at, DAY.tunnel)
    assert is_at(draw(RoadMap(network(replace(north, road_class="motorway")))), *at, DAY.motorway)
    assert is_at(draw(plain, palette=NIGHT), *at, NIGHT.street)


def test_a_tunnel_lies_beneath_the_streets() -> None:
    tunnel = replace(road("t", (-80, 60), (80, 60), kind="motorway"), in_tunnel=True)
    crossing = road("s", (0, 20), (0, 100))
    assert is_at(draw(RoadMap(network(tunnel, crossing))), EGO[0], EGO[1] - 120, DAY.street)


def test_the_car_points_up_where_it_is() -> None:
    picture = draw(RoadMap(network()))
    assert is_at(picture, EGO[0], EGO[1] - 8, DAY.accent)
    assert is_at(picture, EGO[0], EGO[1] + 30, DAY.land)


def test_other_resolutions_draw_the_same_map() -> None:
    roads = RoadMap(network(road("n", (-90, 60), (90, 60))))
    double = draw(roads, scale=2.0)
    assert double.shape == (2 * SIZE, 2 * SIZE, 3)
    assert is_at(double, 2 * EGO[0], 2 * EGO[1] - 240, DAY.street)


def test_names_stand_once_inside_and_apart() -> None:
    streets = [road(f"s{i}", (-90, i * 9.0), (90, i * 9.0), name=f"Street {i % 20}") for i in range(-40, 40)]
    area, free = Rect(100, 50, 500, 500), Rect(100, 50, 500, 120)
    names = RoadMap(network(*streets)).names_in_sight(area, Camera(0.0, 0.0, 30.0, 0.5), (free,))
    assert len(names) > 3
    assert len({name.text for name in names}) == len(names)
    for i, name in enumerate(names):
        assert area.encloses(name.rect)
        assert not name.rect.overlaps(free)
        assert not any(name.rect.overlaps(other.rect) for other in names[i + 1 :])


def test_the_greatest_road_is_named_first() -> None:
    small = road("s", (-50, 60), (50, 60), name="Lane")
    great = road("g", (-50, 65), (50, 65), name="Avenue", kind="primary")
    names = RoadMap(network(small, great)).names_in_sight(Rect(0, 0, 400, 400), Camera(0, 0, 0, 0.5), ())
    assert [name.text for name in names] == ["Avenue"]


@pytest.mark.parametrize("heading", [0.0, 45.0, 123.4, 359.9])
def test_what_is_in_sight_is_drawn_at_any_heading(heading: float) -> None:
    rng = np.random.default_rng(1)
    spots = [(float(x), float(y)) for x, y in rng.uniform(-60, 60, (12, 2))]
    roads = RoadMap(network(*(road(f"r{i}", (x, y), (x + 3, y)) for i, (x, y) in enumerate(spots))))
    picture = draw(roads, heading)
    angle = np.radians(heading)
    for x, y in spots:
        across, up = x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)
        column, row = EGO[0] + across / 0.5, EGO[1] - up / 0.5
        near_car = abs(column - EGO[0]) < 40 and abs(row - EGO[1]) < 40
        if 4 < column < SIZE - 4 and 4 < row < SIZE - 4 and not near_car:
            assert is_at(picture, column, row, DAY.street)


def test_traffic_and_other_ways_have_colours_of_their_own() -> None:
    roads = RoadMap(network(road("n", (0, 30), (0, 100)), road("w", (-90, 60), (-30, 60))))

    def scene(**shown: object) -> npt.NDArray[np.uint8]:
        scene = MapScene(Camera(0.0, 0.0, 0.0, 0.5), **shown)  # type: ignore[arg-type]
        return np.asarray(mapdraw.draw(roads, scene, SIZE, SIZE, 1.0, DAY))

    north, west = (EGO[0], EGO[1] - 130), (EGO[0] - 120, EGO[1] - 120)
    assert is_at(scene(alternatives=(("w", "unknown"),)), *west, DAY.alternative)
    assert is_at(scene(slow=(("n", 0.1), ("w", 0.5))), *north, DAY.jam)
    assert is_at(scene(slow=(("n", 0.1), ("w", 0.5))), *west, DAY.dense)
    assert is_at(scene(slow=(("n", 0.7),)), *north, DAY.street)
    assert is_at(scene(slow=(("n", 0.1),), route=("n",)), *north, DAY.jam)


def test_a_picture_does_not_depend_on_what_was_drawn_before() -> None:
    rng = np.random.default_rng(3)
    spots = rng.uniform(-400, 400, (60, 4)).tolist()
    roads = RoadMap(network(*(road(f"r{i}", (a, b), (c, d)) for i, (a, b, c, d) in enumerate(spots))))
    scenes = [
        MapScene(Camera(x, 2.0 * x, 2.0 * turn, 0.9), (x, 2.0 * x, 2.0 * turn))
        for x, turn in zip(np.arange(0.0, 60.0, 7.3).tolist(), (0, 0, 0, 1, 1, 90, 90, 0, 0), strict=True)
    ]
    drawn = [mapdraw.draw(roads, scene, SIZE, 300, 1.0, NIGHT).tobytes() for scene in scenes]
    for scene, picture in reversed(list(zip(scenes, drawn, strict=True))):
        mapdraw._sheet.cache_clear()
        assert mapdraw.draw(roads, scene, SIZE, 300, 1.0, NIGHT).tobytes() == picture


def test_the_car_is_turned_on_a_map_with_north_up() -> None:
    scene = MapScene(Camera(0.0, 0.0, 0.0, 0.5, 0.5), (0.0, 0.0, 90.0))
    picture = np.asarray(mapdraw.draw(RoadMap(network()), scene, SIZE, SIZE, 1.0, DAY))
    assert is_at(picture, SIZE // 2 + 10, SIZE // 2, DAY.accent)
    assert is_at(picture, SIZE // 2 - 18, SIZE // 2, DAY.land)


def test_the_ground_lies_under_the_roads() -> None:
    kinds = (GroundKind.GREEN, GroundKind.WATER, GroundKind.BUILDING)
    ground = tuple(square(kind, -90.0 + 60 * at, 30.0, 50.0) for at, kind in enumerate(kinds))
    roads = RoadMap(network(road("w", (-95, 60), (95, 60)), ground=ground))
    for palette in (DAY, NIGHT):
        picture = draw(roads, palette=palette)
        colours = (palette.green, palette.water, palette.building)
        for at, colour in enumerate(colours):
            x, y = EGO[0] - 130 + 120 * at, EGO[1] - 80
            assert is_at(picture, x, y, colour)
            assert is_at(picture, x, EGO[1] - 120, palette.street)
            assert not is_at(picture, x, EGO[1] - 40, colour)


def test_from_further_away_there_are_no_buildings_and_no_specks() -> None:
    ground = (square(GroundKind.BUILDING, 50, 100, 200), square(GroundKind.WATER, -250, 100, 200))
    roads = RoadMap(network(ground=(*ground, square(GroundKind.GREEN, -50, 200, 8))))
    scene = MapScene(Camera(0.0, 0.0, 0.0, 2.8))
    colours = set(mapdraw.draw(roads, scene, SIZE, SIZE, 1.0, DAY).get_flattened_data())
    assert DAY.water in colours
    assert colours.isdisjoint({DAY.building, DAY.green})


@pytest.mark.parametrize("palette", [DAY, NIGHT])
def test_what_is_on_the_map_can_be_told_apart(palette: Palette) -> None:
    def away(one: Colour, other: Colour) -> float:
        return float(np.linalg.norm(np.subtract(one, other)))

    ways = (palette.street, palette.avenue, palette.motorway, palette.route, palette.dense, palette.jam)
    for ground in (palette.green, palette.water, palette.building, palette.land):
        assert min(away(ground, way) for way in ways) > 25
    assert away(palette.water, palette.route) > 90
    assert min(away(palette.land, one) for one in (palette.green, palette.water)) > 20
