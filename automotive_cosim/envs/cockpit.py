"""The environment: a task in a car in traffic, as gymnasium's ``Env``."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from itertools import product
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit.actions import check, parse
from automotive_cosim.cockpit.arrivals import Arrival
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.restrictions import Motion, motion
from automotive_cosim.cockpit.signals import DRIVE, MOTION
from automotive_cosim.contracts import (
    Action,
    ActionType,
    Feedback,
    FeedbackCode,
    GoalStatus,
    Observation,
    Reason,
    RoadNetwork,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.errors import TriggerNotReachedError, UnknownNameError, UserError
from automotive_cosim.geo import sensor
from automotive_cosim.geo.context import Geo
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.reckoning import Roads
from automotive_cosim.interface import spaces, trace
from automotive_cosim.interface.controls import GeoInput, shown
from automotive_cosim.interface.observe import ALL, Channel, observe
from automotive_cosim.scenarios import Scenario, Trip, WeatherAt
from automotive_cosim.scenery import open_scenario
from automotive_cosim.tasking.instance import Instance, draw
from automotive_cosim.tasking.task import STANDING_ORDER, Half, Mode, Task
from automotive_cosim.tasking.verdict import Verdict, as_json, judge
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.base import EgoPlan, Traffic
from automotive_cosim.traffic.fork import Simulations

ACTION_COST_S = 1.0
"""Simulated seconds that an action takes: about what a tap takes a person (NHTSA 2013 counts glances of up to 2
s)."""

WATCH_S = 30.0
"""A watch begins at least so long before its trigger, and up to twice that."""
WAITS_S = (0.0, 41.0, 113.0)
"""Departures that may bring a task's situation about, each only where the one before did not; out of step with
the usual cycles of traffic lights."""
PARKED: Mapping[str, Any] = {MOTION.GEAR.path: "P", DRIVE.PARKING_BRAKE.path: True}
"""Signals of a car that is parked."""


class Listener(Protocol):
    """Hears how an episode comes about, for a live view."""

    def loading(self, scenario: Scenario) -> None:
        """SUMO loads the scenario's files."""
        ...

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """Traffic is being warmed up, in simulated seconds."""
        ...

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """The co-simulation has a new state; the cockpit stands at the newest of those reported together."""
        ...


class Untouched:
    """The hand-over's twin in which nobody touches the cockpit, driven only as far as somebody asks."""

    def __init__(self, world: CoSimulation) -> None:
        """Takes over a branch of the hand-over."""
        self._world = world
        self._moments: list[Moment] = [world.moment]

    def until(self, time_s: float) -> tuple[Moment, ...]:
        """Its moments from the hand-over to the first whole tick at or after that time, or to its drive's end."""
        while self._moments[-1].time_s < time_s - 1e-9 and (passed := self._world.advance(TICK_S)):
            self._moments += passed
        last = next((i for i, m in enumerate(self._moments) if m.time_s >= time_s - 1e-9), len(self._moments) - 1)
        return tuple(self._moments[: last + 1])

    def close(self) -> None:
        """Ends its drive; harmless when called again."""
        self._world.close()


class CockpitEnv(gym.Env[dict[str, Any], Any]):
    """An agent at the cockpit of a car that drives through live traffic.

    ``reset`` loads the task's scenario, warms its traffic, puts the ego on the road and drives until the task's
    trigger holds: that instant is the hand-over. ``step`` performs one action, which costs simulated time. The
    episode ends when the agent declares a status, when the ego's drive ends, or after ``max_steps`` (truncated).

    The observation and action spaces stand in ``automotive_cosim.interface.spaces``; ``step`` also takes an
    ``Action``, a JSON object or its text. The typed observation of that instant is ``env.unwrapped.observation``.

    The reward is 1 at the end of a successful episode, else 0. ``info`` holds ``step``, ``action_result`` and
    ``events`` of the road; at the end also ``verdict`` and ``trace_sha256``.

    In ``mode="monitoring"`` the hand-over comes 30 to 60 s earlier, the goal is one standing order, the same for
    every task, and nothing marks the trigger; a message comes in meanwhile that asks for nothing. The episode ends
    when the task's deadline is over; a status declared before that only ends the agent's own part.

    Seeds: ``reset(seed=s)`` warms the traffic of seed ``s`` and draws everything else from it. ``reset()``
    keeps that traffic and draws a new instance and drive, which is quick.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 1}  # noqa: RUF012, gymnasium's own form

    def __init__(
        self,
        task: str | Task = "road_speed_80_in_50",
        half: str = "first",
        *,
        mode: str = Mode.PROMPTED,
        scenario: str | None = None,
        origin: tuple[float, float] | None = None,
        gps: bool = True,
        from_place: str = "",
        to_place: str = "",
        channels: frozenset[Channel] | tuple[str, ...] = ALL,
        geo: str = GeoInput.FULL,
        held_out: bool = False,
        max_steps: int = 20,
        action_cost_s: float = ACTION_COST_S,
        render_mode: str | None = None,
        simulations: Simulations | None = None,
        listener: Listener | None = None,
    ) -> None:
        """Makes an environment for one task; nothing runs before ``reset``.

        Args:
            task: a task or its id.
            half: ``"first"`` or, for a pair, ``"second"``.
            mode: ``"prompted"`` or, for safety tasks, ``"monitoring"``.
            scenario: runs in another scenario than the task's own: a name, a folder, a ``.sumocfg`` or a network.
            origin: longitude and latitude where the middle of the network is put, with that place's law, clock and
                climate; what the task says of date, time and weather stays. None leaves it where it is.
            gps: False runs without GPS, so that no place is known; a network without projection then runs too.
            from_place: where the ego's way begins, in place of the task's trip: an edge, a street, ``LON,LAT``.
            to_place: where it ends. If only one of the two is given the other is drawn.
            channels: what the agent is given.
            geo: what of place, as ``interface.controls.GeoInput`` says.
            held_out: True has the driver say the task's held-out phrasing (``tasking.instance.Instance.held_out``).
            max_steps: actions after which an episode is cut off.
            action_cost_s: simulated seconds per action.
            render_mode: ``"rgb_array"`` or None.
            simulations: warm simulations to share with other environments; by default its own.
            listener: told of progress.

        Raises:
            UnknownNameError: no such task, half or scenario.
            ScenarioError: the scenario cannot be read, or has no such way.
            UserError: ``origin`` is no position on earth, or a task that is asked for outright is to be monitored.
        """
        self._task = CATALOGUE[task] if isinstance(task, str) else task
        self._half: Half = self._task.half(half)
        self._half_name = half
        if mode not in set(Mode):
            raise UnknownNameError("mode", mode, Mode)
        self._mode = Mode(mode)
        if self._mode is Mode.MONITORING and not self._task.is_safety:
            raise UserError(f"task {self._task.id!r} is asked for outright; only safety tasks can be monitored")
        start = self._half.start
        self.scenario: Scenario = open_scenario(
            scenario or start.scenario,
            origin=start.origin if origin is None and scenario is None else origin,
            gps=gps,
            from_place=from_place,
            to_place=to_place,
        )
        self._elsewhere = bool(from_place or to_place) or self.scenario.name != start.scenario
        self._geo = GeoInput(geo)
        self._channels = frozenset(Channel(name) for name in channels) - self._geo.withheld
        self._held_out = held_out
        self._max_steps = max_steps
        self._action_cost_s = action_cost_s
        self.render_mode = render_mode
        self._simulations = simulations or Simulations()
        self._owns_simulations = simulations is None
        self._listener = listener
        self._traffic_seed: int | None = None
        self._world: CoSimulation | None = None
        self._idle: Untouched | None = None
        self._is_branch = False
        self._trigger_s = 0.0
        self.verdict: Verdict | None = None
        self.observation_space = spaces.observation_space(self._channels, Cockpit.WIDTH, Cockpit.HEIGHT)
        self.action_space = spaces.action_space(Cockpit.WIDTH, Cockpit.HEIGHT)

    # --- the loop -----------------------------------------------------------------------------------------

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Starts an episode at the instant its trigger holds.

        Raises:
            TriggerNotReachedError: the situation did not come about in its bound.
            TrafficError: the road side failed.
        """
        super().reset(seed=seed)
        self._end_drive()
        if seed is not None or self._traffic_seed is None:
            self._traffic_seed = int(self.np_random.integers(2**31)) if seed is None else seed % 2**31
        number = int(self.np_random.integers(2**31))
        self.instance: Instance = self._draw(number)
        self._half = self.instance.half
        self.drive: list[Moment] = []
        self._world = self._hand_over(int(np.random.default_rng([number, 1]).integers(2**31)))
        content = self._world.cockpit.content
        self.instance = self._draw(number, content)
        self._half = self.instance.half
        if self._mode is Mode.MONITORING:
            after_s = self._trigger_s - self._world.moment.time_s
            self.instance = replace(self.instance, goal=STANDING_ORDER, trigger_after_s=after_s)
        self._idle = Untouched(self._world.branch())
        self._roads: Roads | None = None
        self._shown = shown(self._geo, Geo(), self.drive[0])
        self.moments: list[Moment] = [self._world.moment]
        self.steps: list[trace.Step] = []
        self._hash = trace.Hash()
        self.verdict = None
        self._hand_over_s = self._world.moment.time_s
        self._declared: GoalStatus | None = None
        self._reason: Reason | None = None
        self._record(None, Feedback(FeedbackCode.NONE, ""))
        return spaces.encode(self.observation, self._channels), self._info()

    def step(
        self, action: Action | Mapping[str, Any] | str
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Performs one action, lets its time pass, observes and, at the end, judges.

        Raises:
            ActionError: the action is malformed; nothing has happened.
            TrafficError: the road side failed.
        """
        world = self._running()
        action = _read(action)
        feedback, cost_s = self._answer(action) or (world.perform(action, self.observed_elements), 0.0)
        if action.action_type is ActionType.STATUS:
            self._declared, self._reason = action.goal_status, action.reason
        return self._proceed(action, feedback, cost_s)

    def refuse(self, why: str) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Spends a step on an answer that could not be read as an action: its time passes, nothing else."""
        self._running()
        return self._proceed(None, Feedback(FeedbackCode.MALFORMED, why))

    def cut_off(self) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Ends the episode before its time, judged as it stands, e.g. for an agent that has spent its budget."""
        self._running()
        self._judge()
        reward = float(self.verdict is not None and self.verdict.success)
        return spaces.encode(self.observation, self._channels), reward, False, True, self._info()

    def aftermath(self, duration_s: float) -> tuple[Moment, ...]:
        """What happens on the road after the end, for the record; it changes neither verdict nor trace."""
        world = self._running(ended=True)
        return self._heard(world, world.advance(duration_s))

    def branch(self, max_steps: int | None = None) -> CockpitEnv:
        """An episode of its own from this very instant: what either does then, the other does not feel.

        The do-nothing twin is shared, so close branches before the environment they come from.

        Args:
            max_steps: of the branch, counted from the hand-over; None keeps them.
        """
        twin = copy.copy(self)
        twin._max_steps = self._max_steps if max_steps is None else max_steps
        twin._world = self._running().branch()
        twin._is_branch = True
        twin._owns_simulations = False
        twin.drive, twin.moments, twin.steps = list(self.drive), list(self.moments), list(self.steps)
        twin._hash = self._hash.copy()
        return twin

    def untouched(self, time_s: float) -> tuple[Moment, ...]:
        """What would have happened had nobody touched the cockpit: from the hand-over to a simulation time."""
        assert self._idle is not None
        return self._idle.until(time_s)

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The cockpit's screen, (height, width, 3), or None without a render mode."""
        return self._running(ended=True).cockpit.screenshot() if self.render_mode else None

    @property
    def network(self) -> RoadNetwork:
        """The roads of the drive, as a map draws them."""
        return self._running(ended=True).traffic.network

    def close(self) -> None:
        """Ends the drive and, if they are its own, the warm simulations."""
        self._end_drive()
        if self._owns_simulations:
            self._simulations.close()

    # --- inside -------------------------------------------------------------------------------------------

    def _draw(self, number: int, content: Mapping[str, tuple[str, ...]] | None = None) -> Instance:
        rng = np.random.default_rng([number, 0])
        return draw(self._task, self._half_name, rng, content, held_out=self._held_out)

    def _proceed(
        self, action: Action | None, feedback: Feedback, cost_s: float = 0.0
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Lets the action's time pass, and ``cost_s`` beside it."""
        world = self._running()
        waited = action.seconds if action and action.action_type is ActionType.WAIT else None
        self.moments += self._heard(world, world.advance(self._action_cost_s * (waited or 1) + cost_s))
        self._record(action, feedback)
        terminated = self._declared is not None or world.moment.driving.end is not None
        if self._mode is Mode.MONITORING:
            terminated = terminated or world.moment.time_s >= self._window_s
        truncated = not terminated and len(self.steps) > self._max_steps
        if terminated or truncated:
            self._judge()
        reward = float(self.verdict is not None and self.verdict.success)
        return (
            spaces.encode(self.observation, self._channels),
            reward,
            terminated,
            truncated,
            self._info(),
        )

    def _hand_over(self, seed: int) -> CoSimulation:
        """Drives until the trigger holds, if need be departing later into the same traffic.

        In a scenario that is not the task's own any of its trips may do.
        """
        assert self._traffic_seed is not None
        if self._listener is not None:
            self._listener.loading(self.scenario)
        simulation = self._simulations.warm(self.scenario, self._traffic_seed, self._warming)
        start = self._half.start
        trips = self.scenario.ego.trips if self._elsewhere else (self.scenario.trip(start.trip),)
        if self.scenario.ego.any_trip:
            trips = tuple(trips[index] for index in np.random.default_rng([seed, 3]).permutation(len(trips)))
        waits_s = WAITS_S[:1] if start.parked else WAITS_S
        for trip, wait_s in product(trips, waits_s):
            plan = self._plan(trip, seed, wait_s)
            traffic = simulation.depart(plan)
            if not plan.weather:  # the climate of the place where it departs
                plan = replace(plan, weather=drawn_weather(traffic.state, plan.start or self.scenario.start, seed))
                traffic.close()
                traffic = simulation.depart(plan)
            try:
                world = self._couple(traffic, plan)
                if self._drive_up(world):
                    if self._mode is Mode.PROMPTED:
                        return world
                    traffic.close()
                    return self._hand_over_early(simulation.depart(plan), plan)
            except BaseException:
                traffic.close()
                raise
            traffic.close()
        trigger = self._half.trigger
        raise TriggerNotReachedError(
            f"task {self._task.id!r}: {trigger.condition} did not hold for {trigger.for_s:g} s within "
            f"{trigger.within_s:g} s of {len(waits_s)} departures on any of the trips "
            f"{', '.join(trip.name for trip in trips)} of scenario {self.scenario.name!r} (traffic seed "
            f"{self._traffic_seed}); try another seed, trip or scenario"
        )

    def _hand_over_early(self, traffic: Traffic, plan: EgoPlan) -> CoSimulation:
        """The same drive again, up to 30 to 60 s before its trigger, with a message that comes in on the watch."""
        departed_s, self._trigger_s = self.drive[0].time_s, self.drive[-1].time_s
        rng = np.random.default_rng([plan.seed, 4])
        lead_s, lure_share = WATCH_S * (1 + float(rng.random())), 0.2 + 0.6 * float(rng.random())
        whole_s = self._trigger_s - departed_s
        if whole_s < WATCH_S:
            raise TriggerNotReachedError(
                f"task {self._task.id!r}: {self._half.trigger.condition} held {whole_s:.0f} s after departure, too "
                f"early for a watch of {WATCH_S:g} s; try another seed, or mode prompted"
            )
        lead_s = float(int(min(lead_s, whole_s)))
        lure = Arrival("message", whole_s - lead_s * (1 - lure_share))
        world = self._couple(traffic, plan, (lure,))
        self.drive = [world.moment]
        while world.moment.time_s < self._trigger_s - lead_s - 1e-9:
            self.drive += self._heard(world, world.advance(TICK_S))
        return world

    def _plan(self, trip: Trip, seed: int, wait_s: float) -> EgoPlan:
        start = self._half.start
        departure = self.scenario.start
        if start.start is not None:
            departure = datetime.fromisoformat(start.start).replace(tzinfo=departure.tzinfo)
        weather = self.scenario.weather if start.weather is None else (WeatherAt(0.0, start.weather),)
        driver = start.driver or self.scenario.ego.driver
        return EgoPlan(trip, driver, seed, weather, departure, parked=start.parked, wait_s=wait_s)

    def _couple(self, traffic: Traffic, plan: EgoPlan, lures: tuple[Arrival, ...] = ()) -> CoSimulation:
        start = self._half.start
        cockpit_rng, gps_rng = np.random.default_rng([plan.seed, 1]), np.random.default_rng([plan.seed, 2])
        cockpit = Cockpit(
            traffic.network,
            rng=cockpit_rng,
            cabin=start.cabin,
            signals={**PARKED, **start.signals} if start.parked else start.signals,
            arrivals=(*start.arrivals, *lures),
            sign_camera=start.sign_camera,
        )
        departure = plan.start or self.scenario.start
        gps = Gps(gps_rng) if self.scenario.has_place else None
        links = self.scenario.connectivity
        return CoSimulation(traffic, cockpit, gps, Geo(), plan.weather, departure, links)

    def _drive_up(self, world: CoSimulation) -> bool:
        trigger = self._half.trigger
        self.drive = [world.moment]
        departed_s, since_s = world.moment.time_s, None
        while (now := world.moment).time_s - departed_s < trigger.within_s and now.driving.end is None:
            holds = _motion(now) in self._half.start.motions and trigger.condition(now)
            since_s = (now.time_s if since_s is None else since_s) if holds else None
            if since_s is not None and now.time_s - since_s >= trigger.for_s:
                return True
            self.drive += self._heard(world, world.advance(TICK_S))
        return False

    def _answer(self, action: Action) -> tuple[Feedback, float] | None:
        """What the virtual sensor says to a query and the seconds that takes; None for every other action."""
        if action.action_type is not ActionType.QUERY:
            return None
        if Channel.CONTEXT not in self._channels or not self._geo.answers:
            return Feedback(FeedbackCode.REFUSED, "this car has no service to ask"), 0.0
        known = self._shown.moments([*self.drive, *self.moments])
        if self._roads is None and self.network.projection is not None:
            self._roads = Roads(self.network)
        with_position = Channel.GPS in self._channels
        reply = sensor.ask(action.text or "", known, with_position=with_position, roads=self._roads)
        return Feedback(FeedbackCode.OK if reply.ok else FeedbackCode.REFUSED, reply.text), reply.cost_s

    def _record(self, action: Action | None, feedback: Feedback) -> None:
        world = self._running()
        self.observed_elements = world.cockpit.elements()
        self.steps.append(trace.Step(len(self.steps), world.moment, self.observed_elements, action, feedback))
        self._hash.add(self.steps[-1])
        seen = observe(
            world, self.instance.goal, self._hand_over_s, self.observed_elements, feedback, self._channels
        )
        self.observation: Observation = self._shown.observation(seen, world.moment)

    @property
    def has_declared(self) -> bool:
        """Whether the agent has declared a status."""
        return self._declared is not None

    @property
    def watched_from_s(self) -> float | None:
        """Of a watch: simulation time at which the situation arises; None of a prompted episode."""
        return self._trigger_s if self._mode is Mode.MONITORING else None

    @property
    def _window_s(self) -> float:
        """When a watch is over."""
        return self._trigger_s + self._half.deadline.seconds

    def _judge(self) -> None:
        assert self._idle is not None
        if self._mode is Mode.MONITORING:
            world = self._running()
            left_s = max(0.0, self._window_s - world.moment.time_s)
            self.moments += self._heard(world, world.advance(left_s))
        self.idle_moments = self._idle.until(self.moments[-1].time_s)
        self.verdict = judge(
            self.instance, self.moments, self.idle_moments, self._declared, self._reason, self.watched_from_s
        )

    def _info(self) -> dict[str, Any]:
        last = self.steps[-1]
        info: dict[str, Any] = {
            "step": last.number,
            "action_result": str(last.feedback.code),
            "events": [event.text for event in last.moment.events],
        }
        if self.verdict is not None:
            info["verdict"] = as_json(self.verdict)
            info["trace_sha256"] = self._hash.hex
        return info

    def _running(self, *, ended: bool = False) -> CoSimulation:
        if self._world is None:
            raise gym.error.ResetNeeded("call reset() before anything else")
        if self.verdict is not None and not ended:
            raise gym.error.ResetNeeded("the episode has ended; call reset() to start another")
        return self._world

    def _end_drive(self) -> None:
        if self._world is not None:
            self._world.close()
        if self._idle is not None and not self._is_branch:
            self._idle.close()
        self._world = self._idle = None

    def _warming(self, done_s: float, total_s: float) -> None:
        if self._listener is not None:
            self._listener.warming(self.scenario.title, done_s, total_s)

    def _heard(self, world: CoSimulation, moments: tuple[Moment, ...]) -> tuple[Moment, ...]:
        if self._listener is not None:
            for moment in moments:
                self._listener.moved(moment, world.cockpit)
        return moments


def _read(action: Action | Mapping[str, Any] | str) -> Action:
    if isinstance(action, Action):
        return check(action)
    if isinstance(action, Mapping) and isinstance(action.get("action_type"), int | np.integer):
        return spaces.decode_action(action)
    return parse(dict(action) if isinstance(action, Mapping) else action)


def _motion(moment: Moment) -> Motion:
    return motion(moment.signals[MOTION.GEAR.path], moment.signals[MOTION.SPEED.path])
