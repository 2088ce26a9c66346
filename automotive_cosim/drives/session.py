"""An agent at the cockpit on a drive of many minutes.

    wait  ->  the road goes on, second by second, until something wakes or a minute has passed
    act   ->  as in any session

The driver has given one standing order. Nothing ends the session but the end of the drive, and nothing says which
change is an event.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Self

from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode, Observation, VehicleState
from automotive_cosim.contracts.given import Hearing
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.drives.acts import acts_of, refusal, spoken
from automotive_cosim.drives.alarm import Alarm, Noticed, noticed
from automotive_cosim.drives.changes import FAR_S, LONGEST_S
from automotive_cosim.drives.driver import IN_FORCE_S, driver_events, driver_line
from automotive_cosim.drives.errands import said, thanks, words_about
from automotive_cosim.drives.events import KINDS, DriveAct, DriveEvent, Tracker
from automotive_cosim.drives.events.errands import carried_out
from automotive_cosim.drives.harm import Harm, harm
from automotive_cosim.drives.judge import BACK, Against, Judgement, facts_of, judge
from automotive_cosim.drives.order import ANSWERS, ordered
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Baseline, JudgedSession, TakesTime, beginning
from automotive_cosim.episode.specification import ROUNDING_S, End, SessionSetup
from automotive_cosim.interface.observe import Channel
from automotive_cosim.traffic.base import Event
from automotive_cosim.traffic.records import changer
from automotive_cosim.voice.table import check

_with_readings = changer(VehicleState, "noticed", "leader_time_to_collision_s")
_on_watch = changer(Observation, "vehicle", "on_watch")
CHANGED = "something changed"
"""What a result says of all that ends a wait; the readings say what it was."""
READ_BACK = 20
"""Moments that readings look back on for their trend."""
TWIN_S = 120.0
"""How long a do-nothing copy is driven at most to see whether its event becomes an obligation."""


@dataclass(slots=True)
class Twin:
    """A do-nothing copy of the drive from the instant at which an event became observable."""

    index: int
    """Number of the event."""
    event: DriveEvent
    copy: Baseline
    drive: list[Moment]
    """The drive before that instant, and the copy's."""
    tracker: Tracker
    due_s: float | None = None
    """When the obligation arose in it."""

    def follow(self, time_s: float) -> bool:
        """Looks at what the copy has driven up to that simulation time; returns whether there is more to see."""
        for moment in self.copy.since(self.drive[-1].time_s):
            self.drive.append(moment)
            self.tracker.see(self.drive)
        if self.drive[-1].time_s < time_s - ROUNDING_S:
            return False
        same = [
            event for event in self.tracker.events if event.subject == self.event.subject and not event.lookalike
        ]
        self.due_s = next((event.obliged_s for event in same if event.obliged_s is not None), None)
        over = bool(same) and all(event.ended for event in same)
        return self.due_s is None and not over and time_s - self.event.observable_s < TWIN_S


@dataclass(kw_only=True)
class DriveSession(JudgedSession):
    """A session on a drive. Make one with ``depart_with``."""

    tracker: Tracker
    alarm: Alarm
    acts: list[DriveAct] = field(default_factory=list)
    """What the agent did so far that reaches driver, car or road."""
    twins: list[Twin] = field(default_factory=list)
    due_anyway: dict[int, float | None] = field(default_factory=dict)
    """By number of an event, when its obligation arose in its do-nothing copy."""
    reactions: list[tuple[float, Event]] = field(default_factory=list)
    """What the driver did because of alerts and requests, and the time of the moment that tells of it."""
    changes: list[Noticed] = field(default_factory=list)
    """What has changed since the last observation."""
    marked: tuple[str, ...] = ()
    """Names of the readings that the present observation marks as changed."""
    woken: list[tuple[float, tuple[str, ...]]] = field(default_factory=list)
    """Simulation times at which something changed that ends a wait, and the names of the readings."""
    unwatched_from_s: float | None = None
    """Seconds since departure from which nobody watched, because the agent had failed or spent its budget."""
    waits: int = 0
    wakes: int = 0
    judgement: Judgement | None = None
    """The judgement; None until the drive is over."""
    _so_far: tuple[tuple[float, ...], Judgement] = (), Judgement((), ())
    """What was last judged: the same until there is another act, event or end of a copy, or an event goes on."""
    judged: bool = True
    """Whether it is compared with drives with nobody at the cockpit, and judged; each of those is a simulation."""
    _against: Against | None = None
    _given: int = 0
    _asked: int = 0
    """How much of what was asked for the agent has heard."""
    _thanked: frozenset[float] = frozenset()
    """When the errands were asked for that somebody has said thanks for."""

    @classmethod
    def depart_with(
        cls,
        world: CoSimulation,
        setup: SessionSetup,
        observer: Observer | None = None,
        *,
        judged: bool = True,
    ) -> Self:
        """The session that begins at the present moment of a drive, and takes it over.

        Args:
            setup: the agent's input, and the duration as ``max_sim_s``.
            observer: notified of every second that passes.
            judged: whether it is judged at its end.

        Raises:
            TrafficError: the traffic simulation failed.
        """
        words = ordered(setup.conditions.order, setup.conditions.language, with_errands=bool(world.car.errands))
        if setup.conditions.hear is Hearing.CABIN:
            language = setup.conditions.language
            check((words, *(text for each in world.car.errands for text in words_about(each, language))))
        begun: dict[str, Any] = beginning(world, words, setup, (), observer)
        session = cls(**begun, baseline=Baseline(world), tracker=Tracker(KINDS), alarm=Alarm(), judged=judged)
        session._note(world.moment)
        session._read()
        return session

    @property
    def events(self) -> Sequence[DriveEvent]:
        """The events so far, for reports and reference; no agent is told."""
        return self.tracker.events

    @property
    def is_judged(self) -> bool:
        """Whether the drive is over and judged."""
        return self.judgement is not None

    def judged_so_far(self) -> Judgement:
        """The judgement if the drive were over now, without what the do-nothing run has more; the final one at the
        end."""
        if self.judgement is not None:
            return self.judgement
        events = self.events
        last_s, ended = max((event.last_s for event in events), default=0.0), sum(event.ended for event in events)
        now = len(self.acts), len(self.due_anyway), len(events), ended, last_s
        if now != self._so_far[0]:
            self._so_far = now, self._judged()
        return self._so_far[1]

    @property
    def harms(self) -> tuple[Harm, Harm]:
        """The harm on this drive, and on the do-nothing drive of the same length."""
        return harm(self.moments), harm(self.baseline_moments)

    @property
    def harmed_s(self) -> float:
        """For how much longer than the do-nothing drive it was near a collision, where attention is limited."""
        if self.moments[0].awareness is None:
            return 0.0
        mine, baseline = self.harms
        return max(0.0, mine.short_ttc_s - baseline.short_ttc_s)

    def thinking(self, seconds: float) -> TakesTime[None]:
        """As in a session, at most to the end of the drive."""
        return super().thinking(min(seconds, max(0.0, self._left_s())))

    def stepping(self, action: Action) -> TakesTime[None]:
        """As in a session; a spoken answer is noted, and a declared status ends nothing."""
        said = spoken(action, self.world.moment.time_s)
        if said is not None and self._is_understood:
            self.acts.append(said)
        yield from super().stepping(action)

    def close(self) -> None:
        """Ends the drive and all its copies; may be called again."""
        for twin in self.twins:
            twin.copy.close()
        self.twins.clear()
        self.baseline.close()
        self.world.close()

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _copies(self) -> Sequence[Baseline]:
        return (self.baseline, *(twin.copy for twin in self.twins)) if self.judged else ()

    def _spend(self, action: Action | None, feedback: Feedback, cost_s: float) -> TakesTime[Feedback]:
        """Lets an action's time pass: a wait lasts until something wakes."""
        if why := self._note_acts():
            feedback = self.world.cockpit.spoken(Feedback(FeedbackCode.REFUSED, why))
        if action is None or action.action_type is not ActionType.WAIT:
            feedback = yield from super()._spend(action, feedback, cost_s)
            goes_on = action is not None and action.action_type is ActionType.STATUS
            return self._told(
                feedback.code, "the watch goes on; wait for what changes" if goes_on else feedback.text
            )
        self.waits += 1
        begun_s, longest_s = self.world.moment.time_s, float(action.seconds or LONGEST_S)
        left_s = min(longest_s, self._left_s())
        while left_s > ROUNDING_S and not self._is_woken and self.world.moment.driving.end is None:
            yield from self._advance(min(TICK_S, left_s))
            left_s = min(longest_s - (self.world.moment.time_s - begun_s), self._left_s())
        passed_s = self.world.moment.time_s - begun_s
        return self._told(FeedbackCode.OK, f"{passed_s:.0f} s passed")

    def _reply(self, question: str) -> str:
        return ANSWERS[self.setup.conditions.language]

    def _remarks(self) -> tuple[str, ...]:
        """What people aboard have asked for since the last observation, and thanks for what is done."""
        asked, language = self.moments[-1].asked, self.setup.conditions.language
        new, self._asked = asked[self._asked :], len(asked)
        carried = carried_out(self.moments) - self._thanked if asked else frozenset[float]()
        done = [each for each in asked if each.at_s in carried]
        self._thanked |= {each.at_s for each in done}
        return (*(said(each, language) for each in new), *(thanks(each, language) for each in done))

    def _told(self, code: FeedbackCode, text: str) -> Feedback:
        self.wakes += self._is_woken
        changed = [CHANGED] if self._is_woken else []
        return Feedback(code, "; ".join([text, *changed] if text else changed))

    def _proceed(
        self, action: Action | None, feedback: Feedback, cost_s: float = 0.0, said: tuple[str, ...] = ()
    ) -> TakesTime[None]:
        yield from super()._proceed(action, feedback, cost_s, said)
        self._read()

    def _read(self) -> None:
        """Adds to the observation what the car reads, with a mark at what has changed, and that this is a drive."""
        self.marked = tuple(change.name for change in self.changes)
        self.changes.clear()
        vehicle = self.observation.vehicle
        if vehicle is not None:
            from_s = self.moments[-IN_FORCE_S:][0].time_s
            in_force = (event for at_s, event in self.reactions if at_s >= from_s)
            lines = [noticed(self.moments[-READ_BACK:], self.marked), *driver_line(self.moments[-1], in_force)]
            ttc_s = vehicle.leader_time_to_collision_s
            ttc_s = None if ttc_s is None or ttc_s > FAR_S else ttc_s
            vehicle = _with_readings(vehicle, "\n".join(lines), ttc_s)
        self.observation = _on_watch(self.observation, vehicle, True)

    @property
    def _is_woken(self) -> bool:
        return any(change.wakes for change in self.changes)

    def _left_s(self) -> float:
        most_s = self.setup.max_sim_s
        return float("inf") if most_s is None else most_s - self.seconds

    def _channels(self, action: Action | None) -> frozenset[Channel]:
        """After a wait there is no picture: an agent that wants one looks at a screen."""
        waited = action is not None and action.action_type is ActionType.WAIT
        return self.setup.given - {Channel.SCREENSHOT} if waited else self.setup.given

    def _passed(self, moments: tuple[Moment, ...]) -> None:
        for moment in moments:
            self.moments.append(moment)
            self._note(moment)
        if not self.judged:  # nobody looks back further
            del self.moments[1 : -max(READ_BACK, IN_FORCE_S)]
        self._follow()

    def _note(self, moment: Moment) -> None:
        self.reactions += ((moment.time_s, event) for event in driver_events((moment,)))
        changes = self.alarm.see(self.moments[-READ_BACK:])
        self.changes += changes
        names = tuple(change.name for change in changes if change.wakes)
        if names:
            self.woken.append((moment.time_s, names))
        for event in self.tracker.see(self.moments) if self.judged else ():
            if not event.lookalike and event.obliged_s is None and not KINDS[event.kind].by_state:
                index = len(self.tracker.events) - 1 - self.tracker.events[::-1].index(event)
                tracker = Tracker({event.kind: KINDS[event.kind]})
                drive = list(self.moments)
                tracker.see(drive)
                self.twins.append(Twin(index, event, Baseline(self.world), drive, tracker))

    def _follow(self) -> None:
        kept = []
        for twin in self.twins:
            if twin.event.obliged_s is None and twin.follow(self.world.moment.time_s):
                kept.append(twin)
            else:
                self.due_anyway[twin.index] = twin.due_s
                twin.copy.close()
        self.twins = kept

    def _untouched(self) -> Sequence[DriveEvent]:
        """The events of the do-nothing run from departure."""
        tracker, drive = Tracker(KINDS), self.baseline_moments
        for count in range(1, len(drive) + 1):
            tracker.see(drive[max(0, count - BACK) : count])
        return tracker.events

    @property
    def untouched(self) -> tuple[DriveEvent, ...]:
        """Events of the do-nothing run, if an act of the agent holds something back: then they are compared."""
        return tuple(self._untouched()) if any(act.holds_back for act in self.acts) else ()

    def _note_acts(self) -> str:
        """Notes what was commanded since, and returns why the road refuses it, if it does."""
        given = self.world.cockpit.given
        new, self._given = given[self._given :], len(given)
        self.acts += acts_of(new, self.world.moment.driving)
        return next(filter(None, map(refusal, new)), "")

    def _ended(self) -> End | None:
        end = super()._ended()
        if end is End.DECLARED:
            most_s = self.setup.max_sim_s
            self.declared = self.reason = None
            end = End.MINUTES_OVER if most_s is not None and self.seconds >= most_s - ROUNDING_S else None
        return End.MINUTES_OVER if end is End.OUT_OF_TIME else end

    def _finish(self, end: End) -> TakesTime[None]:
        """An agent that stops acting leaves the rest of the drive to itself."""
        if end not in (End.DRIVE_ENDED, End.MINUTES_OVER) and self.setup.max_sim_s is not None:
            self.unwatched_from_s = round(self.seconds, 1)
            yield from self._advance(max(0.0, self._left_s()))
        for twin in self.twins:
            self.due_anyway[twin.index] = twin.due_s
        if self.judged:
            self.judgement = self._judged(self.untouched)
        yield from super()._finish(end)

    def _judged(self, untouched: Sequence[DriveEvent] = ()) -> Judgement:
        if self._against is None:
            self._against = facts_of(self.moments)
        return judge(
            KINDS,
            self.events,
            self.acts,
            self.due_anyway,
            self._against,
            self.moments[0].commands,
            untouched,
            order=self.setup.conditions.order,
        )
