"""Texts that the car shows and says, which know how they were made, so that they can be told in other languages.

    say("Sent to {to}: {text}", to="Ada", text=say("Thank you"))
    say_in("dock", "Home")
    counted("{n} new message", "{n} new messages", n)

    Quantity(f"{km:.1f} km")

Each is an English ``str``. The message with its named fields is what catalogues translate (``cockpit.language``). A
plain ``str`` is data in every language: a name, a time, what somebody wrote.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

FieldValue = str | int | float
"""What fills a field. A text in it is translated too."""


class Text(str):
    """An English text with what it was made from; equal to the same plain ``str``."""

    __slots__ = ("context", "fields", "message", "number", "plural")

    message: str
    """In English, with ``{name}`` for each field; for one, if it is counted."""
    fields: dict[str, FieldValue]
    context: str
    """Tells apart messages with the same words and different meanings; mostly empty."""
    plural: str
    """The message for several, if it is counted."""
    number: int
    """How many, if it is counted."""

    def __new__(
        cls, message: str, fields: dict[str, FieldValue], context: str = "", plural: str = "", number: int = 1
    ) -> Text:
        """Fills in the fields. Use ``say``, ``say_in``, ``counted`` or ``joined``, which catalogues know."""
        form = plural if plural and number != 1 else message
        text = super().__new__(cls, form.format(**fields) if fields else form)
        text.message, text.fields, text.context, text.plural, text.number = message, fields, context, plural, number
        return text

    def __reduce__(self) -> tuple[Any, ...]:
        """For copies and pickles, which keep what it was made from."""
        return Text, (self.message, self.fields, self.context, self.plural, self.number)


class Quantity(str):
    """A number as it is shown in English, with or without its unit; other languages have their own decimal sign."""

    __slots__ = ()


def say(message: str, /, **fields: FieldValue) -> Text:
    """A message with its fields filled in."""
    return Text(message, fields) if fields else _plain(message)


@cache
def _plain(message: str) -> Text:
    """A message without fields; there are as many as the program has."""
    return Text(message, {})


def say_in(context: str, message: str, /, **fields: FieldValue) -> Text:
    """A message whose words mean something else elsewhere."""
    return Text(message, fields, context)


def counted(one: str, several: str, n: int, /, **fields: FieldValue) -> Text:
    """The message for so many, with ``{n}`` for the number; languages have one form, two or more."""
    return Text(one, {"n": n, **fields}, plural=several, number=n)


def listed(parts: Sequence[str]) -> str:
    """Texts as a list of several."""
    first, *others = parts
    return say("{first}, {others}", first=first, others=listed(others)) if others else first


def joined(separator: str, parts: Iterable[str]) -> Text:
    """Texts one after the other."""
    fields: dict[str, FieldValue] = {f"part{at}": part for at, part in enumerate(parts)}
    return Text(separator.join(f"{{{name}}}" for name in fields), fields)
