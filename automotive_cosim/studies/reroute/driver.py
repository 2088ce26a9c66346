"""Drives to the next decision, and lets an agent decide, who gets the cockpit of the car in a branch."""

from __future__ import annotations

from collections.abc import Callable
from datetime import timedelta

import numpy as np

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import DrivingState
from automotive_cosim.cosim.car import ALTERNATIVES_FROM_S
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation, couple
from automotive_cosim.episode.session import Session, play
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.studies.reroute.plan import StudyJob, StudyPlan, named
from automotive_cosim.traffic.base import Traffic

LOOK_S = 10.0
"""Time between two checks for a due decision, and between two samples of the traffic's speeds."""


def drive_on(
    traffic: Traffic,
    plan: StudyPlan,
    decide: Callable[[DrivingState], bool],
    most: int | None = None,
    advance: Callable[[float], object] | None = None,
) -> float:
    """Drives until the drive or its decisions are over.

    Args:
        plan: which delay makes a decision due, and how often.
        decide: called while one is due; true if there was something to decide, so the next is due later.
        most: the drive ends after this many decisions; None drives to the destination.
        advance: drives on by that many seconds; None uses the traffic's own.

    Returns:
        The greatest expected delay at any check."""
    advance = advance or traffic.advance
    begun_s = traffic.state.time_s
    due_s = begun_s + LOOK_S
    decided, most_delay_s = 0, 0.0
    advance(LOOK_S)
    while (now := traffic.state).end is None and now.time_s - begun_s < plan.limit_s:
        most_delay_s = max(most_delay_s, now.ahead.delay_s)
        is_due = now.time_s >= due_s - 1e-9 and now.ahead.delay_s >= plan.least_delay_s
        if is_due and not now.road.edge_id.startswith(":") and decide(now):
            due_s = now.time_s + plan.every_s
            decided += 1
            if decided == most:
                break
        advance(LOOK_S)
    return most_delay_s


GOAL = "There's a lot of traffic ahead. Can we get there faster?"
"""What the driver says."""


def decided(agent: str, job: StudyJob, traffic: Traffic) -> None:
    """Lets an agent act in a branch until it declares an end, has no actions left, or the ego arrives.

    The map takes some seconds to find other routes; meanwhile, and while the agent acts, the ego drives on.

    Args:
        agent: the agent for ``make_agent``, as ``NAME`` or ``NAME/MODEL``.

    Raises:
        UserError: no such agent or model.
        ModelError: its model could not be reached."""
    player = make_agent(*named(agent), AgentSettings(seed=job.seed))
    world = _coupled(job, traffic)
    drive = [world.moment, *world.advance(ALTERNATIVES_FROM_S + TICK_S)]
    if world.moment.driving.end is not None:
        return
    player.reset(GOAL)
    play(Session.begin(world, GOAL, SessionSetup(player.channels, max_steps=job.plan.agent_steps), drive), player)


def _coupled(job: StudyJob, traffic: Traffic) -> CoSimulation:
    """A cockpit that is switched on at this instant."""
    scenario = job.plan.scene(job.share)
    cockpit_rng, gps_rng = (np.random.default_rng([*job.entropy, number]) for number in (2, 3))
    clock = scenario.start + timedelta(seconds=traffic.state.time_s - scenario.sumo.warm_up_s)
    weather = scenario.weather or drawn_weather(traffic.state, clock, job.seed)
    return couple(
        traffic,
        Cockpit(traffic.network, rng=cockpit_rng),
        scenario,
        gps_rng=gps_rng,
        weather=weather,
        departure=clock,
    )
