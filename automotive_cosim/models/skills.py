"""The rule model's knowledge as a table: the words of a request, and how to fulfil it in this cockpit.

To add one, write a ``Skill`` into ``SKILLS``, above those whose words are more general: the first whose words occur
in the goal decides. ``do`` is a ``Course``, a ``Decline``, a ``Wait``, or a function that reads the ``Page`` and
returns one of them. The words are taken from a task's first phrasings; its last ones are held out
(``tasking.instance.Instance.held_out``) and must not be used here.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass

from automotive_cosim.models.page import Page

SPEEDING_MARGIN_KMH = 3.0
"""A speed further above the limit is too fast: 1 km/h of rounding and the 3 % of tolerance at 50 km/h that
Regulation (EU) 2021/1958 grants to a speed assistant."""
RAIN_PCT = 20.0
"""Rain intensity from which the glass is covered by drops, not fog."""

SkillMove = tuple[str, ...]
"""One step of a ``Course``; the functions below make them."""


@dataclass(frozen=True, slots=True)
class Course:
    """Moves to carry out in order, and why."""

    because: str
    moves: tuple[SkillMove, ...]
    declares: bool = True
    """Whether it is complete with the last move; a watch goes on."""


@dataclass(frozen=True, slots=True)
class Decline:
    """Nothing has to be done: ``infeasible`` or ``not_needed``, with a reason code."""

    status: str
    reason: str
    because: str


@dataclass(frozen=True, slots=True)
class Wait:
    """Nothing has to be done yet."""

    because: str
    seconds: int | None = 1
    """None waits until something changes, as only a watch does."""


SkillDecision = Course | Decline | Wait


@dataclass(frozen=True, slots=True)
class Skill:
    """A request and what to do about it."""

    words: tuple[str, ...]
    """Regular expressions on the goal in lower case, of which one must match."""
    do: SkillDecision | Callable[[Page], SkillDecision]


def opened(app: str) -> SkillMove:
    """Opens an app."""
    return ("open", app)


def tap(label: str) -> SkillMove:
    """Taps the element with this text or description (``Page.find``); scrolls to it if necessary."""
    return ("tap", label)


def slide(label: str, share: float) -> SkillMove:
    """Sets a slider to a share of its range, 0 to 1."""
    return ("slide", label, f"{share:.3f}")


def typed(label: str, text: str) -> SkillMove:
    """Types into a text field."""
    return ("type", label, text)


def say(text: str) -> SkillMove:
    """Says something to the driver."""
    return ("say", text)


def call(action_type: str, **fields: object) -> SkillMove:
    """Any other action, e.g. ``call("show_alert", kind="speed")``."""
    return ("do", json.dumps({"action_type": action_type} | fields))


def in_app(app: str, *labels: str, because: str) -> Course:
    """Opens an app and taps elements."""
    return Course(because, (opened(app), *map(tap, labels)))


# --- decisions that read the page -------------------------------------------------------------------------


def _watch_speed(page: Page) -> SkillDecision:
    speed, limit = page.number("speed_kmh"), page.limit_kmh()
    if speed is None or limit is None:
        return Decline("not_needed", "none", f"At {speed} km/h and no limit known there is nothing to say.")
    if speed > limit + SPEEDING_MARGIN_KMH:
        because = f"{speed:.0f} km/h where {limit:.0f} is the limit."
        return in_app("safety", "Speed", "Warn driver", because=because)
    return Decline("not_needed", "already_so", f"{speed:.0f} km/h is within the limit of {limit:.0f}.")


TELLS: tuple[tuple[str, str], ...] = (
    (r"belt: open: .*driver", "seat_belt"),
    (r"behind: blue light", "yield"),
    (r"breakdown: in \d{1,3} m", "move_over"),
    (r"(jam|roadworks): in \d{1,3} m", "traffic"),
    (r"vehicle ahead: .* time gap 0\.\d s", "distance"),
    (r"open: .*(trunk|flap)", "vehicle"),
    (r"tyres: .*(left|right) 1\d\d\b", "vehicle"),
    (r"(glass|rain): .* [2-9]\d\.\d%", "visibility"),
    (r"weather: .*(snow|freezing|rime)", "slippery"),
    (r"driving time: [2-9]\.", "fatigue"),
)
"""What may have changed on a watch, and the alert that it asks for."""


def _keep_watch(page: Page) -> SkillDecision:
    """Tells what has just changed, if it is something to tell."""
    mark = " (changed)"
    changed = [f"{name.removesuffix(mark)}: {words}" for name, words in page.car.items() if name.endswith(mark)]
    speed, limit = page.number("speed_kmh"), page.limit_kmh()
    too_fast = speed is not None and limit is not None and speed > limit + SPEEDING_MARGIN_KMH
    if too_fast and any(change.startswith(("speed: ", "limit: ")) for change in changed):
        because = f"{speed:.0f} km/h where {limit:.0f} is the limit."
        return Course(because, (call("show_alert", kind="speed"),), declares=False)
    for change in changed:
        kind = next((kind for pattern, kind in TELLS if re.match(pattern, change)), None)
        if kind is not None:
            return Course(f"The car says: {change}.", (call("show_alert", kind=kind),), declares=False)
    return Wait("Nothing has to be done now.", seconds=None)


def _tell_limit(page: Page) -> SkillDecision:
    limit = page.limit_kmh()
    if limit is None:
        return Decline("not_needed", "none", "There is no limit that I could name.")
    return Course(f"The limit is {limit:.0f} km/h.", (call("show_alert", kind="speed", speed_kmh=round(limit, 1)),))


def _high_beam(page: Page) -> SkillDecision:
    if page.forbids_high_beam():
        return Decline("infeasible", "law", "High beam is not allowed on a road like this.")
    return in_app("vehicle", "High beam", because="Nothing speaks against high beam here.")


def _fog_lamp(rule: str, switch: str) -> Callable[[Page], SkillDecision]:
    def decide(page: Page) -> SkillDecision:
        if page.allows_now(rule) is False:
            return Decline("infeasible", "law", f"{rule}: not allowed in this weather here.")
        return in_app("vehicle", switch, because=f"{rule}: allowed here.")

    return decide


def _rear_fog_left_on(page: Page) -> SkillDecision:
    if page.is_on("is_rear_fog_on") and page.allows_now("Rear fog lamp") is False:
        return in_app("vehicle", "Rear fog", because="The rear fog lamp is not allowed in this weather here.")
    return Decline("not_needed", "already_so", "The rear fog lamp may stay as it is.")


def _windshield(page: Page) -> SkillDecision:
    outside, inside = page.number("ambient_temperature_c"), page.number("cabin_temperature_c")
    if outside is not None and inside is not None and outside > inside:
        return in_app("vehicle", "Slow", because="Warm damp air outside meets cold glass: wipe it off.")
    return in_app("climate", "Front defrost", because="The glass is fogged from inside: blow dry air on it.")


def _rear_window(page: Page) -> SkillDecision:
    if (page.number("rain_intensity_pct") or 0.0) > RAIN_PCT:
        return in_app("vehicle", "Slow#2", because="It is rain on the outside: wipe it.")
    return in_app("climate", "Rear defrost", because="The glass is fogged from inside: heat it.")


# --- the table ----------------------------------------------------------------------------------------------

_REAR_FOG = r"(rear fog(s|light)?\b|fog light at the back)"
_FRONT_FOG = r"(front fogs?\b|fog lights at the front)"
_HIGH_BEAM = r"((high|full|main) (beam|lights)|far lights|high lights|full headlights|\bbrights\b)"

SKILLS: tuple[Skill, ...] = (
    Skill(
        (
            r"^(keep watch while i drive|veille pendant que|pass auf, während ich|運転中、見張って)",
            r"^(keep us safe and legal|fais que tout reste sûr|sorg dafür, dass alles sicher|安全と法律)",
        ),
        _keep_watch,
    ),
    Skill(
        (
            rf"(still burning|leave|keep|put it out|flashed).*{_REAR_FOG}",
            rf"{_REAR_FOG}.*(still burning|put it out)",
        ),
        _rear_fog_left_on,
    ),
    Skill((_REAR_FOG,), _fog_lamp("Rear fog lamp", "Rear fog")),
    Skill((_FRONT_FOG,), _fog_lamp("Front fog lamps", "Front fog")),
    Skill((_HIGH_BEAM,), _high_beam),
    Skill(
        (
            r"\b(figures?|number|maximum|top speed|which speed|legal speed|real figure|right one)\b",
            r"limit, now",
            r"(the|give .*) limits?\b(?! disagrees)",
            r"give me one",
            r"\bpost(ed|s)\b",
            r"\bsign (says|gives)\b",
            r"read me mine",
            r"speed (for here|they want)",
            r"what.s allowed between",
            r"how fast (in|one|is|i should|may i)\b",
        ),
        _tell_limit,
    ),
    Skill(
        (
            r"how i.m driving",
            r"my driving",
            r"my speed",
            r"too (fast|quick)",
            r"how fast",
            r"\bpace\b",
            r"within the rules",
            r"what i.m allowed",
            r"\bobject\b",
            r"illegal",
            r"complain",
            r"anything against",
            r"grumble|bark if|pipe up|shout if it",
            r"not allowed",
            r"i.m not over",
            r"ease off",
            r"breaking a",
            r"i.m breaking",
            r"cost me speed",
            r"law think",
            r"slow(er)? (for|than this)",
            r"check what goes",
            r"still fine like this",
            r"new rule",
            r"changed for",
            r"permitted",
            r"different limits",
        ),
        _watch_speed,
    ),
    Skill((r"rear (glass|window)|back window|behind me|out of the back",), _rear_window),
    Skill((r"windshield|windscreen|front window|fogg(y|ed|ing)", r"steamed.up"), _windshield),
    Skill(
        (r"\bfan\b", r"\bblower\b"),
        in_app("climate", "Fan at full speed", because="The fan belongs to the climate screen."),
    ),
    Skill(
        (r"seat (heat|warm)", r"driver seat"),
        in_app("climate", "Driver: Seat heat", because="The driver's seat is heated on the climate screen."),
    ),
    Skill(
        (r"(faster|quicker) (route|way)", r"get there faster", r"recalculate"),
        in_app("map", "Faster", because="The map knows the traffic and the other ways."),
    ),
    Skill(
        (r"hands|fingers",),
        in_app("climate", "Steering wheel heat", because="Cold hands want a warm wheel."),
    ),
)


CALLS: tuple[tuple[str, tuple[tuple[str, dict[str, object]], ...]], ...] = (
    (
        r"\bfull blast|\bfan\b.*\b(highest|maximum|full|max|all the way)",
        (("set_hvac_fan_speed", {"percent": 100}),),
    ),
    (r"\brear (window )?(defroster|heat)", (("switch_hvac", {"which": "rear_defroster", "on": True}),)),
    (r"\bhazard", (("switch_lights", {"which": "hazard", "on": True}),)),
    (r"\bhigh beam", (("switch_lights", {"which": "high_beam", "on": True}),)),
    (r"\brecirculat", (("switch_hvac", {"which": "recirculation", "on": True}),)),
    (r"\bwindshield is fogg?", (("switch_hvac", {"which": "front_defroster", "on": True}),)),
    (r"\bmute\b", (("switch_media", {"which": "muted", "on": True}),)),
)
"""What the same words are as calls of functions: a handful, which shows that the loop works."""
