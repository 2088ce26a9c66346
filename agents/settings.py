"""Profiles of the agents that use a model, as data, and switches that take parts of them away."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path

from automotive_cosim.contracts import BY_HAND, UNCALLED, ActionType
from automotive_cosim.contracts.given import Interface, Order, PromptLength
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.interface.functions import LIGHT, Function, offered
from automotive_cosim.interface.observe import ALL, Channel


class AgentPart(StrEnum):
    """Parts that can be switched off, to measure their effect."""

    GPS = "gps"
    CONTEXT = "context"
    QUERIES = "queries"
    SCREEN = "screen"
    """The screenshots; the list of elements stays."""
    REFLECTION = "reflection"
    MEMORY = "memory"


def parts(names: Iterable[str]) -> frozenset[AgentPart]:
    """Parts by name. Raises UnknownNameError: there is no such part."""
    chosen = list(names)
    for name in chosen:
        if name not in set(AgentPart):
            raise UnknownNameError("part of an agent", name, AgentPart)
    return frozenset(map(AgentPart, chosen))


@dataclass(frozen=True, slots=True)
class AgentSettings:
    """How to run an agent. An agent ignores the settings that it has no use for."""

    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What it is given; see ``episode.conditions``."""
    without: frozenset[AgentPart] = frozenset()
    memory: Path | None = None
    """SQLite file with what worked in earlier episodes; None, the default, keeps episodes independent."""
    seed: int = 0
    """Seed of an agent that acts randomly."""
    most_tokens: int = 2_000_000
    """An episode's budget of tokens, for questions and answers together."""
    most_seconds: float = 14_400.0
    """An episode's budget of time to wait for the model: hours, for a slow one that is asked hundreds of times on a
    drive of thirty minutes."""
    answer_s: float = 120.0
    """Wall seconds in which an agent behind an address has to answer."""
    instructions: str = ""
    """Text of the file that the condition ``prompt`` names (``episode.own_prompt``), read by who starts the agent:
    its own process has another working folder."""

    def __post_init__(self) -> None:
        if self.most_tokens <= 0 or self.most_seconds <= 0:
            raise UserError(
                f"an agent's budget is {self.most_tokens} tokens and {self.most_seconds:g} s; give both above 0"
            )


SCREEN_ALONE = frozenset(UNCALLED) - {ActionType.QUERY, ActionType.ESTIMATE_POSITION}


@dataclass(frozen=True, slots=True)
class AgentProfile:
    """One variant of the common cycle."""

    name: str
    """Name of the agent and of its prompt."""
    channels: frozenset[Channel]
    actions: frozenset[ActionType] = SCREEN_ALONE
    """Actions that its prompt offers; anything else is refused."""
    reflects: bool = True
    length: PromptLength = PromptLength.STANDARD
    """How much its prompt spells out."""
    instructions: str = ""
    """What stands in place of the standard prompt's, if anything does."""
    remembers: bool = False
    """Whether it can remember what worked from one episode to the next."""
    interface: Interface = Interface.TOUCH
    """How it acts."""
    order: Order = Order.PLAIN
    """What the driver of a drive asks for."""

    @property
    def functions(self) -> tuple[Function, ...]:
        """The car's functions that its prompt offers, besides the actions."""
        if not self.interface.calls:
            return ()
        return tuple(each for each in offered(Interface.FUNCTIONS) if each.name not in set(ActionType))

    def under(self, settings: AgentSettings) -> AgentProfile:
        """The profile without what the settings take away."""
        without = settings.without
        lost = set(settings.conditions.geo.withheld | settings.conditions.see.withheld)
        lost |= {channel for part, channel in _CHANNELS.items() if part in without}
        channels = self.channels - lost
        actions = set(self.actions)
        if AgentPart.QUERIES in without or not settings.conditions.geo.answers or Channel.CONTEXT not in channels:
            actions.discard(ActionType.QUERY)
        if Channel.GPS not in channels:
            actions.discard(ActionType.ESTIMATE_POSITION)
        interface = settings.conditions.interface
        if interface.calls:
            actions.add(ActionType.CALL)
        if not interface.touches:
            actions -= {*BY_HAND, LIGHT}
        return replace(
            self,
            channels=channels,
            actions=frozenset(actions),
            length=settings.conditions.prompt.length,
            instructions=settings.instructions,
            reflects=self.reflects and AgentPart.REFLECTION not in without,
            remembers=self.remembers and AgentPart.MEMORY not in without and settings.memory is not None,
            interface=interface,
            order=settings.conditions.order,
        )


_CHANNELS = {AgentPart.GPS: Channel.GPS, AgentPart.CONTEXT: Channel.CONTEXT, AgentPart.SCREEN: Channel.SCREENSHOT}

_TEXT = frozenset({Channel.ELEMENTS, Channel.VEHICLE, Channel.CONNECTIVITY})
T3A = AgentProfile("t3a", _TEXT)
"""Reads the elements (after AndroidWorld's T3A)."""
M3A = AgentProfile("m3a", _TEXT | {Channel.SCREENSHOT})
"""Also sees the screen, raw and with numbered marks (after AndroidWorld's M3A)."""
ASURADA = AgentProfile("asurada", ALL, frozenset(UNCALLED), remembers=True)
"""Also knows where it is, and can query the rules there (after the paper's ASURADA)."""
PROFILES = {profile.name: profile for profile in (T3A, M3A, ASURADA)}
