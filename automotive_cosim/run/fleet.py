"""Drives of several cars in one traffic: each has an agent, a judge and a row of its own."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack, closing
from math import inf
from pathlib import Path
from typing import Any

from automotive_cosim.cockpit.actions import action_in_words
from automotive_cosim.contracts import ActionType
from automotive_cosim.drives.departure import Departures, car_named
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.episode.fleet import Fleet
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import InfrastructureError, NoRoomError
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.fleet_record import EVERY_S, FAILS, FleetRecord
from automotive_cosim.run.rows import TrialRow
from automotive_cosim.run.trial import Shot, TrialObserver, TrialRun
from automotive_cosim.traffic.fork import RemoteRoad, RemoteTraffic, Simulations
from automotive_cosim.traffic.running import seen

CLOCK = ""
"""Beside the cars, what looks at all of them."""


def record_of(leader: str) -> str:
    """The name of the record of a fleet (``FleetRecord``), by the id of its first car's trial."""
    return f"{leader}-cars"


def run_fleet(
    drives: Sequence[DriveSetup],
    runs: Sequence[TrialRun],
    simulations: Simulations,
    folder: Path | None = None,
    wall_s: float = inf,
) -> Sequence[TrialRow]:
    """Runs the drives of a fleet to their ends; each is judged when it is over.

    A car whose drive is over goes on in the traffic without a cockpit. What an agent or its model does wrong is its
    own car's failure or error; what the road does, that of all that still drive.

    Args:
        drives: ``DriveSetup.cars`` of the fleet.
        runs: who acts in each, and who observes.
        folder: where to record how all cars drive (``FleetRecord``); None does not.
        wall_s: wall seconds from each departure after which that drive is cut off.

    Returns:
        The rows of all cars.

    Raises UserError: something in the trials does not exist or is invalid."""
    error: InfrastructureError = NoRoomError("no gap opened for it while others of its fleet drove")
    with ExitStack() as ends:
        fleet = _Running(drives, runs, simulations, folder, wall_s, ends)
        try:
            fleet.drive()
        except InfrastructureError as broken:
            error = broken
        return [fleet.rows.get(car_named(n)) or run.over(End.ERROR, error) for n, run in enumerate(runs)]


class _Running:
    """A fleet that drives."""

    def __init__(
        self,
        drives: Sequence[DriveSetup],
        runs: Sequence[TrialRun],
        simulations: Simulations,
        folder: Path | None,
        wall_s: float,
        ends: ExitStack,
    ) -> None:
        self._drives, self._runs, self._simulations = drives, runs, simulations
        self._folder, self._wall_s, self._ends = folder, wall_s, ends
        self._sessions: dict[str, DriveSession] = {}
        self._record: FleetRecord | None = None
        self.rows: dict[str, TrialRow] = {}
        """Those of the cars whose drives are over, by SUMO's ids."""

    def drive(self) -> None:
        """Drives until no car's drive goes on."""
        scripts = [drive.script for drive in self._drives]
        first = self._entered(0, scripts[0])
        departures = Departures(scripts, first.world)
        road = departures.road
        fleet = Fleet[TrialRow | None](road.step_s)
        self._look_at(road, first)
        self._begin(fleet, 0, first)
        while fleet.busy - {CLOCK}:
            fleet.begin(CLOCK, _tick(road), lambda: road.time_s)
            while CLOCK in fleet.busy:
                self._note(fleet, fleet.run())
            for number, script, traffic in departures.entered():
                self._begin(fleet, number, self._entered(number, script, traffic))
            if self._record is not None:
                self._record.look()

    def _entered(self, number: int, script: DriveScript, traffic: RemoteTraffic | None = None) -> DriveSession:
        run = self._runs[number]
        session = self._drives[number].begin(self._simulations, run.agent.channels, run.observer, script, traffic)
        self._ends.callback(session.close)
        self._sessions[car_named(number)] = session
        return session

    def _begin(self, fleet: Fleet[TrialRow | None], number: int, session: DriveSession) -> None:
        observers = [] if self._record is None else [_Notes(car_named(number), self._record)]
        passing = self._runs[number].playing(session, self._wall_s, observers)
        fleet.begin(car_named(number), passing, lambda: session.world.moment.time_s)

    def _note(self, fleet: Fleet[TrialRow | None], done: dict[str, TrialRow | None]) -> None:
        """Takes the rows of the drives that are over; the cars drive on without cockpits, unless none has one."""
        self.rows |= {car: row for car, row in done.items() if row is not None}
        for car in done.keys() - {CLOCK} if fleet.busy - {CLOCK} else ():
            self._sessions.pop(car).close()

    def _look_at(self, road: RemoteRoad, first: DriveSession) -> None:
        if self._folder is not None:
            leader = self._drives[0]
            cars = {car_named(each.car): each.id for each in self._drives}
            shapes, about = first.world.traffic.shapes(), {**leader.about, "cars": cars}
            self._record = FleetRecord(
                self._folder, record_of(leader.id), road, shapes, lambda: road.call(seen, tuple(cars)), about
            )
            self._ends.enter_context(closing(self._record))


def _tick(road: RemoteRoad) -> TakesTime[None]:
    until_s = road.time_s + EVERY_S
    yield EVERY_S
    road.reach(until_s)


class _Notes(TrialObserver):
    """Notes what is done in a car in the record of its fleet."""

    def __init__(self, car: str, record: FleetRecord) -> None:
        self._car, self._record = car, record

    def stepped(self, shot: Shot) -> None:
        action = shot.step.action
        if action is not None and action.action_type is not ActionType.WAIT:
            self._record.note(f"{self._car}: {action_in_words(action, shot.seen)}")

    def finished(self, row: Any, told: Any) -> None:
        if why := row.error or row.agent_error:
            self._record.note(f"{self._car}: {FAILS} {why}")
