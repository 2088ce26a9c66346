"""Makes agents by their names; only the module of the one that is asked for is imported."""

from __future__ import annotations

from automotive_cosim.agents.base import Agent
from automotive_cosim.agents.registry import AGENTS, BY_TOUCH, MODELLED, SIMPLE, is_remote
from automotive_cosim.agents.settings import PROFILES, AgentSettings
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.interface.functions import as_json
from automotive_cosim.models import ChatModel, make_model
from automotive_cosim.models.apis import ChatTools, ProviderApi
from automotive_cosim.models.turns import Turns


def make_agent(
    name: str,
    model: str = "rules",
    settings: AgentSettings = AgentSettings(),  # noqa: B008, frozen
    chat_model: ChatModel | None = None,
) -> Agent:
    """An agent by name.

    Args:
        name: one of ``AGENTS``, ``package.module:Class``, or ``a2a:http://HOST:PORT``.
        model: a model's name (``models.make_model``), for the agents that have one; for ``native`` with the setting
            ``format``.
        chat_model: what answers in that model's place, e.g. a connection to it.

    Raises:
        UnknownNameError: no agent or model of that name.
        UserError: a class of your own is not an agent, or a memory cannot be used.
        SetupError: the model's package, key or address is missing, or no agent answers at an address."""
    if is_remote(name):
        from automotive_cosim.agents.a2a import A2AAgent

        return A2AAgent(name, settings)
    if ":" in name:
        from automotive_cosim.agents import guest

        return guest.load(name)
    if name in BY_TOUCH and not settings.conditions.interface.touches:
        raise UserError(f"agent {name!r} works on the screen, which --interface functions withholds; take 'caller'")
    if name == "caller":
        from automotive_cosim.agents.caller import Caller

        return Caller(chat_model or make_model(model, _speaking(settings)), settings)
    if name in PROFILES:
        from automotive_cosim.agents.model_agent import ModelAgent

        return ModelAgent(PROFILES[name], chat_model or make_model(model), settings)
    if name == "native":
        from automotive_cosim.agents.native import NativeAgent, chosen

        without_format, form = chosen(model)
        return NativeAgent(model, chat_model or make_model(without_format, form.api), form, settings)
    if name not in SIMPLE:
        from automotive_cosim.agents import guest

        if own := guest.classes_in(name):
            raise UserError(f"agent {name!r} names no class; did you mean {' or '.join(own)}?")
        raise UnknownNameError("agent", name, AGENTS, "automotive-cosim agents list")
    return SIMPLE[name].make(settings)


def model_of(
    name: str,
    model: str,
    turns: Turns | None = None,
    settings: AgentSettings = AgentSettings(),  # noqa: B008, frozen
) -> ChatModel | None:
    """The model that an agent of this name asks; None if it has none.

    Args:
        turns: where a model with a limit of questions a minute takes its turns; by default its own.
        settings: of the agent; one that calls functions tells its model which.

    Raises:
        as ``make_agent``."""
    if name not in MODELLED:
        return None
    if name == "native":
        from automotive_cosim.agents.native import chosen

        without_format, form = chosen(model)
        return make_model(without_format, form.api, turns)
    return make_model(model, _speaking(settings) if name == "caller" else None, turns)


def _speaking(settings: AgentSettings) -> ProviderApi:
    """The protocol of a model that is offered the functions."""
    from automotive_cosim.agents.caller import tools

    return ChatTools(tools=tuple(map(as_json, tools(settings))))
