"""Agents: the contestants (T3A, M3A, ASURADA), the references (oracle, human) and the negative controls."""

from __future__ import annotations

if __name__ != "automotive_cosim.agents":
    raise ImportError(f"import this package as automotive_cosim.agents, not as {__name__}")

from collections.abc import Callable, Mapping

from automotive_cosim.agents.base import Agent, Learner, Privileged, Stage, StageName, Thinker
from automotive_cosim.agents.guest import load
from automotive_cosim.agents.human import Human
from automotive_cosim.agents.model_agent import ModelAgent
from automotive_cosim.agents.native import FORMATS, NativeAgent, chosen
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.agents.settings import PROFILES, AgentPart, AgentSettings
from automotive_cosim.agents.trivial import AlwaysAlert, NoOp, PressEverything, Random
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.models import make_model

__all__ = [
    "AGENTS",
    "FORMATS",
    "MODELLED",
    "PROFILES",
    "Agent",
    "AgentPart",
    "AgentSettings",
    "AlwaysAlert",
    "Human",
    "Learner",
    "ModelAgent",
    "NativeAgent",
    "NoOp",
    "Oracle",
    "PressEverything",
    "Privileged",
    "Random",
    "Stage",
    "StageName",
    "Thinker",
    "chosen",
    "make_agent",
]

SIMPLE: Mapping[str, Callable[[AgentSettings], Agent]] = {
    "always-alert": lambda settings: AlwaysAlert(),
    "human": lambda settings: Human(),
    "no-op": lambda settings: NoOp(),
    "oracle": lambda settings: Oracle(),
    "press-everything": lambda settings: PressEverything(),
    "random": lambda settings: Random(settings.seed),
}
"""Agents without a model."""

MODELLED = frozenset({*PROFILES, NativeAgent.name})
"""Agents with a model."""

AGENTS = tuple(sorted([*SIMPLE, *MODELLED]))
"""Names of all agents; ``package.module:Class`` names one of your own."""


def make_agent(name: str, model: str = "rules", settings: AgentSettings = AgentSettings()) -> Agent:  # noqa: B008, frozen
    """An agent by name.

    Args:
        name: one of ``AGENTS``, or ``package.module:Class``.
        model: a model's name (``models.make_model``), for the agents that have one; for ``native`` with the setting
            ``format``.
        settings: how to run it.

    Raises:
        UnknownNameError: no agent or model of that name.
        UserError: a class of your own is not an agent, or a memory cannot be used.
        SetupError: the model's package, key or address is missing.
    """
    if ":" in name:
        return load(name)
    if name in PROFILES:
        return ModelAgent(PROFILES[name], make_model(model), settings)
    if name == NativeAgent.name:
        without_format, form = chosen(model)
        return NativeAgent(model, make_model(without_format, form.wire), form, settings)
    if name not in SIMPLE:
        raise UnknownNameError("agent", name, AGENTS, "automotive-cosim agents list")
    return SIMPLE[name](settings)
