"""Watchers: the rule-perfect one, which shows what an agent could do, and trivial ones, which must fail."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.contracts import Action, ActionType, AlertKind, Observation
from automotive_cosim.drives.attention import LOOK_S, LOOKS, Concern, fog_lamps_lit
from automotive_cosim.drives.reading import Gathered, Reader
from automotive_cosim.drives.touches import Hands
from automotive_cosim.interface.observe import Channel

READS = frozenset({Channel.VEHICLE, Channel.CONTEXT, Channel.ELEMENTS})
GONE_S = 31.0
"""A concern that was away for longer is another one."""
FORGOTTEN_S = 60.0
"""What was told longer ago, before it was due, the driver has forgotten."""


class RulePerfect:
    """Knows the rules of every kind of event, and reads only what an agent may observe."""

    name = "rule-perfect"
    model = "none"
    channels: frozenset[Channel] = READS

    def __init__(self, delay_s: float = 0.0) -> None:
        """A watcher that tells each concern that many seconds late."""
        self._delay_s = delay_s
        self.reset("")

    def reset(self, goal: str) -> None:
        """Forgets the previous drive."""
        self._reader = Reader()
        self._seen: dict[str, float] = {}
        self._since: dict[str, float] = {}
        self._told: dict[str, _Telling] = {}
        self._hands = Hands()

    def act(self, observation: Observation) -> Action:
        """An alert of what has not been told yet, a question for a rule that is not shown, a touch for what people
        ask for, else a wait."""
        known = self._reader.read(observation)
        if known is None:
            return Action(ActionType.WAIT)
        unknown = next((label for label in fog_lamps_lit(known) if self._reader.can_ask(known, label)), None)
        if unknown is not None:
            return self._reader.ask(known, unknown)
        concerns = self._concerns(known)
        for concern in concerns:
            if self._is_time(concern, known.time_s):
                self._told[concern.key] = _Telling(known.time_s, concern.due)
                if concern.say:
                    return Action(ActionType.ANSWER, text=concern.say)
                return Action(ActionType.SHOW_ALERT, kind=concern.alert)
        self._hands.hear(observation)
        touch = self._hands.act(observation)
        if touch is not None:
            return touch
        if any(concern.now and self._is_untold(concern, known.time_s) for concern in concerns):
            return Action(ActionType.WAIT, seconds=1)
        return Action(ActionType.WAIT, seconds=LOOK_S) if concerns else Action(ActionType.WAIT)

    def look_on(self, observation: Observation, given: Action) -> None:
        """Notes what somebody else does in its stead: an alert tells of all its concerns that are there."""
        known = self._reader.read(observation)
        if known is None:
            return
        for concern in self._concerns(known):
            is_told = given.action_type is ActionType.SHOW_ALERT and given.kind is concern.alert
            if is_told and (concern.now or concern.is_there) and self._is_untold(concern, known.time_s):
                self._told[concern.key] = _Telling(known.time_s, concern.now and concern.due)

    def _concerns(self, known: Gathered) -> list[Concern]:
        """What there is to tell or to watch, noted."""
        concerns = [concern for look in LOOKS for concern in look(known)]
        self._note(concerns, known.time_s)
        return concerns

    def _note(self, concerns: Sequence[Concern], now_s: float) -> None:
        """Since when each lasts; one that was away for long is another concern."""
        lasting = {concern.key for concern in concerns if concern.now}
        self._since = {key: since_s for key, since_s in self._since.items() if key in lasting}
        for concern in concerns:
            key = concern.key
            if concern.now or concern.is_there:
                if now_s - self._seen.get(key, -GONE_S) >= GONE_S:
                    self._told.pop(key, None)
                self._seen[key] = now_s
            told = self._told.get(key)
            if told is not None:
                told.was_due |= concern.now and concern.due and now_s - told.at_s <= FORGOTTEN_S
            if concern.now:
                self._since.setdefault(key, now_s - concern.lasted_s)

    def _is_untold(self, concern: Concern, now_s: float) -> bool:
        told = self._told.get(concern.key)
        return told is None or (not told.was_due and now_s - told.at_s > FORGOTTEN_S)

    def _is_time(self, concern: Concern, now_s: float) -> bool:
        due = concern.now and self._is_untold(concern, now_s)
        return due and now_s - self._since[concern.key] >= concern.hold_s + self._delay_s


@dataclass(slots=True)
class _Telling:
    """What the driver was told, and when."""

    at_s: float
    was_due: bool
    """Whether it came due while the driver remembered; if not, it was told too early and is told again."""


# --- watchers that must fail -----------------------------------------------------------------------------------


class Silent:
    """Waits, and does nothing."""

    name = "silent"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def reset(self, goal: str) -> None:
        """Does nothing."""

    def act(self, observation: Observation) -> Action:
        """Waits as long as it may."""
        return Action(ActionType.WAIT)


class AlertAll:
    """Gives every kind of alert in turn, one each ten seconds, whatever happens."""

    name = "alert-all"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self) -> None:
        self.reset("")

    def reset(self, goal: str) -> None:
        """Begins with the first kind."""
        self._turn = 0

    def act(self, observation: Observation) -> Action:
        """An alert, then a wait."""
        self._turn += 1
        if self._turn % 2:
            kinds = tuple(AlertKind)
            return Action(ActionType.SHOW_ALERT, kind=kinds[self._turn // 2 % len(kinds)])
        return Action(ActionType.WAIT, seconds=9)


class AlertOnWake:
    """Gives the kind of alert that is right most often whenever something wakes it."""

    name = "alert-on-wake"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self) -> None:
        self.reset("")

    def reset(self, goal: str) -> None:
        """Forgets the previous drive."""
        self._waited = False

    def act(self, observation: Observation) -> Action:
        """An alert if the wait was ended by something, else a wait."""
        woken = self._waited and "; " in observation.feedback.text
        self._waited = not woken
        return Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED) if woken else Action(ActionType.WAIT)


class AlertOften:
    """Gives the most frequent kind of alert twice a minute, whatever happens."""

    name = "alert-often"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self) -> None:
        self.reset("")

    def reset(self, goal: str) -> None:
        self._next_s = 0.0

    def act(self, observation: Observation) -> Action:
        """The alert once it is time, else a short wait."""
        if observation.time_s >= self._next_s:
            self._next_s = observation.time_s + 30.0
            return Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED)
        return Action(ActionType.WAIT, seconds=10)
