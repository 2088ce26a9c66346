"""The view through the windshield: what is in it can be read back from it, and nothing else is in it."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from automotive_cosim.contracts import (
    Around,
    DrivingState,
    IncidentKind,
    LaneShape,
    Limit,
    LimitSource,
    Road,
    RoadAhead,
    RoadHere,
    RoadIncident,
    RoadNetwork,
    RoadShapes,
    RoadSnapshot,
    SeenVehicle,
    SumoSignal,
    Weather,
)
from automotive_cosim.contracts.given import ALL, Channel, See
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.envs.drive import DriveEnv
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.geo.signs import LocalSigns
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.view import paint
from automotive_cosim.view.lens import HEIGHT, WIDTH
from automotive_cosim.view.scene import Board, Outside, OwnCar, Scene, Sights, without
from automotive_cosim.view.signs import board

CLEAR = Weather(18.0, 50.0, 0.0, 0, 5.0, 30_000.0, 5.0)
FOG, RAIN = replace(CLEAR, visibility=200.0, weather_code=45), replace(CLEAR, precipitation=4.0, weather_code=63)
DAY = Outside(CLEAR, 40.0, 180.0, False, False, "FR")
NIGHT = replace(DAY, sun_deg=-30.0)
LIT = OwnCar(low_beam=True)
KINDS = ("passenger", "delivery", "truck", "bus", "tram", "motorcycle", "bicycle", "emergency", "pedestrian")


def _road(name: str, y_m: float, limit_kmh: float | None, source: LimitSource, **more: Any) -> Road:
    shape = ((0.0, y_m), (0.0, y_m + 300.0))
    return Road(name, name, "primary", 2, 300.0, limit_kmh and limit_kmh / 3.6, source, False, shape, **more)


LANES = tuple(
    LaneShape(
        f"{edge}_{at}", "road", 3.2, ((-3.2 * at, y), (-3.2 * at, y + 300.0)), (("t", at),) if edge == "a" else ()
    )
    for edge, y in (("a", 0.0), ("b", 310.0))
    for at in (0, 1)
)
SHAPES = RoadShapes(LANES, (((-8.0, 300.0), (8.0, 300.0), (8.0, 310.0), (-8.0, 310.0)),))
"""Two lanes due north, a junction with a signal at 300 m, and the same beyond."""


def network(*roads: Road) -> RoadNetwork:
    return RoadNetwork(roads, (-10.0, 0.0, 10.0, 610.0), None, (0.0, 0.0), False, junctions_m={("a", "b"): 10.0})


PLAIN = network(_road("a", 0.0, 50.0, LimitSource.POSTED), _road("b", 310.0, 50.0, LimitSource.POSTED))


def driving(y_m: float = 200.0, **ahead: Any) -> DrivingState:
    limit = Limit(50 / 3.6, LimitSource.POSTED)
    here = RoadHere("a", "a_0", 0, 2, y_m, "a", "primary", limit, False, False, True, True, 1.0)
    on = RoadAhead(600.0 - y_m, 50.0, 0.0, 1.0, None, 0.0, None, None, None, None, None, route_edges=("a", "b"))
    return DrivingState(
        9.0, 0.0, y_m, None, None, 0.0, 10.0, 0.0, 0.0, y_m, here, replace(on, **ahead),
        Around(None, None, None, None, 1.0), False, 1,
    )  # fmt: skip


def car(kind: str, ahead_m: float, aside_m: float = 0.0, heading_deg: float = 0.0, signals: int = 0) -> SeenVehicle:
    """One whose front is so far ahead of where ``driving`` stands."""
    size = {"truck": (12.0, 2.5), "bus": (12.0, 2.5), "tram": (30.0, 2.5), "pedestrian": (0.3, 0.5)}
    length_m, width_m = size.get(kind, (2.0, 0.7) if kind in ("motorcycle", "bicycle") else (4.6, 1.8))
    return SeenVehicle(
        f"{kind}{ahead_m}", kind, length_m, width_m, aside_m, 200.0 + ahead_m, heading_deg, 8.0, signals
    )


def made(
    vehicles: tuple[SeenVehicle, ...] = (),
    outside: Outside = DAY,
    own: OwnCar = LIT,
    *,
    lights: str = "GG",
    closed: tuple[str, ...] = (),
    of: RoadNetwork = PLAIN,
    at: DrivingState | None = None,
) -> Scene:
    snapshot = RoadSnapshot(9.0, vehicles, (("t", lights),), closed=closed)
    return Sights(SHAPES, of).scene(snapshot, at or driving(), outside, own)


def box(one: Scene, other: Scene, least: int = 8) -> tuple[int, int, int, int] | None:
    """What differs between two pictures: left, top, right, bottom, the last included."""
    change = np.abs(paint.picture(one).astype(int) - paint.picture(other)).max(axis=2) >= least
    rows, columns = np.flatnonzero(change.any(axis=1)), np.flatnonzero(change.any(axis=0))
    return None if not len(rows) else (int(columns[0]), int(rows[0]), int(columns[-1]), int(rows[-1]))


def nearest(scene: Scene, vehicle: SeenVehicle) -> tuple[float, float]:
    """How far to the right and how far ahead of the lens the nearer end of a vehicle is."""
    line = ((vehicle.x_m, vehicle.y_m), _rear(vehicle))
    ends = [scene.lens.sees(*point) for point in line]
    right, ahead, _ = min(ends, key=lambda each: each[1])
    return right, ahead


def _rear(vehicle: SeenVehicle) -> tuple[float, float]:
    angle = np.radians(vehicle.heading_deg)
    return vehicle.x_m - vehicle.length_m * np.sin(angle), vehicle.y_m - vehicle.length_m * np.cos(angle)


def read_back(scene: Scene, vehicle: SeenVehicle) -> tuple[float, float]:
    """The same, from the picture alone: by the lowest pixel that shows the vehicle, and the middle of those."""
    found = box(scene, without(scene, vehicle.vehicle_id))
    assert found is not None, f"{vehicle} is not in the picture"
    left, _, right, bottom = found
    right_m, ahead_m, _ = scene.lens.sees(*scene.lens.on_road((left + right + 1) / 2, bottom + 1))
    return right_m, ahead_m


def slack_m(scene: Scene, ahead_m: float) -> float:
    """What two pixels are there, and a bumper."""
    return 0.8 + 2.0 * ahead_m**2 / (scene.lens.up_m * scene.lens.focal * WIDTH)


# --- positions ---------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("outside", [DAY, NIGHT, replace(DAY, weather=RAIN)], ids=["day", "night", "rain"])
def test_who_is_there_can_be_read_back_where_it_is(outside: Outside) -> None:
    wrong = []
    for kind, ahead_m, (aside_m, heading_deg) in product(KINDS, (16.0, 30.0, 48.0), ((0.0, 0.0), (-3.2, 180.0))):
        length_m = car(kind, 0.0).length_m if heading_deg == 0 else 0.0
        vehicle = car(kind, ahead_m + length_m, aside_m, heading_deg)
        scene = made((vehicle,), outside)
        for own, told, slack in zip(
            nearest(scene, vehicle), read_back(scene, vehicle), (0.9, slack_m(scene, ahead_m)), strict=True
        ):
            # a lamp's light is wider than the lamp, and of a long side the middle is not that of its end
            if abs(own - told) > slack + (vehicle.length_m / 4 if aside_m else 0.0):
                wrong.append((kind, ahead_m, aside_m, own, told))
    assert not wrong


def test_a_pixel_of_the_road_is_one_place_and_back() -> None:
    for own in (LIT, OwnCar(reverse=True)):
        lens = made(own=own).lens
        for across, down in product((100, 320, 500), (200, 260, 350)):
            assert lens.pixel(lens.sees(*lens.on_road(across, down))) == (across, down)


def test_behind_the_car_is_what_is_behind_and_right_stays_right() -> None:
    follower = car("passenger", -12.0, aside_m=-3.2)
    assert box(made((follower,)), made()) is None
    scene = made((follower,), own=OwnCar(reverse=True))
    right_m, ahead_m = read_back(scene, follower)
    assert right_m == pytest.approx(-3.2, abs=0.8)
    assert ahead_m == pytest.approx(12.0 - 5.0, abs=1.5)


@pytest.mark.parametrize("kind", KINDS)
def test_a_picture_has_nothing_beside_what_is_there(kind: str) -> None:
    vehicle = car(kind, 30.0 + car(kind, 0.0).length_m)
    scene = made((vehicle,))
    found = box(scene, without(scene, vehicle.vehicle_id), least=1)
    assert found is not None
    assert found[2] - found[0] < 130
    assert found[3] - found[1] < 130
    assert (paint.picture(scene) == paint.picture(made((vehicle,)))).all()


def _seen_in_traffic(family: str, simulations: Simulations, looks: int) -> Iterator[tuple[Scene, SeenVehicle]]:
    """Vehicles of a real drive that nothing hides."""
    kept: list[Scene] = []
    session = DriveSpec(family, seed=1).begin(simulations, frozenset(), lean=True)
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("automotive_cosim.cosim.simulation.picture", kept.append)
            for _ in range(looks):
                session.world.advance(4.0)
                session.world.view()
    finally:
        session.close()
    for scene in kept:
        for vehicle in scene.vehicles:
            right, ahead = nearest(scene, vehicle)
            others = [nearest(scene, each) for each in scene.vehicles if each is not vehicle]
            is_hidden = any(
                a < ahead + 3 and abs(r / max(a, 1.0) - right / ahead) < 6.0 / max(a, 1.0)
                for r, a in others
                if a > -5
            )
            if 8.0 < ahead < 45.0 and abs(right) < 0.45 * ahead and not is_hidden:
                yield scene, vehicle


def _check_traffic(family: str, simulations: Simulations, looks: int) -> int:
    count, wrong = 0, []
    for scene, vehicle in _seen_in_traffic(family, simulations, looks):
        count += 1
        own, told = nearest(scene, vehicle), read_back(scene, vehicle)
        if (
            abs(own[0] - told[0]) > 1.0 + vehicle.length_m / 2
            or abs(own[1] - told[1]) > slack_m(scene, own[1]) + 2.0
        ):
            wrong.append((vehicle, own, told))
    assert not wrong
    return count


def test_the_vehicles_of_a_real_drive_can_be_read_back(simulations: Simulations) -> None:
    assert _check_traffic("grid_june", simulations, 20) > 5


@pytest.mark.proof
@pytest.mark.parametrize("family", ["london_november", "autobahn_july", "new_york_june", "gulf_july"])
def test_and_those_of_other_places(simulations: Simulations, family: str) -> None:
    assert _check_traffic(family, simulations, 100) > 3


# --- signs, signals and lamps -------------------------------------------------------------------------------

THIRTY = Limit(30 / 3.6, LimitSource.POSTED)
OTHER = _road("b", 310.0, 30.0, LimitSource.POSTED)
FREE = replace(OTHER, limit_mps=None)
BEFORE = _road("a", 0.0, 50.0, LimitSource.POSTED)


def boards(scene: Scene) -> set[tuple[Board, str]]:
    return {(each.board, each.figure) for each in scene.posted}


@pytest.mark.parametrize(
    ("of", "ahead", "expected"),
    [
        (PLAIN, {}, set()),
        (network(BEFORE, OTHER), {"route_edges": ("a",)}, {(Board.LIMIT, "30")}),
        (network(BEFORE, replace(OTHER, limit_source=LimitSource.ASSUMED)), {"route_edges": ("a",)}, set()),
        (network(BEFORE, FREE), {"route_edges": ("a",)}, {(Board.END_OF_LIMIT, "")}),
        (network(BEFORE, OTHER), {}, set()),
        (PLAIN, {"next_limit": THIRTY, "next_limit_distance_m": 110.0}, {(Board.LIMIT, "30")}),
        (PLAIN, {"next_limit": Limit(9.0, LimitSource.ASSUMED), "next_limit_distance_m": 110.0}, set()),
        (PLAIN, {"next_sign": "stop", "sign_distance_m": 100.0}, {(Board.STOP, "")}),
        (PLAIN, {"next_sign": "give_way", "sign_distance_m": 900.0}, set()),
        (PLAIN, {"incidents": (RoadIncident(IncidentKind.ROADWORKS, "b", 0.0),)}, {(Board.ROADWORKS, "")}),
        (network(BEFORE, _road("b", 310.0, 50.0, LimitSource.POSTED, school_zone=True)), {}, {(Board.SCHOOL, "")}),
    ],
)
def test_a_sign_stands_where_one_is_posted_and_only_there(
    of: RoadNetwork, ahead: dict[str, Any], expected: set[tuple[Board, str]]
) -> None:
    scene = made(of=of, at=driving(**ahead))
    assert boards(scene) == expected
    assert (box(scene, replace(scene, posted=())) is not None) == bool(expected), "what is posted is seen"


def test_a_network_that_was_moved_shows_the_signs_of_its_new_country() -> None:
    snapshot = RoadSnapshot(9.0, (), ())
    miles = Sights(SHAPES, network(BEFORE, OTHER), LocalSigns("mph", 5.0))
    outside = replace(DAY, country="US", unit="mph")
    assert boards(miles.scene(snapshot, driving(route_edges=("a",)), outside, LIT)) == {(Board.LIMIT, "20")}


def test_each_country_has_its_own_shapes() -> None:
    def shape(kind: Board, country: str) -> npt.NDArray[np.uint8]:
        return np.asarray(board(kind, "50" if kind is Board.LIMIT else "", 60, country))

    for kind, one, other in (
        (Board.LIMIT, "FR", "US"),
        (Board.SCHOOL, "DE", "US"),
        (Board.STOP, "GB", "JP"),
        (Board.ROADWORKS, "FR", "AU"),
    ):
        assert (shape(kind, one) != shape(kind, other)).any()
        assert (shape(kind, one) == shape(kind, "")).all()


@pytest.mark.parametrize(("letter", "channel"), [("G", 1), ("g", 1), ("r", 0), ("y", 0)])
def test_a_signal_shows_its_state(letter: str, channel: int) -> None:
    dark, lit = made(lights="OO", at=driving(270.0)), made(lights=letter * 2, at=driving(270.0))
    change = paint.picture(lit).astype(int) - paint.picture(dark)
    assert change.max() > 100
    strongest = np.unravel_index(change.max(axis=2).argmax(), (HEIGHT, WIDTH))
    assert change[strongest].argmax() == channel


@pytest.mark.parametrize(
    ("kind", "bit", "dim"),
    [
        ("passenger", SumoSignal.BRAKE, 2),
        ("bus", SumoSignal.LEFT, 2),
        ("truck", SumoSignal.RIGHT, 2),
        ("passenger", SumoSignal.HAZARD, 2),
        ("emergency", SumoSignal.BLUE, 0),
    ],
)
def test_lamps_are_lit_where_sumo_lights_them(kind: str, bit: SumoSignal, dim: int) -> None:
    off, on = (made((car(kind, 22.0, signals=signals),)) for signals in (0, int(bit)))
    change = paint.picture(on).astype(int) - paint.picture(off)
    strongest = np.unravel_index(change.max(axis=2).argmax(), (HEIGHT, WIDTH))
    assert change.max() > 60
    assert change[strongest].argmin() == dim


def test_what_is_closed_has_barriers_and_cones_on_it() -> None:
    one = made(closed=("a_0",), at=driving(5.0))
    assert {each.board for each in one.posted} == {Board.ROADWORKS, Board.BARRIER, Board.CONE}
    assert {round(each.place.x_m, 1) for each in one.posted if each.board is Board.CONE} == {0.0}
    assert (Board.CLOSED, "") in boards(made(closed=("b_0", "b_1")))


def test_a_zebra_is_where_people_cross() -> None:
    line = LaneShape(":a_c0_0", "foot", 4.0, ((8.0, 280.0), (-8.0, 280.0)))
    bare, striped = (
        Sights(replace(SHAPES, crossings=crossings), PLAIN).scene(
            RoadSnapshot(9.0, (), ()), driving(260.0), DAY, LIT
        )
        for crossings in ((), (line,))
    )
    change = np.abs(paint.picture(striped).astype(int) - paint.picture(bare)).max(axis=2) > 60
    places = [striped.lens.on_road(across + 0.5, down + 0.5) for down, across in np.argwhere(change)]
    assert min(x for x, _ in places) == pytest.approx(-8.0, abs=0.7)
    assert max(x for x, _ in places) == pytest.approx(8.0, abs=0.7)
    assert min(y for _, y in places) == pytest.approx(278.0, abs=0.8)
    assert max(y for _, y in places) == pytest.approx(282.0, abs=0.8)
    middle = change[striped.lens.pixel(striped.lens.sees(0.0, 280.0))[1]]
    assert np.count_nonzero(np.diff(middle.astype(int)) > 0) in range(14, 18), "a stripe each metre"


# --- light and air ------------------------------------------------------------------------------------------


def test_night_is_dark_and_headlights_show_the_road() -> None:
    day, night, dark = (
        paint.picture(made(outside=out, own=own)).mean()
        for out, own in ((DAY, LIT), (NIGHT, LIT), (NIGHT, OwnCar()))
    )
    assert day > 2 * night > 2 * 1.3 * dark


def test_fog_hides_what_is_far_and_wet_glass_blurs() -> None:
    far = car("passenger", 140.0)
    fog = replace(DAY, weather=replace(FOG, visibility=60.0))
    assert box(made((far,)), made()) is not None
    assert box(made((far,), fog), made((), fog)) is None
    plain = paint.picture(made())
    for blind in (OwnCar(windshield_fog=0.8), OwnCar(windshield_film=0.8)):
        assert (
            np.diff(paint.picture(made(own=blind)).astype(int), axis=0).std()
            < np.diff(plain.astype(int), axis=0).std()
        )


# --- the channel --------------------------------------------------------------------------------------------


def test_only_who_asks_for_the_road_and_takes_pictures_gets_it() -> None:
    assert Channel.CAMERA not in ALL
    for see in See:
        for channels in (ALL, ALL - {Channel.SCREENSHOT}, ALL | {Channel.CAMERA}):
            if see is See.NOTHING or (see is See.PICTURE and Channel.SCREENSHOT not in channels):
                continue  # an agent that would see nothing
            given = SessionSetup(channels, Conditions(see=see)).given
            asked = see is See.CAMERA and Channel.SCREENSHOT in channels
            assert (Channel.CAMERA in given) == (asked or Channel.CAMERA in channels)
            assert given - {Channel.CAMERA} == channels - see.withheld - {Channel.CAMERA}


def test_the_environment_gives_the_view_and_it_changes_nothing(simulations: Simulations) -> None:
    hashes = []
    for conditions in ({}, {"see": "camera"}):
        env = DriveEnv("grid_june", minutes=10, simulations=simulations, **conditions)
        try:
            seen, _ = env.reset(seed=3)
            for _ in range(4):
                seen, *_ = env.step('{"action_type": "wait", "seconds": 2}')
                assert env.observation_space.contains(seen)
            assert ("camera" in seen) == bool(conditions)
            if conditions:
                assert seen["camera"].shape == (HEIGHT, WIDTH, 3)
                assert (seen["camera"] == env.unwrapped.episode.world.view()).all()
            hashes.append(env.unwrapped.episode.trace_sha256)
        finally:
            env.close()
    assert hashes[0] == hashes[1]
