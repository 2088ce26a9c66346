"""Places and routes, music, phone and the smaller apps: what they hold and what their buttons do."""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest

from automotive_cosim.cockpit import pois
from automotive_cosim.cockpit.apps.map.state import turns
from automotive_cosim.cockpit.apps.media.state import USB_TRACKS, library
from automotive_cosim.cockpit.apps.phone.state import directory
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.render import render
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    CABIN,
    CALL,
    DRIVE,
    HVAC,
    LINK,
    MEDIA,
    MOTION,
    SEAT,
    Signal,
    difference,
)
from automotive_cosim.contracts import (
    Answer,
    Cruise,
    FeedbackCode,
    LimitSource,
    Reroute,
    Road,
    RoadNetwork,
    RouteOption,
    Surroundings,
)
from tests.cockpit.fingers import find, press, shown

from .couplings import COUPLED

Make = Callable[..., Cockpit]
OK, NO_EFFECT = FeedbackCode.OK, FeedbackCode.NO_EFFECT
SEEDS = (1, 2, 99)


def stopped(surroundings: Surroundings) -> Surroundings:
    return replace(surroundings, driving=replace(surroundings.driving, speed_mps=0.0))


@pytest.fixture
def parked(make: Make, around: Surroundings) -> Cockpit:
    return make(surroundings=stopped(around), signals={MOTION.GEAR.path: "P"})


def test_the_cabin_with_keep_climate_is_two_taps_away_from_climate(make: Make) -> None:
    cockpit = make()
    assert press(cockpit, "open climate; hvac.comfort") is FeedbackCode.OK
    assert press(cockpit, "comfort.cabin") is FeedbackCode.OK
    assert press(cockpit, "cabin.keep_climate") is FeedbackCode.OK
    assert cockpit.signals[HVAC.KEPT]


# --- what there is --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_there_is_enough_of_everything_and_no_two_are_alike(network: RoadNetwork, seed: int) -> None:
    rng = np.random.default_rng(seed)
    music, people_known = library(rng), directory(rng)
    atlas = pois.atlas(RoadMap(network), rng)
    tracks = music.of("BLUETOOTH") + music.of("USB")
    stations = music.of("FM") + music.of("DAB")
    assert len({track.title for track in tracks}) == len(tracks) >= 200
    assert len({(station.title, station.by) for station in stations}) == len(stations) >= 40
    assert len({contact.number for contact in people_known.contacts}) == len(people_known.contacts) >= 60
    assert len({place.name for place in atlas.places}) == len({place.edge_id for place in atlas.places}) >= 80
    assert {place.kind for place in atlas.places} == set(pois.PoiKind)
    for place in atlas.of(pois.PoiKind.PARKING):
        zone = next(zone for zone in pois.ZONES if place.detail.startswith(f"{zone}: "))
        assert place.detail.endswith(f" {pois.PRICES[zone]:.2f} an hour")


@pytest.mark.parametrize("count", [0, 1, 3])
def test_a_tiny_network_has_as_many_places_as_streets(count: int) -> None:
    roads = tuple(
        Road(f"e{i}", f"Street {i}", "residential", 1, 50.0, None, LimitSource.ASSUMED, False, ((0, i), (50, i)))
        for i in range(count)
    )
    atlas = pois.atlas(RoadMap(RoadNetwork(roads, (0, 0, 50, 50), None, (0, 0), False)), np.random.default_rng(1))
    assert len(atlas.places) == count
    assert len(atlas.streets) == count


def test_the_same_seed_makes_up_the_same_and_another_seed_something_else(make: Make) -> None:
    one, same, other = make(5), make(5), make(6)
    assert one.commands() == same.commands()
    for app in ("map", "phone", "media", "charging"):
        for cockpit in (one, same, other):
            cockpit.open_app(app)
        assert one.elements() == same.elements() != other.elements()


# --- navigation -----------------------------------------------------------------------------------------------


def road(edge_id: str, name: str, *points: tuple[float, float]) -> Road:
    return Road(edge_id, name, "residential", 1, 100.0, None, LimitSource.POSTED, False, points)


def test_turns_are_named_by_their_angle_and_the_street_they_lead_to() -> None:
    roads = RoadMap(
        RoadNetwork(
            (
                road("north", "A", (0, 0), (0, 100)),
                road("on", "A", (0, 100), (0, 200)),
                road("east", "B", (0, 200), (100, 200)),
                road("slant", "C", (100, 200), (170, 270)),
                road("west", "D", (170, 270), (70, 270)),
                road("back", "E", (70, 270), (170, 271)),
            ),
            (0, 0, 200, 300),
            None,
            (0, 0),
            False,
        )
    )
    found = turns(roads, ("north", "on", "east", "slant", "west", "back"))
    assert [(turn.words, turn.street, turn.after_m) for turn in found] == [
        ("Turn right", "B", 200.0),
        ("Keep left", "C", 300.0),
        ("Turn left", "D", 400.0),
        ("Make a U-turn", "E", 500.0),
        ("Arrive", "E", 600.0),
    ]
    assert turns(roads, ()) == turns(roads, ("unknown",)) == ()


def test_a_place_is_reached_by_its_edge_and_shown_by_its_name(cockpit: Cockpit) -> None:
    press(cockpit, "open map; map.list.explore; explore.kind.charging")
    name = shown(cockpit, "explore.place.0")
    assert press(cockpit, "explore.place.0; place.start") is OK
    (request,) = cockpit.drain_requests()
    assert isinstance(request, Reroute)
    assert request.destination != name
    cockpit.answered(request, Answer(True, "new route"))
    assert cockpit.commands()["navigation.destination"] == name
    assert press(cockpit, "place.start") is FeedbackCode.DISABLED
    for _ in range(3):
        cockpit.back()
    press(cockpit, "map.list.recent")
    assert shown(cockpit, "map.place.0") == name


def test_a_stop_keeps_the_destination_to_go_on_to(cockpit: Cockpit) -> None:
    def go(index: int, button: str) -> str:
        cockpit.open_app("map")
        name = shown(cockpit, f"map.place.{index}")
        assert press(cockpit, f"map.place.{index}", button) is OK
        (request,) = cockpit.drain_requests()
        cockpit.answered(request, Answer(True, "new route"))
        return name

    goal = go(0, "place.start")
    stop = go(1, "place.stop")
    assert cockpit.commands()["navigation.destination"] == stop
    assert cockpit.commands()["navigation.onward"] == goal
    assert press(cockpit, "open map; map.route; route.tab.options; route.onward") is OK
    cockpit.answered(cockpit.drain_requests()[0], Answer(True, "new route"))
    assert cockpit.commands()["navigation.destination"] == goal
    assert cockpit.commands()["navigation.onward"] == ""


def test_favourites_and_avoidances_are_kept_and_undone(cockpit: Cockpit) -> None:
    before = cockpit.commands()
    cockpit.open_app("map")
    name = shown(cockpit, "map.place.0")
    press(cockpit, "map.place.0; place.save")
    assert name not in cockpit.commands()["navigation.favourites"]
    press(cockpit, "place.save")
    assert sorted(cockpit.commands()["navigation.favourites"]) == sorted(before["navigation.favourites"])
    press(cockpit, "open map; map.route; route.tab.options; route.avoid.tolls")
    assert cockpit.commands()["navigation.avoid"] == ["tolls"]
    press(cockpit, "route.avoid.tolls")
    assert cockpit.commands()["navigation.avoid"] == []


def test_another_way_is_offered_with_its_time_and_taken_by_its_edges(make: Make, around: Surroundings) -> None:
    other = RouteOption(("e6_5", "n6_6"), 3900.0, 520.0, 20.0)
    ahead = replace(around.driving.ahead, alternatives=(other,))
    cockpit = make(surroundings=replace(around, driving=replace(around.driving, ahead=ahead)))
    press(cockpit, "open map; map.route; route.tab.ways")
    element = find(cockpit, "route.way.0")
    assert "2 min shorter" in element.content_description
    assert press(cockpit, "route.way.0") is OK
    assert cockpit.drain_requests() == (Reroute(edges=other.edges),)


def test_places_are_found_by_name_and_by_enter(parked: Cockpit) -> None:
    press(parked, "open map; map.search")
    assert parked.key_enter().code is FeedbackCode.REFUSED
    parked.type_text("pharmacy")
    assert shown(parked, "map.place.0").endswith("Pharmacy")
    assert parked.key_enter().code is OK
    assert len(parked.drain_requests()) == 1


# --- music ----------------------------------------------------------------------------------------------------


def test_a_tap_plays_and_an_ended_track_is_followed_by_the_next(cockpit: Cockpit, around: Surroundings) -> None:
    cockpit.open_app("media")
    third, fourth = shown(cockpit, "media.entry.2"), shown(cockpit, "media.entry.3")
    assert press(cockpit, "media.entry.2") is OK
    assert cockpit.signals[MEDIA.ACTION] == "PLAY"
    assert cockpit.signals[MEDIA.TRACK] == third
    chosen = cockpit.signals[MEDIA.SELECTED]
    cockpit.sense(around, 331.0)
    assert cockpit.signals[MEDIA.TRACK] == fourth
    assert cockpit.signals[MEDIA.SELECTED] == chosen
    assert press(cockpit, "media.entry.2") is OK
    assert cockpit.signals[MEDIA.TRACK] == third


def test_repeat_plays_the_same_again(cockpit: Cockpit, around: Surroundings) -> None:
    press(cockpit, "open media; media.entry.0; media.repeat")
    first = cockpit.signals[MEDIA.TRACK]
    cockpit.sense(around, 331.0)
    assert cockpit.signals[MEDIA.TRACK] == first


def test_shuffle_goes_through_everything_in_another_order(cockpit: Cockpit) -> None:
    cockpit.open_app("media")

    def heard() -> list[str]:
        names = []
        for _ in range(USB_TRACKS):
            press(cockpit, "media.next")
            names.append(cockpit.signals[MEDIA.TRACK])
        return names

    press(cockpit, "media.source.usb")
    straight = heard()
    press(cockpit, "media.shuffle")
    mixed = heard()
    assert sorted(mixed) == sorted(straight)
    assert mixed != straight


def test_a_playlist_plays_its_own_tracks_and_takes_what_plays(cockpit: Cockpit) -> None:
    press(cockpit, "open media; media.list.playlists")
    name = shown(cockpit, "media.playlist.1")
    press(cockpit, "media.playlist.1")
    uris = cockpit.commands()["media.playlists"][name]
    assert press(cockpit, "playlist.play") is OK
    assert cockpit.signals[MEDIA.PLAYED] == uris[0]
    press(cockpit, "media.next")
    assert cockpit.signals[MEDIA.PLAYED] == uris[1]
    assert press(cockpit, "playlist.change") is OK
    assert uris[1] not in cockpit.commands()["media.playlists"][name]
    assert press(cockpit, "playlist.change") is OK
    assert cockpit.commands()["media.playlists"][name][-1] == uris[1]


def test_another_source_leaves_the_playlist(cockpit: Cockpit) -> None:
    press(cockpit, "open media; media.list.playlists; media.playlist.0; playlist.play")
    assert cockpit.commands()["media.playlist"]
    press(cockpit, "open home; open media; media.source.usb; media.next")
    assert cockpit.signals[MEDIA.PLAYED] == "usb:1"
    assert cockpit.commands()["media.playlist"] == ""


def test_podcasts_need_a_connection(cockpit: Cockpit, around: Surroundings) -> None:
    assert press(cockpit, "open media; media.source.internet; media.entry.1") is OK
    press(cockpit, "open settings; settings.page.connections; link.mobile")
    cockpit.sense(around, 1.0)
    assert not cockpit.signals[LINK.ONLINE]
    assert press(cockpit, "open media; media.entry.2") is FeedbackCode.DISABLED


# --- phone ----------------------------------------------------------------------------------------------------


def test_a_call_goes_out_lasts_and_ends(cockpit: Cockpit, around: Surroundings) -> None:
    press(cockpit, "open phone; phone.tab.contacts")
    name = shown(cockpit, "phone.contact.3")
    assert press(cockpit, "phone.contact.3; contact.call") is OK
    driving = replace(around.driving, time_s=around.driving.time_s + 75)
    cockpit.sense(replace(around, driving=driving), 75.0)
    assert shown(cockpit, "call.who") == name
    assert shown(cockpit, "call.time") == "1:15"
    assert press(cockpit, "call.mute") is OK
    assert cockpit.commands()["phone.muted"]
    assert press(cockpit, "call.end") is OK
    assert cockpit.commands()["phone.on_call"] == ""
    assert cockpit.commands()["calls"] == [name]
    press(cockpit, "open phone; phone.tab.recents")
    assert shown(cockpit, "phone.recent.0") == name


def test_a_list_of_people_says_that_a_tap_opens_them_and_calls_nobody(cockpit: Cockpit) -> None:
    for tab, first in (("favourites", "favourite"), ("recents", "recent"), ("contacts", "contact")):
        press(cockpit, "open phone", f"phone.tab.{tab}")
        assert shown(cockpit, "phone.about") == "Select a contact to call or message"
        entry = find(cockpit, f"phone.{first}.0")
        assert entry.content_description.startswith("Call or message")
        assert press(cockpit, f"phone.{first}.0") is OK
        assert (cockpit.screen, shown(cockpit, "contact.call")) == ("contact", "Call")
        assert cockpit.commands()["calls"] == []


def test_one_phone_is_paired_for_calls_and_the_tablet_beside_it(parked: Cockpit) -> None:
    def paired() -> list[str]:
        return list(parked.commands()["bluetooth.devices"])

    assert press(parked, "open settings; settings.page.connections; link.device.2") is OK
    assert paired() == ["Driver's phone", "Tablet"]
    assert press(parked, "link.device.1") is OK
    assert paired() == ["Second phone", "Tablet"]
    parked.open_app("phone")
    assert shown(parked, "phone.device") == "Second phone"
    assert press(parked, "phone.devices; link.device.2") is OK
    assert paired() == ["Second phone"]


def test_balance_and_fader_tell_the_side(cockpit: Cockpit) -> None:
    press(cockpit, "open settings; settings.page.sound")
    assert (shown(cockpit, "sound.balance"), shown(cockpit, "sound.fader")) == ("0", "0")
    cockpit.inject(MEDIA.BALANCE.path, -20.0)
    cockpit.inject(MEDIA.FADER.path, 30.0)
    assert (shown(cockpit, "sound.balance"), shown(cockpit, "sound.fader")) == ("left 20", "front 30")
    cockpit.inject(MEDIA.BALANCE.path, 100.0)
    cockpit.inject(MEDIA.FADER.path, -10.0)
    assert (shown(cockpit, "sound.balance"), shown(cockpit, "sound.fader")) == ("right 100", "rear 10")


def test_no_call_without_a_phone(cockpit: Cockpit) -> None:
    assert (
        press(
            cockpit,
            "open settings; settings.page.connections; link.bluetooth; open phone; phone.favourite.0",
            "contact.call",
        )
        is FeedbackCode.REFUSED
    )
    assert cockpit.commands()["calls"] == []


def test_a_message_is_read_out_while_driving_and_shown_while_parked(make: Make, parked: Cockpit) -> None:
    moving = make()
    for cockpit in (moving, parked):
        press(cockpit, "open phone; phone.tab.messages; phone.thread.0")
        assert shown(cockpit, "thread.line.0") == ""
        who = shown(cockpit, "thread.who")
        assert press(cockpit, "thread.read") is (FeedbackCode.READ_OUT if cockpit is moving else OK)
        assert cockpit.commands()["messages.read"] == [who]
    assert shown(moving, "thread.line.0") == ""
    assert shown(parked, "thread.line.0") == shown(parked, "thread.who")


def test_an_answer_leaves_unread_what_nobody_has_heard(make: Make, parked: Cockpit) -> None:
    for cockpit in (make(), parked):
        unread = cockpit.signals[CALL.UNREAD]
        assert press(cockpit, "open phone; phone.tab.messages; phone.thread.0; thread.answer.2") is OK
        assert (cockpit.commands()["messages.read"], cockpit.signals[CALL.UNREAD]) == ([], unread)
        assert press(cockpit, "thread.read") in (OK, FeedbackCode.READ_OUT)
        assert cockpit.signals[CALL.UNREAD] == unread - 1


def test_an_answer_goes_out_once_for_each_tap(cockpit: Cockpit) -> None:
    press(cockpit, "open phone; phone.tab.messages; phone.thread.1")
    who, text = shown(cockpit, "thread.who"), shown(cockpit, "thread.answer.2")
    assert press(cockpit, "thread.answer.2") is OK
    assert press(cockpit, "thread.answer.2") is OK
    assert cockpit.commands()["messages.sent"] == [{"to": who, "text": text}] * 2


def test_the_keypad_is_locked_while_driving_and_dials_while_parked(make: Make, parked: Cockpit) -> None:
    moving = make()
    for cockpit in (moving, parked):
        press(cockpit, "open phone; phone.tab.keypad")
    assert press(moving, "phone.key.5") is FeedbackCode.RESTRICTED
    for key in ("phone.key.5", "phone.key.hash", "phone.key.7", "phone.erase", "phone.call_number"):
        assert press(parked, key) is OK
    assert parked.commands()["calls"] == ["5#"]


def test_favourite_contacts_come_and_go(cockpit: Cockpit) -> None:
    cockpit.open_app("phone")
    name = shown(cockpit, "phone.favourite.0")
    press(cockpit, "phone.favourite.0; contact.favourite")
    assert name not in cockpit.commands()["phone.favourites"]
    press(cockpit, "contact.favourite")
    assert cockpit.commands()["phone.favourites"][-1] == name


# --- smaller apps ---------------------------------------------------------------------------------------------


def test_parking_is_paid_by_zone_and_time_and_not_twice_by_itself(cockpit: Cockpit) -> None:
    assert press(cockpit, "open parking; parking.pay") is FeedbackCode.DISABLED
    assert shown(cockpit, "parking.price") == "Choose a zone first"
    assert press(cockpit, "parking.zone.b; parking.pay") is FeedbackCode.DISABLED
    assert shown(cockpit, "parking.price") == "2.50 an hour"
    press(cockpit, "parking.time.120")
    assert shown(cockpit, "parking.price") == "Price 5.00"
    before = cockpit.commands()
    assert press(cockpit, "parking.pay") is OK
    assert set(difference(before, cockpit.commands())) == {"payments"}
    assert cockpit.commands()["payments"] == [{"zone": "Zone B", "minutes": 120, "price": 5.0}]
    assert shown(cockpit, "parking.ticket.0") == "Zone B until 16:05"


def test_a_memo_is_as_long_as_it_was_spoken(cockpit: Cockpit, around: Surroundings) -> None:
    press(cockpit, "open memo; memo.record")
    assert cockpit.commands()["apps.recording"]
    driving = replace(around.driving, time_s=around.driving.time_s + 9)
    cockpit.sense(replace(around, driving=driving), 9.0)
    press(cockpit, "memo.record")
    (memo,) = cockpit.commands()["apps.memos"]
    assert memo.endswith("0:09")
    press(cockpit, "memo.0")
    assert cockpit.commands()["apps.memos"] == [memo]
    press(cockpit, "note.delete")
    assert cockpit.commands()["apps.memos"] == []
    assert cockpit.screen == "memo"


def test_the_trip_computer_counts_from_its_reset(cockpit: Cockpit, around: Surroundings) -> None:
    def drive(seconds: float, metres: float) -> None:
        now = replace(
            around.driving, time_s=around.driving.time_s + seconds, distance_m=around.driving.distance_m + metres
        )
        cockpit.sense(replace(around, driving=now), 60.0)

    cockpit.open_app("trip")
    drive(60, 1000)
    assert shown(cockpit, "trip.distance") == "1.0 km"
    assert shown(cockpit, "trip.speed") == "60 km/h"
    press(cockpit, "trip.reset")
    drive(120, 1500)
    assert shown(cockpit, "trip.distance") == "500 m"
    assert shown(cockpit, "trip.time") == "1:00"


def test_the_cabin_is_prepared_from_half_an_hour_before_the_time_that_was_set(
    cockpit: Cockpit, around: Surroundings
) -> None:
    press(cockpit, "open climate; hvac.comfort; climate.schedule")
    for _ in range(16):
        press(cockpit, "climate.schedule.later")
    assert cockpit.commands()["climate.schedule"] == "15:00"
    for minutes, expected in ((24, False), (26, True)):
        cockpit.sense(replace(around, local_time=around.local_time + timedelta(minutes=minutes)), 1.0)
        assert cockpit.signals[HVAC.AUTO] is expected


def test_a_film_of_the_manual_plays_while_parked_alone(parked: Cockpit, around: Surroundings) -> None:
    still = replace(around, driving=replace(around.driving, speed_mps=0.0))
    assert press(parked, "open manual; manual.film") is FeedbackCode.OK
    assert parked.commands()["apps.film"] == "Windows are fogged"
    before = parked.screenshot()
    assert not [ink.text for ink in render(parked.tree).inks if ink.cut]
    parked.sense(replace(still, driving=replace(still.driving, time_s=still.driving.time_s + 3)), 3.0)
    picture = find(parked, "manual.film.picture")
    assert picture.content_description == "The video is at 0:03 of 0:40"
    assert (parked.screenshot() != before).any(), "it moves"
    ended = parked.copy()
    ended.sense(replace(still, driving=replace(still.driving, time_s=still.driving.time_s + 41)), 38.0)
    assert ended.commands()["apps.film"] == ""
    stopped = parked.copy()
    assert press(stopped, "manual.film") is FeedbackCode.OK
    assert stopped.commands()["apps.film"] == ""
    parked.inject("Vehicle.Powertrain.Transmission.Gear", "D")
    for surroundings in (still, around):
        parked.sense(surroundings, 1.0)
        assert parked.commands()["apps.film"] == "", "standing in gear and moving"
        assert press(parked, "manual.film") is FeedbackCode.RESTRICTED
        button = find(parked, "manual.film")
        assert "Videos play only while parked" in button.content_description
        assert not button.is_enabled


def test_the_manual_is_searched_in_its_text(parked: Cockpit) -> None:
    press(parked, "open manual; manual.search")
    parked.type_text("throttle")
    assert parked.key_enter().code is OK
    assert shown(parked, "manual.title") == "Driving on ice"


# --- the car --------------------------------------------------------------------------------------------------


def test_the_seat_moves_only_at_rest_and_its_memory_brings_it_back(make: Make, parked: Cockpit) -> None:
    moving = make()
    for cockpit in (moving, parked):
        press(cockpit, "open vehicle; vehicle.tab.seats")
    assert press(moving, "seat.driver.position.increase") is FeedbackCode.RESTRICTED
    assert press(moving, "seat.memory.1") is FeedbackCode.RESTRICTED
    start = parked.signals[SEAT.DRIVER_POSITION]
    assert press(parked, "seat.store.1; seat.driver.position.increase") is OK
    assert press(parked, "seat.memory.1") is OK
    assert parked.signals[SEAT.DRIVER_POSITION] == start


def test_a_profile_brings_its_seat_and_temperature(parked: Cockpit) -> None:
    assert press(parked, "open settings; settings.page.profiles; profile.1") is OK
    assert parked.commands()["driver.profile"] == "Driver 2"
    assert parked.signals[HVAC.DRIVER_TEMPERATURE] == 22.5


def test_all_doors_and_windows_go_together(cockpit: Cockpit) -> None:
    press(cockpit, "open vehicle; vehicle.tab.doors; door.all")
    assert not cockpit.signals[CABIN.REAR_LEFT_LOCK]
    press(cockpit, "door.all")
    assert cockpit.signals[CABIN.DRIVER_LOCK]
    assert shown(cockpit, "window.vent") == "Open all windows 20 %"
    press(cockpit, "window.vent")
    assert cockpit.signals[CABIN.REAR_RIGHT_WINDOW] == 20.0
    press(cockpit, "window.close_all")
    assert cockpit.signals[CABIN.DRIVER_WINDOW] == 0.0


@pytest.mark.parametrize(
    ("tab", "key", "signal", "value"),
    [
        ("driving", "drive.mode.snow", DRIVE.MODE, "SNOW"),
        ("mirrors", "mirror.driver.heat", None, None),
        ("assistance", "adas.limiter", ADAS.LIMITER_ACTIVE, True),
        ("assistance", "adas.cruise_gap", ADAS.CRUISE_GAP, 2.5),
    ],
)
def test_what_is_set_on_the_vehicle_pages_arrives(
    cockpit: Cockpit, tab: str, key: str, signal: Signal[object] | None, value: object
) -> None:
    assert press(cockpit, "open vehicle", f"vehicle.tab.{tab}", key) is OK
    if signal is not None:
        assert cockpit.signals[signal] == value


def test_the_limiter_and_cruise_control_take_turns_and_tell_the_road(cockpit: Cockpit) -> None:
    press(cockpit, "open vehicle; vehicle.tab.assistance; adas.limiter_speed.decrease")
    for key in ("adas.limiter", "adas.cruise", "adas.limiter", "adas.limiter"):
        press(cockpit, key)
    assert cockpit.drain_requests() == (Cruise(45.0), Cruise(50.0), Cruise(45.0), Cruise(None))


def test_horn_and_washer_are_counted_and_the_tank_runs_dry(cockpit: Cockpit, around: Surroundings) -> None:
    cockpit.open_app("vehicle")
    for _ in range(40):
        assert press(cockpit, "wiper.wash") is OK
    assert cockpit.signals[BODY.WASHER_FLUID] == pytest.approx(0.0)
    assert press(cockpit, "wiper.wash") is FeedbackCode.REFUSED
    press(cockpit, "vehicle.tab.driving; drive.horn")
    assert cockpit.signals[DRIVE.HORN]
    cockpit.sense(around, 1.0)
    assert not cockpit.signals[DRIVE.HORN]
    assert (cockpit.commands()["horn"], cockpit.commands()["washer"]) == (1, 40)


def test_what_wants_attention_leads_to_where_something_can_be_done(cockpit: Cockpit) -> None:
    cockpit.open_app("notifications")
    assert "unread" in shown(cockpit, "notifications.0")
    assert press(cockpit, "notifications.0") is OK
    assert cockpit.screen == "phone"
    assert shown(cockpit, "phone.thread.0")


def test_places_on_the_way_come_before_those_far_beside_it(cockpit: Cockpit, around: Surroundings) -> None:
    def detour(name: str) -> float:
        place = atlas.find(name)
        assert place is not None
        return min(place.away_m(*roads.find(edge).shape_m[-1]) for edge in around.driving.ahead.route_edges)  # type: ignore[union-attr]

    state = cockpit._state
    atlas, roads = state.of(pois.Gazetteer), state.roads
    press(cockpit, "open map; map.route; route.tab.ways")
    shown_first = [detour(shown(cockpit, f"route.way.{at}")) for at in (1, 2, 3)]
    assert shown_first == sorted(detour(place.name) for place in atlas.of(pois.PoiKind.CHARGING))[:3]


def test_no_music_from_a_phone_that_is_not_linked(cockpit: Cockpit) -> None:
    press(cockpit, "open media; media.play; open settings; settings.page.connections; link.bluetooth")
    assert cockpit.signals[MEDIA.ACTION] == "STOP"
    assert press(cockpit, "open media; media.entry.4") is FeedbackCode.REFUSED
    assert press(cockpit, "media.source.fm; media.entry.1") is OK
    assert cockpit.signals[MEDIA.ACTION] == "PLAY"


@pytest.mark.parametrize(
    ("way", "key"),
    [
        (("open media", "media.source.fm"), MEDIA.SOURCE.path),
        (("open media", "media.entry.4"), MEDIA.SELECTED.path),
        (("open media", "media.list.playlists", "media.playlist.0", "playlist.play"), "media.playlist"),
        (("open map", "map.place.0", "place.start"), "navigation.destination"),
        (("open phone", "phone.favourite.0", "contact.call"), "calls"),
        (("open phone", "phone.tab.messages", "phone.thread.0", "thread.answer.0"), "messages.sent"),
        (("open memo", "memo.record", "memo.record"), "apps.memos"),
        (("open vehicle", "vehicle.tab.assistance", "adas.limiter"), ADAS.LIMITER_ACTIVE.path),
    ],
)
def test_an_act_changes_itself_and_what_is_coupled_with_it(
    cockpit: Cockpit, way: tuple[str, ...], key: str
) -> None:
    before = cockpit.commands()
    for step in way:
        if step.startswith("open "):
            cockpit.open_app(step.removeprefix("open "))
        else:
            assert press(cockpit, step) is OK
    for request in cockpit.drain_requests():
        cockpit.answered(request, Answer(True, "so it is"))
    changed = set(difference(before, cockpit.commands()))
    assert key in changed
    assert changed <= {key} | COUPLED[key] if key in COUPLED else changed == {key}
