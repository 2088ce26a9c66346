"""Every kind of event is found where it is, and its look-alike is told from it."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from typing import Any
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.cockpit.signals import (
    BODY,
    CABIN,
    CALL,
    ENERGY,
    GLASS,
    HMI,
    LIGHTS,
    MOTION,
    OCCUPANT,
    SEAT,
    TYRE,
)
from automotive_cosim.contracts import (
    AlertKind,
    IncidentKind,
    Limit,
    LimitSource,
    RoadIncident,
    Sight,
    SightKind,
    SlowDown,
)
from automotive_cosim.contracts.errand import Errand, ErrandKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events import KINDS, DriveAct
from automotive_cosim.drives.events.tracker import CLOSE_S, REOPEN_S
from automotive_cosim.drives.margins import BORDER_S
from automotive_cosim.traffic.base import Event
from tests.drives.scenes import NOON, found, limit, moment, stream, vehicle

PARIS_TIME = ZoneInfo("Europe/Paris")
NIGHT = datetime(2026, 6, 9, 1, 0, tzinfo=PARIS_TIME)
DUSK = datetime(2026, 6, 9, 21, 35, tzinfo=PARIS_TIME)
UNLIT = {LIGHTS.LOW_BEAM.path: False, LIGHTS.SWITCH.path: "OFF"}
SCHOOL = {"school_zone": True, "limit": limit(30), "limit_hours": "30 km/h Mo-Fr 13:00-14:00"}
MOTORWAY = {"road_class": "motorway", "lane_count": 2, "limit": limit(130)}
FRANCE, BRITAIN, IRELAND = {"position": (2.0, 48.3)}, {"position": (-1.0, 52.2)}, {"position": (-7.5, 53.3)}
RAIN = {"weather_code": 63, "precipitation": 4.0}


def sight(kind: SightKind, away_m: float | None, value: float | None = None) -> dict[str, Any]:
    """What the car notices."""
    return {"sights": (Sight(kind, kind.value, away_m, value),)}


def elsewhere(kind: IncidentKind) -> dict[str, Any]:
    """An incident that is reported, but not on the route."""
    return {"incidents": (RoadIncident(kind, "x", 0.0),)}


def asked(kind: ErrandKind, about: str, wanted: str = "", **scene: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """Somebody asks for something at second 0; the driver says no."""
    errand = Errand(kind, 0.0, about, wanted)
    return {"asked": (errand,), **scene}, {"asked": (replace(errand, is_declined=True),), **scene}


def behind(kind: str) -> dict[str, Any]:
    """Somebody or something on a rear seat, without a belt."""
    return {OCCUPANT.REAR_LEFT.occupied.path: True, OCCUPANT.REAR_LEFT.kind.path: kind}


AUTOBAHN = {"position": (8.6, 49.95), "road_class": "motorway", "lane_count": 3, "limit": limit(130)}

LEFT = {MOTION.GEAR.path: "P", OCCUPANT.DRIVER.occupied.path: False}
SCENES: Mapping[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "over_limit": ({"kmh": 60}, {"kmh": 52}),
    "limit_falls": (
        {"kmh": 80, "limit": limit(80), "next_limit": limit(50), "next_limit_distance_m": 150.0},
        {"kmh": 49, "limit": limit(80), "next_limit": limit(50), "next_limit_distance_m": 150.0},
    ),
    "school_zone": ({"kmh": 45, "limit_by_clock": True, **SCHOOL}, {"kmh": 45, **SCHOOL, "limit": limit(50)}),
    "weather_speed": ({"kmh": 128, **MOTORWAY, **RAIN}, {"kmh": 128, **MOTORWAY}),
    "lamps": ({"signals": UNLIT, "at": NIGHT}, {"signals": UNLIT, "at": DUSK}),
    "high_beam": (
        {"signals": {LIGHTS.HIGH_BEAM.path: True}, "at": NIGHT, "leader": vehicle(60.0)},
        {"signals": {LIGHTS.HIGH_BEAM.path: True}, "at": NIGHT},
    ),
    "fog_lamps": (
        {"signals": {LIGHTS.REAR_FOG.path: True}},
        {"signals": {LIGHTS.REAR_FOG.path: True}, "weather_code": 45, "visibility": 80.0},
    ),
    "glass_fog": (
        {"signals": {GLASS.WINDSHIELD_FOG.path: 0.3}},
        {"signals": {GLASS.WINDSHIELD_FOG.path: 0.1}},
    ),
    "wipers": (
        {
            "signals": {
                GLASS.WINDSHIELD_FILM.path: 0.4,
                BODY.FRONT_WIPER.path: "OFF",
                BODY.RAIN_INTENSITY.path: 40.0,
            }
        },
        {"signals": {GLASS.WINDSHIELD_FILM.path: 0.1, BODY.FRONT_WIPER.path: "OFF", BODY.RAIN_INTENSITY.path: 4.0}},
    ),
    "slippery": (
        {"friction": 0.25, "weather_code": 75, "temperature_2m": -3.0},
        {"temperature_2m": 2.0},
    ),
    "tunnel": ({"tunnel_distance_m": 110.0, "signals": UNLIT}, {"tunnel_distance_m": 900.0, "signals": UNLIT}),
    "rear_end": (sight(SightKind.VEHICLE_BEHIND, 40.0, 13.0), sight(SightKind.VEHICLE_BEHIND, 40.0, 3.0)),
    "corridor": (AUTOBAHN | {"kmh": 8}, AUTOBAHN | {"kmh": 100}),
    "jam_tail": ({"kmh": 90, **sight(SightKind.JAM, 300.0)}, {"kmh": 50, "relative_speed": 0.4}),
    "breakdown": (
        {"kmh": 80, **sight(SightKind.BREAKDOWN, 250.0)},
        {"incidents": (RoadIncident(IncidentKind.BREAKDOWN, "x", 0.0),)},
    ),
    "roadworks": (
        {"kmh": 80, **sight(SightKind.ROADWORKS, 250.0)},
        {"incidents": (RoadIncident(IncidentKind.ROADWORKS, "x", 0.0),)},
    ),
    "fatigue": ({**sight(SightKind.DRIVING_TIME, None, 2.1)}, {**sight(SightKind.DRIVING_TIME, None, 1.4)}),
    "blue_light": (sight(SightKind.EMERGENCY_VEHICLE, 100.0), sight(SightKind.VEHICLE_BEHIND, 30.0)),
    "leader_close": ({"kmh": 50, "leader": vehicle(12.0)}, {"kmh": 50, "leader": vehicle(32.0)}),
    "leader_brakes": (
        {"leader": vehicle(15.0, 10, time_to_collision_s=3.5, drac_mps2=4.1)},
        {"leader": vehicle(60.0, 22, time_to_collision_s=9.0, drac_mps2=0.6)},
    ),
    "tractor": (
        {"kmh": 80, "limit": limit(80), "leader": vehicle(90.0, 25)},
        {"kmh": 50, "limit": limit(50), "leader": vehicle(120.0, 25)},
    ),
    "belt": ({"signals": {SEAT.DRIVER_BELT.path: False}}, {"kmh": 0, "signals": {SEAT.DRIVER_BELT.path: False}}),
    "door": ({"signals": {CABIN.TRUNK.path: True}}, {"signals": {CABIN.DRIVER_WINDOW.path: 50.0}}),
    "tyre": ({"signals": {TYRE.REAR_LEFT.path: 180.0}}, {"signals": {TYRE.REAR_LEFT.path: 220.0}}),
    "phone": ({"signals": {CALL.PHONE.path: "HAND"}}, {"signals": {CALL.PHONE.path: "CRADLE"}}),
    "left_behind": (
        {
            "kmh": 0,
            "signals": {**LEFT, OCCUPANT.REAR_LEFT.occupied.path: True, OCCUPANT.REAR_LEFT.kind.path: "CHILD"},
        },
        {
            "kmh": 0,
            "signals": {**LEFT, OCCUPANT.REAR_LEFT.occupied.path: True, OCCUPANT.REAR_LEFT.kind.path: "OBJECT"},
        },
    ),
    "limit_units": (
        {"before": [FRANCE], **BRITAIN},
        {"before": [FRANCE], **BRITAIN, "signals": {HMI.DISTANCE_UNIT.path: "MILES"}},
    ),
    "rule_change": ({"before": [FRANCE], **BRITAIN}, {"before": [BRITAIN, IRELAND], **BRITAIN}),
    "range": (
        {"signals": {ENERGY.RANGE.path: 9_000.0, ENERGY.LEVEL.path: 3.0}},
        {"signals": {ENERGY.RANGE.path: 60_000.0, ENERGY.LEVEL.path: 15.0}},
    ),
    "errand_climate": asked(ErrandKind.CLIMATE, "driver", "23"),
    "errand_message": asked(ErrandKind.MESSAGE, "Mia Frost", "On my way"),
    "errand_call": asked(ErrandKind.CALL, "Tom Hale", signals={CALL.RINGING.path: "Tom Hale"}),
    "errand_place": asked(ErrandKind.PLACE, "Work"),
}
"""By kind, a scene in which something is due, and one that only looks like it."""


DUE = [name for name, kind in KINDS.items() if kind.is_due_ever]
"""Kinds of which an act is ever due."""


def test_every_kind_has_its_scenes() -> None:
    assert SCENES.keys() == KINDS.keys()


@pytest.mark.parametrize("name", DUE)
def test_an_event_is_found_with_its_three_instants(name: str) -> None:
    truth, _ = SCENES[name]
    seconds = 35 if KINDS[name].by_state else 20
    event, *others = [event for event in found(stream(seconds, **truth), name) if not event.lookalike]
    assert not others
    assert event.observable_s == 0.0
    assert event.obliged_s is not None
    assert event.deadline_s is not None
    assert 0.0 <= event.obliged_s <= seconds - 5
    assert event.obliged_s < event.deadline_s


@pytest.mark.parametrize("name", DUE)
def test_a_look_alike_obliges_to_nothing(name: str) -> None:
    _, lookalike = SCENES[name]
    events = found(stream(20, **lookalike), name)
    assert [event.lookalike for event in events] == [True]
    assert events[0].obliged_s is None


@pytest.mark.parametrize("name", KINDS)
def test_a_fact_speaks_against_a_warning_of_a_look_alike_and_none_against_one_of_an_event(name: str) -> None:
    truth, lookalike = SCENES[name]
    assert KINDS[name].speaks_against(stream(20, **truth)) is None
    assert KINDS[name].speaks_against(stream(20, **lookalike))


UNDUE: dict[str, list[dict[str, Any]]] = {
    "over_limit": [{"kmh": 15, "limit": limit(7)}, {"limit": Limit(None, LimitSource.NONE), "road_class": ""}],
    "limit_falls": [{"kmh": 80, "next_limit": limit(50), "next_limit_distance_m": 1500.0, "limit": limit(80)}],
    "weather_speed": [{"visibility": 800.0, "weather_code": 45, "kmh": 30}],
    "lamps": [
        {"visibility": 24.0, "weather_code": 45, "signals": UNLIT, "position": place}
        for place in ((2.0, 48.3), (55.3, 25.2), (-73.97, 40.77))
    ],
    "high_beam": [{"signals": {LIGHTS.HIGH_BEAM.path: True}, "leader": vehicle(140.0)}],
    "tunnel": [{"tunnel_distance_m": 600.0, "kmh": 50}],
    "leader_close": [{"kmh": 20, "leader": vehicle(10.0, 20)}],
    "leader_brakes": [{"leader": vehicle(30.0, 10, time_to_collision_s=4.0, drac_mps2=2.0)}],
    "tractor": [{"kmh": 50, "limit": limit(50), "leader": vehicle(60.0, 25)}],
    "belt": [{"kmh": 10, "signals": {SEAT.DRIVER_BELT.path: False}}],
    "phone": [{"kmh": 10, "signals": {CALL.PHONE.path: "HAND"}}],
    "wipers": [{"kmh": 0, "signals": {GLASS.WINDSHIELD_FILM.path: 0.4, BODY.FRONT_WIPER.path: "OFF"}}],
}
"""By kind, scenes in which a warning is true although nothing is due."""


@pytest.mark.parametrize(("name", "scene"), [(name, scene) for name, scenes in UNDUE.items() for scene in scenes])
def test_a_true_warning_is_never_false(name: str, scene: dict[str, Any]) -> None:
    assert KINDS[name].speaks_against(stream(20, **scene)) is None


def test_a_tyre_that_leaks_prepares_the_event_and_one_that_is_low_does_not() -> None:
    """One leak, from the first loss that the sensor tells of to 200 kPa and below."""
    drive = [moment(float(second), signals={TYRE.FRONT_LEFT.path: 250.0 - 0.7 * second}) for second in range(100)]
    event, *others = found(drive, "tyre")
    assert not others
    assert event.observable_s < 20.0
    assert event.obliged_s == pytest.approx(77.0, abs=1.0)
    steady = [moment(float(second), signals={TYRE.FRONT_LEFT.path: 237.0}) for second in range(30)]
    assert KINDS["tyre"].speaks_against(steady) == "the softest tyre has 237 kPa of 250, and keeps them"


def test_a_tyre_that_has_become_clearly_softer_is_worse() -> None:
    """Told of at 233 kPa, and again at 209."""
    drive = [moment(float(second), signals={TYRE.FRONT_LEFT.path: 250.0 - 0.7 * second}) for second in range(60)]
    (event,) = found(drive, "tyre")
    assert event.severity_at(58.0) > 1.25 * event.severity_at(24.0)


def test_a_trend_counts_from_the_first_second_of_a_drive() -> None:
    """Glass fogged by a tenth eight seconds after departure: it grows, and a warning of it is true."""
    drive = [moment(float(second), signals={GLASS.WINDSHIELD_FOG.path: 0.0136 * second}) for second in range(9)]
    assert KINDS["glass_fog"].speaks_against(drive) is None


def test_an_open_flap_can_be_seen_before_the_car_drives_off_with_it() -> None:
    opened = {CABIN.TRUNK.path: True}
    drive = [moment(float(second), kmh=0.0 if second < 10 else 30.0, signals=opened) for second in range(20)]
    (event,) = found(drive, "door")
    assert (event.observable_s, event.obliged_s) == (0.0, 12.0)
    assert not found(stream(10, kmh=0, signals=opened | {MOTION.GEAR.path: "P"}), "door")
    door = KINDS["door"]
    assert [door.settles(DriveAct(0.0, writes=((CABIN.TRUNK.path, is_open),)), None) for is_open in (0, False)] == [
        False,
        True,
    ]


@pytest.mark.parametrize(("at_sign_kmh", "kept"), [(52.0, True), (58.0, False)])
def test_a_lower_limit_that_the_driver_keeps_at_the_sign_eases(at_sign_kmh: float, kept: bool) -> None:
    falling: dict[str, Any] = {"limit": limit(80), "next_limit": limit(50)}
    drive = [
        moment(float(second), kmh=80.0 - 2 * second, next_limit_distance_m=110.0 - 10 * second, **falling)
        for second in range(11)
    ]
    drive += [moment(11.0 + second, kmh=at_sign_kmh, limit=limit(50)) for second in range(3)]
    event = next(event for event in found(drive, "limit_falls") if not event.lookalike)
    assert event.obliged_s is not None
    assert (event.eased_s is not None) is kept


@pytest.mark.parametrize("name", KINDS)
def test_an_ordinary_moment_is_neither(name: str) -> None:
    assert not found(stream(10), name)


@pytest.mark.parametrize("name", KINDS)
def test_only_its_own_alerts_settle_a_kind(name: str) -> None:
    kind = KINDS[name]
    settled = {alert for alert in AlertKind if kind.settles(DriveAct(0.0, alert), 30.0)}
    if not kind.alerts:
        assert kind.says or kind.by_state or not kind.is_due_ever
        assert not settled
        return
    assert settled == kind.alerts
    assert 0 < len(settled) < len(AlertKind) / 2


def test_what_is_said_settles_only_what_it_is_about() -> None:
    units, law = KINDS["limit_units"], KINDS["rule_change"]
    said = DriveAct(0.0, said="Signs are in mph here")
    assert units.settles(said, 1.0)
    assert not law.settles(said, None)
    assert law.settles(DriveAct(0.0, said="No horn at night here"), None)
    assert not KINDS["over_limit"].settles(said, 50.0)


def test_only_the_unit_of_the_signs_is_right() -> None:
    miles, kilometres = (
        DriveAct(0.0, writes=((HMI.DISTANCE_UNIT.path, unit),)) for unit in ("MILES", "KILOMETERS")
    )
    assert [KINDS["limit_units"].settles(act, 1.0) for act in (miles, kilometres)] == [True, False]
    assert [KINDS["limit_units"].settles(act, 0.0) for act in (miles, kilometres)] == [False, True]


def test_what_only_oncoming_traffic_forbids_is_not_due() -> None:
    """In Sweden, where the law names oncoming traffic; no sensor of the car tells of it."""
    lit = {"signals": {LIGHTS.HIGH_BEAM.path: True}, "at": NIGHT, "position": (20.2, 67.8)}
    (dark,) = found(stream(10, oncoming=vehicle(200.0), **lit), "high_beam")
    assert (dark.lookalike, dark.obliged_s) == (False, None)
    (lamps,) = found(stream(10, oncoming=vehicle(200.0), lit=True, **lit), "high_beam")
    assert lamps.obliged_s is not None
    tokyo = lit | {"position": (139.7, 35.66)}
    (coming,) = found(stream(10, oncoming=vehicle(200.0), lit=True, **tokyo), "high_beam")
    assert (coming.lookalike, coming.obliged_s) == (False, None), (
        "Japanese law does not forbid it where the road is lit"
    )


def test_a_border_is_news_for_a_minute() -> None:
    (event,) = found(stream(200, before=[FRANCE], **BRITAIN), "limit_units")
    assert event.last_s == pytest.approx(BORDER_S, abs=1.0)


def test_glass_covered_by_rain_stays_so_after_it_until_it_is_wiped() -> None:
    dry = {GLASS.WINDSHIELD_FILM.path: 0.9, BODY.FRONT_WIPER.path: "OFF", BODY.RAIN_INTENSITY.path: 0.0}
    assert [event.lookalike for event in found(stream(10, signals=dry), "wipers")] == [False]
    assert not found(stream(10, signals=dry | {GLASS.WINDSHIELD_FILM.path: 0.1}), "wipers")


def test_the_phone_may_be_looked_at_longer_the_slower_the_car() -> None:
    slow, fast = (
        found(stream(20, kmh=kmh, signals={CALL.PHONE.path: "HAND"}), "phone")[0].obliged_s for kmh in (30, 90)
    )
    assert (slow, fast) == (6.0, 4.0)


def test_an_event_that_flickers_is_one() -> None:
    drive = [moment(float(s), kmh=40.0 if 10 < s < 10 + CLOSE_S else 70.0) for s in range(20)]
    assert len(found(drive, "over_limit")) == 1


def test_a_child_with_an_adult_and_an_empty_car_need_nobody() -> None:
    child = behind("BABY")
    adult = {OCCUPANT.PASSENGER.occupied.path: True, OCCUPANT.PASSENGER.kind.path: "ELDERLY"}
    for signals, is_lookalike in (({**LEFT, **child}, False), ({**LEFT, **child, **adult}, True), (LEFT, True)):
        assert [event.lookalike for event in found(stream(20, kmh=0, signals=signals), "left_behind")] == [
            is_lookalike
        ]
    assert not found(stream(20, kmh=0, signals={**child, MOTION.GEAR.path: "P"}), "left_behind")


@pytest.mark.parametrize(
    ("kind", "is_lookalike"), [("ADULT", False), ("BABY", False), ("PET", True), ("OBJECT", True)]
)
def test_everybody_aboard_is_belted_and_things_need_not_be(kind: str, is_lookalike: bool) -> None:
    aboard = behind(kind)
    (event,) = found(stream(20, signals=aboard), "belt")
    assert "object's" not in event.words, "a thing has no belt of its own"
    assert (event.lookalike, event.obliged_s is None) == (is_lookalike, is_lookalike)
    assert not found(stream(20, signals={**aboard, OCCUPANT.REAR_LEFT.belted.path: True}), "belt")


@pytest.mark.parametrize("name", ["breakdown", "roadworks", "jam_tail"])
def test_a_slow_car_does_not_end_what_stands_ahead(name: str) -> None:
    """Nor does the driver who slows down for it when warned: later on, it is the same event."""
    scene = SCENES[name][0]
    slow = [moment(float(second), **(scene | {"kmh": 8.0})) for second in range(10, 55)]
    drive = [*stream(10, **scene), *slow, *(moment(float(second), **scene) for second in range(55, 70))]
    (event,) = [each for each in found(drive, name) if not each.lookalike]
    assert event.last_s == 69.0
    assert event.words[0].islower(), "as the words of all events, though the cockpit's line has a capital"


def test_a_red_light_does_not_end_an_open_belt() -> None:
    open_belt = {SEAT.DRIVER_BELT.path: False}
    drive = [moment(float(s), kmh=0.0 if 10 < s < 60 else 50.0, signals=open_belt) for s in range(80)]
    assert [event.lookalike for event in found(drive, "belt")] == [False]


def test_the_same_limit_again_much_later_is_another_event() -> None:
    def speed(second: int) -> float:
        return 70.0 if second < 10 or second > 15 + REOPEN_S else 40.0

    drive = [moment(float(second), kmh=speed(second)) for second in range(60)]
    assert len(found(drive, "over_limit")) == 2


def test_what_passed_by_itself_before_its_deadline_has_passed_though_it_comes_again() -> None:
    def drive(again_s: float) -> list[Moment]:
        short = [5 <= second < 10 or second >= again_s for second in range(40)]
        return [moment(float(at), leader=vehicle(8.0 if is_short else 90.0)) for at, is_short in enumerate(short)]

    (passed,) = found(drive(again_s=22), "leader_close")
    assert (passed.obliged_s, passed.deadline_s, passed.due_until_s) == (8.0, 14.0, 9.0)
    assert passed.ended_early
    (lasting,) = found(drive(again_s=12), "leader_close")
    assert not lasting.ended_early


def test_the_obligation_comes_sooner_the_faster_the_car() -> None:
    due = [found(stream(12, kmh=kmh), "over_limit")[0].obliged_s for kmh in (54, 56, 61, 66)]
    assert due == [6.0, 5.0, 4.0, 3.0]


def test_a_little_above_the_sign_of_a_school_zone_is_a_look_alike() -> None:
    at_hours = {"limit_by_clock": True, **SCHOOL}
    events = found([moment(second, kmh=32, **at_hours) for second in range(20)], "school_zone")
    assert [(event.lookalike, event.obliged_s) for event in events] == [(True, None)]
    events = found([moment(second, kmh=29, **at_hours) for second in range(20)], "school_zone")
    assert [(event.lookalike, event.obliged_s) for event in events] == [(False, None)]


def test_an_advised_speed_above_the_limit_settles_nothing() -> None:
    kind = KINDS["over_limit"]
    assert kind.settles(DriveAct(0.0, AlertKind.SPEED, speed_kmh=50.0), 50.0)
    assert not kind.settles(DriveAct(0.0, AlertKind.SPEED, speed_kmh=70.0), 50.0)
    assert kind.settles(DriveAct(0.0, requests=(SlowDown(48.0),)), 50.0)
    assert not kind.settles(DriveAct(0.0, requests=(SlowDown(90.0),)), 50.0)


def test_an_automatic_switch_lights_nothing_by_day() -> None:
    kind, act = KINDS["lamps"], DriveAct(0.0, writes=((LIGHTS.SWITCH.path, "AUTO"),))
    assert kind.settles(act, 1.0)
    assert not kind.settles(act, 0.0)


def test_rules_that_are_not_verified_oblige_to_nothing() -> None:
    """The French rule on dipped beam by day is secondary, the Swiss one verified."""
    snow = {"weather_code": 75, "visibility": 600.0, "signals": UNLIT, "at": NOON}
    assert not [event for event in found(stream(10, **snow), "lamps") if not event.lookalike]
    assert [event for event in found(stream(10, position=(8.6, 46.6), **snow), "lamps") if not event.lookalike]


def test_a_road_that_loses_its_grip_is_on_its_way_to_ice_and_one_that_is_wet_is_not() -> None:
    """So that a warning before the ice is a warning of it."""
    falling = [moment(float(second), kmh=80.0, friction=1.0 - 0.02 * second) for second in range(40)]
    (event,) = (event for event in found(falling, "slippery") if event.obliged_s is not None)
    assert event.observable_s < event.obliged_s - 15.0
    wet = found([moment(float(second), kmh=80.0, friction=0.75) for second in range(40)], "slippery")
    assert [(event.subject, event.obliged_s) for event in wet] == [("wet", None)]


@pytest.mark.parametrize(
    ("events", "is_due"),
    [
        ((), True),
        (("driver_pulls_over",), False),
        (("driver_parks",), False),
        (("driver_pulls_over", "driver_drives_on"), True),
        (("driver_parks", "driver_sets_off"), True),
    ],
)
def test_whoever_stands_at_the_side_need_not_make_room(events: tuple[str, ...], is_due: bool) -> None:
    drive = [moment(float(second), kmh=0.0, **sight(SightKind.EMERGENCY_VEHICLE, 100.0)) for second in range(20)]
    drive = [replace(each, driving=replace(each.driving, standing_s=60.0)) for each in drive]
    told = tuple(Event(0.0, kind, "driver") for kind in events)
    (event,) = found([replace(drive[0], events=told), *drive[1:]], "blue_light")
    assert (event.obliged_s is not None) is is_due
