"""Lets an agent decide: it gets the cockpit of a car in a branch, hears the driver's request, and acts."""

from __future__ import annotations

from datetime import timedelta

import numpy as np

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.car import ALTERNATIVES_FROM_S
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation, couple
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.studies.reroute.plan import StudyJob, named
from automotive_cosim.traffic.base import Traffic

GOAL = "There's a lot of traffic ahead. Can we get there faster?"
"""What the driver says."""


def decided(agent: str, job: StudyJob, traffic: Traffic) -> None:
    """Lets an agent act in a branch until it declares an end, has no actions left, or the ego arrives.

    The map takes some seconds to find other routes; meanwhile, and while the agent acts, the ego drives on.

    Args:
        agent: the agent for ``make_agent``, as ``NAME`` or ``NAME/MODEL``.
        job: the drive.
        traffic: the branch; it is not closed.

    Raises:
        UserError: no such agent or model.
        ModelError: its model could not be reached.
    """
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
