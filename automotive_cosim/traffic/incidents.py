"""Decides when a scenario's incidents begin and end, and which limits apply; ``staging`` and ``signs`` stage them.

Nothing here is random: everything depends only on the simulation's time and the ego's route. All times are
evaluated at whole seconds of the simulation.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from automotive_cosim.contracts import RoadIncident
from automotive_cosim.formats.incidents import EgoIncident, Incident, ScriptedVehicle
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.traffic.base import EgoPlan, Event
from automotive_cosim.traffic.detours import Detours
from automotive_cosim.traffic.incident_tools import IncidentTools
from automotive_cosim.traffic.sensing import Sensor
from automotive_cosim.traffic.staged import StagedIncident
from automotive_cosim.traffic.staging import staged


@dataclass(slots=True)
class _Entry:
    incident: Incident
    staged: StagedIncident
    tools: IncidentTools
    """Around the car that it is staged for."""
    zero_s: float | None = None
    """When that car departed, from where its times count; None for the clock that all share."""
    has_begun: bool = False
    is_over: bool = False


class Incidents:
    """The incidents of one simulation."""

    def __init__(self, tools: IncidentTools, scenario: Scenario) -> None:
        """Reads the scenario's incidents. Raises ScenarioError: one of them does not fit the network."""
        self._tools = tools
        self._entries = [_Entry(incident, staged(tools, incident), tools) for incident in scenario.incidents]
        self._others: list[IncidentTools] = []
        """Around the other equipped cars."""
        self._zero_s = scenario.sumo.warm_up_s
        self._start = scenario.start
        self._trip = ""

    @property
    def are_left(self) -> bool:
        """Whether any incident is pending or active."""
        return self._tools.follows_the_clock or any(not entry.is_over for entry in self._entries)

    @property
    def detours(self) -> Detours:
        """The other vehicles' ways round what is closed."""
        return self._tools.detours

    @property
    def slowed(self) -> dict[str, float]:
        return self._tools.signs.slowed

    def move(self, start: datetime) -> None:
        """Takes the clock of another place."""
        self._start = start

    def expect(self, plan: EgoPlan, now_s: float) -> None:
        """Opens and closes roads and turns for the clock of an ego that is about to depart, whose route depends on
        them; without any, its clock counts once it is on the road."""
        if self._tools.closures.follow_the_clock:
            self._zero_s, self._start = now_s, plan.start or self._start
            self._tools.follow(self._local_time(now_s))

    def set_off(self, plan: EgoPlan, sensor: Sensor, now_s: float) -> None:
        """Takes note of the ego's departure: from now on its trip, its route and its clock count.

        Raises ScenarioError: an incident of the plan does not fit the network."""
        self._tools.sensor = sensor
        for incident in plan.incidents:
            self.add(incident)
        self._zero_s = now_s
        self._start = plan.start or self._start
        self._trip = plan.trip.name
        self._tools.follow(self._local_time(now_s))
        for entry in self._entries:  # where they are is told with the ego's own place
            if isinstance(entry.incident, ScriptedVehicle) and not entry.has_begun and self._is_due(entry, 0.0):
                entry.has_begun = True
                entry.staged.begin()

    def add(self, incident: Incident) -> None:
        """One more incident; its times count like those of the others.

        Raises ScenarioError: it does not fit the network."""
        self._entries.append(_Entry(incident, staged(self._tools, incident), self._tools))

    def join(self, plan: EgoPlan, car: str, sensor: Sensor, now_s: float) -> None:
        """Takes note of another equipped car that has departed: what its plan stages is staged around it. The clock
        stays that of the first.

        Raises ScenarioError: an incident of the plan does not fit the network."""
        tools = self._tools.around(car, sensor)
        self._others.append(tools)
        self._entries += [_Entry(each, staged(tools, each), tools, now_s) for each in plan.incidents]

    def tick(self, now_s: float) -> tuple[Event, ...]:
        """Begins and ends the incidents that are due; called once per second of the simulation."""
        told: list[str] = []
        going_on = [
            entry
            for entry in self._entries
            if not entry.is_over and (entry.has_begun or now_s - self._begun_s(entry) >= entry.incident.from_s)
        ]
        if not (going_on or self._tools.follows_the_clock):
            return ()
        local_time = self._local_time(now_s)
        if any(isinstance(entry.incident, EgoIncident) for entry in going_on):
            left = {tools.ego_id for tools in (self._tools, *self._others) if not tools.is_there}
            going_on = [entry for entry in going_on if not self._has_left(entry, left)]
        for entry in going_on:
            told += self._proceed(entry, now_s - self._begun_s(entry), local_time)
        self._tools.follow(local_time)
        return tuple(Event(now_s, "incident", text) for text in told if text)

    def reported(self, slow: Mapping[str, float]) -> tuple[RoadIncident, ...]:
        """Active incidents that a live-traffic service knows of.

        Args:
            slow: edges that it knows to be slow, and their relative speed."""
        going_on = (entry.staged for entry in self._entries if entry.has_begun and not entry.is_over)
        return tuple(seen for one in going_on if (seen := one.reported(slow)) is not None)

    @property
    def closed(self) -> tuple[str, ...]:
        """Lanes that are closed to cars now."""
        going_on = (entry.staged.closed for entry in self._entries if entry.has_begun and not entry.is_over)
        return tuple(lane for lanes in going_on for lane in lanes)

    def _begun_s(self, entry: _Entry) -> float:
        """From when the times of an incident count."""
        return self._zero_s if entry.zero_s is None else entry.zero_s

    def _has_left(self, entry: _Entry, left: set[str]) -> bool:
        """Whether the car that it goes by has arrived or was removed, while others drive on: nothing happens around
        it any more."""
        tools = entry.tools
        return isinstance(entry.incident, EgoIncident) and tools.sensor is not None and tools.ego_id in left

    def _local_time(self, now_s: float) -> datetime:
        """The local time: the scenario's in the warm-up, the ego's once it is driving."""
        since = timedelta(seconds=now_s - self._zero_s)
        return (self._start.astimezone(UTC) + since).astimezone(self._start.tzinfo)

    def take_changes(self) -> bool:
        """Whether signs or the ego's route have changed since the last call."""
        every = self._tools, *self._others
        changed = self._tools.signs.changed or any(tools.route_changed for tools in every)
        self._tools.signs.changed = False
        for tools in every:
            tools.route_changed = False
        return changed

    def _proceed(self, entry: _Entry, since_s: float, local_time: datetime) -> list[str]:
        told: list[str] = []
        if not entry.has_begun and self._is_due(entry, since_s):
            entry.has_begun = True
            told.append(entry.staged.begin())
        if entry.has_begun and since_s < entry.incident.to_s:
            told.append(entry.staged.tick(local_time))
        elif since_s >= entry.incident.to_s:
            entry.is_over = True
            if entry.has_begun:
                told.append(entry.staged.end())
        return told

    def _is_due(self, entry: _Entry, since_s: float) -> bool:
        incident, sensor = entry.incident, entry.tools.sensor
        if not self._concerns(incident) or not incident.from_s <= since_s < incident.to_s:
            return False
        return not isinstance(incident, EgoIncident) or (sensor is not None and sensor.position_m >= incident.at_m)

    def _concerns(self, incident: Incident) -> bool:
        if isinstance(incident, EgoIncident) and self._tools.sensor is None:
            return False
        return not incident.trip or incident.trip == self._trip
