"""When a wait ends: the readings of a drive as an agent is told of them, and which of them have changed."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field

from automotive_cosim.drives.changes import EASED_S, WAKES, Drive, Level, Nearness, Wake


def noticed(drive: Drive, changed: Sequence[str] = ()) -> str:
    """Every reading of the car, one line each: its name, whether it has changed, and its words.

    Args:
        drive: the moments so far.
        changed: names of what has changed since the last look; of those that are no longer there, that they ended.
    """
    lines = []
    for wake in WAKES:
        words = wake.words(drive)
        has_changed = wake.name in changed
        if words or has_changed:
            lines.append(f"{wake.name}{' (changed)' if has_changed else ''}: {words or wake.ended}")
    return "\n".join(lines)


@dataclass(frozen=True, slots=True)
class Noticed:
    """One change that an agent is told of."""

    name: str
    """Of the reading."""
    wakes: bool
    """Whether it ends a wait; what has ended is only told with the next observation."""


@dataclass(slots=True)
class _Told:
    reading: Hashable = None
    differs_since_s: float | None = None
    """Since when the reading has been another; None while it is this one."""


@dataclass(slots=True)
class Alarm:
    """Watches one drive for what wakes."""

    wakes: tuple[Wake, ...] = WAKES
    _told: tuple[_Told, ...] = field(init=False)
    """What was told last of each."""

    def __post_init__(self) -> None:
        self._told = tuple(_Told() for _ in self.wakes)

    def see(self, drive: Drive) -> tuple[Noticed, ...]:
        """What has changed at the newest moment. At the first, whatever there is to report."""
        found = []
        now, now_s = drive[-1], drive[-1].time_s
        for wake, told in zip(self.wakes, self._told, strict=True):
            reading = wake.reads(now)
            if reading == told.reading or (reading := _risen(reading, told.reading)) == told.reading:
                told.differs_since_s = None
                continue
            if told.differs_since_s is None:
                told.differs_since_s = now_s
            eases = isinstance(reading, Level) and isinstance(told.reading, Level) and reading <= told.reading
            hold_s = EASED_S if eases else wake.hold_s
            if now_s - told.differs_since_s < hold_s:
                continue
            told.reading, told.differs_since_s = reading, None
            is_far = isinstance(reading, Nearness) and not reading.number
            if not eases and not is_far:
                found.append(Noticed(wake.name, wakes=reading is not None))
        return tuple(found)


def _risen(reading: Hashable, told: Hashable) -> Hashable:
    """A reading; the step of what was told before if it is no nearer, as in a queue, or no worse in one of its
    kinds."""
    if isinstance(reading, Level) and isinstance(told, Level) and not reading <= told:
        return Level(tuple(map(max, reading.steps, told.steps)))
    if isinstance(reading, Nearness) and isinstance(told, Nearness) and reading.what == told.what:
        return told if reading.number <= told.number else reading
    return reading
