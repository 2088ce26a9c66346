"""The ego on a scripted road: a car that moves by simple kinematics, and its pedals."""

import math
from dataclasses import replace

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    STANDING_BELOW_MPS,
    Around,
    DrivingState,
    EgoEnd,
    LaneShape,
    OtherVehicle,
    Reroute,
    RoadHere,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
    SeenVehicle,
    SumoSignal,
)
from automotive_cosim.contracts.text import say
from automotive_cosim.traffic.base import Event
from automotive_cosim.traffic.ego import EASING_MPS2
from automotive_cosim.traffic.instant import KnownInstant, packed_other
from automotive_cosim.traffic.pedals import RefusedError
from automotive_cosim.traffic.profiles import DriverProfile
from automotive_cosim.traffic.records import make_other
from automotive_cosim.traffic.road_weather import G_MPS2
from automotive_cosim.traffic.steering import STOPPING_MPS2, STOPPING_RESERVE_M
from tests.scripted.stretches import Layout, Stretch

CAR_M, CAR_WIDTH_M, LANE_M = 4.5, 1.8, 3.2
"""Size of every car, and width of every lane."""
BRAKE_LIGHT_MPS2 = 0.5
"""Deceleration from which the brake lights are on: less comes from releasing the accelerator."""


class ScriptedCar:
    """Moves step by step and provides the driver's pedals (``ego_loop.Stepper`` and ``pedals.Pedals``)."""

    def __init__(
        self,
        layout: Layout,
        driver: DriverProfile,
        step_s: float,
        start_s: float,
        start_mps: float,
        *,
        parked: bool = False,
    ) -> None:
        self.step_s = step_s
        self._layout = layout
        self._driver = driver
        self._headway_s = driver.headway_s
        self._hardest_mps2 = G_MPS2
        self._factor = 1.0
        self._top_mps = math.inf
        self._stop_m = 0.0 if parked else math.inf
        self._stop_s = math.inf
        self._start_s = start_s
        self._steps = 0
        self._along_m = 0.0
        self._speed_mps = start_mps
        self._acceleration_mps2 = 0.0
        self._standing_s = 0.0
        self._leader_m = math.inf
        """Position of the leader's rear bumper."""
        self._enter(0)
        self.now = KnownInstant(self._sense(hazard_lights=False))

    def step(self, *, hazard_lights: bool) -> tuple[KnownInstant, tuple[Event, ...]]:
        before_mps = self._speed_mps
        self._speed_mps = self._next_speed()
        self._along_m += self._speed_mps * self.step_s
        self._steps += 1
        self._acceleration_mps2 = (self._speed_mps - before_mps) / self.step_s
        self._standing_s = self._standing_s + self.step_s if self._speed_mps < STANDING_BELOW_MPS else 0.0
        if self._standing_s >= self._stop_s and self._along_m > self._stop_m - 1.0:
            self._stop_m = self._stop_s = math.inf
        if leader := self._layout.stretches[self._index].leader:
            self._leader_m += leader.speed_kmh / KMH_PER_MPS * self.step_s
        if self._along_m >= self._layout.starts_m[-1]:
            return self._ended(EgoEnd.ARRIVED), ()
        if self._along_m > self._leader_m:
            return self._ended(EgoEnd.COLLIDED), ()
        index = self._layout.index_at(self._along_m)
        if index != self._index:
            self._enter(index)
        self.now = KnownInstant(self._sense(hazard_lights=hazard_lights))
        return self.now, ()

    def alternatives(self, age_s: float) -> tuple[RouteOption, ...]:
        """Empty: there is only one route."""
        return ()

    def look(self) -> RoadSnapshot:
        stretch, state = self._layout.stretches[self._index], self.now.state
        braking = SumoSignal.BRAKE if self._acceleration_mps2 < -BRAKE_LIGHT_MPS2 else 0
        hazards = SumoSignal.HAZARD if state.hazard_lights else 0
        seen = [self._seen("ego", self._along_m, self._speed_mps, signals=braking | hazards)]
        if stretch.leader is not None:
            seen.append(self._seen("leader", self._leader_m + CAR_M, stretch.leader.speed_kmh / KMH_PER_MPS))
        if stretch.oncoming_gap_m is not None:
            seen.append(
                self._seen("oncoming", self._along_m + stretch.oncoming_gap_m, stretch.free_mps, towards=True)
            )
        return RoadSnapshot(state.time_s, tuple(seen), ())

    def shapes(self) -> RoadShapes:
        edges = self._layout.network.edges.values()
        return RoadShapes(tuple(LaneShape(edge.lane_ids[0], "road", LANE_M, edge.shape_m) for edge in edges), ())

    # --- pedals -------------------------------------------------------------------------------------------

    def set_speed_factor(self, factor: float) -> None:
        self._factor = factor

    def set_top_speed(self, speed_mps: float) -> None:
        """Limits the speed."""
        self._top_mps = speed_mps

    def set_headway(self, headway_s: float) -> None:
        """Time gap to the leader."""
        self._headway_s = headway_s

    def set_overtaking(self, readiness: float) -> None:
        """Does nothing: there are no other lanes."""

    def set_grip(self, friction: float) -> None:
        """Limits the braking."""
        self._hardest_mps2 = friction * G_MPS2

    def set_traction(self, friction: float) -> None:
        """Does nothing: nobody accelerates hard here."""

    def set_braking(self, deceleration_mps2: float) -> None:
        """Does nothing: braking is gentle here."""

    def set_imperfection(self, imperfection: float) -> None:
        """Does nothing: speed is kept perfectly here."""

    def set_awareness(self, awareness: float) -> None:
        """Does nothing: nobody misjudges anything here."""

    def set_hazards(self, on: bool) -> None:
        """Does nothing: nobody is there to see them."""

    def pull_over(self, state: DrivingState, for_s: float, within_m: float = math.inf) -> str:
        """Stops as soon as possible with gentle braking."""
        needed_m = state.speed_mps**2 / (2 * STOPPING_MPS2) + STOPPING_RESERVE_M
        stop_m = self._along_m + needed_m
        is_beyond = stop_m >= self._layout.starts_m[-1] or needed_m > within_m
        if is_beyond or self._layout.stretches[self._layout.index_at(stop_m)].in_tunnel:
            raise RefusedError(say("there is no place to stop within the next metres"))
        self._stop_m, self._stop_s = stop_m, for_s
        return f"in {needed_m:.0f} m"

    def is_parked(self) -> bool:
        """Whether it has stopped where it was asked to."""
        return self._standing_s > 0 and self._along_m > self._stop_m - 1.0

    def renew(self, seed: int) -> None:
        """Does nothing: there is no other traffic."""

    def change_lane(self, lanes_from_kerb: int, for_s: float) -> bool:
        """False: there are no other lanes."""
        return False

    def standing_ahead_m(self) -> float | None:
        return self._layout.route.standing_ahead_m(self._along_m)

    def leave_corridor(self, leave: bool) -> str:
        """Does nothing: nobody is there to use it."""
        return "keeps to the side" if leave else "drives in the middle of the lane"

    def reroute(self, request: Reroute, state: DrivingState) -> str:
        """Refused: there is no other route."""
        raise RefusedError(say("this road has no alternative route"))

    # --- kinematics ---------------------------------------------------------------------------------------

    def _next_speed(self) -> float:
        """The desired speed as far as the car can reach it in one step; braking for a leader may be harder."""
        driver, step_s = self._driver, self.step_s
        stretch = self._layout.stretches[self._index]
        free_mps = stretch.free_mps
        wanted_mps = min(self._top_mps, self._factor * free_mps, self._lower_ahead())
        if stretch.relative_speed < 1.0:
            wanted_mps = min(wanted_mps, stretch.relative_speed * free_mps)
        wanted_mps = min(wanted_mps, _stopping_speed(self._stop_m - self._along_m, STOPPING_MPS2, step_s))
        slowest_mps = self._speed_mps - self._service_mps2() * step_s
        held_mps = max(slowest_mps, min(wanted_mps, self._speed_mps + driver.acceleration_mps2 * step_s))
        hardest_mps = self._speed_mps - self._hardest_mps2 * step_s
        return max(0.0, hardest_mps, min(held_mps, self._safe_speed()))

    def _service_mps2(self) -> float:
        return min(self._driver.deceleration_mps2, self._hardest_mps2)

    def _lower_ahead(self) -> float:
        """Speed from which the next stretch's limit is reached with gentle braking."""
        if self._index + 1 == len(self._layout.stretches):
            return math.inf
        next_mps = self._factor * self._layout.stretches[self._index + 1].free_mps
        before_m = self._layout.starts_m[self._index + 1] - self._along_m
        return math.sqrt(next_mps**2 + 2 * EASING_MPS2 * max(0.0, before_m))

    def _safe_speed(self) -> float:
        """Krauss (1998): the speed from which the car can still stop behind a leader that brakes equally hard."""
        leader = self._layout.stretches[self._index].leader
        if leader is None:
            return math.inf
        hardest, headway_s = self._service_mps2(), self._headway_s
        gap_m = max(0.0, self._leader_m - self._along_m - self._driver.min_gap_m)
        leader_mps = leader.speed_kmh / KMH_PER_MPS
        braking = hardest * headway_s
        return -braking + math.sqrt(braking**2 + leader_mps**2 + 2 * hardest * gap_m)

    def _seen(
        self, name: str, along_m: float, speed_mps: float, *, signals: int = 0, towards: bool = False
    ) -> SeenVehicle:
        """A car with its front bumper there; one that comes towards the ego drives in the next lane."""
        x_m, y_m = self._layout.position(along_m)
        heading_deg = self._layout.heading_deg
        if towards:
            turn = math.radians(heading_deg)
            x_m, y_m = x_m - LANE_M * math.cos(turn), y_m + LANE_M * math.sin(turn)
            heading_deg += 180.0
        heading_deg %= 360.0
        return SeenVehicle(name, "passenger", CAR_M, CAR_WIDTH_M, x_m, y_m, heading_deg, speed_mps, signals)

    # --- sensing ------------------------------------------------------------------------------------------

    def _enter(self, index: int) -> None:
        self._index = index
        leader = self._layout.stretches[index].leader
        self._leader_m = math.inf if leader is None else self._along_m + leader.gap_m

    def _ended(self, end: EgoEnd) -> KnownInstant:
        self.now = KnownInstant(replace(self.now.state, time_s=self._time_s(), end=end))
        return self.now

    def _time_s(self) -> float:
        return round(self._start_s + self._steps * self.step_s, 6)

    def _sense(self, *, hazard_lights: bool) -> DrivingState:
        layout, index, along_m = self._layout, self._index, self._along_m
        stretch, edge = layout.stretches[index], layout.network.edges[f"stretch{index}"]
        x_m, y_m = layout.position(along_m)
        place = layout.lon_lat(along_m)
        return DrivingState(
            time_s=self._time_s(),
            x_m=x_m,
            y_m=y_m,
            lon_deg=place and place[0],
            lat_deg=place and place[1],
            heading_deg=layout.heading_deg,
            speed_mps=self._speed_mps,
            acceleration_mps2=self._acceleration_mps2,
            standing_s=self._standing_s,
            distance_m=along_m,
            road=RoadHere(
                edge_id=edge.edge_id,
                lane_id=edge.lane_ids[0],
                lane_index=0,
                lane_count=stretch.lane_count,
                lane_position_m=along_m - layout.starts_m[index],
                name=stretch.name,
                road_class=stretch.road_class,
                limit=edge.limit,
                in_tunnel=stretch.in_tunnel,
                lit=stretch.lit,
                built_up=stretch.built_up,
                centre_line=stretch.centre_line,
                friction=stretch.friction,
            ),
            ahead=layout.route.ahead(index, along_m),
            around=Around(
                leader=self._leader(stretch),
                follower=None,
                oncoming=self._oncoming(stretch),
                emergency_behind=None,
                relative_speed=stretch.relative_speed,
            ),
            hazard_lights=hazard_lights,
            vehicle_count=1 + (stretch.leader is not None) + (stretch.oncoming_gap_m is not None),
        )

    def _leader(self, stretch: Stretch) -> OtherVehicle | None:
        if stretch.leader is None:
            return None
        speed_mps = stretch.leader.speed_kmh / KMH_PER_MPS
        return make_other(
            *packed_other("leader", self._leader_m - self._along_m, speed_mps, self._speed_mps - speed_mps)
        )

    def _oncoming(self, stretch: Stretch) -> OtherVehicle | None:
        if stretch.oncoming_gap_m is None:
            return None
        speed_mps = stretch.free_mps
        return make_other(*packed_other("oncoming", stretch.oncoming_gap_m, speed_mps, self._speed_mps + speed_mps))


def _stopping_speed(before_m: float, deceleration_mps2: float, step_s: float) -> float:
    """Speed for one step from which the car can still stop in that distance."""
    reserve_mps = deceleration_mps2 * step_s
    return max(0.0, math.sqrt(reserve_mps**2 + 2 * deceleration_mps2 * max(0.0, before_m)) - reserve_mps)
