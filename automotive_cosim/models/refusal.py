"""What an endpoint says with a refusal: why, and how long to wait before another question.

Providers and servers agree on neither. A reason comes as ``error``, ``message``, ``detail``, a list of those, or as
plain text or HTML; a pause in a header (RFC 9110 10.2.3: seconds or a date; OpenAI's and Azure's in milliseconds),
in the body (Google's ``RetryInfo``), in the words, or as the time at which a limit that is used up begins anew.
"""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from email.utils import mktime_tz, parsedate_tz
from itertools import islice

LONGEST_REASON = 300
"""Characters of a reason."""
MOST_REASONS = 20
"""Looked at, as many as anybody gives."""
LONGEST_TOLD = 20_000
"""Characters of a text that are looked at: what looks for markup and pauses takes longer than the text is long."""
REASONS = (
    "title", "error", "errors", "faultstring", "fault", "message", "msg", "detail", "description",
    "error_description", "error_message", "raw", "metadata",
)  # fmt: skip
"""Keys under which the words of a reason stand, in the order in which they are told. Names of capital letters count
alike."""
SINCE_1970_S = 1e9
"""A larger number of seconds is no pause."""
_PAUSES = {"retrydelay": 1.0, "retryafter": 1.0, "retryafterseconds": 1.0, "retryafterms": 1e-3}
"""Keys of a body under which a pause stands, in letters alone, and the seconds of one of its units."""
_RESET = re.compile(r"(?:[\w-]+-)?ratelimit-(?:[\w-]+-)?reset(?:-[\w-]+)?", re.IGNORECASE)
"""Headers with such a time: a pause, a date, or seconds or milliseconds since 1970."""
_DRAFT = re.compile(r";\s*r=0\b[^,]*;\s*t=(\d+)")
"""The same in the header ``RateLimit`` of IETF's draft."""
_UNITS_S = {"ms": 1e-3, "s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0}
_AMOUNT = (
    r"\d+(?:\.\d+)?\s*(?:milliseconds?|msecs?|ms|seconds?|secs?|s|minutes?|mins?|m|hours?|hrs?|h|days?|d)(?![a-z])"
)
_IN_WORDS = re.compile(rf"(?:again|retry|wait)\b[^.\n]{{0,30}}?((?:{_AMOUNT}[\s,]*(?:and\s+)?)+)", re.IGNORECASE)
_EACH = re.compile(r"(\d+(?:\.\d+)?)\s*([a-z]+)", re.IGNORECASE)
_MARKUP = re.compile(r"<(script|style)\b.*?</\1\s*>|<!--.*?-->|<[^<>]*>", re.DOTALL | re.IGNORECASE)


def told(body: bytes) -> object:
    """The body as JSON, or else its text, without the markup of a page."""
    text = body.decode(errors="replace").strip().removeprefix("data:").strip()  # of a stream's event
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        short = text[:LONGEST_TOLD]
        return _MARKUP.sub(" ", short) if text.startswith("<") else short


def reason(body: object) -> str:
    """Why it refuses, on one line; empty if it says nothing."""
    texts = islice(_reasons(body), MOST_REASONS)
    found = dict.fromkeys(" ".join(text[:LONGEST_TOLD].split()) for text in texts)
    return "; ".join(text for text in found if text and not any(text in other for other in found if other != text))


def _reasons(body: object, depth: int = 0) -> Iterator[str]:
    """The texts of a reason, each where it stands."""
    if depth > 8:
        return
    if isinstance(body, str):
        inner = told(body.encode("utf-8", "replace")) if body.lstrip()[:1] in ("{", "[") else body
        yield from [body] if isinstance(inner, str) else _reasons(inner, depth + 1)
    elif isinstance(body, list):
        for each in body:
            yield from _reasons(each, depth + 1)
    elif isinstance(body, dict):
        named = {str(name).lower(): value for name, value in body.items()}
        place = named.get("loc")
        before = ".".join(map(str, place)) + ": " if isinstance(place, list) else ""
        texts = [text for name in REASONS for text in _reasons(named.get(name), depth + 1)]
        if not texts and body:
            texts = [json.dumps(body, ensure_ascii=False)] if depth <= 1 else []
        yield from (before + text for text in texts)


def pause_asked_s(headers: Mapping[str, str], body: object) -> float | None:
    """The pause that the server asks for, in seconds; None if it asks for none.

    Args:
        headers: of its answer, by names in small letters; a date in them counts from its own clock, if it tells it.
    """
    told_s = [
        _seconds(headers.get("retry-after-ms") or headers.get("x-ms-retry-after-ms"), 1e-3),
        _seconds(headers.get("retry-after"), 1.0, headers.get("date", "")),
        *_asked(body),
    ]
    stated = next((each for each in told_s if each is not None), None)
    if stated is None and (words := _IN_WORDS.search(reason(body))):
        return _length(words[1])
    if stated is None:
        return max((pause_s for each in (headers, *_headers(body)) for pause_s in _resets(each)), default=None)
    return stated


def _headers(body: object, depth: int = 0) -> Iterator[Mapping[str, str]]:
    """Headers of a provider behind the one that was asked, which its answer repeats."""
    for name, value in body.items() if isinstance(body, dict) and depth < 8 else ():
        if name == "headers" and isinstance(value, dict):
            yield {str(each).lower(): str(said) for each, said in value.items()}
        else:
            yield from _headers(value, depth + 1)


def _resets(headers: Mapping[str, str]) -> Iterator[float]:
    """The pauses until limits begin anew, of those that are used up or do not say what is left."""
    for name, value in headers.items():
        left = headers.get(name.replace("reset", "remaining"), "0")
        if name.lower() == "ratelimit":
            yield from map(float, _DRAFT.findall(value))
        elif _RESET.fullmatch(name) and left.strip() in ("0", "0.0"):
            pause_s = _seconds(value, 1.0, headers.get("date", ""))
            if pause_s is not None and pause_s > SINCE_1970_S:
                pause_s = max(0.0, (pause_s / 1000 if pause_s > 1000 * SINCE_1970_S else pause_s) - time.time())
            if pause_s is not None:
                yield pause_s


def _asked(body: object, depth: int = 0) -> Iterator[float | None]:
    if isinstance(body, dict):
        for name, value in body.items():
            key = re.sub(r"[^a-z]", "", str(name).lower())
            if key in _PAUSES:
                yield _seconds(value, _PAUSES[key])
    for each in body.values() if isinstance(body, dict) else body if isinstance(body, list) else ():
        if depth < 8:
            yield from _asked(each, depth + 1)


def _seconds(value: object, unit_s: float, now: str = "") -> float | None:
    """A pause as a number of units, a text such as ``34.07s``, a date, or an object of seconds and nanoseconds."""
    if isinstance(value, dict):
        parts = _seconds(value.get("seconds"), 1.0), _seconds(value.get("nanos"), 1e-9)
        return None if parts == (None, None) else sum(part or 0.0 for part in parts)
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    try:
        pause = float(value) * unit_s
        return max(0.0, pause) if pause < float("inf") else None  # no comparison holds for NaN
    except (ValueError, OverflowError):
        pass
    text = str(value)[:LONGEST_REASON]
    if re.fullmatch(rf"\s*(?:{_AMOUNT}\s*)+", text, re.IGNORECASE):
        return _length(text)
    at, since = _at(text), _at(now[:LONGEST_REASON])
    return None if at is None else max(0.0, at - (time.time() if since is None else since))


def _at(text: str) -> float | None:
    """Seconds since 1970 of a date of HTTP (in any of its three forms) or of ISO 8601; without a zone, of UTC."""
    try:
        date = datetime.fromisoformat(text)
    except ValueError:
        parts = parsedate_tz(text)
        return None if parts is None else mktime_tz((*parts[:9], parts[9] or 0))
    return (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp()


def _length(text: str) -> float:
    """Seconds of a text such as ``1m30s`` or ``2 minutes``."""
    total_s = 0.0
    for number, unit in _EACH.findall(text):
        short = unit.lower()
        total_s += float(number) * _UNITS_S["ms" if short.startswith(("ms", "milli")) else short[0]]
    return total_s
