"""An agent decides: it gets the cockpit of a car in a branch, hears what the driver wants, and taps."""

from __future__ import annotations

from datetime import timedelta

import numpy as np

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import ActionType, Feedback, FeedbackCode
from automotive_cosim.cosim.simulation import TICK_S, WAYS_FROM_S, CoSimulation
from automotive_cosim.errors import ActionError, OutOfBudgetError
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.locate import Geo
from automotive_cosim.interface.observe import observe
from automotive_cosim.studies.plan import DriveJob, named
from automotive_cosim.traffic.base import Traffic

GOAL = "There's a lot of traffic ahead. Can we get there faster?"
"""What the driver says."""


def decided(agent: str, job: DriveJob, traffic: Traffic) -> None:
    """Lets an agent act in a branch until it declares an end, has no actions left, or the ego arrives.

    The map needs some seconds to know other ways; the ego drives on meanwhile and while the agent acts, as it does
    when a person thinks.

    Args:
        agent: as ``make_agent`` names it, ``NAME`` or ``NAME/MODEL``.
        job: whose drive it is.
        traffic: the branch; it is not closed.

    Raises:
        UserError: no such agent or model.
        ModelError: its model could not be reached.
    """
    player = make_agent(*named(agent), AgentSettings(seed=job.seed))
    world = _coupled(job, traffic)
    world.advance(WAYS_FROM_S + TICK_S)
    begun_s = world.moment.time_s
    feedback = Feedback(FeedbackCode.NONE, "")
    player.reset(GOAL)
    for _ in range(job.plan.agent_steps):
        if world.moment.driving.end is not None:
            break
        elements = world.cockpit.elements()
        try:
            action = player.act(observe(world, GOAL, begun_s, elements, feedback, player.channels))
        except OutOfBudgetError:
            break
        except ActionError as error:
            feedback = Feedback(FeedbackCode.MALFORMED, str(error))
        else:
            if action.action_type is ActionType.STATUS:
                break
            feedback = world.perform(action, elements)
        world.advance(TICK_S)


def _coupled(job: DriveJob, traffic: Traffic) -> CoSimulation:
    """A cockpit that is switched on at this instant."""
    scenario = job.plan.scene(job.share)
    draws = [np.random.default_rng([*job.entropy, number]) for number in (2, 3)]
    clock = scenario.start + timedelta(seconds=traffic.state.time_s - scenario.sumo.warm_up_s)
    weather = scenario.weather or drawn_weather(traffic.state, clock, job.seed)
    gps = Gps(draws[1]) if scenario.has_place else None
    return CoSimulation(traffic, Cockpit(traffic.network, rng=draws[0]), gps, Geo(), weather, clock)
