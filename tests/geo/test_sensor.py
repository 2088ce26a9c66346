"""The virtual sensor: what may be asked, what it costs, and what no answer says."""

import itertools
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.contracts import (
    Connectivity,
    DrivingState,
    GpsFix,
    IncidentKind,
    Limit,
    LimitSource,
    OtherVehicle,
    RoadIncident,
    Sight,
    SightKind,
    Weather,
)
from automotive_cosim.geo import sensor
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.reckoning import reckon
from automotive_cosim.geo.sensor import ask

ONLINE, OFFLINE = Connectivity(True, "5g", 4), Connectivity(False, "none", 0)
PARIS, BERLIN, DUBAI, SEA = (48.873, 2.285), (52.52, 13.4), (25.2, 55.3), (40.0, -30.0)
LONDON = 51.528, -0.128
SUBJECTS = ("weather", "rules", "hazards", "traffic", "norms", "units", "position")
Locate = Callable[..., GeoContext]


@dataclass(frozen=True)
class Instant:
    driving: DrivingState
    context: GeoContext
    gps: GpsFix | None = None
    connectivity: Connectivity = ONLINE
    time_s: float = 0.0
    sights: tuple[Sight, ...] = ()


@pytest.fixture(scope="module")
def instant(locate: Locate, drive: Callable[..., DrivingState]) -> Callable[..., Instant]:
    def make(place: tuple[float, float] = PARIS, connectivity: Connectivity = ONLINE, **changes: object) -> Instant:
        weather = changes.pop("weather", None)
        context = locate(*place, weather, **changes) if weather else locate(*place, **changes)
        return Instant(drive(**changes), context, context.gps, connectivity)

    return make


@pytest.mark.parametrize(
    ("query", "place", "expected"),
    [
        ("what is the weather", PARIS, "Weather: clear sky, 12 °C"),
        ("may the rear fog lamp be on", PARIS, "Rear fog lamp: allowed in fog or snow, not in rain"),
        ("rear fog lamp", BERLIN, "Rear fog lamp: allowed in fog with visibility under 50 m"),
        ("horn?", PARIS, "Horn: in built-up areas for immediate danger only"),
        ("alcohol", DUBAI, "Blood alcohol limit: any is forbidden"),
        ("what is the speed limit", PARIS, "Default limit: 50 km/h on the axes left at 50"),
        ("traffic on the route", PARIS, "Route left: 1.0 km, 2 min"),
        ("customs when it is hot", DUBAI, "Custom when hot: cars are cooled all year"),
        ("usual climate", PARIS, "Usual in October at Paris (Montsouris): 10 °C at night to 17 °C by day"),
        ("which units do signs have here", PARIS, "Units on signs here: km/h, kilometres and metres"),
        ("is that km/h or mph", LONDON, "Units on signs here: mph, miles and yards"),
        ("where are we", PARIS, "Position: 48.8730°N 2.2850°E, within 3 m"),
        ("rules", SEA, "Rules: none known here"),
        ("norms", SEA, "Customs: none known here"),
    ],
)
def test_it_answers_from_what_it_knows(
    instant: Callable[..., Instant], query: str, place: tuple[float, float], expected: str
) -> None:
    reply = ask(query, [instant(place)])
    assert reply.ok
    assert expected in reply.text


def test_a_lamp_asked_for_by_name_comes_alone(instant: Callable[..., Instant]) -> None:
    assert ask("rear fog lamp", [instant()]).text.count("\n") == 0
    assert ask("fog lamps", [instant()]).text.count("\n") == 1
    assert len(ask("lamps", [instant()]).text.splitlines()) >= 4


def test_hazards_are_what_lies_ahead(instant: Callable[..., Instant], weather: Callable[..., Weather]) -> None:
    known = instant(weather=weather(weather_code=45, visibility=90.0), friction=0.5)
    ahead = replace(
        known.driving.ahead,
        jam_distance_m=420.0,
        jam_length_m=300.0,
        tunnel_distance_m=250.0,
        next_limit=Limit(30 / 3.6, LimitSource.POSTED),
        next_limit_distance_m=80.0,
    )
    around = replace(known.driving.around, emergency_behind=OtherVehicle("ambulance", 60.0, 25.0, None))
    text = ask("hazards", [replace(known, driving=replace(known.driving, ahead=ahead, around=around))]).text
    for line in (
        "Jam on the route: in 420 m, 300 m long",
        "Visibility: 90 m (very poor)",
        "Tunnel: in 250 m",
        "Limit on the route: 30 km/h in 80 m",
        "Blue light: 60 m behind",
        "Road surface: friction 0.50, dry is 1",
    ):
        assert line in text.splitlines()


def test_a_blue_light_is_told_unasked(instant: Callable[..., Instant]) -> None:
    """As by a car's radio: no driver's words say that one comes."""
    driving = instant().driving
    around = replace(driving.around, emergency_behind=OtherVehicle("ambulance", 60.0, 25.0, None))
    near = instant().context
    told = replace(near, driving=replace(driving, around=around))
    assert "Blue light: 60 m behind" in told.text().splitlines()
    assert "Blue light" not in near.text()


def test_an_incident_on_the_route_is_told_by_hazards_and_traffic(instant: Callable[..., Instant]) -> None:
    known = instant()
    told = (
        RoadIncident(IncidentKind.ROADWORKS, "on", 0.0),
        RoadIncident(IncidentKind.BREAKDOWN, "off", 0.0),
        RoadIncident(IncidentKind.ROADWORKS, "on", 50.0),
    )
    ahead = replace(known.driving.ahead, route_edges=("here", "on"), incidents=told)
    sights = (
        Sight(SightKind.ROADWORKS, "Roadworks in 640 m", 640.0),
        Sight(SightKind.TYRE, "Rear left tyre: 1.5 bar"),
    )
    met = replace(known, driving=replace(known.driving, ahead=ahead), sights=sights)
    for query in ("hazards", "traffic"):
        lines = ask(query, [met]).text.splitlines()
        assert lines.count("Reported further on the route: roadworks") == 1
        assert not any("broken-down" in line or "tyre" in line for line in lines)
    assert "Roadworks in 640 m" in ask("hazards", [met]).text.splitlines()
    assert "Reported on the route: nothing" in ask("hazards traffic", [known]).text.splitlines()
    jam = replace(known.driving.ahead, jam_distance_m=420.0, jam_length_m=300.0, delay_s=200.0)
    jammed = replace(known, driving=replace(known.driving, ahead=jam))
    assert "Reported on the route: nothing besides the jam" in ask("hazards traffic", [jammed]).text.splitlines()
    here = replace(known.driving, ahead=replace(ahead, route_edges=(known.driving.road.edge_id,)))
    on_it = replace(here, ahead=replace(here.ahead, incidents=(replace(told[0], edge_id=here.road.edge_id),)))
    assert "Reported on this road, here: roadworks" in ask("roadworks?", [replace(known, driving=on_it)]).text
    later = replace(told[0], edge_id=here.road.edge_id, position_m=here.road.lane_position_m + 90.0)
    nearing = replace(here, ahead=replace(here.ahead, incidents=(later,)))
    assert "Reported on this road, in 90 m: roadworks" in ask("works?", [replace(known, driving=nearing)]).text


def test_what_is_asked_for_and_not_there_is_told(instant: Callable[..., Instant]) -> None:
    known = instant()
    told = set(ask("Is there a tunnel, an oncoming vehicle or a car ahead?", [known]).text.splitlines())
    assert told >= {"Tunnel: none on the route", "Oncoming vehicle: none in reach", "Vehicle ahead: none in reach"}
    inside = replace(known, driving=replace(known.driving, road=replace(known.driving.road, in_tunnel=True)))
    assert "Tunnel: here" in ask("tunnel", [inside]).text


def test_words_of_many_questions_do_not_hide_what_is_asked(instant: Callable[..., Instant]) -> None:
    around = replace(instant().driving.around, emergency_behind=OtherVehicle("ambulance", 60.0, 25.0, None))
    known = replace(instant(), driving=replace(instant().driving, around=around))
    for query in (
        "emergency vehicle with blue light and siren near",
        "siren, ambulance approaching",
        "where is the ambulance, at what distance",
        "blue light near, rules, traffic and hazards",
    ):
        assert "Blue light: 60 m behind" in ask(query, [known]).text.splitlines(), query
    assert "Blue light: none in reach" in ask("is there an ambulance", [instant()]).text.splitlines()
    assert "Position" not in ask("roadworks: where do they begin, at what distance", [instant()]).text
    assert "Position" in ask("where are we", [instant()]).text
    assert "Following distance" in ask("which following distance is kept here", [instant()]).text


def test_what_is_not_known_names_what_is(instant: Callable[..., Instant]) -> None:
    reply = ask("the meaning of life", [instant()])
    assert not reply.ok
    assert all(subject in reply.text for subject in SUBJECTS)


def test_without_a_link_the_cars_own_data_still_answers(instant: Callable[..., Instant]) -> None:
    offline = [instant(connectivity=OFFLINE)]
    for query in ("rules", "norms", "position", "horn"):
        assert ask(query, offline) == ask(query, [instant()])
    for query in ("weather", "traffic", "hazards"):
        reply = ask(query, offline)
        assert (reply.ok, reply.text) == (False, f"No connection: {query} unknown")
    both = ask("horn and weather", offline)
    assert both.ok
    assert "Horn:" in both.text
    assert "No connection: weather unknown" in both.text


def test_what_comes_over_the_air_costs_more(instant: Callable[..., Instant]) -> None:
    slow = replace(instant(), connectivity=Connectivity(True, "4g", 3))
    costs = [
        ask(query, [known]).cost_s for query, known in (("rules", slow), ("weather", instant()), ("weather", slow))
    ]
    assert costs == sorted(set(costs))
    assert costs[0] > 0


@pytest.mark.parametrize("place", [PARIS, BERLIN, DUBAI, SEA, (39.9, 116.4), (40.75, -73.98), (53.35, -6.26)])
@pytest.mark.parametrize("speed_mps", [0.0, 60.0])
def test_no_answer_judges_or_advises(
    instant: Callable[..., Instant], weather: Callable[..., Weather], place: tuple[float, float], speed_mps: float
) -> None:
    """The car drives 216 km/h where 50 is posted, close behind another in dense fog: nobody is told."""
    judging = re.compile(
        r"\b(you|your|should|must|violat\w*|break\w*|broken|too (fast|close|slow)|exceed\w*|over the limit"
        r"|illegal\w*|unlawful\w*|speeding|warn the|slow down|alert\w*|please|now)\b",
        re.IGNORECASE,
    )
    known = instant(
        place,
        weather=weather(weather_code=45, visibility=40.0),
        speed_mps=speed_mps,
        leader_m=4.0,
        limit=Limit(50 / 3.6, LimitSource.POSTED),
    )
    for query in (
        *SUBJECTS,
        "is my speed above the limit",
        "may the rear fog lamp be on",
        "what next",
        "lamps horn",
    ):
        assert not judging.search(ask(query, [known]).text), query


def test_the_law_it_tells_does_not_follow_speed_light_or_weather(
    instant: Callable[..., Instant], weather: Callable[..., Weather]
) -> None:
    fog = weather(weather_code=45, visibility=30.0)
    calm, wild = instant(), instant(weather=fog, speed_mps=60.0, leader_m=2.0)
    for query in ("rules", "lamps", "distance", "speed limit", "horn", "norms"):
        assert ask(query, [calm]) == ask(query, [wild])


@given(query=st.text(max_size=120))
def test_any_query_has_an_answer_that_fits(instant: Callable[..., Instant], query: str) -> None:
    reply = ask(query, [instant()])
    assert 0 < len(reply.text.encode()) <= sensor.ANSWER_BYTES
    assert reply.cost_s > 0


def test_a_long_answer_ends_with_whole_lines_and_a_count(instant: Callable[..., Instant]) -> None:
    known = instant()
    text = ask("rules", [known]).text
    *lines, last = text.splitlines()
    assert set(lines) <= {line.text for line in known.context.lines}
    assert re.fullmatch(r"\d+ more; they come when asked for by topic", last)


# --- dead reckoning -----------------------------------------------------------------------------------------


def _through_a_tunnel(
    drive: Callable[..., DrivingState], geo: Geo, seed: int, turn_deg_per_s: float, lat: float = 48.87
) -> list[Instant]:
    """20 s in the open, then 60 s underground, at 15 m/s; receiver noise and all."""
    gps = Gps(np.random.default_rng(seed))
    lon, heading, seen = 2.28, 80.0, []
    for second in range(80):
        state = drive(lon_deg=lon, lat_deg=lat, heading_deg=heading % 360, speed_mps=15.0, in_tunnel=second >= 20)
        seen.append(Instant(state, None, gps.read(state, 1.0), OFFLINE, float(second)))  # type: ignore[arg-type]
        middle = math.radians(heading + turn_deg_per_s / 2)
        lon += 15.0 * math.sin(middle) / metres_per_degree_east(lat)
        lat += 15.0 * math.cos(middle) / METRES_PER_DEGREE
        heading += turn_deg_per_s
    return seen


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("turn_deg_per_s", [0.0, 2.0, -5.0])
def test_dead_reckoning_stays_within_what_it_claims(
    drive: Callable[..., DrivingState], geo: Geo, seed: int, turn_deg_per_s: float
) -> None:
    seen = _through_a_tunnel(drive, geo, seed, turn_deg_per_s)
    estimate, last = reckon(seen), seen[-1]
    assert estimate is not None
    assert last.gps is not None
    truth = last.driving
    assert truth.lon_deg is not None
    assert truth.lat_deg is not None

    def off_m(lon: float, lat: float) -> float:
        east = (lon - truth.lon_deg) * metres_per_degree_east(lat)  # type: ignore[operator]
        return math.hypot(east, (lat - truth.lat_deg) * METRES_PER_DEGREE)  # type: ignore[operator]

    assert off_m(estimate.lon_deg, estimate.lat_deg) < 3 * estimate.accuracy_m
    assert off_m(estimate.lon_deg, estimate.lat_deg) < 0.2 * off_m(last.gps.lon_deg, last.gps.lat_deg)
    assert estimate.driven_m == pytest.approx(15.0 * 60)
    assert estimate.age_s == pytest.approx(60)


def test_the_uncertainty_grows_with_the_way(drive: Callable[..., DrivingState], geo: Geo) -> None:
    seen = _through_a_tunnel(drive, geo, 1, 0.0)
    claims = [estimate.accuracy_m for end in range(21, 81) if (estimate := reckon(seen[:end]))]
    assert all(later > earlier for earlier, later in itertools.pairwise(claims))


def test_underground_the_position_is_reckoned(drive: Callable[..., DrivingState], geo: Geo) -> None:
    reply = ask("where", _through_a_tunnel(drive, geo, 1, 0.0))
    assert reply.text.startswith("Position by dead reckoning: 48.87")
    assert "(900 m and 60 s since the last fix)" in reply.text


def test_without_a_receiver_or_a_fix(drive: Callable[..., DrivingState], geo: Geo, locate: Locate) -> None:
    blind = Instant(drive(), locate(*PARIS), None)
    assert reckon([blind]) is None
    seen = _through_a_tunnel(drive, geo, 1, 0.0)[20:]
    remembered = [replace(known, gps=replace(known.gps, has_fix=False)) for known in seen]  # type: ignore[type-var]
    assert reckon(remembered) is not None


def test_reckoning_north_across_zero(drive: Callable[..., DrivingState]) -> None:
    """The middle of 350 and 10 degrees is north, not south."""
    fix = GpsFix(True, 2.0, 48.0, 3.0, 0.0, 0.0)
    seen = [
        Instant(drive(heading_deg=heading, speed_mps=10.0), None, replace(fix, has_fix=not time), ONLINE, time)  # type: ignore[arg-type]
        for time, heading in ((0.0, 350.0), (10.0, 10.0))
    ]
    estimate = reckon(seen)
    assert estimate is not None
    assert estimate.lat_deg > 48.0
    assert estimate.lon_deg == pytest.approx(2.0)


def test_a_delay_without_a_jam_has_its_cause(instant: Callable[..., Instant]) -> None:
    known = instant()
    slow = replace(known, driving=replace(known.driving, ahead=replace(known.driving.ahead, delay_s=170.0)))
    lines = ask("jams", [slow]).text.splitlines()
    assert any("3 min of it delay" in line for line in lines)
    assert "Jam on the route: none; the delay is slow traffic that keeps moving" in lines
    lines = ask("jams", [known]).text.splitlines()
    assert any("no delay" in line for line in lines)
    assert "Jam on the route: none" in lines
