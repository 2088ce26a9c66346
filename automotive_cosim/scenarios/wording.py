"""Incidents in one line, for commands: a kind and its fields as in ``[[incidents]]``, as
``breakdown edge=c1c2 position_m=120 from_s=300``."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any, get_args, get_origin, get_type_hints

from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.incidents import AnyIncident, Incident

KINDS: dict[str, type[Incident]] = {
    get_args(get_type_hints(each)["kind"])[0]: each for each in get_args(get_args(AnyIncident)[0])
}


def read_line(text: str, kinds: Mapping[str, type[Any]], place: str) -> Any:
    """What a line describes: a kind, and values of its fields; lists are separated by commas.

    Args:
        kinds: name of each kind -> the dataclass of its fields.

    Raises UserError: there is no such kind or field, or a value is not valid."""
    kind, *pairs = text.split() or [""]
    if kind not in kinds:
        raise UnknownNameError(f"kind in {place}", kind, kinds)
    hints = get_type_hints(kinds[kind])
    table: dict[str, Any] = {"kind": kind}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals:
            raise UserError(f"{place} has {pair!r}; give fields as name=value, such as from_s=300")
        name = spelled(name, hints)
        if name not in hints:
            raise UnknownNameError(f"field of {kind} in {place}", name, hints)
        table[name] = _value(value, hints[name])
    return checked(kinds[kind], table, lambda steps: (place, str(steps[-1]) if steps else ""))


def spelled(name: str, known: Container[str]) -> str:
    """A field's name as its kind has it: ``edge`` and ``edges`` both do."""
    other = {"edge": "edges", "edges": "edge"}.get(name, name)
    return name if name in known or other not in known else other


def _value(text: str, hint: Any) -> Any:
    """A value in its type; as it is if it is none of that type, so that the check refuses it."""
    if get_origin(hint) is tuple:
        return [_value(part, get_args(hint)[0]) for part in text.split(",")]
    if hint is bool:
        return {"true": True, "false": False}.get(text, text)
    try:
        return hint(text) if hint in (int, float) else text
    except ValueError:
        return text
