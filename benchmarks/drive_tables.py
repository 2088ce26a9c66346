"""Whether a drive can be scored without watching: by stopping, by crawling, by tables of words.

    python benchmarks/drive_tables.py                          # five families, seed 0
    python benchmarks/drive_tables.py grid_june --seeds 0 1 --unseen 2 --keep runs/tables

Three things are tried:

* strategies that watch nothing are played: stop at once, stop again and again, crawl at once, crawl all the time;
* tables over the words of results: these say only that something changed, so a table is one or two kinds of alert
  in turn, and how long it keeps quiet then. All of them are tried;
* tables over the names of the readings that changed, with an alert or none for each, found by coordinate ascent.
  These need the car's readings, not only the results.

Tables are tried on the record of a drive with nobody at the cockpit, thousands in a minute; the best of each search
is then judged on the record of the same families with other seeds, and played on the drives themselves, as is the
table that a person would write.

A search with so many entries fits any drives to some degree, also by readings that have nothing to do with what
happens next. What a table is worth is its score on drives that it was not fitted to.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from typing import TypeVar

from automotive_cosim.contracts import Action, ActionType, AlertKind, Observation
from automotive_cosim.drives.alarm import Alarm
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.events import KINDS, DriveAct, DriveEvent, EventKind, Tracker
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import facts_of, judge
from automotive_cosim.drives.score import Score, score, together
from automotive_cosim.drives.session import CHANGED, DriveSession
from automotive_cosim.drives.wakes import WAKES
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.interface.observe import Channel
from automotive_cosim.run.row import from_json
from automotive_cosim.traffic.fork import Simulations

FAMILIES_TRIED = ("grid_june", "paris_november", "autobahn_january", "border_july", "nordic_december")
QUIET_S = (30.0, 61.0, 120.0, 300.0, 600.0)
"""How long a table keeps quiet after it has given a kind of alert."""
MOST = 15.0
"""No strategy may score more over all families."""

Kind = TypeVar("Kind")
Table = Mapping[str, AlertKind]
"""An alert by the name of the reading that changed."""
BY_HAND: Table = {
    "speed": AlertKind.SPEED,
    "belt": AlertKind.SEAT_BELT,
    "phone": AlertKind.DISTRACTION,
    "open": AlertKind.VEHICLE,
    "tyres": AlertKind.VEHICLE,
    "range": AlertKind.VEHICLE,
    "jam": AlertKind.TRAFFIC,
    "breakdown": AlertKind.MOVE_OVER,
    "roadworks": AlertKind.TRAFFIC,
    "behind": AlertKind.MOVE_OVER,
    "glass": AlertKind.VISIBILITY,
    "rain": AlertKind.VISIBILITY,
}
"""The table that a person would write."""


# --- tables, on record -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Untouched:
    """A drive with nobody at the cockpit."""

    family: str
    seed: int
    begun_s: float
    driven_s: float
    events: tuple[DriveEvent, ...]
    changes: tuple[tuple[float, tuple[str, ...]], ...]
    """Simulation times at which something changed that wakes, and the names of the readings."""
    facts: Mapping[str, tuple[str | None, ...]]
    """By kind, what spoke against a warning of it at each of these times."""

    def scored(self, acts: Sequence[DriveAct]) -> Score:
        """The score of acts at some of these times."""
        number = {at_s: index for index, (at_s, _) in enumerate(self.changes)}

        def against(kind: EventKind, time_s: float) -> str | None:
            return self.facts[kind.name][number[time_s]]

        return score(judge(KINDS, self.events, acts, {}, against), self.driven_s)


def untouched(family: str, seed: int, simulations: Simulations) -> Untouched:
    """Drives with nobody at the cockpit."""
    script = FAMILIES[family].draw(seed)
    tracker, alarm, changes = Tracker(KINDS), Alarm(), []
    with closing(depart(script, simulations)) as world:
        moments = [world.moment]
        while moments[-1].time_s < moments[0].time_s + script.duration_s:
            tracker.see(moments)
            names = tuple(change.name for change in alarm.see(moments[-20:]) if change.wakes)
            if names:
                changes.append((moments[-1].time_s, names))
            moments += world.advance(1.0)
    against, begun_s = facts_of(moments), moments[0].time_s
    facts = {name: tuple(against(kind, at_s) for at_s, _ in changes) for name, kind in KINDS.items()}
    driven_s = moments[-1].time_s - begun_s
    return Untouched(family, seed, begun_s, driven_s, tuple(tracker.events), tuple(changes), facts)


def of_results(drive: Untouched, alerts: Sequence[AlertKind], quiet_s: float) -> list[DriveAct]:
    """These alerts in turn, whenever something changed and nothing was said for so long."""
    acts: list[DriveAct] = []
    for at_s, _ in drive.changes:
        if not acts or at_s - acts[-1].time_s >= quiet_s:
            acts.append(DriveAct(at_s, alerts[len(acts) % len(alerts)]))
    return acts


def of_names(drive: Untouched, table: Table, quiet_s: float) -> list[DriveAct]:
    """The alert of the first reading that changed and is in the table, if it was not given for so long."""
    acts: list[DriveAct] = []
    told_s: dict[AlertKind, float] = {}
    for at_s, names in drive.changes:
        alert = next((table[name] for name in names if name in table), None)
        if alert is not None and at_s - told_s.get(alert, -quiet_s) >= quiet_s:
            told_s[alert] = at_s
            acts.append(DriveAct(at_s, alert))
    return acts


def acts_of(drive: Untouched, table: Table | Sequence[AlertKind], quiet_s: float) -> list[DriveAct]:
    """What either kind of table does on a drive."""
    if isinstance(table, Mapping):
        return of_names(drive, table, quiet_s)
    return of_results(drive, table, quiet_s)


def of_hand(drives: Sequence[Untouched], quiet_s: float = 61.0) -> tuple[float, Table, float, int]:
    """The same as of a search for the table that a person would write."""
    value = together([drive.scored(of_names(drive, BY_HAND, quiet_s)) for drive in drives]).value
    return value, BY_HAND, quiet_s, len(drives)


def best_of_results(drives: Sequence[Untouched]) -> tuple[float, tuple[AlertKind, ...], float, int]:
    """The best score of a table over the words of results, the table, its quiet time, and how many were tried."""
    singles = [(alert,) for alert in AlertKind]
    tables = [*singles, *((one, other) for one, other in product(AlertKind, repeat=2) if one is not other)]
    found = [
        (together([drive.scored(of_results(drive, table, quiet_s)) for drive in drives]).value, table, quiet_s)
        for table in tables
        for quiet_s in QUIET_S
    ]
    value, table, quiet_s = max(found, key=lambda each: each[0])
    return value, table, quiet_s, len(found) * len(drives)


def best_of_names(drives: Sequence[Untouched]) -> tuple[float, dict[str, AlertKind], float, int]:
    """The same over the names of readings: coordinate ascent from the empty table, for each quiet time."""
    tried = 0

    def value(table: Table, quiet_s: float) -> float:
        nonlocal tried
        tried += len(drives)
        return together([drive.scored(of_names(drive, table, quiet_s)) for drive in drives]).value

    best: tuple[float, dict[str, AlertKind], float] = (0.0, {}, QUIET_S[0])
    for quiet_s in QUIET_S[1:3]:
        table: dict[str, AlertKind] = {}
        reached, rises = 0.0, True
        while rises:
            rises = False
            for wake in WAKES:
                for alert in (None, *AlertKind):
                    other = {name: kind for name, kind in table.items() if name != wake.name}
                    if alert is not None:
                        other[wake.name] = alert
                    now = value(other, quiet_s)
                    if now > reached + 1e-9:
                        table, reached, rises = other, now, True
        best = max(best, (reached, table, quiet_s), key=lambda each: each[0])
    return (*best, tried)


# --- strategies, on the road -----------------------------------------------------------------------------------

WAIT = Action(ActionType.WAIT)


class Blind:
    """Reads nothing but results."""

    name = model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self, act: Callable[[float, bool], Action | None]) -> None:
        """From the seconds since departure and whether something changed, an action, or None to wait."""
        self._act = act
        self._waited = True

    def reset(self, goal: str) -> None:
        """Does nothing."""

    def act(self, observation: Observation) -> Action:
        """An action, then a wait."""
        if not self._waited:
            self._waited = True
            return WAIT
        action = self._act(observation.time_s, CHANGED in observation.feedback.text)
        self._waited = action is None
        return action or WAIT


def at_once(action: Action) -> Blind:
    """The action in the first second."""
    done: list[float] = []
    return Blind(lambda at_s, changed: None if done or done.append(at_s) else action)  # type: ignore[func-returns-value]


def again(action: Action, every_s: float) -> Blind:
    """The action now and again."""
    done: list[float] = []

    def act(at_s: float, changed: bool) -> Action | None:
        if done and at_s - done[-1] < every_s:
            return None
        done.append(at_s)
        return action

    return Blind(act)


def told(alerts: Sequence[AlertKind], quiet_s: float) -> Blind:
    """A table over the words of results."""
    done: list[float] = []

    def act(at_s: float, changed: bool) -> Action | None:
        if not changed or (done and at_s - done[-1] < quiet_s):
            return None
        done.append(at_s)
        return Action(ActionType.SHOW_ALERT, kind=alerts[(len(done) - 1) % len(alerts)])

    return Blind(act)


class ByName:
    """A table over the names of the readings that changed."""

    name = model = "none"
    channels = frozenset({Channel.VEHICLE})

    def __init__(self, table: Table, quiet_s: float, parks: bool = False) -> None:
        """With ``parks``, it has the car stopped instead of giving the alert."""
        self._table, self._quiet_s, self._parks = table, quiet_s, parks
        self.reset("")

    def reset(self, goal: str) -> None:
        """Forgets what it has told."""
        self._told_s: dict[AlertKind, float] = {}

    def act(self, observation: Observation) -> Action:
        """The alert of the first reading that changed and is in the table, else a wait."""
        noticed = "" if observation.vehicle is None else observation.vehicle.noticed or ""
        for line in noticed.splitlines():
            name, mark, words = line.partition(" (changed): ")
            alert = self._table.get(name) if mark and words != "ended" else None
            if alert is not None and observation.time_s - self._told_s.get(alert, -self._quiet_s) >= self._quiet_s:
                self._told_s[alert] = observation.time_s
                return Action(ActionType.PULL_OVER) if self._parks else Action(ActionType.SHOW_ALERT, kind=alert)
        return WAIT


STOP, CRAWL = Action(ActionType.PULL_OVER), Action(ActionType.REQUEST_SLOW_DOWN, speed_kmh=20.0)
Strategy = Blind | ByName
STRATEGIES: Mapping[str, Callable[[], Strategy]] = {
    "stops at once": lambda: at_once(STOP),
    "stops every 150 s": lambda: again(STOP, 150.0),
    "crawls at once": lambda: at_once(CRAWL),
    "crawls all the time": lambda: again(CRAWL, 115.0),
    "names, by hand": lambda: ByName(BY_HAND, 61.0),
    "names, by hand, and stops": lambda: ByName(BY_HAND, 61.0, parks=True),
}


def played(strategy: Strategy, family: str, seed: int, simulations: Simulations) -> Score:
    """One drive."""
    script = FAMILIES[family].draw(seed)
    setup = SessionSetup(max_steps=10**6, max_sim_s=script.duration_s, channels=strategy.channels)
    with closing(DriveSession.depart_with(depart(script, simulations), setup)) as session:
        play(session, strategy)
        assert session.judgement is not None
        return score(session.judgement, session.seconds)


# --- the command -----------------------------------------------------------------------------------------------


def kept(kind: type[Kind], file: Path | None, make: Callable[[], Kind]) -> Kind:
    """What a file holds, else what is made, which the file then holds."""
    if file is not None and file.exists():
        return from_json(kind, json.loads(file.read_text("utf-8")))
    made = make()
    if file is not None:
        draft = file.with_suffix(".part")
        draft.write_text(json.dumps(asdict(made)), "utf-8")  # type: ignore[call-overload]
        draft.replace(file)
    return made


def lines(
    families: Sequence[str], seeds: Sequence[int], unseen: Sequence[int], folder: Path | None, live: bool
) -> Iterator[str]:
    """The result, in Markdown."""
    where = list(product(families, seeds))
    with closing(Simulations(count_limit=1)) as simulations:

        def file(name: str, family: str, seed: int) -> Path | None:
            return None if folder is None else folder / f"{name}-{family}-{seed}.json"

        def recorded(family: str, seed: int) -> Untouched:
            made = file("untouched", family, seed)
            return kept(Untouched, made, lambda: untouched(family, seed, simulations))

        drives = [recorded(family, seed) for family, seed in where]
        others = [recorded(family, seed) for family, seed in product(families, unseen)]
        by_results, by_names = best_of_results(drives), best_of_names(drives)
        hours = sum(drive.driven_s for drive in (*drives, *others)) / 3600
        yield f"{len(drives)} drives and {len(others)} others, {hours:.1f} h"
        yield ""
        yield "| tables on record | judged drives | best score | on the other drives | the best |"
        yield "|---|---|---|---|---|"
        for name, (value, table, quiet_s, tried) in (
            ("results", by_results),
            ("names", by_names),
            ("names, by hand", of_hand(drives)),
        ):
            words = ", ".join(table) if isinstance(table, tuple) else _words(table)
            elsewhere = together([drive.scored(acts_of(drive, table, quiet_s)) for drive in others]).value
            there = f"{elsewhere:.0f}" if others else ""
            yield f"| {name} | {tried} | {value:.0f} | {there} | {words or 'none'}, quiet for {quiet_s:.0f} s |"
        if not live:
            return
        strategies = dict(STRATEGIES) | {
            "results, the best": lambda: told(by_results[1], by_results[2]),
            "names, the best": lambda: ByName(by_names[1], by_names[2]),
        }
        yield ""
        yield "| on the road | score | by family |"
        yield "|---|---|---|"
        for name, strategy in strategies.items():
            slug = name.replace(", ", "-").replace(" ", "-")
            scores = {
                (family, seed): kept(
                    Score,
                    file(slug, family, seed),
                    lambda f=family, s=seed, w=strategy: played(w(), f, s, simulations),  # type: ignore[misc]
                )
                for family, seed in where
            }
            each = [together([scores[family, seed] for seed in seeds]).value for family in families]
            total = together(list(scores.values())).value
            yield f"| {name} | {total:.0f} | {', '.join(f'{value:.0f}' for value in each)} |"


def _words(table: Mapping[str, AlertKind]) -> str:
    return ", ".join(f"{name}: {alert}" for name, alert in table.items())


def main() -> None:
    parser = argparse.ArgumentParser(description="Whether a drive can be scored without watching.")
    parser.add_argument("families", nargs="*", default=list(FAMILIES_TRIED))
    parser.add_argument("--seeds", nargs="+", type=int, default=[0])
    parser.add_argument("--unseen", nargs="*", type=int, default=[1], help="seeds that no table is fitted to")
    parser.add_argument("--keep", type=Path, help="folder of finished drives, which are not rerun")
    parser.add_argument("--on-record", action="store_true", help="search tables, and play nothing")
    asked = parser.parse_args()
    if asked.keep is not None:
        asked.keep.mkdir(parents=True, exist_ok=True)
    for line in lines(asked.families, asked.seeds, asked.unseen, asked.keep, not asked.on_record):
        print(line, flush=True)
    sys.stdout.flush()


if __name__ == "__main__":
    main()
