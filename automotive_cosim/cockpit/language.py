"""The cockpit in other languages: the widget tree, and its answers, told from one gettext catalogue per language.

Screens are written in English, as texts that know how they were made (``contracts.text``). A catalogue
(``languages/fr.po`` and so on) translates their messages; ``python -m tests.cockpit.catalogues --renew`` adds what
is new to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from gettext import GNUTranslations, NullTranslations
from importlib.resources import files
from io import BytesIO
from typing import TYPE_CHECKING, Any, TypeVar

from automotive_cosim.cockpit.make import HOME, Make
from automotive_cosim.cockpit.widgets import Field, Row, Tile, Widget
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.given import Language as Language
from automotive_cosim.contracts.text import Quantity, Text

if TYPE_CHECKING:
    from babel.messages.catalog import Catalog

W = TypeVar("W", bound=Widget)


_COMMON = ("text", "description", "disabled", "locked")
_OWN: Mapping[type[Widget], tuple[str, ...]] = {
    Field: ("hint",),
    Row: ("detail", "trail"),
    Tile: ("level", "levels", "read"),
}
"""Additional text fields of some widgets."""


@lru_cache
def catalogue(language: str) -> GNUTranslations:
    """The catalogue of a language other than English."""
    from babel.messages.mofile import write_mo  # takes a while to import, and English does without

    compiled = BytesIO()
    write_mo(compiled, _entries(language))
    compiled.seek(0)
    return GNUTranslations(compiled)


def messages() -> frozenset[str]:
    """All that the screens say, in English."""
    ids = [entry.id for entry in _entries(Language.FRENCH)]
    return frozenset(each if isinstance(each, str) else each[0] for each in ids)


def _entries(language: str) -> Catalog:
    from babel.messages.pofile import read_po

    with files("automotive_cosim.cockpit").joinpath("languages", f"{language}.po").open("rb") as texts:
        return read_po(texts)


def said(text: str, language: str, make: Make = HOME) -> str:
    """A text or figure in that language and the make's words. A plain ``str`` stays as it is."""
    if language == Language.ENGLISH and (make is HOME or not isinstance(text, Text)):
        return str(text)
    if isinstance(text, Quantity):
        return text.replace(".", _decimal_sign(language))
    return _translated(text, language, make) if isinstance(text, Text) else text


def word(message: str, language: str, make: Make = HOME) -> str:
    """What the screens say for a message without fields; unchanged if they do not say it."""
    if not message or message in make.told[language]:  # the empty message is a catalogue's header
        return make.said(message, language)
    return message if language == Language.ENGLISH else catalogue(language).gettext(message)


@lru_cache
def _decimal_sign(language: str) -> str:
    from babel.numbers import get_decimal_symbol

    return get_decimal_symbol(language)


def _translated(text: Text, language: str, make: Make) -> str:
    known = NullTranslations() if language == Language.ENGLISH else catalogue(language)
    own = make.told[language].get(text.message)
    if own is not None and not text.plural:
        form = own
    elif text.plural:
        form = known.ngettext(text.message, text.plural, text.number)
    elif text.context:
        form = known.pgettext(text.context, text.message)
    else:
        form = known.gettext(text.message)
    if not text.fields:
        return form
    fields = {
        name: said(value, language, make) if isinstance(value, str) else value
        for name, value in text.fields.items()
    }
    return form.format(**fields)


def answered(feedback: Feedback, language: str, make: Make = HOME) -> Feedback:
    """The feedback to an action in that language."""
    text = said(feedback.text, language, make)
    return feedback if text is feedback.text else replace(feedback, text=text)


def translated(widget: W, language: str, make: Make = HOME) -> W:
    """The widget and its children in that language and the make's words. Typed text stays."""
    if language == Language.ENGLISH and make is HOME:
        return widget
    changes: dict[str, Any] = {}
    for name in (*_COMMON, *_OWN.get(type(widget), ())):
        text: str = getattr(widget, name)
        if isinstance(text, Text | Quantity):
            changes[name] = said(text, language, make)
    if widget.children:
        changes["children"] = tuple(translated(child, language, make) for child in widget.children)
    return replace(widget, **changes) if changes else widget
