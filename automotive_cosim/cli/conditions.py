"""The options of the conditions: one for each line of their table."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import partial
from typing import Annotated, Any, TypeVar

import typer
from annotated_types import Ge, Le

from automotive_cosim.cli.batches import words
from automotive_cosim.cli.derived import ShownDefault, number_in, unless_shown, with_options
from automotive_cosim.episode.conditions import TABLE, Condition, condition
from automotive_cosim.episode.own_prompt import resolved

FROM_FILES: Mapping[str, Callable[[str], Any]] = {
    "prompt": resolved,
    "make": partial(Condition.value, condition("make")),
}
"""What becomes of the name of a file, by condition."""
F = TypeVar("F", bound=Callable[..., Any])


def takes_conditions(*, lists: bool = False) -> Callable[[F], F]:
    """Gives a command an option for each condition; it gets what was given as ``**settings``.

    Args:
        lists: whether an option takes several values, separated by commas."""
    return with_options(_parameter(each, lists=lists) for each in TABLE)


def values_of(settings: Mapping[str, Any]) -> dict[str, list[Any]]:
    """The values between the commas of the options that were given, by the conditions' names.

    Raises UserError: an option is empty."""
    return {each.name: [_value(each, word) for word in words(each.word, text)] for each, text in _told(settings)}


def given(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The values of the options that were given, by the conditions' names."""
    return {each.name: _value(each, text) for each, text in _told(settings)}


def _told(settings: Mapping[str, Any]) -> list[tuple[Condition, str]]:
    """The conditions among what was given."""
    return [(each, settings[each.name]) for each in TABLE if settings[each.name] is not None]


def _value(each: Condition, word: str) -> Any:
    if each.name in FROM_FILES:
        return FROM_FILES[each.name](word)
    if each.choices:
        return word
    try:
        return number_in(float, [Ge(each.bounds[0]), Le(each.bounds[1])], word)
    except typer.BadParameter as error:  # typer, which would name the option, has gone on to run the command
        error.param_hint = f"'--{each.word}'"
        raise


def _parameter(each: Condition, *, lists: bool) -> inspect.Parameter:
    named = [*each.choices, *(["FILE"] if each.name in FROM_FILES else [])]
    choices = f" {'Separated by commas' if lists else 'One of'}: {', '.join(named)}." if named else ""
    option = typer.Option(
        f"--{each.word}",
        help=each.help + choices + (" Several are separated by commas." if lists and not each.choices else ""),
        metavar=None if each.choices else "SECONDS",
        rich_help_panel="Conditions: what the agent is given, and at what speed",
        parser=partial(unless_shown, str),
    )
    own = ShownDefault(f"{each.default:g}" if isinstance(each.default, float) else each.default)
    kind = inspect.Parameter.KEYWORD_ONLY
    return inspect.Parameter(each.name, kind, default=own, annotation=Annotated[str | None, option])
