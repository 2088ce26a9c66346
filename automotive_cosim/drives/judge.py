"""The judge: what became of each event of a drive, and what each act was.

Each event is judged against the agent's own drive; one that never became an obligation there is compared with a
copy of the drive that was forked when the event became observable, with nobody at its cockpit.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from math import ceil
from typing import Any

from automotive_cosim.contracts import AlertKind
from automotive_cosim.contracts.given import Order
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import DriveAct, EventKind, Measured
from automotive_cosim.drives.events.tracker import DriveEvent

REPEAT_S = 60.0
"""An alert about the same event, or the same alert while nothing is due, is a nuisance within this time, unless it
has become worse, or it advises a clearly lower speed: fog thickens, and the driver follows the one told before."""
NAGGING_S = 15.0
"""The same for who was told of no minute: whoever says a thing again sooner than this nags."""
WORSE = 1.25
"""Ratio of severities from which an event has become worse, and of the speeds advised."""
HOLD_S = 120.0
"""For how long a request or a stop holds the car back (``departure.ADVICE_S``)."""
AFTER_S = 60.0
"""How long after that the drive is still another one because of it."""
NEAR_S = 120.0
"""The same event comes on both drives within this time."""
CHANCE_S = 2.0
"""An event whose deadline comes sooner than this after its obligation arose could be met by nobody: one glance
(NHTSA 2013)."""
NUISANCE = 1.0
"""Cost of a nuisance: as much as a miss of weight 1, which is our choice. At a
fifth of that, an alert of the most frequent kind twice a minute would pay."""
SWING = 2.0
"""To take a look-alike for an event costs what meeting the event gains, twice its weight: who cannot tell the two
apart gains nothing."""
ORDER = "the driver asked to leave everything else as it is"
"""What speaks against a command that no kind of event concerns."""
NOT_DUE = "nothing that asks for it is due"
"""What speaks against a stop, or against driving slowly, while there is only something that may come."""
Against = Callable[[EventKind, float], str | None]
"""The fact known to the agent at a simulation time that speaks against a warning of a kind; None if none does."""
CAUSED_S = 10.0
"""An event that becomes observable within this time of the agent's own contrary act is of its own making."""
PASSED_S = 3.0
"""Who speaks of an event this soon after its end still speaks of it."""
EARLY_S = 2.0
"""Who acts this short before an event is observable has seen it come: readings are told once a second."""
STEP_S = 2.0
"""The state is read once a second: what it reaches within this time of an act is that act's doing."""
LATE_S = 30.0
"""How long after a deadline an act still counts as late and not as a nuisance."""


class EventOutcome(StrEnum):
    """The outcome of an event."""

    HIT = "hit"
    """A right act between obligation and deadline."""
    PREPARED = "prepared"
    """A right act before the obligation, which then came."""
    PREVENTED = "prevented"
    """A right act, after which the obligation did not come; without the agent it would have."""
    LATE = "late"
    """The first right act came after the deadline."""
    MISSED = "missed"
    """No right act."""
    CAUSED = "caused"
    """The agent's own doing: counts as missed, whatever it did then."""
    EVADED = "evaded"
    """It arose in the do-nothing run, but not here, because the agent held the car back for no reason: counts as
    missed."""
    VOID = "void"
    """Nothing ever had to be done, or it passed by itself before the deadline, or came too suddenly for anybody."""
    AVOIDED = "avoided"
    """A look-alike that the agent left alone."""
    TAKEN = "taken"
    """A look-alike that the agent acted on."""

    @property
    def is_credited(self) -> bool:
        """Whether the agent did what was right in time."""
        return self in _CREDITED

    @property
    def counts(self) -> bool:
        """Whether recall counts it: an event in which something had to be done."""
        return self in _COUNTED


_CREDITED = frozenset({EventOutcome.HIT, EventOutcome.PREPARED, EventOutcome.PREVENTED})
_COUNTED = _CREDITED | {EventOutcome.LATE, EventOutcome.MISSED, EventOutcome.CAUSED, EventOutcome.EVADED}


class Worth(StrEnum):
    """How an act is judged."""

    RIGHT = "right"
    """It settled an event, or prepared for one."""
    LATE = "late"
    """It would have settled an event before its deadline."""
    NEUTRAL = "neutral"
    """Neither asked for nor false: something that could be known supported it, or it set back what was changed."""
    LOOKALIKE = "lookalike"
    """A look-alike was taken for an event."""
    WRONG = "wrong"
    """Something was due, but not this."""
    FALSE = "false"
    """Nothing that could be known supported it."""
    REPEAT = "repeat"
    """The driver had just been told."""

    @property
    def is_false(self) -> bool:
        """Whether it is a false alarm."""
        return self in (Worth.LOOKALIKE, Worth.WRONG, Worth.FALSE)

    @property
    def is_nuisance(self) -> bool:
        """Whether it costs: a false alarm or a repeat."""
        return self.is_false or self is Worth.REPEAT


@dataclass(frozen=True, slots=True)
class JudgedEvent:
    """One event and what became of it; times in simulation seconds."""

    kind: str
    words: str
    lookalike: bool
    weight: float
    outcome: EventOutcome
    observable_s: float
    obliged_s: float | None
    deadline_s: float | None
    ends_s: float
    acted_s: float | None = None
    """When the act came that settled it."""

    @property
    def delay_s(self) -> float | None:
        """From the instant at which it could be known to the act."""
        return None if self.acted_s is None else self.acted_s - self.observable_s

    @property
    def credit(self) -> float:
        """1 until three seconds after the obligation, falling to 0 at the deadline; -1 if nothing came in time;
        0 for what does not count."""
        if not self.outcome.is_credited:
            return -1.0 if self.outcome.counts else 0.0
        if self.outcome is not EventOutcome.HIT or self.acted_s is None:
            return 1.0
        assert self.obliged_s is not None
        assert self.deadline_s is not None
        full_s = self.obliged_s + FULL_S
        if self.acted_s <= full_s or self.deadline_s <= full_s:
            return 1.0
        return (self.deadline_s - self.acted_s) / (self.deadline_s - full_s)


FULL_S = 3.0
"""Time after the obligation in which an act earns full credit."""


@dataclass(frozen=True, slots=True)
class JudgedAct:
    """One act and what it was."""

    time_s: float
    words: str
    worth: Worth
    about: str = ""
    """The kind of event that it was about."""
    reason: str = ""
    """What speaks against it, of what the agent could know, if it is a nuisance."""
    cost: float = 0.0
    """What it costs, if it is a nuisance."""
    holds_s: float = 0.0
    """For how long it holds the car back for no reason."""


@dataclass(frozen=True, slots=True)
class Judgement:
    """Everything that was judged of one drive."""

    events: tuple[JudgedEvent, ...]
    acts: tuple[JudgedAct, ...]


@dataclass(slots=True)
class _Case:
    """An event while it is judged."""

    event: DriveEvent
    kind: EventKind
    due_anyway_s: float | None = None
    """When its obligation arose in its do-nothing copy, if it did."""
    answered_s: float | None = None
    told_s: float | None = None
    told_severity: float = 0.0
    is_named: bool = False
    """Whether an alert was about it in the first place; one may settle others along with it."""
    caused: bool = False
    taken: bool = False

    def is_too_early(self, act: DriveAct) -> bool:
        """Whether an act comes so long before the obligation that it does not prepare for it.

        A driver who heeds a warning meets the obligation later, or never: what counts is when it would have come.
        """
        obliged_s = self.event.obliged_s
        if obliged_s is None or (act.alert is None and not act.said):
            return False
        due_s = obliged_s if self.due_anyway_s is None else min(obliged_s, self.due_anyway_s)
        return act.time_s < due_s - self.kind.lasts_s

    def is_open(self, time_s: float) -> bool:
        """Whether an act at that time can be about it."""
        event = self.event
        until_s = max(event.last_s, min(event.deadline_s or 0.0, event.last_s + LATE_S))
        early_s = 0.0 if event.lookalike or self.kind.by_state else EARLY_S
        return event.observable_s - early_s <= time_s <= until_s + PASSED_S


def judge(
    kinds: Mapping[str, EventKind],
    events: Sequence[DriveEvent],
    acts: Sequence[DriveAct],
    due_anyway: Mapping[int, float | None],
    against: Against,
    at_start: Mapping[str, Any] | None = None,
    untouched: Sequence[DriveEvent] = (),
    hold_s: float = HOLD_S,
    order: Order = Order.FULL,
) -> Judgement:
    """What became of events, and what acts were.

    Args:
        kinds: the kinds by name.
        events: those of the agent's own drive.
        acts: what the agent did, in chronological order.
        due_anyway: by the index of an event, when its obligation arose in the copy of the drive that was forked
            when it became observable; None if it did not.
        against: the facts that speak against acts.
        at_start: the signals at departure; to set one back is no nuisance.
        untouched: the events of the do-nothing run from departure, so that nobody gains by avoiding events.
        hold_s: for how long a request holds the car back.
        order: what the driver said. Who was told no thresholds is not charged for what a measure alone speaks
            against, and who was told of no minute may say a thing again after ``NAGGING_S``.
    """
    cases = [
        _Case(event, kinds[event.kind], due_anyway.get(index), event.done_s) for index, event in enumerate(events)
    ]
    for case in cases:
        case.caused = not case.event.lookalike and any(_contrary(case, act) for act in acts)
    known = known_to(order, against)
    repeat_s = NAGGING_S if order is Order.PLAIN else REPEAT_S
    bench = _Bench(tuple(kinds.values()), cases, known, at_start or {}, hold_s, repeat_s)
    judged = tuple(map(bench.act, acts))
    found = tuple(map(_event, cases))
    heard = [act for act, what in zip(acts, judged, strict=True) if not what.worth.is_false]
    evadable = [
        event
        for event in untouched
        if not (kinds[event.kind].by_state or _has_passed(event, kinds[event.kind]))
        and not any(_heeds(act, event, kinds[event.kind]) for act in heard)
    ]
    return Judgement((*found, *_evaded(evadable, found, judged)), judged)


def known_to(order: Order, against: Against) -> Against:
    """The facts that count against who was given that order."""
    return against if order.tells_thresholds else partial(_beyond_doubt, against)


def _beyond_doubt(against: Against, kind: EventKind, time_s: float) -> str | None:
    """The fact that speaks against a warning, unless it is one of measure."""
    fact = against(kind, time_s)
    return None if isinstance(fact, Measured) else fact


def _has_passed(event: DriveEvent, kind: EventKind) -> bool:
    """Whether it has passed by itself before its deadline, or in the end only looked like one."""
    return event.ended_early or (kind.eases and event.eased_s is not None)


def _heeds(act: DriveAct, event: DriveEvent, kind: EventKind) -> bool:
    """Whether an act told of an event of the do-nothing run, or settled it, in time."""
    if event.obliged_s is None or event.deadline_s is None:
        return False
    return event.obliged_s - kind.lasts_s <= act.time_s <= event.deadline_s and kind.settles(act, event.value)


def _evaded(
    untouched: Sequence[DriveEvent], found: Sequence[JudgedEvent], acts: Sequence[JudgedAct]
) -> Iterator[JudgedEvent]:
    """The events of the do-nothing run that did not arise because the agent had held the car back for no reason."""
    held = [(act.time_s, act.time_s + act.holds_s + AFTER_S) for act in acts if act.holds_s]
    for event in untouched if held else ():
        due_s = event.obliged_s
        if event.lookalike or due_s is None or event.deadline_s is None:
            continue
        if event.deadline_s - due_s < CHANCE_S or not any(from_s <= due_s <= until_s for from_s, until_s in held):
            continue
        same = (other.obliged_s or 0.0 for other in found if other.kind == event.kind and other.outcome.counts)
        if any(abs(other_s - due_s) <= NEAR_S for other_s in same):
            continue
        yield JudgedEvent(
            event.kind,
            event.words,
            False,
            event.weight,
            EventOutcome.EVADED,
            event.observable_s,
            due_s,
            event.deadline_s,
            event.last_s,
        )


def facts_of(drive: Sequence[Moment]) -> Against:
    """What speaks against acts on a drive, from its moments, one per second; the drive may go on meanwhile."""
    found: dict[tuple[str, float], str | None] = {}

    def against(kind: EventKind, time_s: float) -> str | None:
        if (kind.name, time_s) in found:
            return found[kind.name, time_s]
        until = max(1, bisect_right(drive, time_s + HALF_TICK_S, key=lambda moment: moment.time_s))
        fact = kind.speaks_against(drive[max(0, until - BACK) : until])
        if until < len(drive):  # later moments change nothing
            found[kind.name, time_s] = fact
        return fact

    return against


HALF_TICK_S = 0.5
BACK = 100
"""Moments that a kind looks back on at most."""


def _contrary(case: _Case, act: DriveAct) -> bool:
    """Whether an act brought an event about: it wrote what the kind watches, the wrong way, just before."""
    before_s = case.event.observable_s - act.time_s
    return 0.0 <= before_s <= CAUSED_S and case.kind.concerns(act) and not case.kind.settles(act, case.event.value)


@dataclass(slots=True)
class _Bench:
    """Judges the acts of a drive in turn."""

    kinds: Sequence[EventKind]
    cases: Sequence[_Case]
    against: Against
    at_start: Mapping[str, Any]
    hold_s: float
    """For how long a request holds the car back."""
    repeat_s: float = REPEAT_S
    """Within which time the same alert is a nuisance."""
    written: set[str] = field(default_factory=set)
    """Signals that the agent has changed."""
    alerted_s: dict[AlertKind, float] = field(default_factory=dict)
    """When each kind of alert was given last."""
    alerted_kmh: dict[AlertKind, float | None] = field(default_factory=dict)
    """The speed that it advised."""

    def act(self, act: DriveAct) -> JudgedAct:
        judged = self._judged(act)
        if judged.worth.is_nuisance:
            judged = replace(judged, cost=max(NUISANCE, judged.cost))
        self.written |= {path for path, _ in act.writes}
        if judged.worth.is_false and act.holds_back:
            judged = replace(judged, holds_s=self.hold_s)
        if act.alert is not None:
            self.alerted_s[act.alert] = act.time_s
            self.alerted_kmh[act.alert] = act.speed_kmh
        return judged

    def _judged(self, act: DriveAct) -> JudgedAct:
        if act.releases:
            return JudgedAct(act.time_s, act.words, Worth.NEUTRAL)
        there = [case for case in self.cases if case.is_open(act.time_s)]
        true = [case for case in there if not case.event.lookalike]
        settled = [case for case in true if case.kind.settles(act, case.event.value)]
        right = [case for case in settled if not case.kind.by_state]
        if settled and not right:
            return _step(act, settled)
        if right:
            worth, told_s = self._told(act, right)
            reason = f"told {act.time_s - told_s:.0f} s before" if worth is Worth.REPEAT else ""
            return JudgedAct(act.time_s, act.words, worth, right[0].event.kind, reason)
        if act.alert is None and _sets_back(act, self.written, self.at_start):
            return JudgedAct(act.time_s, act.words, Worth.NEUTRAL)
        meant = [kind for kind in self.kinds if kind.settles(act, None) or kind.concerns(act)]
        facts = {kind.name: self.against(kind, act.time_s) for kind in meant}
        supported = [kind for kind in meant if facts[kind.name] is None]
        holds_back = act.alert is None and act.holds_back  # no warning: it must be due, not only true
        if (supported and not holds_back) or (
            act.said and not meant
        ):  # of other words nobody can say whether they are true
            return self._supported(act, meant, supported)
        alike = [case for case in there if case.event.lookalike and case.kind.settles(act, case.event.value)]
        again = bool(alike) and all(case.taken and case.kind.by_state for case in alike)
        for case in alike:
            case.taken = True
        if again:  # a further step of what is charged already
            return JudgedAct(act.time_s, act.words, Worth.NEUTRAL, alike[0].event.kind)
        reason = "; ".join(filter(None, facts.values())) or (NOT_DUE if supported else ORDER)
        if alike:
            cost = SWING * max(case.event.weight for case in alike)
            return JudgedAct(act.time_s, act.words, Worth.LOOKALIKE, alike[0].event.kind, reason, cost)
        due = [case for case in true if case.answered_s is None and case.event.obliged_s is not None]
        wrong = any((case.event.obliged_s or 0.0) <= act.time_s for case in due)
        return JudgedAct(act.time_s, act.words, Worth.WRONG if wrong else Worth.FALSE, "", reason)

    def _supported(self, act: DriveAct, meant: Sequence[EventKind], supported: Sequence[EventKind]) -> JudgedAct:
        """An act that is true for all that is known, although nothing is due: neutral, unless it was just told, and
        something has supported it ever since."""
        about = min(supported, key=lambda kind: len(kind.alerts)).name if supported else ""
        told_s = self.alerted_s.get(act.alert) if act.alert is not None else None
        recent = told_s is not None and act.time_s - told_s < self.repeat_s
        if told_s is not None and recent and not self._is_slower(act) and self._lasts(meant, told_s, act.time_s):
            reason = f"told {act.time_s - told_s:.0f} s before"
            return JudgedAct(act.time_s, act.words, Worth.REPEAT, about, reason)
        return JudgedAct(act.time_s, act.words, Worth.NEUTRAL, about)

    def _told(self, act: DriveAct, cases: Sequence[_Case]) -> tuple[Worth, float]:
        """Notes an act that is right for some open events; the best that it is for any of them, and when one of
        them was told of last."""
        worths = []
        before_s = max((case.told_s for case in cases if case.told_s is not None), default=act.time_s)
        meant = [kind for kind in self.kinds if kind.settles(act, None)]
        unnamed = [case for case in cases if not case.is_named]
        for case in cases:
            event = case.event
            if case.is_too_early(act):
                worths.append(Worth.NEUTRAL)
                continue
            if case.answered_s is None:
                case.answered_s = act.time_s
                late = event.deadline_s is not None and act.time_s > event.deadline_s
                worths.append(Worth.LATE if late else Worth.RIGHT)
            elif act.alert is None and not act.said:
                worths.append(Worth.NEUTRAL)
            else:
                severity = event.severity_at(act.time_s)
                recent = case.told_s is not None and act.time_s - case.told_s < self.repeat_s
                worse = severity >= WORSE * case.told_severity or self._is_slower(act)
                again = recent and not unnamed and not worse
                worths.append(Worth.REPEAT if again and self._lasts(meant, before_s, act.time_s) else Worth.NEUTRAL)
            if act.alert is not None or act.said:
                case.told_s, case.told_severity = act.time_s, event.severity_at(act.time_s)
        if unnamed and act.alert is not None:
            min(unnamed, key=_most_likely).is_named = True
        return min(worths, key=(Worth.RIGHT, Worth.LATE, Worth.NEUTRAL, Worth.REPEAT).index), before_s

    def _is_slower(self, act: DriveAct) -> bool:
        """Whether an alert advises a clearly lower speed than the last one of its kind."""
        before_kmh = self.alerted_kmh.get(act.alert) if act.alert is not None else None
        return act.speed_kmh is not None and before_kmh is not None and act.speed_kmh * WORSE <= before_kmh

    def _lasts(self, meant: Sequence[EventKind], from_s: float, until_s: float) -> bool:
        """Whether at every second between two alerts something supported them."""
        seconds = (from_s + count for count in range(1, ceil(until_s - from_s)))
        return all(any(self.against(kind, at_s) is None for kind in meant) for at_s in seconds)


def _step(act: DriveAct, cases: Sequence[_Case]) -> JudgedAct:
    """A step towards what was asked for: right if the state is reached by it."""
    for case in cases:
        done_s, deadline_s = case.event.done_s, case.event.deadline_s
        if done_s is not None and not case.is_named and 0.0 <= done_s - act.time_s <= STEP_S:
            case.is_named = True
            late = deadline_s is not None and done_s > deadline_s
            return JudgedAct(act.time_s, act.words, Worth.LATE if late else Worth.RIGHT, case.event.kind)
    return JudgedAct(act.time_s, act.words, Worth.NEUTRAL, cases[0].event.kind)


def _most_likely(case: _Case) -> tuple[int, float]:
    """What an alert is about, least first: the kind that the fewest alerts settle, then what is due soonest."""
    obliged_s = case.event.obliged_s
    return len(case.kind.alerts), float("inf") if obliged_s is None else obliged_s


def _sets_back(act: DriveAct, written: set[str], at_start: Mapping[str, Any]) -> bool:
    """Whether an act only sets back what the agent itself had changed."""
    return bool(act.writes) and all(
        path in written and path in at_start and at_start[path] == value for path, value in act.writes
    )


def _event(case: _Case) -> JudgedEvent:
    event = case.event
    outcome = _outcome(case)
    obliged_s = case.due_anyway_s if event.obliged_s is None else event.obliged_s
    return JudgedEvent(
        kind=event.kind,
        words=event.words,
        lookalike=event.lookalike,
        weight=event.weight,
        outcome=outcome,
        observable_s=event.observable_s,
        obliged_s=obliged_s,
        deadline_s=event.deadline_s,
        ends_s=event.last_s,
        acted_s=case.answered_s if not event.lookalike else None,
    )


def _outcome(case: _Case) -> EventOutcome:
    event, acted_s = case.event, case.answered_s
    if event.lookalike:
        return EventOutcome.TAKEN if case.taken else EventOutcome.AVOIDED
    if event.obliged_s is None:
        if event.done_s is not None:
            return EventOutcome.PREPARED
        in_time = acted_s is not None and case.due_anyway_s is not None
        return EventOutcome.PREVENTED if in_time and not case.caused else EventOutcome.VOID
    if case.caused:
        return EventOutcome.CAUSED
    assert event.deadline_s is not None
    if acted_s is not None and acted_s <= event.deadline_s:
        return EventOutcome.PREPARED if acted_s < event.obliged_s else EventOutcome.HIT
    if event.deadline_s - event.obliged_s < CHANCE_S or _has_passed(event, case.kind):
        return EventOutcome.VOID
    return EventOutcome.LATE if acted_s is not None else EventOutcome.MISSED
