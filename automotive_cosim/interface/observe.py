"""Observations: the part of a moment that an agent is given. A channel it is not given is absent, not empty."""

from __future__ import annotations

from automotive_cosim.contracts import Element, Feedback, Observation
from automotive_cosim.contracts.given import ALL as ALL
from automotive_cosim.contracts.given import Channel as Channel
from automotive_cosim.contracts.given import See as See
from automotive_cosim.contracts.given import ToldPolicy
from automotive_cosim.cosim.simulation import CoSimulation
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.text import BUDGET_TOKENS, within_budget
from automotive_cosim.interface.house_rules import told


def observe(
    world: CoSimulation,
    goal: str,
    hand_over_s: float,
    elements: tuple[Element, ...],
    feedback: Feedback,
    channels: frozenset[Channel] = ALL,
    said: tuple[str, ...] = (),
    policy: ToldPolicy = ToldPolicy.NONE,
    sounds: tuple[bytes, ...] = (),
) -> Observation:
    """An agent's observation of the present moment.

    Args:
        hand_over_s: simulation time at which the agent took over.
        elements: the accessibility elements of the present screen.
        feedback: the result of the last action.
        said: what the driver has said since the hand-over.
        sounds: the wish and what was said since, as WAV files.
    """
    moment = world.moment
    return Observation(
        goal=goal,
        time_s=moment.time_s - hand_over_s,
        feedback=feedback,
        said=said,
        elements=elements if Channel.ELEMENTS in channels else None,
        screenshot=world.cockpit.screenshot() if Channel.SCREENSHOT in channels else None,
        camera=world.view() if Channel.CAMERA in channels else None,
        vehicle=world.cockpit.vehicle_state() if Channel.VEHICLE in channels else None,
        connectivity=moment.connectivity if Channel.CONNECTIVITY in channels else None,
        gps=moment.gps if Channel.GPS in channels else None,
        context=context_text(moment.context, with_position=Channel.GPS in channels)
        if Channel.CONTEXT in channels
        else None,
        policy=told(policy),
        sounds=sounds,
    )


def context_text(context: GeoContext, *, with_position: bool) -> str:
    """The geo-context as text; an agent without GPS gets no line that states the position either."""
    if with_position:
        return context.text()
    return within_budget((line for line in context.shown if line.source != "gps"), BUDGET_TOKENS)
