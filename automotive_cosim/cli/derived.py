"""Options that follow from a type: one for each field of a dataclass that holds what a command can be told."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import MISSING, Field, fields
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import typer

from automotive_cosim.cli.batches import numbers_in, whole_numbers_in, words
from automotive_cosim.formats.docs import inherited_field_docs
from automotive_cosim.formats.options import option_name, shown_as

F = TypeVar("F", bound=Callable[..., Any])


def takes(kind: type, but: Collection[str] = ()) -> Callable[[F], F]:
    """Gives a command an option for each field of a dataclass; it gets what was given as ``**settings``.

    Name, help, default and form follow from the field's name, docstring, default and type, or from its ``Option``.

    Args:
        kind: the dataclass.
        but: fields that have no option.
    """

    def given(command: F) -> F:
        signature = inspect.signature(command, eval_str=True)
        own = [each for each in signature.parameters.values() if each.kind is not inspect.Parameter.VAR_KEYWORD]
        more = [each for each in _parameters(kind) if each.name not in but]
        keyword = [each.replace(kind=inspect.Parameter.KEYWORD_ONLY) for each in own]
        any_command: Any = command
        any_command.__signature__ = signature.replace(parameters=[*more, *keyword])
        return command

    return given


def settings_in(kind: type, given: Mapping[str, Any]) -> dict[str, Any]:
    """The values of the options that were given, by the names of the fields.

    Numbers are read where the field takes them; what is none stays a text, for the type's own check to refuse.

    Raises:
        UserError: an option has no value, or a list of numbers has something else.
    """
    hints = get_type_hints(kind, include_extras=True)
    return {
        name: _value(name, hints[name], value) for name, value in given.items() if value not in (None, False, [])
    }


def _parameters(kind: type) -> Iterator[inspect.Parameter]:
    hints, docs = get_type_hints(kind, include_extras=True), inherited_field_docs(kind)
    for each in fields(kind):
        yield _parameter(each, hints[each.name], docs[each.name])


def _parameter(each: Field[Any], hint: Any, text: str) -> inspect.Parameter:
    option, bare = shown_as(hint), _bare(hint)
    given: Any = bool if bare is bool else list[str] if option.repeats else str
    told = option.default or _told(each.default)
    made = typer.Option(
        f"--{option_name(each.name, hint)}",
        help=text.replace("`", ""),
        metavar=None if bare is bool or option.repeats else _form(bare),
        show_default=told or ("none" if option.repeats else False),
    )
    return inspect.Parameter(
        each.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=False if bare is bool else None,
        annotation=Annotated[given if bare is bool else given | None, made],
    )


def _bare(hint: Any) -> Any:
    """A type without its annotations, and without None."""
    while get_origin(hint) is Annotated:
        hint = get_args(hint)[0]
    if get_origin(hint) in (Union, UnionType):
        (first, *_) = [each for each in get_args(hint) if each is not NoneType]
        return _bare(first)
    return hint


def _item(bare: Any) -> Any:
    """The type of a list's items; None if it is no list."""
    return _bare(get_args(bare)[0]) if get_origin(bare) is tuple else None


def _form(bare: Any) -> str | None:
    if get_origin(bare) is Literal:
        return "|".join(get_args(bare))
    if _item(bare) is not None:
        return "LIST"
    return {int: "N", float: "X"}.get(bare)


def _told(default: Any) -> str:
    """A default as one would write it; empty for nothing."""
    if default is MISSING or default is None or default is False:
        return ""
    if not isinstance(default, tuple):
        return f"{default:g}" if isinstance(default, int | float) else str(default)
    if len(default) > 1 and isinstance(default[0], int) and default == (*range(default[0], default[-1] + 1),):
        return f"{default[0]}-{default[-1]}"
    return ",".join(map(_told, default))


def _value(name: str, hint: Any, given: Any) -> Any:
    bare = _bare(hint)
    if isinstance(given, list):
        return tuple(given)
    if not isinstance(given, str):
        return given
    if (item := _item(bare)) is not None:
        read: Any = {int: whole_numbers_in, float: numbers_in}.get(item, words)
        return tuple(read(option_name(name, hint), given))
    with suppress(ValueError):
        return bare(given) if bare in (int, float) else given
    return given
