"""What the driver does because of alerts and requests, from the events of a drive's moments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.traffic.base import Event
from automotive_cosim.traffic.ego import WAKES_UP

HEEDS = frozenset({"driver_slows", "driver_holds", "driver_opens_gap", WAKES_UP, "driver_pulls_over"})
"""Events after which the driver drives, or stops, as was asked, until it is over."""
SPEEDS = frozenset({"driver_slows", "driver_holds"})
PULLS_OVER = "driver_pulls_over"
RELEASED, DRIVES_ON, GOES_ON = "driver_released", "driver_drives_on", "driver_goes_on"
STOPS = frozenset({"driver_parks", PULLS_OVER})
"""Events after which the car stops at the side."""
SETS_OFF = frozenset({"driver_sets_off", DRIVES_ON})
"""Events after which it no longer stands there."""
STOP_OVER = frozenset({"driver_cannot_stop", DRIVES_ON})
IN_FORCE_S = 400
"""For how long something that the driver was asked for lasts at most: a search, the way there and the stop."""
NEWS_S = 60.0


def driver_events(moments: Sequence[Moment]) -> Iterator[Event]:
    """The driver's reactions, in order."""
    return (event for moment in moments for event in moment.events if event.kind.startswith("driver_"))


def driver_line(now: Moment, events: Iterable[Event]) -> Iterator[str]:
    """What the driver does because of alerts and requests as long as that is in force, then what came last as long
    as that is news; nothing if there is neither.

    Args:
        now: the present moment.
        events: the driver's reactions of as long as something may be in force.
    """
    told = dict[str, Event]()
    for event in events:
        for replaced in {*SPEEDS, event.kind} if event.kind in {*SPEEDS, GOES_ON} else {event.kind}:
            told.pop(replaced, None)
        told[event.kind] = event  # in the order in which they came
        if event.kind in STOP_OVER:
            told.pop(PULLS_OVER, None)
        elif event.kind == RELEASED:
            told = {kind: each for kind, each in told.items() if kind in (PULLS_OVER, RELEASED)}
    news = list(told.values())[-1:]
    said = [
        f"{event.text.removeprefix('driver ')}, {now.time_s - event.time_s:.0f} s ago"
        for event in told.values()
        if event.kind in HEEDS or (event in news and now.time_s - event.time_s < NEWS_S)
    ]
    if PULLS_OVER in told and now.driving.standing_s >= 1.0:
        said.append(f"the car stands for {now.driving.standing_s:.0f} s")
    if said:
        yield f"driver: {'; '.join(said)}"
