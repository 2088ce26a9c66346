"""Every kind of incident happens in SUMO as the scenario's file declares it."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import get_args

import pytest

from automotive_cosim.contracts import KMH_PER_MPS, DrivingState, EgoEnd, IncidentKind, RoadIncident
from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.formats.incidents import AnyIncident
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.base import Advance, DriverAt, EgoPlan
from automotive_cosim.traffic.congestion import JAM_BELOW
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.staging import STAGED
from automotive_cosim.view.scene import Sights
from tests.traffic.in_process import InProcess, InProcessTraffic
from tests.view.test_view import DAY, LIT, nearest, read_back, slack_m

Edit = Callable[[Path], None]
Variant = Callable[[Edit], Scenario]
Staged = Callable[..., Scenario]


@pytest.fixture
def staged(variant: Variant) -> Staged:
    """The grid with incidents, and without its traffic if so wished."""

    def make(*incidents: str, empty: bool = False, sumo: str = "") -> Scenario:
        def edit(folder: Path) -> None:
            path = folder / "scenario.toml"
            text = path.read_text().replace("[ego]", f"{sumo}\n[ego]", 1)
            path.write_text(text + "".join(f"\n[[incidents]]\n{incident}\n" for incident in incidents))
            if empty:
                (folder / "grid.rou.xml").write_text("<routes/>")

        return variant(edit)

    return make


@pytest.fixture
def in_sumo() -> Iterator[Callable[[Scenario, EgoPlan], InProcessTraffic]]:
    """A drive in this process, whose SUMO can be asked."""
    opened: list[InProcess] = []

    def make(scenario: Scenario, plan: EgoPlan) -> InProcessTraffic:
        opened.append(InProcess(scenario, seed=1))
        return opened[0].depart(plan)

    yield make
    for simulation in opened:
        simulation.close()


InSumo = Callable[[Scenario, EgoPlan], InProcessTraffic]


@pytest.fixture
def average(grid: Scenario) -> EgoPlan:
    return EgoPlan(grid.trip("avenue"), "average", seed=3)


def driven(scenario: Scenario, plan: EgoPlan, duration_s: float = 600.0) -> Advance:
    with closing(Forked(scenario, seed=1)) as simulation, closing(simulation.depart(plan)) as traffic:
        return traffic.advance(duration_s)


def told(drive: Advance) -> list[str]:
    return [event.text for event in drive.events if event.kind == "incident"]


def edges_of(states: tuple[DrivingState, ...]) -> list[str]:
    met = dict.fromkeys(state.road.edge_id for state in states)
    return [edge for edge in met if not edge.startswith(":")]


# --- on the road ------------------------------------------------------------------------------------------


@pytest.mark.sumo
def test_a_breakdown_blocks_its_lane(staged: Staged, average: EgoPlan) -> None:
    """On a street of one lane the ego waits behind it until it is gone."""
    plan = replace(average, trip=replace(average.trip, from_edge="sws0", to_edge="s4se"))
    blocked = staged(
        'kind = "breakdown"\nedge = "s0s1"\nposition_m = 150.0\nfrom_s = 1.0\nto_s = 100.0', empty=True
    )
    drive = driven(blocked, plan)
    assert told(drive) == ["a car has broken down on Rue du Sud"]
    waiting = [state for state in drive.states if state.speed_mps < 0.1 and state.road.edge_id == "s0s1"]
    assert waiting[-1].road.lane_position_m == pytest.approx(150.0 - 5.0 - 2.5, abs=1.5)
    assert {state.around.leader.vehicle_id for state in waiting if state.around.leader} == {
        "automotive_cosim.breakdown.1"
    }
    assert waiting[-1].time_s == pytest.approx(drive.states[0].time_s + 100.0, abs=5.0)
    assert drive.states[-1].end is EgoEnd.ARRIVED


@pytest.mark.sumo
def test_roadworks_lower_the_sign_and_close_a_lane(staged: Staged, average: EgoPlan, in_sumo: InSumo) -> None:
    works = staged('kind = "roadworks"\nedge = "c2c3"\nlimit_kmh = 30\nclosed_lanes = [0]\nfrom_s = -30.0')
    traffic = in_sumo(works, average)
    import libsumo

    while traffic.state.distance_m < 300.0:
        assert traffic.advance(0.1).states
    assert traffic.state.ahead.next_limit.mps == pytest.approx(30 / KMH_PER_MPS)
    states, others = [], []
    while traffic.advance(0.5).states and traffic.state.end is None:
        others += libsumo.lane.getLastStepVehicleIDs("c2c3_0")
        if traffic.state.road.edge_id == "c2c3":
            states.append(traffic.state)
    assert {state.road.lane_index for state in states} == {1}
    assert {round((state.road.limit.mps or 0) * KMH_PER_MPS) for state in states} == {30}
    assert max(state.speed_mps for state in states[-3:]) * KMH_PER_MPS < 31
    assert not others


@pytest.mark.sumo
def test_a_sign_that_is_left_after_roadworks_holds_and_is_not_reported(staged: Staged, average: EgoPlan) -> None:
    left = staged('kind = "roadworks"\nedge = "c2c3"\nlimit_kmh = 30\nover = true\nfrom_s = 5.0')
    drive = driven(left, average)
    assert any("a sign of 30 km/h still stands after roadworks" in event.text for event in drive.events)
    assert not any(state.ahead.incidents for state in drive.states)
    limits = {state.road.limit.mps for state in drive.states if state.road.edge_id == "c2c3"}
    assert {round((mps or 0) * KMH_PER_MPS) for mps in limits} == {30}


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("sign", "kmh", "source", "alone"),
    [
        ('plate = "Mo-Fr 08:00-09:00"', {30}, "posted", None),
        ('plate = "Sa,Su 08:00-09:00"', {50}, "posted", None),
        ('plate = "wet"', {50}, "posted", None),
        ("", {30}, "variable", None),
        ('shows = "by lane"', {30, 50}, "variable", True),
        ("to_s = -2.0", {50}, "posted", None),
        ('plate = "Mo-Fr 08:00-09:00"\nto_s = -2.0', {50}, "posted", None),
    ],
)
def test_a_sign_holds_as_its_plate_says_and_a_variable_one_over_its_lanes(
    staged: Staged, average: EgoPlan, sign: str, kmh: set[int], source: str, alone: bool | None
) -> None:
    put_up = f'kind = "sign"\nedges = ["c2c3"]\nlimit_kmh = 30\n{sign}'
    drive = driven(staged(f"{put_up}\nfrom_s = -5.0"), average)
    roads = [state.road for state in drive.states if state.road.edge_id == "c2c3"]
    assert roads
    assert {round((road.limit.mps or 0) * KMH_PER_MPS) for road in roads} <= kmh
    low = [road for road in roads if round((road.limit.mps or 0) * KMH_PER_MPS) == 30]
    assert bool(low) or 50 in kmh
    assert {(road.limit.source, road.lane_alone) for road in low} <= {(source, alone)}


@pytest.mark.sumo
def test_a_jam_stands_beyond_a_bend(staged: Staged, average: EgoPlan) -> None:
    """Its tail is in the street that the ego turns into; the queue moves up, and the ego gets through."""
    jam = staged(
        'kind = "jam"\nedges = ["n4n3", "n3n2"]\nlength_m = 250.0\nfrom_s = 0.0\nhold_s = 10.0', empty=True
    )
    plan = replace(average, trip=replace(average.trip, from_edge="ses4", to_edge="n1n0"))
    plan = replace(plan, trip=replace(plan.trip, via=("c4n4", "n4n3")))
    with closing(Forked(jam, seed=1)) as simulation, closing(simulation.depart(plan)) as traffic:
        while traffic.state.distance_m < 560.0:
            assert traffic.advance(0.1).states
        assert traffic.state.road.edge_id == "c4n4", "still round the corner"
        assert traffic.state.ahead.jam_distance_m is not None
        assert traffic.state.ahead.jam_distance_m > 0
        drive = traffic.advance(900.0)
    waits = [state for state in drive.states if state.speed_mps < 0.1]
    assert waits[0].road.edge_id == "n4n3"
    assert len({round(state.distance_m) for state in waits}) > 5, "it moves up, again and again"
    assert drive.states[-1].end is EgoEnd.ARRIVED
    assert not [event for event in drive.events if event.kind == "teleport"]


@pytest.mark.sumo
def test_a_closed_road_is_gone_round(staged: Staged, average: EgoPlan, in_sumo: InSumo) -> None:
    traffic = in_sumo(staged('kind = "closure"\nedge = "c2c3"\nfrom_s = 10.0\nto_s = 500.0'), average)
    import libsumo

    since_s, met, events = traffic.state.time_s, [], []
    inside: set[str] = set()
    while traffic.state.end is None:
        drive = traffic.advance(1.0)
        met += drive.states
        events += [event.text for event in drive.events if event.kind == "incident"]
        if traffic.state.time_s > since_s + 40.0:
            inside.update(libsumo.edge.getLastStepVehicleIDs("c2c3"))
    assert events == ["Avenue Centrale is closed", "driver goes round Avenue Centrale, which is closed"]
    assert "c2c3" not in edges_of(tuple(met))
    assert edges_of(tuple(met))[-1] == "c4ce"
    assert traffic.state.end is EgoEnd.ARRIVED
    assert not inside


@pytest.mark.sumo
def test_a_school_zone_keeps_school_hours(staged: Staged, average: EgoPlan) -> None:
    zone = staged('kind = "school_zone"\nedges = ["c1c2"]\nlimit_kmh = 20\nopens = 08:00:00\ncloses = 09:00:00')
    limits = {}
    tuesday = zone.start
    with closing(Forked(zone, seed=1)) as simulation:
        for name, start in {
            "school": tuesday,
            "later": tuesday.replace(hour=9, minute=30),
            "saturday": tuesday.replace(day=14),
        }.items():
            with closing(simulation.depart(replace(average, start=start))) as traffic:
                states = traffic.advance(300.0).states
            inside = [state for state in states if state.road.edge_id == "c1c2"]
            limits[name] = {round((state.road.limit.mps or 0) * KMH_PER_MPS) for state in inside}
    assert limits == {"school": {20}, "later": {50}, "saturday": {50}}
    assert tuesday.weekday() < 5


@pytest.mark.sumo
def test_a_driver_hurries_through_a_school_zone_at_its_hours_only(staged: Staged, average: EgoPlan) -> None:
    """One profile a zone, in turn; a mood that would change meanwhile comes after the zone."""
    zones = [
        f'kind = "school_zone"\nedges = ["{edge}"]\nlimit_kmh = 20\nopens = 08:00:00\ncloses = 09:00:00'
        for edge in ("c0c1", "c2c3")
    ]
    plan = replace(average, at_schools=("hurried", "brisk"), moods=(DriverAt(1.0, "calm"),))
    quiet = staged(*zones, empty=True)
    over_kmh: dict[str, dict[str, float]] = {}
    with closing(Forked(quiet, seed=1)) as simulation:
        for name, hour in {"school": 8, "later": 10}.items():
            with closing(
                simulation.depart(replace(plan, start=quiet.start.replace(hour=hour, minute=30)))
            ) as traffic:
                states = traffic.advance(300.0).states
            assert states[-1].end is EgoEnd.ARRIVED
            over_kmh[name] = {
                edge: max(
                    (state.speed_mps - (state.road.limit.mps or 0.0)) * KMH_PER_MPS
                    for state in states
                    if state.road.edge_id == edge
                )
                for edge in ("c0c1", "c1c2", "c2c3")
            }
    assert over_kmh["school"]["c0c1"] > 10
    assert over_kmh["school"]["c1c2"] < 1
    assert 0 < over_kmh["school"]["c2c3"] < 3
    assert max(over_kmh["later"].values()) < 1


@pytest.mark.sumo
def test_the_rush_hour_scales_the_demand(staged: Staged, grid: Scenario, average: EgoPlan) -> None:
    rush = staged('kind = "rush_hour"\nscale = 3.0\nfrom_s = -60.0\nto_s = 60.0')
    counts = []
    for scenario in (rush, grid):
        traffic_plan = replace(average, trip=grid.trip("round"), driver="calm")
        states = driven(scenario, traffic_plan, 300.0).states
        counts.append([states[0].vehicle_count, states[-1].vehicle_count])
    assert counts[0][0] > 1.8 * counts[1][0]
    assert counts[0][1] < counts[0][0], "it is over"


@pytest.mark.sumo
def test_a_tractor_holds_everybody_up(staged: Staged, average: EgoPlan) -> None:
    tractor = 'kind = "tractor"\nfrom_edge = "n0n1"\nto_edge = "n4ne"\nspeed_kmh = 12\ntrip = "tunnel"'
    scenario = staged(tractor, empty=True)
    tunnel = scenario.trip("tunnel")
    held = driven(scenario, replace(average, trip=tunnel))
    assert told(held) == ["a tractor on Rue du Nord"]
    following = [state for state in held.states if state.around.leader and state.around.leader.gap_m < 15]
    assert following
    assert {state.around.leader.vehicle_id for state in following if state.around.leader} == {
        "automotive_cosim.tractor.2"
    }
    assert max(state.speed_mps for state in following[50:]) * KMH_PER_MPS < 16
    free = driven(scenario, replace(average, trip=replace(tunnel, name="another trip")))
    assert not told(free)
    assert len(free.states) < len(held.states) - 200


# --- around the ego ---------------------------------------------------------------------------------------


@pytest.mark.sumo
def test_the_leader_brakes(staged: Staged, average: EgoPlan) -> None:
    braking = staged('kind = "braking_leader"\nat_m = 400.0\ndeceleration_mps2 = 6.0\nhold_s = 3.0', empty=True)
    drive = driven(braking, replace(average, trip=replace(average.trip, from_edge="sws0", to_edge="s4se")))
    assert told(drive) == ["the vehicle ahead brakes"]
    (told_s,) = [event.time_s for event in drive.events if event.kind == "incident"]
    before = next(state for state in drive.states if state.time_s >= told_s)
    assert before.distance_m >= 400.0
    assert before.around.leader
    leader = before.around.leader.vehicle_id
    after = [state for state in drive.states if told_s <= state.time_s <= told_s + 8]
    seen = [state.around.leader for state in after if state.around.leader]
    hardest = min((b.speed_mps - a.speed_mps) for a, b in zip(seen, seen[10:], strict=False))
    assert hardest == pytest.approx(-6.0, abs=0.7), "in one second"
    assert min(state.acceleration_mps2 for state in after) < -2.0
    assert min(leader.speed_mps for leader in seen) < 0.1
    assert any(
        state.around.leader and state.around.leader.vehicle_id == leader and state.around.leader.speed_mps > 5
        for state in drive.states
        if state.time_s > told_s + 10
    ), "it drives on"
    assert drive.states[-1].end is EgoEnd.ARRIVED


@pytest.mark.sumo
def test_a_vehicle_cuts_in_and_the_driver_brakes(staged: Staged, average: EgoPlan) -> None:
    cutting = staged('kind = "cut_in"\nat_m = 100.0\ngap_m = 12.0\nslower_kmh = 15.0', empty=True)
    drive = driven(cutting, average)
    (cut_s,) = [event.time_s for event in drive.events if event.text == "a vehicle cuts in ahead"]
    before = [state for state in drive.states if cut_s - 2 <= state.time_s < cut_s]
    after = [state for state in drive.states if cut_s + 0.5 <= state.time_s <= cut_s + 1.5]
    assert not any(state.around.leader and state.around.leader.gap_m < 40 for state in before)
    assert all(state.around.leader and state.around.leader.gap_m < 25 for state in after)
    assert min(state.acceleration_mps2 for state in drive.states if state.time_s > cut_s) < -1.0


@pytest.mark.sumo
def test_after_a_cut_in_it_drives_on_also_if_the_time_is_no_whole_number(staged: Staged, average: EgoPlan) -> None:
    cutting = staged('kind = "cut_in"\nat_m = 100.0\ngap_m = 12.0\nslower_kmh = 12.0\nhold_s = 1.5', empty=True)
    drive = driven(cutting, average)
    (cut_s,) = [event.time_s for event in drive.events if event.text == "a vehicle cuts in ahead"]
    ahead = {state.time_s - cut_s: state.around.leader for state in drive.states if state.around.leader}
    at_mps = {round(after_s, 1): leader.speed_mps for after_s, leader in ahead.items()}
    assert at_mps[3.0] > at_mps[2.0] + 1.0, (
        "it is free two seconds after it moved over, and the ego still behind it"
    )


@pytest.mark.sumo
def test_the_leader_cuts_out_before_a_standing_car(staged: Staged, average: EgoPlan) -> None:
    revealing = staged('kind = "cut_out"\nfrom_s = 30.0\nreveal_m = 30.0')
    drive = driven(revealing, average)
    assert told(drive) == ["the vehicle ahead cuts out before a standing car"]
    (cut_s,) = [event.time_s for event in drive.events if event.kind == "incident"]
    before = next(state for state in drive.states if state.time_s >= cut_s - 1)
    assert before.around.leader
    assert before.around.leader.gap_m < 60
    later = [state for state in drive.states if cut_s <= state.time_s <= cut_s + 10]
    assert any(incident.kind == "breakdown" for state in later for incident in state.ahead.incidents)


@pytest.mark.sumo
@pytest.mark.parametrize(
    "kind",
    ['"braking_leader"\nat_m = 100.0\ndeceleration_mps2 = 7.0\nkeeps_lane = true', '"cut_out"\nfrom_s = 30.0'],
)
def test_after_a_manoeuvre_the_driver_ahead_is_who_they_were(
    staged: Staged, average: EgoPlan, in_sumo: Callable[[Scenario, EgoPlan], InProcessTraffic], kind: str
) -> None:
    drive = in_sumo(staged(f"kind = {kind}"), average)
    import libsumo

    of = libsumo.vehicle
    ways = of.getLaneChangeMode, of.getSpeedMode, of.getDecel, of.getSpeedFactor

    def manners() -> dict[str, tuple[float, ...]]:
        others = (each for each in of.getIDList() if not each.startswith(("ego", "automotive_cosim.breakdown")))
        return {each: tuple(way(each) for way in ways) for each in others}

    before = now = dict[str, tuple[float, ...]]()
    touched: set[str] = set()
    for _ in range(90):
        drive.advance(1.0)
        now = manners()
        before = now | before
        touched |= {each for each in now if now[each] != before[each]}
    assert touched
    assert now == {each: before[each] for each in now}


@pytest.mark.sumo
def test_an_ambulance_comes_from_behind(staged: Staged, average: EgoPlan) -> None:
    ambulance = staged('kind = "emergency"\nat_m = 300.0\nbehind_m = 200.0', empty=True)
    drive = driven(ambulance, replace(average, driver="calm"))
    first = next(state for state in drive.states if state.around.emergency_behind)
    assert first.distance_m >= 300.0
    assert first.around.emergency_behind
    assert first.around.emergency_behind.gap_m == pytest.approx(200.0, abs=40.0)
    gone = [state for state in drive.states if state.time_s > first.time_s + 20 and state.end is None]
    assert gone
    assert not gone[-1].around.emergency_behind, "it has overtaken"


# --- together ---------------------------------------------------------------------------------------------

EVERYTHING = (
    'kind = "rush_hour"\nscale = 1.5\nfrom_s = -60.0',
    'kind = "breakdown"\nedge = "c1c2"\nposition_m = 100.0\nlane = 0\nfrom_s = -30.0\nto_s = 200.0',
    'kind = "roadworks"\nedge = "c3c4"\nlimit_kmh = 30.0\nclosed_lanes = [1]\nfrom_s = 5.0\nto_s = 60.0',
    'kind = "closure"\nedge = "n2n3"\nfrom_s = 10.0\nto_s = 80.0',
    'kind = "jam"\nedges = ["s2s3"]\nlength_m = 80.0\nfrom_s = 0.0\nto_s = 100.0',
    'kind = "school_zone"\nedges = ["c0c1"]\nlimit_kmh = 30.0\nopens = 08:00:00\ncloses = 08:31:00',
    'kind = "tractor"\nfrom_edge = "c0c1"\nto_edge = "c4ce"\nfrom_s = -20.0',
    'kind = "braking_leader"\nat_m = 100.0',
    'kind = "emergency"\nat_m = 200.0\nbehind_m = 150.0',
    'kind = "cut_in"\nat_m = 150.0',
    'kind = "cut_out"\nat_m = 250.0',
)


@pytest.mark.sumo
def test_all_at_once_in_process_and_forked_alike(staged: Staged, average: EgoPlan, in_sumo: InSumo) -> None:
    scenario = staged(*EVERYTHING)
    with closing(Forked(scenario, seed=1)) as simulation, closing(simulation.depart(average)) as traffic:
        traffic.advance(15.0)
        with closing(traffic.branch()) as branch:
            expected = traffic.advance(100.0)
            assert branch.advance(100.0) == expected
    own = in_sumo(scenario, average)
    own.advance(15.0)
    assert own.advance(100.0) == expected
    assert told(expected)
    assert expected.states[-1].ahead.incidents


@pytest.mark.sumo
def test_live_traffic_tells_of_what_lasts_and_can_be_known(staged: Staged, average: EgoPlan) -> None:
    """Within a sample of the traffic, until it is over; of a jam as soon as its edges are that slow."""
    zone = 'kind = "school_zone"\nedges = ["c2c3"]\nlimit_kmh = 20\nopens = 08:00:00\ncloses = 09:00:00'
    known = {
        'kind = "breakdown"\nedge = "s0s1"\nposition_m = 90.0': RoadIncident(IncidentKind.BREAKDOWN, "s0s1", 90.0),
        'kind = "roadworks"\nedge = "c2c3"\nlimit_kmh = 30': RoadIncident(IncidentKind.ROADWORKS, "c2c3", 0.0),
        'kind = "closure"\nedge = "s2s3"': RoadIncident(IncidentKind.CLOSURE, "s2s3", 0.0),
        zone: RoadIncident(IncidentKind.SCHOOL_ZONE, "c2c3", 0.0),
    }
    lasting = [f"{incident}\nfrom_s = 20.0\nto_s = 60.0" for incident in known]
    unknown = 'kind = "tractor"\nfrom_edge = "sws0"\nto_edge = "s3s4"'
    jam = 'kind = "jam"\nedges = ["n4n3", "n3n2"]\nlength_m = 250.0\nhold_s = 20.0\nfrom_s = 0.0'
    states = driven(staged(*lasting, unknown, jam), average, 100.0).states
    for state in states:
        since_s, told = state.time_s - states[0].time_s, set(state.ahead.incidents)
        jams = {incident for incident in told if incident.kind is IncidentKind.JAM}
        slow = dict(state.ahead.slow_edges)
        jammed = [edge for edge in ("n4n3", "n3n2") if slow.get(edge, 1.0) < JAM_BELOW]
        assert jams == {RoadIncident(IncidentKind.JAM, edge, 0.0) for edge in jammed[:1]}
        if 31.0 < since_s < 59.0:
            assert told - jams == set(known.values())
        if since_s < 19.0 or since_s > 71.0:
            assert told == jams
    assert any(state.ahead.incidents for state in states[-10:]), "the jam is known in the end"
    assert not [incident for incident in states[1].ahead.incidents if incident.kind is IncidentKind.JAM]


@pytest.mark.sumo
def test_an_incident_of_another_trip_is_not_told_of(staged: Staged, grid: Scenario, average: EgoPlan) -> None:
    other = next(trip.name for trip in grid.ego.trips if trip.name != average.trip.name)
    works = 'kind = "roadworks"\nedge = "s2s3"\nlimit_kmh = 30'
    both = staged(f'{works}\ntrip = "{other}"', f'kind = "closure"\nedge = "n2n3"\ntrip = "{average.trip.name}"')
    (told,) = driven(both, average, 30.0).states[-1].ahead.incidents
    assert told.kind is IncidentKind.CLOSURE


# --- the file ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("incident", "said"),
    [
        ('kind = "volcano"', "no kind named 'volcano'"),
        ('kind = "closure"', "lacks 'edge'"),
        ('kind = "closure"\nedge = "c1c2"\nedges = 3', "no field named 'edges'"),
        ('kind = "closure"\nedge = "c1c2"\nfrom_s = 5.0\nto_s = 5.0', "from_s = 5 is not before to_s = 5"),
        ('kind = "closure"\nedge = "c1c2"\ntrip = "moon"', "no trip of scenario 'grid' named 'moon'"),
        ('kind = "closure"\nedge = "c1c2"\ntrip = "avenue"\nfrom_s = -1.0', "cannot begin in the warm-up"),
        ('kind = "emergency"\nat_m = -5.0', "at_m is -5.0; it must be a number of at least 0"),
        ('kind = "rush_hour"\nscale = 0', "scale is 0; it must be a number above 0"),
        ('kind = "braking_leader"\ndeceleration_mps2 = 20', "at most 10"),
    ],
)
def test_what_makes_no_sense_is_refused_when_read(staged: Staged, incident: str, said: str) -> None:
    with pytest.raises((ScenarioError, UnknownNameError), match=said) as caught:
        staged(incident)
    assert "\n" not in str(caught.value)


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("incident", "said"),
    [
        ('kind = "closure"\nedge = "moon"', "no edge 'moon'"),
        ('kind = "breakdown"\nedge = "c1c2"\nposition_m = 900.0', "is 1.. m long"),
        ('kind = "breakdown"\nedge = "c1c2"\nposition_m = 90.0\nlane = 2', "has 2 lanes"),
        ('kind = "roadworks"\nedge = "n1n2"\nlimit_kmh = 20\nclosed_lanes = [0]', "leave no lane"),
        ('kind = "sign"\nedges = ["n1n2"]\nlimit_kmh = 20\nshows = "by lane"', "has 1 lanes"),
        ('kind = "sign"\nedges = ["c1c2"]\nlimit_kmh = 20\nplate = "at dawn"', "is not understood; write"),
        ('kind = "jam"\nedges = ["c1c2", "n1n2"]\nlength_m = 20.0', "no route leads"),
        ('kind = "jam"\nedges = ["c1c2"]\nlength_m = 2000.0', "does not fit"),
        ('kind = "pedestrians"\nfrom_edge = "c1c2"\nto_edge = "c2c3"', "sidewalks"),
    ],
)
def test_what_does_not_fit_the_network_is_refused_when_loaded(staged: Staged, incident: str, said: str) -> None:
    with pytest.raises(ScenarioError, match=said):
        Forked(staged(incident), seed=1)


@pytest.mark.sumo
def test_nothing_happens_around_an_ego_that_has_left(staged: Staged, average: EgoPlan) -> None:
    """It arrives in the very second in which its incidents are looked after: with steps of a second, in each."""
    never = staged('kind = "braking_leader"\nat_m = 100.0\nfrom_kmh = 190.0', empty=True)
    never = replace(never, sumo=replace(never.sumo, step_length_s=1.0))
    assert driven(never, average).states[-1].end is EgoEnd.ARRIVED


def test_people_cross_and_the_ego_lets_them(
    variant: Variant, walkable: Edit, average: EgoPlan, in_sumo: InSumo
) -> None:
    def crossed(folder: Path) -> None:
        walkable(folder)
        path = folder / "scenario.toml"
        people = 'kind = "pedestrians"\nfrom_edge = "n2c2"\nto_edge = "c2s2"\nevery_s = 5.0\ngroup = 4'
        people += "\nfrom_s = -30.0\nto_s = 60.0"
        path.write_text(path.read_text() + f"\n[[incidents]]\n{people}\n")

    traffic = in_sumo(variant(crossed), average)
    import libsumo

    crossings, waits, met = set(), 0, []
    while traffic.advance(0.5).states and traffic.state.end is None:
        state = traffic.state
        met.append(state)
        crossings |= {libsumo.person.getRoadID(person) for person in libsumo.person.getIDList()}
        waits += state.speed_mps < 3.0 and state.road.edge_id == "c1c2"
    assert any(edge.startswith(":c2_c") for edge in crossings)
    assert waits > 1, "the ego waits before the crossing"
    assert traffic.state.end is EgoEnd.ARRIVED


def test_who_waits_at_the_kerb_is_seen_there(
    variant: Variant, walkable: Edit, average: EgoPlan, in_sumo: InSumo
) -> None:
    """SUMO lets people without priority wait until the ego has passed."""

    def crossed(folder: Path) -> None:
        walkable(folder, first=False)
        (folder / "grid.rou.xml").write_text("<routes/>")
        path = folder / "scenario.toml"
        people = 'kind = "pedestrians"\nfrom_edge = "n2c2"\nto_edge = "c2s2"\nevery_s = 5.0\ngroup = 1'
        path.write_text(path.read_text() + f"\n[[incidents]]\n{people}\nfrom_s = -30.0\nto_s = 90.0\n")

    traffic = in_sumo(variant(crossed), average)
    shapes = traffic.shapes()
    assert len(shapes.crossings) == 2
    sights, read = Sights(shapes, traffic.network), 0
    while traffic.advance(1.0).states and traffic.state.end is None:
        scene = sights.scene(traffic.look(), traffic.state, DAY, LIT)
        first = min(scene.people, key=lambda each: nearest(scene, each)[1], default=None)
        if first is None or first.speed_mps > 0.1 or not 20.0 < nearest(scene, first)[1] < 70.0:
            continue
        (right_m, ahead_m), told = nearest(scene, first), read_back(scene, first)
        assert told == (pytest.approx(right_m, abs=0.9), pytest.approx(ahead_m, abs=slack_m(scene, ahead_m)))
        read += 1
    assert read > 2


def test_every_kind_of_incident_is_staged() -> None:
    assert set(STAGED) == set(get_args(get_args(AnyIncident)[0]))
