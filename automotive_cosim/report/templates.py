"""Renders self-contained pages from templates."""

from __future__ import annotations

import re

import jinja2
from markupsafe import Markup, escape

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


_ENVIRONMENT.filters["ticked"] = _ticked


def render(template: str, **values: object) -> str:
    """Renders a page.

    Args:
        template: path inside the package, e.g. ``report/page.html``; it extends ``report/base.html``.
        values: what it shows; a missing one is an error, not a gap.
    """
    return _ENVIRONMENT.get_template(template).render(values)
