"""Options that follow from a type: one for each field of a dataclass that holds what a command can be told."""

from __future__ import annotations

import inspect
import operator
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import MISSING, Field, fields
from enum import EnumMeta
from functools import partial
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import typer
from annotated_types import Ge, Gt, Le, Lt

from automotive_cosim.cli.batches import numbers_in, whole_numbers_in, words
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.annotations import OneOf, option_name, shown_as
from automotive_cosim.formats.docs import inherited_field_docs

F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T")

BOUNDS = {
    Ge: ("from", operator.ge),
    Gt: ("above", operator.gt),
    Le: ("to", operator.le),
    Lt: ("below", operator.lt),
}
"""How a bound is told, and what keeps it."""


def takes(kind: type, *, only: Collection[str] = (), but: Collection[str] = ()) -> Callable[[F], F]:
    """Gives a command an option for each field of a dataclass; it gets what was given as ``**settings``.

    Name, help, default, form and bounds follow from the field's name, docstring, default and type, or from its
    ``Option``. A field without a default has an option that must be given, one that is true unless said otherwise
    an option that denies it.

    Args:
        only: the fields that have an option; empty for all."""
    return with_options(
        each for each in _parameters(kind) if (not only or each.name in only) and each.name not in but
    )


def with_options(more: Iterable[inspect.Parameter]) -> Callable[[F], F]:
    """Gives a command further options, after those that it requires; it gets what was given by name."""

    def given(command: F) -> F:
        signature = inspect.signature(command, eval_str=True)
        kinds = inspect.Parameter.VAR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
        own = [each.replace(kind=kinds[1]) for each in signature.parameters.values() if each.kind is not kinds[0]]
        required = [each for each in own if each.default is inspect.Parameter.empty]
        optional = [each for each in own if each.default is not inspect.Parameter.empty]
        any_command: Any = command
        any_command.__signature__ = signature.replace(parameters=[*required, *more, *optional])
        return command

    return given


def settings_in(kind: type, given: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a type's options that were given, by the names of its fields."""
    return {
        each.name: _value(each, given[each.name])
        for each in fields(kind)
        if not any(given.get(each.name) is nothing for nothing in (None, False)) and given[each.name] != []
    }


def filled(kind: type[T], given: Mapping[str, Any]) -> T:
    """The type with the values of its options that were given, and its defaults for the others."""
    return kind(**settings_in(kind, given))


def _parameters(kind: type) -> Iterator[inspect.Parameter]:
    hints, docs = get_type_hints(kind, include_extras=True), inherited_field_docs(kind)
    for each in fields(kind):
        yield _parameter(each, hints[each.name], docs[each.name])


def _parameter(each: Field[Any], hint: Any, text: str) -> inspect.Parameter:
    option, bare = shown_as(hint), _bare(hint)
    name, is_flag = option_name(each.name, hint), bare is bool
    is_path = bare is Path  # which typer reads, completes and shows by itself
    kind: Any = bool if is_flag else list[str] if option.repeats else Path if is_path else str
    own = "" if is_flag or option.repeats or option.default else _told(each.default)
    is_denied = is_flag and each.default is True and not option.name
    read = None if is_flag or option.repeats else option.read or _reader(name, hint)
    made = typer.Option(
        f"--no-{name}" if is_denied else f"--{name}",
        help=text.replace("`", ""),
        metavar=option.form or (None if is_flag or option.repeats else _form(bare)),
        parser=partial(unless_shown, read or str) if own and not is_path else read,
        show_default=bool(own) or option.default or ("none" if option.repeats else False),
        envvar=option.variable,
        rich_help_panel=option.panel,
    )
    return inspect.Parameter(
        each.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=_unless_given(each, own),
        annotation=Annotated[kind if is_flag else kind | None, made],
    )


def _unless_given(each: Field[Any], own: str) -> Any:
    """What an option is if it is left out."""
    if each.default is MISSING and each.default_factory is MISSING:
        return inspect.Parameter.empty
    if isinstance(each.default, Path):
        return each.default
    return ShownDefault(own) if own else False if isinstance(each.default, bool) else None


class ShownDefault(str):
    """A default as the help shows it; whoever leaves the option out gives no value."""


def unless_shown(read: Callable[[str], Any], text: str) -> Any:
    """The value in a text; None for a default."""
    return None if isinstance(text, ShownDefault) else read(text)


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
        return f"{default:g}" if isinstance(default, float) else str(default)
    if len(default) > 1 and isinstance(default[0], int) and default == (*range(default[0], default[-1] + 1),):
        return f"{default[0]}-{default[-1]}"
    return ",".join(map(_told, default))


def _value(each: Field[Any], given: Any) -> Any:
    if given is True:
        return not each.default
    return tuple(given) if isinstance(given, list) else given


def _reader(name: str, hint: Any) -> Callable[[str], Any] | None:
    """What turns a text into a value of this type; None for a text as it is."""
    bare = _bare(hint)
    if (item := _item(bare)) is not None:
        listed: Callable[[str, str], list[Any]] = {int: whole_numbers_in, float: numbers_in}.get(item, words)  # type: ignore[assignment]
        return lambda text: tuple(listed(name, text))
    if isinstance(bare, EnumMeta):
        (names,) = [each for each in _annotations(hint) if isinstance(each, OneOf)]
        return partial(_member, bare, names)
    if bare in (int, float):
        return partial(number_in, bare, tuple(_annotations(hint)), beside=tuple(_beside(hint)))
    return None


def _member(kind: Callable[[str], Any], names: OneOf, text: str) -> Any:
    if text not in set(names.names):
        raise UnknownNameError(names.what, text, names.names)
    return kind(text)


def _beside(hint: Any) -> Iterator[str]:
    """The words that a type takes beside numbers."""
    if get_origin(hint) is Literal:
        yield from get_args(hint)
    elif get_origin(hint) in (Annotated, Union, UnionType):
        for each in get_args(hint):
            yield from _beside(each)


def _annotations(hint: Any) -> Iterator[Any]:
    """All annotations of a type and of the types that it is made of."""
    yield from getattr(hint, "__metadata__", ())
    if get_origin(hint) in (Annotated, Union, UnionType):
        for each in get_args(hint):
            yield from _annotations(each)


def number_in(kind: type[int | float], annotations: Iterable[Any], text: str, beside: Collection[str] = ()) -> Any:
    """The number in a text, within the bounds among its annotations; or one of the words beside numbers."""
    if text in beside:
        return text
    bounds = [
        (*BOUNDS[type(each)], getattr(each, type(each).__name__.lower()))
        for each in annotations
        if type(each) in BOUNDS
    ]
    try:
        value = kind(text)
    except ValueError:
        value = None
    if value is None or not all(keeps(value, bound) for _, keeps, bound in bounds):
        within = "".join(f" {told} {_told(bound)}" for told, _, bound in bounds)
        others = "".join(f" nor {word}" for word in beside)
        what = f"{'neither' if others else 'not'} a {'whole number' if kind is int else 'number'}{within}{others}"
        raise typer.BadParameter(f"{text!r} is {what}")
    return value
