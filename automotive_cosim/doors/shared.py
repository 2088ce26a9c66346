"""What several doors share: one service for a whole process, and conditions from plain words."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import cache
from typing import Annotated, Any, TypeVar

from pydantic import Field

from automotive_cosim.episode.conditions import INPUTS, Condition, Conditions
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.service import EpisodeService, ServiceLimits

F = TypeVar("F", bound=Callable[..., Any])
LIMITS = ServiceLimits(episodes=1000, idle_s=86_400.0)
"""For hosts that limit their episodes themselves, and end each."""


@cache
def shared_service() -> EpisodeService:
    """The episodes of this process, for a host that limits them itself; what simulates them ends with it."""
    return EpisodeService(limits=LIMITS)


def takes_conditions(function: F) -> F:
    """Lists the words behind a function's ``**conditions`` one by one, for hosts that read signatures.

    A door has all conditions but those about speed: who acts through it takes the time that it takes.
    """
    signature = inspect.signature(function, eval_str=True)
    own = [each for each in signature.parameters.values() if each.kind is not inspect.Parameter.VAR_KEYWORD]
    any_function: Any = function
    any_function.__signature__ = signature.replace(parameters=[*own, *map(_parameter, INPUTS)])
    any_function.__annotations__ = {
        name: kind for name, kind in function.__annotations__.items() if name != "conditions"
    } | {each.name: str for each in INPUTS}
    return function


def conditions_of(words: Mapping[str, str]) -> Conditions:
    """The conditions of a door, in words.

    Raises:
        UserError: there is no such condition or value.
    """
    for name in words:
        if name not in {each.name for each in INPUTS}:
            raise UnknownNameError("condition", name, [each.name for each in INPUTS])
    return Conditions.named(words)


def _parameter(each: Condition) -> inspect.Parameter:
    told = f"{each.help.removesuffix('.')}: {', '.join(each.choices)}."
    kind = Annotated[str, Field(description=told)]
    return inspect.Parameter(each.name, inspect.Parameter.KEYWORD_ONLY, default=str(each.default), annotation=kind)
