"""The loop: plays any actor to the end of a session, and says when it has acted."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from math import inf
from typing import Protocol, TypeVar

from automotive_cosim.cockpit.actions import check
from automotive_cosim.contracts import Action, Element, Observation
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError


class Actor(Protocol):
    """Whoever acts in a session."""

    def act(self, observation: Observation) -> Action:
        """The next action.

        Raises:
            ActionError: its answer could not be read; the step still counts.
            OutOfBudgetError: its budget is spent; the session ends as it is.
            AgentError: it can act no more; the session ends, and is not a success.
        """
        ...


T = TypeVar("T", bound=Session)


def play(
    session: T,
    actor: Actor,
    stepped: Callable[[T, Sequence[Element]], None] = lambda session, seen: None,
    thought_s: Callable[[], float] = lambda: 0.0,
    wall_s: float = inf,
) -> End:
    """Lets an actor act until the session is over, and returns why it is.

    Args:
        session: the session, which may be under way.
        actor: the actor, which has been told the goal.
        stepped: called after each step, including the last, with the session and the screen that was acted on.
        thought_s: gives the simulated seconds that the actor's last answer took, which pass before its action.
        wall_s: wall seconds after which it is cut off.

    Raises:
        TrafficError: the traffic simulation failed.
        ModelError: the actor's model could not be reached.
    """
    ends_s = time.monotonic() + wall_s
    while session.end is None:
        if time.monotonic() >= ends_s:
            session.cut_off(End.OUT_OF_BUDGET)
            break
        seen = session.elements
        try:
            action = check(actor.act(session.observation))
        except ActionError as error:
            session.think(thought_s())
            session.refuse(str(error))
        except OutOfBudgetError:
            session.cut_off(End.OUT_OF_BUDGET)
            break
        except AgentError as error:
            session.give_up(str(error))
            break
        else:
            session.think(thought_s())
            session.step(action)
        stepped(session, seen)
    assert session.end is not None
    return session.end
