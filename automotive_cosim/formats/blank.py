"""What models and clients fill in where they have nothing to say."""

from __future__ import annotations

from collections.abc import Collection

_BLANK = frozenset({"", "null", "none"})


def is_blank(value: object, choices: Collection[object] = ()) -> bool:
    """Whether the value of an optional argument stands for none at all.

    Those who fill in every argument send null, its name as a text, an empty text (OpenAI's strict mode, as in
    moltis-org/moltis#283), or a list of such a text (anthropics/claude-code#95239).

    Args:
        choices: the argument's own words. One of them that is written in another way, as ``None`` for ``none``, is
            not blank: it may be meant."""
    match value:
        case None:
            return True
        case str():
            word = value.strip().casefold()
            return word in _BLANK and word not in {str(each).casefold() for each in choices}
        case [only]:
            return is_blank(only, choices)
    return False
