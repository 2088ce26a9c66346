"""Agents by their names; to know the names, and what each agent does in a line, none is imported."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from automotive_cosim.agents.base import Agent
    from automotive_cosim.agents.settings import AgentSettings

PREFIX = "a2a:"
"""Of the name of an agent behind an address."""
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


def _made(where: str, **given: Any) -> Agent:
    """An agent of a class of this package, which is imported for it."""
    agent: Agent = resolve_name(f"automotive_cosim.{where}")(**given)
    return agent


def _control(where: str, about: str, on: str = "", *, by_touch: bool = False) -> AgentEntry:
    return AgentEntry(lambda settings: _made(where), f"{CONTROL}{on}: {about}", CONTROL, by_touch)


SIMPLE: Mapping[str, AgentEntry] = {
    "alert-all": _control("drives.watchers:AlertAll", "gives every kind of alert in turn", ON_DRIVES),
    "alert-often": _control("drives.watchers:AlertOften", "warns of speed twice a minute", ON_DRIVES),
    "alert-on-wake": _control(
        "drives.watchers:AlertOnWake", "warns of speed whenever something changes", ON_DRIVES
    ),
    "always-alert": _control("agents.trivial:AlwaysAlert", "warns at once, whatever happens"),
    "always-ask": _control("agents.trivial:AlwaysAsk", "asks the driver what is meant, and declares complete"),
    "human": AgentEntry(
        lambda settings: _made("agents.human:Human"), "you, with numbered elements on the terminal", by_touch=True
    ),
    "limit-law": AgentEntry(
        lambda settings: _made("agents.limits:LimitTeller", knows_law=True),
        "tells the speed limit, by sign or by law, in this weather, and nothing else",
        "scripted",
    ),
    "limit-sign": AgentEntry(
        lambda settings: _made("agents.limits:LimitTeller", knows_law=False),
        "tells the speed limit on the last sign alone",
        "scripted",
    ),
    "no-op": _control("agents.trivial:NoOp", "waits and declares nothing"),
    "oracle": AgentEntry(
        lambda settings: (
            _made("agents.oracle:Oracle", see=settings.conditions.see)
            if settings.conditions.interface.touches
            else _made("agents.by_calls:OracleByCalls")
        ),
        "reference: is told the task and plays its reference solution, by touch or by calls",
        "told the answer",
    ),
    "press-everything": _control("agents.trivial:PressEverything", "presses every button", by_touch=True),
    "random": AgentEntry(
        lambda settings: _made("agents.trivial:Random", seed=settings.seed),
        f"{CONTROL}: random actions",
        CONTROL,
        by_touch=True,
    ),
    "rule-perfect": AgentEntry(
        lambda settings: _made("drives.watchers:RulePerfect"),
        "reference on drives: knows the rules and reads only what any agent may observe",
        "told the rules",
    ),
    "silent": _control("drives.watchers:Silent", "waits", ON_DRIVES),
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

BY_TOUCH = frozenset({"native", *(name for name, each in SIMPLE.items() if each.by_touch)})
"""Agents that act on the screen alone."""


def is_remote(name: str) -> bool:
    """Whether a name is that of an agent behind an address."""
    return name.startswith(PREFIX)
