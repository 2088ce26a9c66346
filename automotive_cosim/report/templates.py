"""Pages from templates: each opens from disk and needs nothing beside it."""

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
    """A page.

    Args:
        template: path below the package, as in ``report/page.html``; it extends ``report/base.html``.
        values: what it shows. One that is missing is an error, not a gap.
    """
    return _ENVIRONMENT.get_template(template).render(values)
