"""A record of all vehicles, kept along with a simulation for studies, with one entry per step.

A study compares futures of one instant. It has to know which vehicles were on the road or waiting to enter it, when
each of them arrived, what the ego consumed on the way, and whether the traffic as a whole was still flowing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from automotive_cosim.formats.incidents import AnyIncident
from automotive_cosim.studies.calls.accounts import (
    HALTED_MPS,
    LOUD_DB,
    STUCK_S,
    Account,
    Consumption,
    Settled,
    TrackPoint,
    TrafficSummary,
)
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import EGO, LibSumo


class Ledger:
    """Records each step; a fork has its own copy."""

    def __init__(self, sumo: LibSumo, step_s: float, *, consumptions: bool = False, tracks: bool = False) -> None:
        """Opens the ledger.

        Args:
            consumptions: also what every vehicle emits and consumes, which costs about a third of SUMO's own step.
        """
        self._sumo = sumo
        self._step_s = step_s
        self._consumed: dict[str, list[float]] | None = {} if consumptions else None
        """CO2, NOx and fuel in mg, energy in Wh and noise in seconds of ``LOUD_DB`` of each vehicle so far."""
        self._classes: dict[str, str] = {}
        self._track: list[TrackPoint] | None = [] if tracks else None
        self._departed = self._teleported = self._collided = 0
        self.arrivals_s: dict[str, float] = {}
        """Time at which each vehicle arrived; who collides or is removed by a calibrator has not."""
        self.left: Sequence[str] = ()
        """Vehicles that left the road in the last step, arrived or not."""
        self._calibrators: Sequence[str] = sumo.calibrators.getIDList()
        self._removed = self._removals()
        self._driving: frozenset[str] | None = None
        """Who is on the road, if a calibrator has removed others in the last step. SUMO lists these as arrived one
        step after they have gone, and everybody else in the same."""
        self._ego_is_on = self._ego_is_halted = False
        self._ego = Account(0.0, 0, 0.0, 0.0, 0.0)

    def after_step(self) -> None:
        """Records the step that has just been made."""
        sumo, now_s = self._sumo, self._sumo.time()
        departed = sumo.departed() if sumo.departed_count() else ()
        self.left = sumo.arrived() if sumo.arrived_count() else ()
        collided = set(sumo.colliding()) if sumo.colliding_count() else ()
        teleporting = sumo.teleporting() if sumo.teleporting_count() else ()
        self._departed += len(departed)
        self._teleported += len(teleporting)
        self._collided += sum(vehicle in collided for vehicle in self.left)
        at_end = self.left if self._driving is None else self._driving.intersection(self.left)
        self.arrivals_s.update((vehicle, now_s) for vehicle in at_end if vehicle not in collided)
        before, self._removed = self._removed, self._removals()
        self._driving = None if self._removed == before else frozenset(sumo.vehicle_ids())
        if EGO in departed:
            self._ego_is_on = True
            self._ego = Account(now_s, 0, 0.0, 0.0, 0.0)
        if self._ego_is_on and (EGO in self.left or EGO in teleporting):
            self._ego_is_on = False
        if self._ego_is_on:
            self._note_ego()
        if self._consumed is not None:
            self._note_consumed(self._consumed)

    def _removals(self) -> tuple[int, ...]:
        """How many vehicles each calibrator has removed in its present interval."""
        return tuple(self._sumo.calibrators.getRemoved(each) for each in self._calibrators)

    def _note_consumed(self, consumed: dict[str, list[float]]) -> None:
        vehicle, step_s = self._sumo.vehicle, self._step_s
        for each in self._sumo.vehicle_ids():
            so_far = consumed.get(each)
            if so_far is None:
                so_far = consumed[each] = [0.0, 0.0, 0.0, 0.0, 0.0]
                self._classes[each] = vehicle.getEmissionClass(each)
            so_far[0] += vehicle.getCO2Emission(each) * step_s
            so_far[1] += vehicle.getNOxEmission(each) * step_s
            so_far[2] += vehicle.getFuelConsumption(each) * step_s
            so_far[3] += vehicle.getElectricityConsumption(each) * step_s
            so_far[4] += 10 ** ((vehicle.getNoiseEmission(each) - LOUD_DB) / 10) * step_s

    def consumptions(self, vehicles: Iterable[str]) -> dict[str, Consumption]:
        """What those vehicles have emitted and consumed so far; empty if that is not recorded."""
        found = {}
        for each in vehicles:
            if self._consumed is not None and each in self._consumed:
                co2_mg, nox_mg, fuel_mg, energy_wh, noise_s = self._consumed[each]
                found[each] = Consumption(
                    self._classes[each], co2_mg / 1000, nox_mg / 1000, fuel_mg / 1000, energy_wh, noise_s
                )
        return found

    def consumed_by_class(self) -> dict[str, tuple[int, float, float, float, float, float]]:
        """What all vehicles so far have emitted and consumed, see ``flow.FlowSummary``; empty if not recorded."""
        found: dict[str, tuple[int, float, float, float, float, float]] = {}
        for each in self.consumptions(self._consumed or ()).values():
            count, *sums = found.get(each.emission_class, (0, 0.0, 0.0, 0.0, 0.0, 0.0))
            more = each.co2_g, each.nox_g, each.fuel_g, each.energy_wh, each.noise_s
            co2_g, nox_g, fuel_g, energy_wh, noise_s = (one + two for one, two in zip(sums, more, strict=True))
            found[each.emission_class] = count + 1, co2_g, nox_g, fuel_g, energy_wh, noise_s
        return found

    def _note_ego(self) -> None:
        vehicle, before, step_s = self._sumo.vehicle, self._ego, self._step_s
        halted = self._sumo.speed(EGO) <= HALTED_MPS
        self._ego = Account(
            before.departed_s,
            before.stops + (halted and not self._ego_is_halted),
            before.standing_s + step_s * halted,
            before.co2_g + vehicle.getCO2Emission(EGO) * step_s / 1000,
            before.fuel_g + vehicle.getFuelConsumption(EGO) * step_s / 1000,
            before.energy_wh + vehicle.getElectricityConsumption(EGO) * step_s,
            vehicle.getTimeLoss(EGO),
        )
        self._ego_is_halted = halted
        if self._track is not None:
            sumo = self._sumo
            x_m, y_m = sumo.position(EGO)
            point = sumo.time(), round(x_m, 2), round(y_m, 2), round(sumo.speed(EGO), 2), sumo.edge_of(EGO)
            self._track.append(point)

    @property
    def track(self) -> tuple[TrackPoint, ...]:
        """Where the ego was after every step; empty if that is not recorded."""
        return tuple(self._track or ())

    def account(self) -> Account:
        """Figures of the ego's drive, up to now or to its end."""
        return self._ego

    def summary(self) -> TrafficSummary:
        """The present state of the traffic."""
        vehicle = self._sumo.vehicle
        running = vehicle.getIDList()
        return TrafficSummary(
            self._sumo.time(),
            len(running),
            sum(self._sumo.speed(each) <= HALTED_MPS for each in running),
            sum(vehicle.getWaitingTime(each) >= STUCK_S for each in running),
            len(self._sumo.simulation.getPendingVehicles()),
            self._departed,
            self._teleported,
            self._collided,
        )

    def queues_m(self) -> dict[str, float]:
        """The length of the vehicles that wait in each lane, wherever in it, with the gaps that they keep.

        SUMO's own queue output counts from the end of the lane, so over the free road before a breakdown too."""
        vehicle, lane_of = self._sumo.vehicle, self._sumo.lane_of
        found: dict[str, float] = {}
        for each in self._sumo.vehicle_ids():
            if vehicle.getWaitingTime(each) > 0 and (lane := lane_of(each)):
                found[lane] = found.get(lane, 0.0) + vehicle.getLength(each) + vehicle.getMinGap(each)
        return found

    def at_stops(self) -> Iterator[str]:
        """The edge of each vehicle that stands at a stop of its own in a lane."""
        vehicle = self._sumo.vehicle
        for each in self._sumo.vehicle_ids():
            if vehicle.isStopped(each) and not vehicle.isStoppedParking(each):
                yield vehicle.getRoadID(each)

    def others(self) -> tuple[str, ...]:
        """All other vehicles on the road, teleporting, or due and not yet in; sorted by name."""
        simulation = self._sumo.simulation
        due = {*self._sumo.vehicle.getIDList(), *simulation.getPendingVehicles()}
        return tuple(sorted(due - {EGO}))


def keep_ledger(running: Running, *, consumptions: bool = False, tracks: bool = False) -> None:
    """Records every step from now on, in all copies made later too.

    Args:
        consumptions: also of what every vehicle emits and consumes.
        tracks: also of where the ego is."""
    step_s = running.world.step_s
    running.watchers.append(Ledger(running.sumo, step_s, consumptions=consumptions, tracks=tracks))


def run_on(running: Running, duration_s: float) -> TrafficSummary:
    """Lets the traffic run without an ego, so that later drives depart later; returns its state."""
    for _ in range(round(duration_s / running.world.step_s)):
        running.step()
    return running.watcher(Ledger).summary()


def others(running: Running) -> tuple[tuple[str, ...], TrafficSummary]:
    """The other vehicles on the road or due, and the state of the traffic."""
    ledger = running.watcher(Ledger)
    return ledger.others(), ledger.summary()


def account(running: Running) -> Account:
    """Figures of the ego's drive so far."""
    return running.watcher(Ledger).account()


def settle(running: Running, groups: Sequence[Sequence[str]], share: float, limit_s: float) -> Settled:
    """Runs until the ego's drive has ended and a share of each group has arrived, or the time is over.

    From then on nothing is read but the drive, so its state knows of no other vehicles, signals or delays. What is
    done is told as the number of vehicles that have arrived of those to wait for.

    Args:
        running: the traffic, with the ego and a ledger opened before the groups were formed.
        groups: ids of vehicles to wait for, from ``others``.
        share: share of each group, 0 to 1.
        limit_s: limit of simulated seconds.

    Raises TrafficError: SUMO stopped at an error."""
    world, drive, ledger = running.world, running.drive, running.watcher(Ledger)
    assert drive is not None
    left = [set(group) - ledger.arrivals_s.keys() for group in groups]
    most = [(1 - share) * len(group) + 1e-9 for group in groups]

    def awaited() -> float:
        return sum(max(0.0, len(each) - limit) for each, limit in zip(left, most, strict=True))

    def is_complete() -> bool:
        return drive.has_ended and all(len(each) <= limit for each, limit in zip(left, most, strict=True))

    world.look_away()
    total = open_ = awaited()
    for _ in range(round(limit_s / world.step_s)):
        if is_complete():
            break
        if drive.has_ended:
            world.step()
        else:
            drive.step()
        running.done = total - open_, total
        running.after_step()
        for each in left if ledger.left else ():
            each.difference_update(ledger.left)
        open_ = awaited() if ledger.left else open_
    everybody = {vehicle for group in groups for vehicle in group}
    arrivals_s = {vehicle: at_s for vehicle, at_s in ledger.arrivals_s.items() if vehicle in everybody}
    summary = ledger.summary()
    consumptions = ledger.consumptions([EGO, *everybody])
    return Settled(summary.time_s, is_complete(), arrivals_s, ledger.account(), summary, consumptions, ledger.track)


def own_choice(running: Running) -> tuple[str, ...]:
    """The route that SUMO's rerouting device would take now, from the present edge.

    The ego takes it, so use a copy. The device routes by travel times averaged over its adaptation interval
    (``World.prepare_copies``)."""
    sumo = running.sumo
    sumo.reroute(EGO)
    return tuple(sumo.route(EGO)[sumo.route_index(EGO) :])


def stage(running: Running, incident: AnyIncident) -> None:
    """Stages an incident; its times count from the end of the warm-up.

    Raises ScenarioError: it does not fit the network."""
    running.world.stage(incident)
