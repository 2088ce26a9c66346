"""The cockpit as its users drive it: fingers, safety calls, the road's answers, copies, and a lot of nonsense."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.occupants import company
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.cockpit.signals import ADAS, ENERGY, GLASS, HVAC, LIGHTS, MEDIA, MOTION, difference
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    Answer,
    Around,
    Cruise,
    Direction,
    FeedbackCode,
    Hazards,
    Limit,
    LimitSource,
    OtherVehicle,
    PullOver,
    Reroute,
    RoadNetwork,
    Severity,
    SlowDown,
    Surroundings,
    Weather,
)
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.errors import SignalError, UnknownNameError
from automotive_cosim.interface import spaces
from tests.cockpit.fingers import find, middle, press, shown

Make = Callable[..., Cockpit]
OK, NO_EFFECT = FeedbackCode.OK, FeedbackCode.NO_EFFECT


def at_rest(surroundings: Surroundings) -> Surroundings:
    return replace(surroundings, driving=replace(surroundings.driving, speed_mps=0.0))


# --- sensing ------------------------------------------------------------------------------------------------


def test_the_signals_say_what_is_outside(make: Make, around: Surroundings) -> None:
    leader = OtherVehicle("v", 32.0, 9.0, 7.5)
    driving = replace(around.driving, around=Around(leader, None, None, None, 1.0))
    cockpit = make(surroundings=replace(around, driving=driving, weather=Weather(3.0, 80.0, 4.0, 63, 90, 4000, 9)))
    state = cockpit.vehicle_state()
    assert state.speed_kmh == pytest.approx(48.0)
    assert state.ambient_temperature_c == 3.0
    assert state.rain_intensity_pct == pytest.approx(40.0)
    assert state.leader_gap_m == 32.0
    assert state.leader_time_to_collision_s == 7.5
    assert state.restrictions == 511
    assert cockpit.signals[MOTION.LATITUDE] == pytest.approx(48.86)


def test_what_the_car_has_not_is_absent(make: Make, around: Surroundings) -> None:
    far = OtherVehicle("v", 400.0, 9.0, 7.5)
    driving = replace(around.driving, around=Around(far, None, None, None, 1.0))
    state = make(surroundings=replace(around, driving=driving, gps=None), sign_camera=False).vehicle_state()
    assert state.speed_limit_sign_kmh is None
    assert state.leader_gap_m is None


def test_the_camera_reads_signs_and_no_assumptions(make: Make, around: Surroundings) -> None:
    assert make().vehicle_state().speed_limit_sign_kmh == pytest.approx(50.0)
    assert shown(make(), "status.limit_sign") == "50"
    assert shown(make(sign_camera=False), "status.limit_sign") == ""
    road = replace(around.driving.road, limit=Limit(50 / 3.6, LimitSource.ASSUMED))
    assumed = make(surroundings=replace(around, driving=replace(around.driving, road=road)))
    assert assumed.vehicle_state().speed_limit_sign_kmh is None


def test_dusk_and_tunnels_light_the_lamps_and_darken_the_display(cockpit: Cockpit, around: Surroundings) -> None:
    day = cockpit.screenshot()
    road = replace(around.driving.road, in_tunnel=True)
    cockpit.sense(replace(around, driving=replace(around.driving, road=road)), 1.0)
    assert cockpit.signals[LIGHTS.LOW_BEAM]
    assert cockpit.screenshot().mean() < day.mean() / 2


def test_damp_people_fog_the_windows_and_the_button_in_the_dock_clears_them(
    make: Make, around: Surroundings
) -> None:
    cold = replace(around, weather=Weather(4.0, 92.0, 0.0, 3, 95.0, 9000.0, 8.0))
    cockpit = make(
        surroundings=cold,
        aboard=company(4),
        cabin={"wet_clothes": True, "temperature_c": 17.0, "humidity_pct": 40.0},
        signals={HVAC.RECIRCULATION.path: True},
    )
    for _ in range(130):
        cockpit.sense(cold, 1.0)
    assert cockpit.signals[GLASS.WINDSHIELD_FOG] > 0.5
    cockpit.open_app("climate")
    assert "fogged inside" in shown(cockpit, "glass.windshield")
    assert press(cockpit, "dock.front_defroster") is OK
    for _ in range(60):
        cockpit.sense(cold, 1.0)
    assert cockpit.signals[GLASS.WINDSHIELD_FOG] < 0.05
    assert "clear" in shown(cockpit, "glass.windshield")


def test_driving_drains_the_battery(cockpit: Cockpit, around: Surroundings) -> None:
    before = cockpit.signals[ENERGY.LEVEL]
    cockpit.sense(around, 60.0)
    assert cockpit.signals[ENERGY.LEVEL] < before


# --- fingers ------------------------------------------------------------------------------------------------


def test_every_app_opens_by_name_and_from_the_dock(cockpit: Cockpit) -> None:
    for app in {name for name, app in apps().items() if app.preinstalled} - {"home"}:
        assert cockpit.open_app(app).code is OK
        assert cockpit.screen == app
        assert cockpit.open_app(app).code is NO_EFFECT
        cockpit.home()
        where = app if apps()[app].where is Where.DOCK else "apps"
        assert press(cockpit, f"dock.{where}") is OK
        assert where == app or press(cockpit, f"apps.{app}") is OK
        assert cockpit.screen == app


def test_messages_opens_the_messages_of_the_phone(cockpit: Cockpit) -> None:
    cockpit.open_app("phone")
    assert shown(cockpit, "phone.thread.0") == ""
    assert cockpit.open_app("Messages").code is OK
    first = shown(cockpit, "phone.thread.0")
    assert first in cockpit.content["unread"]
    assert cockpit.open_app("messages").code is NO_EFFECT
    assert cockpit.back().code is OK
    assert shown(cockpit, "phone.thread.0") == ""
    assert shown(cockpit, "phone.favourite.0") in cockpit.content["favourite_contacts"]


def test_an_app_opens_once_it_is_installed_which_is_done_while_parked(make: Make, around: Surroundings) -> None:
    moving = make()
    assert moving.open_app("calendar").code is FeedbackCode.REFUSED
    assert press(moving, "open store; store.calendar") is FeedbackCode.RESTRICTED
    parked = make(surroundings=at_rest(around), signals={MOTION.GEAR.path: "P"})
    assert press(parked, "open store; store.calendar") is OK
    assert "calendar" in parked.commands()["apps.installed"]
    assert parked.open_app("calendar").code is OK


def test_the_action_space_knows_every_app() -> None:
    assert set(spaces.APPS) == set(apps())


def test_an_unknown_app_is_named_with_a_suggestion(cockpit: Cockpit) -> None:
    feedback = cockpit.open_app("climat")
    assert feedback.code is FeedbackCode.NO_SUCH_ELEMENT
    assert "climate" in feedback.text


def test_back_retraces_the_way(cockpit: Cockpit) -> None:
    for app in ("map", "media", "safety"):
        cockpit.open_app(app)
    seen = []
    while cockpit.back().code is OK:
        seen.append(cockpit.screen)
    assert seen == ["media", "map", "home"]


def test_a_tap_beside_every_widget_has_no_effect(cockpit: Cockpit) -> None:
    before = cockpit.commands()
    assert cockpit.tap(640, 622).code is NO_EFFECT
    assert cockpit.tap(-5, 9999).code is NO_EFFECT
    assert cockpit.commands() == before


def test_sliders_go_where_they_are_touched_and_drag_by_a_tenth(cockpit: Cockpit) -> None:
    cockpit.open_app("climate")
    track = next(widget for widget in cockpit.tree.walk() if widget.key == "hvac.fan").track  # type: ignore[attr-defined]
    assert cockpit.tap(track.x, track.y).code is OK
    assert cockpit.signals[HVAC.FAN_SPEED] == 0.0
    cockpit.tap(track.right, track.y)
    assert cockpit.signals[HVAC.FAN_SPEED] == 100.0
    assert cockpit.swipe(track.x + 40, track.y, Direction.LEFT).code is OK
    assert cockpit.signals[HVAC.FAN_SPEED] == 90.0
    assert cockpit.swipe(track.x + 40, track.y, Direction.UP).code is NO_EFFECT


def test_a_swipe_up_reveals_what_lies_below(cockpit: Cockpit) -> None:
    cockpit.open_app("media")
    assert cockpit.swipe(900, 400, Direction.UP).code is OK
    assert shown(cockpit, "media.entry.0") == ""
    assert cockpit.swipe(900, 400, Direction.DOWN).code is OK
    assert shown(cockpit, "media.entry.0")
    assert cockpit.scroll("media.entry.0", Direction.UP).code is NO_EFFECT
    assert cockpit.scroll("no.such", Direction.UP).code is FeedbackCode.NO_SUCH_ELEMENT
    assert cockpit.scroll(None, Direction.LEFT).code is NO_EFFECT


def test_a_double_tap_comes_closer_on_the_map(cockpit: Cockpit) -> None:
    cockpit.open_app("map")
    before = cockpit.screenshot()
    assert cockpit.double_tap(800, 300).code is OK
    assert cockpit.screenshot().tobytes() != before.tobytes()
    assert cockpit.double_tap(800, 300).code is NO_EFFECT
    assert cockpit.long_press(800, 300).code is NO_EFFECT


def test_typing_is_locked_while_moving_and_open_when_parked(make: Make, around: Surroundings) -> None:
    moving = make()
    assert press(moving, "open map; map.search") is FeedbackCode.RESTRICTED
    assert moving.type_text("Rue").code is not OK
    assert moving.key_enter().code is FeedbackCode.RESTRICTED
    standing = make(surroundings=at_rest(around))
    assert standing.type_text("Rue").code is FeedbackCode.NO_SUCH_ELEMENT
    assert press(standing, "open map; map.search") is OK
    assert standing.type_text("pont").code is OK
    assert "Pont Neuf" in {element.text for element in standing.elements()}
    assert standing.key_enter().code is OK
    assert standing.drain_requests()[0].destination.startswith("Pont Neuf")  # type: ignore[union-attr]


def test_a_search_begun_at_the_light_is_locked_when_the_car_drives_on(make: Make, around: Surroundings) -> None:
    cockpit = make(surroundings=at_rest(around))
    press(cockpit, "open map; map.search")
    cockpit.sense(around, 1.0)
    assert cockpit.type_text("Rue").code is not OK


# --- what goes to the road ------------------------------------------------------------------------------------


def test_the_button_and_the_call_give_the_same_alert(make: Make) -> None:
    by_hand, by_call = make(), make()
    assert press(by_hand, "open safety; safety.warn") is FeedbackCode.DISABLED
    assert press(by_hand, "safety.kind.distance; safety.severity.critical; safety.warn") is OK
    by_call.alert(Alert(AlertKind.DISTANCE, Severity.CRITICAL))
    assert by_hand.drain_requests() == by_call.drain_requests() == (Alert(AlertKind.DISTANCE, Severity.CRITICAL),)
    assert by_hand.commands() == by_call.commands()
    assert by_hand.drain_requests() == ()


def test_an_advised_speed_starts_from_the_sign_and_can_be_left_to_it(cockpit: Cockpit) -> None:
    press(
        cockpit,
        "open safety; safety.kind.speed; safety.speed.decrease; safety.speed.decrease; safety.warn",
        "safety.kind.speed; safety.warn",
    )
    assert cockpit.drain_requests() == (Alert(AlertKind.SPEED, speed_kmh=40.0), Alert(AlertKind.SPEED))


def test_an_alert_shows_for_a_while_and_the_history_keeps_the_road_s_answer(
    cockpit: Cockpit, around: Surroundings
) -> None:
    cockpit.alert(Alert(AlertKind.SPEED, Severity.WARNING, "Mind the limit"))
    assert shown(cockpit, "status.notice") == "Mind the limit"
    (request,) = cockpit.drain_requests()
    cockpit.answered(request, Answer(True, "The driver slows down"))
    later = replace(around, driving=replace(around.driving, time_s=around.driving.time_s + 60))
    cockpit.sense(later, 60.0)
    assert shown(cockpit, "status.notice") == ""
    cockpit.open_app("safety")
    entry = find(cockpit, "safety.history.0")
    assert "The driver slows down" in entry.content_description
    assert cockpit.commands()["alerts"] == [
        {"kind": "speed", "severity": "warning", "text": "Mind the limit", "speed_kmh": None}
    ]


def test_senseless_speeds_are_refused(cockpit: Cockpit) -> None:
    before = cockpit.commands()
    for speed in (-10.0, 0.0, float("inf"), float("nan"), 900.0):
        assert cockpit.alert(Alert(AlertKind.SPEED, speed_kmh=speed)).code is FeedbackCode.REFUSED
    assert cockpit.ask_road(SlowDown(-3.0)).code is FeedbackCode.REFUSED
    assert cockpit.commands() == before
    assert cockpit.drain_requests() == ()


def test_hazards_and_cruise_tell_the_road(cockpit: Cockpit) -> None:
    assert cockpit.hazards(True).code is OK
    assert cockpit.hazards(True).code is NO_EFFECT
    press(
        cockpit,
        "open vehicle; lights.hazard; vehicle.tab.assistance; adas.cruise; adas.cruise_speed.increase",
        "adas.cruise",
    )
    assert cockpit.drain_requests() == (Hazards(True), Hazards(False), Cruise(50.0), Cruise(55.0), Cruise(None))


def test_a_refused_cruise_goes_off_and_says_why(cockpit: Cockpit) -> None:
    press(cockpit, "open vehicle; vehicle.tab.assistance; adas.cruise")
    (request,) = cockpit.drain_requests()
    cockpit.answered(request, Answer(False, "too slow for cruise control"))
    assert not cockpit.signals[ADAS.CRUISE_ACTIVE]
    assert shown(cockpit, "status.notice") == "too slow for cruise control"


def test_slowing_down_needs_a_speed(make: Make) -> None:
    blind = make(sign_camera=False)
    assert press(blind, "open safety; safety.slow_down") is FeedbackCode.REFUSED
    seeing = make()
    assert press(seeing, "open safety; safety.slow_down") is OK
    assert press(seeing, "safety.pull_over") is OK
    assert seeing.drain_requests() == (SlowDown(50.0), PullOver())


def test_a_destination_counts_once_the_road_accepts_it(cockpit: Cockpit) -> None:
    cockpit.open_app("map")
    name = shown(cockpit, "map.place.2")
    assert press(cockpit, "map.place.2") is OK
    assert press(cockpit, "place.start") is OK
    (request,) = cockpit.drain_requests()
    assert request == Reroute(name)
    assert cockpit.commands()["navigation.destination"] == ""
    cockpit.answered(request, Answer(False, "there is no way there"))
    assert cockpit.commands()["navigation.destination"] == ""
    cockpit.answered(request, Answer(True, "New route"))
    assert cockpit.commands()["navigation.destination"] == name


def test_an_emergency_call_asks_once_more_and_cannot_be_taken_back(cockpit: Cockpit) -> None:
    press(cockpit, "open safety; safety.emergency_call")
    assert cockpit.commands()["calls"] == []
    press(cockpit, "emergency.cancel")
    assert cockpit.screen == "safety"
    press(cockpit, "safety.emergency_call; emergency.call; back")
    assert cockpit.commands()["calls"] == ["emergency"]


# --- media, settings -----------------------------------------------------------------------------------------


def test_music_plays_skips_and_follows_its_source(cockpit: Cockpit, around: Surroundings) -> None:
    cockpit.open_app("media")
    first = cockpit.signals[MEDIA.TRACK]
    press(cockpit, "media.play")
    cockpit.sense(around, 42.0)
    assert shown(cockpit, "media.elapsed") == "0:42"
    press(cockpit, "media.next")
    assert cockpit.signals[MEDIA.TRACK] != first
    assert shown(cockpit, "media.elapsed") == "0:00"
    press(cockpit, "media.previous")
    assert cockpit.signals[MEDIA.TRACK] == first
    press(cockpit, "media.source.fm")
    assert shown(cockpit, "media.live") == "Live"
    assert shown(cockpit, "media.artist").endswith("MHz")


def test_units_are_those_chosen(cockpit: Cockpit) -> None:
    press(cockpit, "open settings; settings.distance.miles; settings.temperature.fahrenheit")
    assert shown(cockpit, "status.speed") == "30"
    assert shown(cockpit, "status.speed_unit") == "mph"
    assert shown(cockpit, "status.limit_sign") == "50", "a sign keeps its own figure"
    assert shown(cockpit, "status.outside_temperature") == "57 °F"


# --- start, copies, nonsense ----------------------------------------------------------------------------------


def test_a_start_is_checked(network: RoadNetwork) -> None:
    rng = np.random.default_rng(1)
    with pytest.raises(UnknownNameError, match="signal"):
        Cockpit(network, rng=rng, signals={"Vehicle.Spede": 1.0})
    with pytest.raises(SignalError, match="0 to 100"):
        Cockpit(network, rng=rng, signals={HVAC.FAN_SPEED.path: 300.0})
    with pytest.raises(SignalError, match="first"):
        Cockpit(network, rng=rng, signals={LIGHTS.HIGH_BEAM.path: True})


def test_the_seed_decides_what_is_made_up(make: Make) -> None:
    assert make(3).screenshot().tobytes() == make(3).screenshot().tobytes()
    assert make(3).signals[MEDIA.TRACK] != make(4).signals[MEDIA.TRACK]


def test_a_network_without_roads_or_names_still_shows(around: Surroundings) -> None:
    cockpit = Cockpit(RoadNetwork((), (0, 0, 1, 1), None, (0, 0), False), rng=np.random.default_rng(1))
    cockpit.sense(replace(around, gps=None, sun_elevation_deg=None), 0.0)
    for app in apps():
        cockpit.open_app(app)
        assert cockpit.screenshot().shape == (720, 1280, 3)
        assert cockpit.elements()


def test_copies_are_independent(cockpit: Cockpit, around: Surroundings) -> None:
    before = (cockpit.commands(), cockpit.elements(), cockpit.screenshot().tobytes())
    twin = cockpit.copy()
    assert (twin.commands(), twin.elements(), twin.screenshot().tobytes()) == before
    press(twin, "open climate; hvac.front_defroster")
    twin.alert(Alert(AlertKind.SPEED))
    twin.emergency_call()
    twin.sense(at_rest(around), 30.0)
    assert (cockpit.commands(), cockpit.elements(), cockpit.screenshot().tobytes()) == before
    assert twin.commands() != before[0]
    assert cockpit.drain_requests() == ()


def test_two_copies_left_alone_stay_alike(cockpit: Cockpit, around: Surroundings) -> None:
    twin = cockpit.copy()
    for one in (cockpit, twin):
        for second in range(20):
            driving = replace(around.driving, time_s=around.driving.time_s + second)
            one.sense(replace(around, driving=driving), 1.0)
    assert difference(cockpit.signals.snapshot(), twin.signals.snapshot()) == {}
    assert cockpit.screenshot().tobytes() == twin.screenshot().tobytes()


def test_a_long_press_on_plus_goes_several_steps_and_stops_at_the_end(cockpit: Cockpit) -> None:
    (plus,) = (
        each for each in cockpit.elements() if each.resource_id == shown_id("dock.driver_temperature.increase")
    )
    assert plus.is_long_clickable
    assert plus.content_description == "Driver's temperature higher by 0.5"
    before = cockpit.signals[HVAC.DRIVER_TEMPERATURE]
    assert cockpit.long_press(*middle(plus)).code is OK
    assert cockpit.signals[HVAC.DRIVER_TEMPERATURE] == before + 2.5
    for _ in range(3):
        code = cockpit.long_press(*middle(plus)).code
    assert cockpit.signals[HVAC.DRIVER_TEMPERATURE] == HVAC.DRIVER_TEMPERATURE.high
    assert code is FeedbackCode.DISABLED


def test_a_page_is_named_with_its_app_and_nothing_else_is_offered(cockpit: Cockpit) -> None:
    said = cockpit.open_app("Seats")
    assert said.code is FeedbackCode.NO_SUCH_ELEMENT
    assert said.text == "seats is not an app; it is a page of vehicle"


def test_no_list_begins_where_another_was_scrolled_to(cockpit: Cockpit) -> None:
    """Another source, another podcast: each list begins at its first row."""

    def press(key: str) -> None:
        (element,) = (each for each in cockpit.elements() if each.resource_id == shown_id(key))
        assert cockpit.tap(*middle(element)).code is OK

    cockpit.open_app("media")
    for other in ("media.source.usb", "media.source.fm", "media.source.dab", "media.source.bluetooth"):
        cockpit.scroll("media.entries", Direction.DOWN)
        press(other)
        assert shown(cockpit, "media.entry.0"), other
    press("media.source.internet")
    cockpit.scroll("media.entries", Direction.DOWN)
    press("media.show.1")
    assert shown(cockpit, "media.entry.0")
