"""Errands: what people aboard ask for on the way, judged by the state that the car reaches, as tasks are.

An errand waits for whatever safety asks: it counts in full for half a minute.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import ClassVar

from automotive_cosim.cockpit.signals import CALL, HVAC, LINK
from automotive_cosim.contracts.errand import Errand, ErrandKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import DriveAct, EventKind, Sighting

KEEPS = 3
"""Moments for which the state that was asked for must last: a value that is only passed on the way is not set."""
LINGERS_S = 10.0
"""How long after the deadline an act is still about the errand."""
REFUSED = "the driver said no"
UNASKED = "nobody has asked for it"
TEMPERATURES = {"driver": HVAC.DRIVER_TEMPERATURE, "passenger": HVAC.PASSENGER_TEMPERATURE}


class ErrandEvent(EventKind):
    """Somebody aboard asks for something."""

    errand: ClassVar[ErrandKind]
    keys: ClassVar[frozenset[str]]
    """Keys of ``Moment.commands`` that carrying it out changes."""
    told_by = ("asked",)
    by_state = True
    source = "30 s, in which it may wait for whatever safety asks, then 60 s; our choice"
    neutral = "every step towards it, and setting it right"
    lookalike = "the same, and the driver says no at once"
    hold_s: ClassVar[float] = 30.0
    grace_s = 60.0
    alerts = frozenset()

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """What is asked for, and since when it is done."""
        now = drive[-1]
        for errand in self.pending(now):
            words, subject = self.words(errand), f"{errand.at_s:.0f}"
            if errand.is_declined:
                yield Sighting(words, subject, lookalike=True)
                continue
            begun = next(moment for moment in drive if moment.time_s >= errand.at_s)
            last = drive[-1 - KEEPS :]
            done = len(last) > KEEPS and all(self.is_done(errand, begun, moment) for moment in last)
            yield Sighting(
                words,
                subject,
                due=self.is_possible(errand, now),
                hold_s=self.hold_s,
                done_s=last[0].time_s if done else None,
            )

    def pending(self, now: Moment) -> tuple[Errand, ...]:
        """What was asked for, of this kind, and still counts."""
        lasts_s = self.hold_s + self.grace_s + LINGERS_S
        return tuple(each for each in now.asked if each.kind is self.errand and now.time_s - each.at_s <= lasts_s)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """What nobody asks for, or the driver does not want."""
        return REFUSED if any(self.sight(drive)) else UNASKED

    def settles(self, act: DriveAct, value: float | None) -> bool:
        """Whatever changes what was asked for; whether it was right, the state says."""
        return any(path in self.keys for path, _ in act.writes)

    def concerns(self, act: DriveAct) -> bool:
        return self.settles(act, None)

    @abstractmethod
    def words(self, errand: Errand) -> str:
        """What was asked for, for reports."""

    @abstractmethod
    def is_done(self, errand: Errand, begun: Moment, now: Moment) -> bool:
        """Whether it is carried out."""

    def is_possible(self, errand: Errand, now: Moment) -> bool:
        """Whether it can be carried out now."""
        return True


class ErrandClimate(ErrandEvent):
    """A temperature."""

    name = "errand_climate"
    about = "somebody asks for a temperature on their side"
    errand = ErrandKind.CLIMATE
    keys = frozenset(signal.path for signal in TEMPERATURES.values())

    def words(self, errand: Errand) -> str:
        """Seat and degrees."""
        return f"{errand.wanted} degrees for the {errand.about}"

    def is_done(self, errand: Errand, begun: Moment, now: Moment) -> bool:
        """Whether the seat has that temperature."""
        return bool(now.signals[TEMPERATURES[errand.about].path] == float(errand.wanted))


class ErrandMessage(ErrandEvent):
    """A reply to a message."""

    name = "errand_message"
    about = "the driver asks to answer a message that has just come"
    errand = ErrandKind.MESSAGE
    keys = frozenset({"messages.sent", "messages.read"})

    def words(self, errand: Errand) -> str:
        return f"answer {errand.about}: {errand.wanted}"

    def is_done(self, errand: Errand, begun: Moment, now: Moment) -> bool:
        """Whether that, and nothing else, was sent since."""
        sent = now.commands["messages.sent"][len(begun.commands["messages.sent"]) :]
        return bool(sent == [{"to": errand.about, "text": errand.wanted}])

    def is_possible(self, errand: Errand, now: Moment) -> bool:
        return bool(now.signals[LINK.ONLINE.path])


class ErrandCall(ErrandEvent):
    """A call to decline."""

    name = "errand_call"
    about = "the driver asks to decline a call that rings"
    errand = ErrandKind.CALL
    keys = frozenset({"calls.declined"})
    source = "8 s, then as long as a phone rings; our choice"
    hold_s = 8.0
    grace_s = 15.0

    def words(self, errand: Errand) -> str:
        return f"decline the call of {errand.about}"

    def is_done(self, errand: Errand, begun: Moment, now: Moment) -> bool:
        return errand.about in now.commands["calls.declined"]

    def is_possible(self, errand: Errand, now: Moment) -> bool:
        """While it rings."""
        return bool(now.signals[CALL.RINGING.path] == errand.about)


class ErrandPlace(ErrandEvent):
    """Another destination."""

    name = "errand_place"
    about = "the driver asks to be guided somewhere else"
    errand = ErrandKind.PLACE
    keys = frozenset({"navigation.destination"})

    def words(self, errand: Errand) -> str:
        return f"guidance to {errand.about}"

    def is_done(self, errand: Errand, begun: Moment, now: Moment) -> bool:
        """Whether it is the destination."""
        return bool(now.commands["navigation.destination"] == errand.about)


ERRANDS = (ErrandClimate(), ErrandMessage(), ErrandCall(), ErrandPlace())


def carried_out(drive: Sequence[Moment]) -> frozenset[float]:
    """When the errands were asked for that are done now, in simulation time."""
    return frozenset(
        errand.at_s
        for kind in ERRANDS
        for errand, sighting in zip(kind.pending(drive[-1]), kind.sight(drive), strict=True)
        if sighting.done_s is not None
    )
