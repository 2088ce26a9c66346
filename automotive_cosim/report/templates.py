"""Renders self-contained pages from templates."""

from __future__ import annotations

import jinja2

_ENVIRONMENT = jinja2.Environment(
    loader=jinja2.PackageLoader("automotive_cosim", ""),
    autoescape=True,
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


def render(template: str, **values: object) -> str:
    """Renders a page.

    Args:
        template: path inside the package, e.g. ``report/page.html``; it extends ``report/base.html``.
        values: what it shows; a missing one is an error, not a gap.
    """
    return _ENVIRONMENT.get_template(template).render(values)
