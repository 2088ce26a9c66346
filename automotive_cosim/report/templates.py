"""Renders self-contained pages from templates."""

from __future__ import annotations

import re
from collections.abc import Mapping

import jinja2
from markupsafe import Markup, escape

from automotive_cosim.contracts.plain import rounded
from automotive_cosim.formats.plain import markup, plain

_ENVIRONMENT = jinja2.Environment(
    loader=jinja2.PackageLoader("automotive_cosim", ""),
    autoescape=True,
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


def _ticked(text: str) -> Markup:
    """A text whose words in backticks, as in Markdown, are code."""
    return Markup(re.sub("`([^`]+)`", r"<code>\1</code>", str(escape(text))))


def _given(settings: Mapping[str, object]) -> list[tuple[str, str]]:
    """Settings in words; those that were left to their default are None or empty, and are not listed."""
    return [(name, told) for name, value in settings.items() if (told := _setting(value))]


def _setting(value: object) -> str:
    match value:
        case None:
            return ""
        case bool():
            return "yes" if value else "no"
        case float():
            return rounded(value, 6)
        case dict():
            return ", ".join(f"{name} {told}" for name, told in _given(value))
        case list() | tuple():
            return ", ".join(filter(None, map(_setting, value)))
    return str(value)


_ENVIRONMENT.filters |= {"ticked": _ticked, "given": _given}


def render(template: str, **values: object) -> str:
    """Renders a page.

    Args:
        template: path inside the package, e.g. ``report/page.html``; it extends ``report/base.html``.
        values: what it shows; a missing one is an error, not a gap."""
    return plain(markup(_ENVIRONMENT.get_template(template).render(values)))
