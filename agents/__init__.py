"""Agents: the contestants (T3A, M3A, ASURADA), the references (oracle, human) and the negative controls."""

from __future__ import annotations

if __name__ != "automotive_cosim.agents":
    raise ImportError(f"import this package as automotive_cosim.agents, not as {__name__}")

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from automotive_cosim.agents.a2a import A2AAgent, is_remote
from automotive_cosim.agents.base import Agent, Learner, Privileged, Stage, StageName, Thinker
from automotive_cosim.agents.by_calls import OracleByCalls
from automotive_cosim.agents.caller import Caller, tools
from automotive_cosim.agents.guest import classes_in, load
from automotive_cosim.agents.human import Human
from automotive_cosim.agents.limits import LimitTeller
from automotive_cosim.agents.model_agent import ModelAgent
from automotive_cosim.agents.native import FORMATS, NativeAgent, chosen
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.agents.settings import PROFILES, AgentPart, AgentSettings
from automotive_cosim.agents.trivial import AlwaysAlert, AlwaysAsk, NoOp, PressEverything, Random
from automotive_cosim.drives.watchers import AlertAll, AlertOften, AlertOnWake, RulePerfect, Silent
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.interface.functions import as_json
from automotive_cosim.models import ChatModel, make_model
from automotive_cosim.models.apis import ChatTools, ProviderApi
from automotive_cosim.models.turns import Turns

__all__ = [
    "ABOUT",
    "AGENTS",
    "FORMATS",
    "MODELLED",
    "NOT_RANKED",
    "PROFILES",
    "Agent",
    "AgentPart",
    "AgentSettings",
    "AlwaysAlert",
    "AlwaysAsk",
    "Caller",
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
    "is_remote",
    "make_agent",
    "model_of",
]

CONTROL, ON_DRIVES = "negative control", " on drives"


@dataclass(frozen=True, slots=True)
class AgentEntry:
    """An agent without a model, as it is made and listed."""

    make: Callable[[AgentSettings], Agent]
    about: str
    """What it does, in a line."""
    unranked: str = ""
    """Why it is not ranked; empty if it is."""
    by_touch: bool = False
    """Whether it acts on the screen alone."""


def _control(kind: Callable[[], Agent], about: str, where: str = "", *, by_touch: bool = False) -> AgentEntry:
    return AgentEntry(lambda settings: kind(), f"{CONTROL}{where}: {about}", CONTROL, by_touch)


SIMPLE: Mapping[str, AgentEntry] = {
    "alert-all": _control(AlertAll, "gives every kind of alert in turn", ON_DRIVES),
    "alert-often": _control(AlertOften, "warns of speed twice a minute", ON_DRIVES),
    "alert-on-wake": _control(AlertOnWake, "warns of speed whenever something changes", ON_DRIVES),
    "always-alert": _control(AlwaysAlert, "warns at once, whatever happens"),
    "always-ask": _control(AlwaysAsk, "asks the driver what is meant, and declares complete"),
    "human": AgentEntry(lambda settings: Human(), "you, with numbered elements on the terminal", by_touch=True),
    "limit-law": AgentEntry(
        lambda settings: LimitTeller(knows_law=True),
        "tells the speed limit, by sign or by law, in this weather, and nothing else",
        "scripted",
    ),
    "limit-sign": AgentEntry(
        lambda settings: LimitTeller(knows_law=False), "tells the speed limit on the last sign alone", "scripted"
    ),
    "no-op": _control(NoOp, "waits and declares nothing"),
    "oracle": AgentEntry(
        lambda settings: (
            Oracle(settings.conditions.see) if settings.conditions.interface.touches else OracleByCalls()
        ),
        "reference: is told the task and plays its reference solution, by touch or by calls",
        "told the answer",
    ),
    "press-everything": _control(PressEverything, "presses every button", by_touch=True),
    "random": AgentEntry(
        lambda settings: Random(settings.seed), f"{CONTROL}: random actions", CONTROL, by_touch=True
    ),
    "rule-perfect": AgentEntry(
        lambda settings: RulePerfect(),
        "reference on drives: knows the rules and reads only what any agent may observe",
        "told the rules",
    ),
    "silent": _control(Silent, "waits", ON_DRIVES),
}
"""Agents without a model."""

MODELLED: Mapping[str, str] = {
    "asurada": "elements, screenshots, GPS, geo-context; can query rules and remember (as the paper's)",
    "caller": "calls functions, in a plain loop; what it sees is set by --see and --geo",
    "m3a": "elements and screenshots, raw and marked (after AndroidWorld's M3A)",
    "native": "screenshots alone, for models trained to operate screens, in their own formats",
    "t3a": "elements as text (after AndroidWorld's T3A)",
}
"""Agents with a model, and what each of them sees or does, in a line."""

ABOUT: Mapping[str, str] = dict(sorted([*((name, each.about) for name, each in SIMPLE.items()), *MODELLED.items()]))
"""What each agent sees or does, in a line."""

AGENTS = tuple(ABOUT)
"""Names of all agents; ``package.module:Class`` names one of your own, ``a2a:http://HOST:PORT`` one that is served
there."""

NOT_RANKED: Mapping[str, str] = {name: each.unranked for name, each in SIMPLE.items() if each.unranked}
"""References and negative controls, and what they are: they measure the benchmark, not themselves."""

BY_TOUCH = frozenset({NativeAgent.name, *(name for name, each in SIMPLE.items() if each.by_touch)})
"""Agents that act on the screen alone."""


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
        SetupError: the model's package, key or address is missing, or no agent answers at an address.
    """
    if is_remote(name):
        return A2AAgent(name, settings)
    if ":" in name:
        return load(name)
    if name in BY_TOUCH and not settings.conditions.interface.touches:
        raise UserError(f"agent {name!r} works on the screen, which --interface functions withholds; take 'caller'")
    if name == Caller.name:
        return Caller(chat_model or make_model(model, _speaking(settings)), settings)
    if name in PROFILES:
        return ModelAgent(PROFILES[name], chat_model or make_model(model), settings)
    if name == NativeAgent.name:
        without_format, form = chosen(model)
        return NativeAgent(model, chat_model or make_model(without_format, form.api), form, settings)
    if name not in SIMPLE:
        if own := classes_in(name):
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
        as ``make_agent``.
    """
    if name not in MODELLED:
        return None
    if name == NativeAgent.name:
        without_format, form = chosen(model)
        return make_model(without_format, form.api, turns)
    return make_model(model, _speaking(settings) if name == Caller.name else None, turns)


def _speaking(settings: AgentSettings) -> ProviderApi:
    """The protocol of a model that is offered the functions."""
    return ChatTools(tools=tuple(map(as_json, tools(settings))))
