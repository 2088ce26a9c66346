"""ASURADA's memory: which strategy worked where, stored in an SQLite file across episodes.

It is off by default, because episodes that learn from each other are no longer independent.
"""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from automotive_cosim.agents.lines import one_line
from automotive_cosim.contracts import Json, Observation
from automotive_cosim.errors import UserError
from automotive_cosim.formats.words import shown

MOST_STRATEGIES = 500
MOST_RECALLED = 3
LONGEST = 600
"""Maximum length of each of a strategy's texts."""
STOP_WORDS = frozenset(re.findall(r"\w+", "a an and the i is it my me to for of on in at you please can do"))

_TABLE = """
CREATE TABLE IF NOT EXISTS strategies (
    place TEXT NOT NULL,
    goal TEXT NOT NULL,
    trigger TEXT NOT NULL,
    steps TEXT NOT NULL,
    worked INTEGER NOT NULL DEFAULT 0,
    failed INTEGER NOT NULL DEFAULT 0,
    used INTEGER NOT NULL,
    PRIMARY KEY (place, goal, steps)
)
"""


@dataclass(frozen=True, slots=True)
class Strategy:
    """A strategy: what was done, where, and for what request."""

    place: str
    """Country and city, or the position to a tenth of a degree if nothing else is known."""
    goal: str
    """What the driver said."""
    trigger: str
    """The situation when it began."""
    steps: str
    """The actions, in order."""
    worked: int = 0
    """Number of episodes in which it worked."""
    failed: int = 0

    @property
    def words(self) -> str:
        """The strategy on one line, for a prompt."""
        return (
            f"At {self.place}, asked {self.goal!r} ({self.trigger}): {self.steps}; worked {self.worked} times, "
            f"failed {self.failed}"
        )

    def as_json(self) -> Json:
        return asdict(self)


class Memory:
    """An SQLite file of strategies; when there are too many, those unused for longest are removed."""

    def __init__(self, path: Path, most: int = MOST_STRATEGIES) -> None:
        """Opens or creates the file. Raises UserError: it cannot be created, or is not a memory."""
        self._path = path
        self._most = most
        with self._open() as file:
            file.execute(_TABLE)

    def keep(self, strategy: Strategy, *, worked: bool) -> None:
        """Records that a strategy worked, or did not, one more time."""
        texts = [value[:LONGEST] for value in (strategy.place, strategy.goal, strategy.trigger, strategy.steps)]
        with self._open() as file:
            file.execute(
                "INSERT INTO strategies (place, goal, trigger, steps, worked, failed, used)"
                " VALUES (?, ?, ?, ?, ?, ?, (SELECT COALESCE(MAX(used), 0) + 1 FROM strategies))"
                " ON CONFLICT (place, goal, steps) DO UPDATE SET worked = worked + excluded.worked,"
                " failed = failed + excluded.failed, trigger = excluded.trigger, used = excluded.used",
                (*texts, int(worked), int(not worked)),
            )
            file.execute(
                "DELETE FROM strategies WHERE rowid NOT IN"
                " (SELECT rowid FROM strategies ORDER BY used DESC LIMIT ?)",
                (self._most,),
            )

    def recall(self, place: str, goal: str) -> tuple[Strategy, ...]:
        """Strategies that worked at a place for a similar goal, best first: more common words, then more
        successes."""
        asked = _content(goal)
        known = [
            (len(asked & _content(strategy.goal)), strategy.worked - strategy.failed, strategy)
            for strategy in self.all()
            if strategy.place == place and strategy.worked > strategy.failed
        ]
        best = sorted((entry for entry in known if entry[0]), key=lambda entry: (-entry[0], -entry[1]))
        return tuple(strategy for _, _, strategy in best[:MOST_RECALLED])

    def all(self) -> tuple[Strategy, ...]:
        """All strategies, the latest first."""
        with self._open() as file:
            rows = file.execute(
                "SELECT place, goal, trigger, steps, worked, failed FROM strategies ORDER BY used DESC"
            )
            return tuple(map(self._strategy, rows))

    def _strategy(self, row: Sequence[object]) -> Strategy:
        match row:
            case [str(place), str(goal), str(trigger), str(steps), int(worked), int(failed)]:
                return Strategy(place, goal, trigger, steps, worked, failed)
        raise UserError(f"cannot use {self._path} as a memory: it has a strategy {shown(row)}; give another file")

    @contextmanager
    def _open(self) -> Iterator[sqlite3.Connection]:
        if self._path.exists() and not self._path.is_file():
            raise UserError(f"cannot use {self._path} as a memory: it is not a regular file; give another file")
        try:
            with closing(sqlite3.connect(self._path, timeout=30)) as file, file:
                yield file
        except (sqlite3.Error, UnicodeDecodeError) as error:  # the latter of a message that quotes damaged text
            why = one_line(str(error))
            raise UserError(f"cannot use {self._path} as a memory: {why}; give another file") from error


def where(seen: Observation) -> str:
    """The place by which the memory stores strategies."""
    first = (seen.context or "").partition("\n")[0]
    if first.startswith("Place: "):
        return first.removeprefix("Place: ")
    if seen.gps is not None:
        return f"{seen.gps.lat_deg:.1f}, {seen.gps.lon_deg:.1f}"
    return "unknown"


def why(seen: Observation) -> str:
    """The situation in a few words: what may have prompted the action."""
    parts = [] if seen.vehicle is None else [f"{seen.vehicle.speed_kmh:.0f} km/h"]
    for line in (seen.context or "").split("\n"):
        if line.startswith(("Speed limit here: ", "Weather: ")):
            parts.append(line)
    return "; ".join(parts) or "nothing known"


def _content(text: str) -> frozenset[str]:
    return frozenset(re.findall(r"\w+", text.casefold())) - STOP_WORDS
