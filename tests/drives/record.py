"""What happens on one drive of each family with nobody at the cockpit, on record, so that their laws need no SUMO.

python -m tests.drives.record            # families whose script has changed since
python -m tests.drives.record --renew    # drives these and stores what happened: some ten seconds a drive
python -m tests.drives.record --renew all
python -m tests.drives.record --renew border_july grid_june
python -m tests.drives.record --staged   # how many of the staged situations came off
"""

import json
import lzma
import sys
from bisect import bisect_right
from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import asdict, dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path

from automotive_cosim.drives.alarm import Alarm
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.events import KINDS, DriveEvent, EventKind, Tracker
from automotive_cosim.drives.events.errands import UNASKED
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import facts_of
from automotive_cosim.drives.script import APART_S, script_json
from automotive_cosim.run.job_row import from_json
from automotive_cosim.traffic.fork import Simulations

FILE = Path(__file__).with_name("record.json.xz")
SEED = 0
FACTS_S = 30
"""How often facts are looked up, in seconds."""


@dataclass(frozen=True)
class Recorded:
    """One drive with nobody at the cockpit."""

    script_sha256: str
    begun_s: float
    """Simulation time at departure."""
    driven_s: float
    events: tuple[DriveEvent, ...]
    """Look-alikes too."""
    wakes_s: tuple[float, ...]
    """Simulation times at which something changed that wakes."""
    facts: Mapping[str, tuple[tuple[float, str | None], ...]]
    """By kind, what speaks against a warning of it, from which of ``facts_s`` on."""
    facts_s: tuple[float, ...]
    """Simulation times at which the facts were looked up."""

    def against(self, kind: EventKind, time_s: float) -> str | None:
        """What spoke against a warning of a kind when the facts were looked up last."""
        known = self.facts.get(kind.name, ((0.0, UNASKED),))  # on record nobody asks for anything
        return known[max(0, bisect_right(known, time_s, key=lambda fact: fact[0]) - 1)][1]


def sha(family: str) -> str:
    """Of the script that would be driven now."""
    return sha256(script_json(FAMILIES[family].draw(SEED)).encode()).hexdigest()


@cache
def recorded() -> Mapping[str, Recorded]:
    """By family."""
    stored = json.loads(lzma.decompress(FILE.read_bytes())) if FILE.exists() else {}
    return {family: from_json(Recorded, values) for family, values in stored.items()}


def outdated() -> list[str]:
    """The families whose drive is not on record as it is drawn now."""
    known = recorded()
    return [family for family in FAMILIES if family not in known or known[family].script_sha256 != sha(family)]


def drive(family: str, simulations: Simulations) -> Recorded:
    """Drives it."""
    script = FAMILIES[family].draw(SEED)
    tracker, alarm, wakes_s, facts_s = Tracker(KINDS), Alarm(), [], []
    facts: dict[str, list[tuple[float, str | None]]] = {
        name: [] for name, kind in KINDS.items() if not kind.by_state
    }
    with closing(depart(script, simulations)) as world:
        moments = [world.moment]
        while moments[-1].time_s < moments[0].time_s + script.duration_s:
            tracker.see(moments)
            if any(change.wakes for change in alarm.see(moments)):
                wakes_s.append(moments[-1].time_s)
            if len(moments) % FACTS_S == 1:
                facts_s.append(moments[-1].time_s)
                against = facts_of(moments)
                for name, known in facts.items():
                    fact = against(KINDS[name], facts_s[-1])
                    if not known or known[-1][1] != fact:
                        known.append((facts_s[-1], fact))
            if not (passed := world.advance(1.0)):
                raise RuntimeError(f"{family} ends after {moments[-1].time_s - moments[0].time_s:.0f} s")
            moments += passed
    begun_s = moments[0].time_s
    events = tuple(tracker.events)
    told = {name: tuple(known) for name, known in facts.items()}
    driven_s = moments[-1].time_s - begun_s
    return Recorded(sha(family), begun_s, driven_s, events, tuple(wakes_s), told, tuple(facts_s))


def came_off() -> list[tuple[bool, bool]]:
    """For each staging of the drives on record, whether it is a look-alike, and whether it came off: events oblige
    within five minutes, look-alikes to nothing within 45 s, as in ``benchmarks/drives.py``."""
    came = []
    for family, seen in recorded().items():
        for one in FAMILIES[family].draw(SEED).staged:
            due_s = [
                (event.observable_s if one.is_lookalike else event.obliged_s) - seen.begun_s
                for event in seen.events
                if event.kind == one.kind and event.obliged_s is not None
            ]
            until_s = one.at_s + (APART_S if one.is_lookalike else 300.0)
            is_due = any(one.at_s - 1 <= at_s <= until_s for at_s in due_s)
            came.append((one.is_lookalike, is_due is not one.is_lookalike))
    return came


def renew(families: Iterable[str], known: dict[str, Recorded]) -> None:
    """Drives these families and stores what happened, with what is known of others."""
    with closing(Simulations(count_limit=1)) as simulations:
        for family in families:
            known[family] = drive(family, simulations)
            print(family, sum(event.obliged_s is not None for event in known[family].events), flush=True)
            stored = {name: asdict(known[name]) for name in FAMILIES if name in known}
            FILE.write_bytes(lzma.compress(json.dumps(stored).encode()))


if __name__ == "__main__":
    named = [each for each in sys.argv if each in FAMILIES]
    if "--staged" in sys.argv:
        for halves, is_lookalike in (("events", False), ("look-alikes", True)):
            came = [did for lookalike, did in came_off() if lookalike is is_lookalike]
            print(f"{halves}: {sum(came)} of {len(came)}")
    elif "all" in sys.argv:
        renew(FAMILIES, {})
    elif "--renew" in sys.argv:
        renew(named or outdated(), dict(recorded()))
    else:
        print(*outdated() or ["every family is on record as it is drawn now"], sep="\n")
