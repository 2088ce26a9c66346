"""How many staged events of drives occur, and how well agents watch, over families and seeds.

    python benchmarks/drives.py                                  # all families, seed 0: nobody at the cockpit
    python benchmarks/drives.py beauce_june grid_january --seeds 0 1 2 3 4
    python benchmarks/drives.py --watch perfect late             # runs these watchers and scores them
    python benchmarks/drives.py --watch perfect --seeds 0 1 2 3 4 --keep runs/perfect    # resumes; docs/drives.md
    python benchmarks/drives.py --watch silent always wakes often late    # the negative controls, in one table

"Staged" counts what the scripts ask for. In the do-nothing run, an event *occurred* if its kind required an act
within five minutes, and a look-alike if nothing of its kind did while it lasted. None of this depends on how
busy the machine is.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from statistics import mean

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.errands import with_errands
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.events.tracker import Tracker
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import JudgedAct, JudgedEvent, Judgement
from automotive_cosim.drives.score import Score, score, together
from automotive_cosim.drives.script import APART_S, Staged
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.watchers import AlertAll, AlertOften, AlertOnWake, RulePerfect, Silent
from automotive_cosim.episode.session import play
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import CosimError
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.run.job_row import from_json
from automotive_cosim.traffic.fork import Simulations

WATCHERS: Mapping[str, Callable[[], RulePerfect | Silent | AlertAll | AlertOnWake | AlertOften]] = {
    "perfect": RulePerfect,
    "late": lambda: RulePerfect(8.0),
    "silent": Silent,
    "always": AlertAll,
    "wakes": AlertOnWake,
    "often": AlertOften,
}
LATEST_S = 300.0
"""An event occurs within this time after it was staged: a tyre leaks for minutes, an incident lies ahead."""
STEPS = 10**6
FIGURES = ("hours", "events", "recall", "false/h", "repeats/h", "score")
"""Columns of ``_row``, after the name."""


@dataclass(frozen=True, slots=True)
class Found:
    """An event of the do-nothing run; seconds since departure."""

    kind: str
    observable_s: float
    obliged_s: float | None


@dataclass(frozen=True, slots=True)
class Kept:
    """What is kept of one drive."""

    family: str
    seed: int
    watcher: str
    driven_s: float
    distance_m: float
    staged: tuple[Staged, ...]
    untouched: tuple[Found, ...]
    events: tuple[JudgedEvent, ...]
    acts: tuple[JudgedAct, ...]
    short_ttc_s: float
    """Near-collision time (``drives.harm``)."""
    untouched_short_ttc_s: float
    """The same in the do-nothing run."""

    @property
    def score(self) -> Score:
        """The watcher's."""
        return score(Judgement(self.events, self.acts), self.driven_s)

    def came_off(self, staged: Staged) -> bool:
        """Whether the staged event happened in the do-nothing run."""
        latest_s = APART_S if staged.is_lookalike else LATEST_S
        due_s = [
            event.observable_s if staged.is_lookalike else event.obliged_s
            for event in self.untouched
            if event.kind == staged.kind and event.obliged_s is not None
        ]
        due = any(staged.at_s - 1 <= at_s <= staged.at_s + latest_s for at_s in due_s)
        return due != staged.is_lookalike


def played(who: str, family: str, seed: int, simulations: Simulations, *, errands: bool = False) -> Kept:
    """One drive by one watcher."""
    drawn, agent = FAMILIES[family].draw(seed), WATCHERS[who]()
    script = with_errands(drawn) if errands else drawn
    setup = SessionSetup(max_steps=STEPS, max_sim_s=script.duration_s, channels=agent.channels)
    with closing(DriveSession.depart_with(depart(script, simulations), setup)) as session:
        agent.reset(session.goal)
        play(session, agent)
        assert session.judgement is not None
        mine, baseline = session.harms
        return Kept(
            family,
            seed,
            who,
            session.seconds,
            session.moments[-1].driving.distance_m,
            script.staged,
            tuple(found(session.baseline_moments)),
            session.judgement.events,
            session.judgement.acts,
            mine.short_ttc_s,
            baseline.short_ttc_s,
        )


def found(drive: Sequence[Moment]) -> Iterator[Found]:
    """The events of a drive, without look-alikes."""
    tracker = Tracker(KINDS)
    for count in range(1, len(drive) + 1):
        tracker.see(drive[:count])
    begin_s = drive[0].time_s
    for event in tracker.events:
        if not event.lookalike:
            obliged_s = None if event.obliged_s is None else event.obliged_s - begin_s
            yield Found(event.kind, event.observable_s - begin_s, obliged_s)


# --- tables --------------------------------------------------------------------------------------------------


def staged(drives: Sequence[Kept]) -> Iterator[str]:
    """Staged events that occurred, by family, then by kind."""
    yield from _table(
        ("family", "drives", "km", "staged", "occurred", "events"),
        (
            (
                name,
                len(kept),
                f"{mean(drive.distance_m for drive in kept) / 1000:.1f}",
                sum(len(drive.staged) for drive in kept),
                f"{mean(drive.came_off(one) for drive in kept for one in drive.staged):.0%}",
                f"{mean(sum(each.obliged_s is not None for each in drive.untouched) for drive in kept):.1f}",
            )
            for name, kept in _by_family(drives)
        ),
    )
    yield ""
    came: dict[tuple[str, bool], list[bool]] = defaultdict(list)
    for drive in drives:
        for one in drive.staged:
            came[one.kind, one.is_lookalike].append(drive.came_off(one))
    rows = []
    for kind in sorted({kind for kind, _ in came}):
        halves = [came[kind, is_lookalike] for is_lookalike in (False, True)]
        rows.append((kind, *(part for each in halves for part in (len(each), f"{mean(each or [0]):.0%}"))))
    yield from _table(("kind", "staged", "occurred", "lookalikes", "occurred"), rows)


def watched(drives: Sequence[Kept]) -> Iterator[str]:
    """How well a watcher did, by family, then by kind."""
    rows = [_row(name, together([drive.score for drive in kept])) for name, kept in _by_family(drives)]
    rows.append(_row("all", together([drive.score for drive in drives])))
    yield from _table(("family", *FIGURES), rows)
    yield ""
    events, met, void = Counter[str](), Counter[str](), Counter[str]()
    for event in (event for drive in drives for event in drive.events if not event.lookalike):
        events[event.kind] += event.outcome.counts
        met[event.kind] += event.outcome.is_credited
        void[event.kind] += event.outcome.value == "void"
    lookalikes, taken = Counter[str](), Counter[str]()
    for event in (event for drive in drives for event in drive.events if event.lookalike):
        lookalikes[event.kind] += 1
        taken[event.kind] += event.outcome.value == "taken"
    yield from _table(
        ("kind", "events", "recall", "void", "look-alikes", "taken"),
        (
            (
                kind,
                events[kind],
                f"{met[kind] / events[kind]:.0%}" if events[kind] else "-",
                void[kind],
                lookalikes[kind],
                taken[kind],
            )
            for kind in KINDS
        ),
    )


def compared(whos: Sequence[str], drives: Sequence[Kept]) -> Iterator[str]:
    """Watchers, one line each, with the lowest and the highest score of a family, and the near-collision time."""
    rows = []
    for who in whos:
        mine = [drive for drive in drives if drive.watcher == who]
        values = [together([drive.score for drive in kept]).value for _, kept in _by_family(mine)]
        spread = f"{min(values):.0f} to {max(values):.0f}" if values else "-"
        near_s = f"{sum(drive.short_ttc_s for drive in mine):.0f}"
        baseline_s = f"{sum(drive.untouched_short_ttc_s for drive in mine):.0f}"
        rows.append((*_row(who, together([drive.score for drive in mine])), spread, near_s, baseline_s))
    yield from _table(("watcher", *FIGURES, "by family", "near collision, s", "without it"), rows)


def _row(name: str, total: Score) -> tuple[object, ...]:
    recall = "-" if total.recall is None else f"{total.recall:.1%}"
    false, repeats = total.false_alarms_per_h, total.nuisances_per_h - total.false_alarms_per_h
    return (
        name,
        f"{total.driven_s / 3600:.1f}",
        total.events,
        recall,
        f"{false:.2f}",
        f"{repeats:.2f}",
        f"{total.value:.0f}",
    )


def _by_family(drives: Sequence[Kept]) -> Iterator[tuple[str, list[Kept]]]:
    for name in FAMILIES:
        kept = [drive for drive in drives if drive.family == name]
        if kept:
            yield name, kept


def _table(head: Sequence[str], rows: Iterator[Sequence[object]] | Sequence[Sequence[object]]) -> Iterator[str]:
    """In Markdown."""
    yield f"| {' | '.join(head)} |"
    yield "|" + "---|" * len(head)
    for row in rows:
        yield f"| {' | '.join(map(str, row))} |"


# --- what is kept ----------------------------------------------------------------------------------------------


def run(
    whos: Sequence[str],
    families: Sequence[str],
    seeds: Sequence[int],
    folder: Path | None,
    minutes: float,
    *,
    errands: bool = False,
) -> list[Kept]:
    """Every drive, read from the folder of finished drives or else run, as far as the time allows."""
    until, drives = time.monotonic() + 60 * minutes, []
    with closing(Simulations(count_limit=2)) as simulations:
        for who, seed, family in product(whos, seeds, families):
            file = None if folder is None else folder / f"{who}-{family}-{seed}{'-errands' * errands}.json"
            if file is not None and file.exists():
                drives.append(from_json(Kept, json.loads(file.read_text("utf-8"))))
            elif time.monotonic() < until:
                begun_s = time.monotonic()
                try:
                    drives.append(played(who, family, seed, simulations, errands=errands))
                except CosimError as error:
                    print(f"{who} {family} {seed}: {error}", file=sys.stderr, flush=True)
                    continue
                print(*_news(drives[-1], time.monotonic() - begun_s), sep="\n", file=sys.stderr, flush=True)
                if file is not None:
                    write_whole(file, json.dumps(asdict(drives[-1])))
    return drives


def _news(drive: Kept, took_s: float) -> Iterator[str]:
    """One drive as it ends: its figures, and each event that was not met and each act that was a nuisance."""
    found = drive.score
    yield (
        f"{drive.watcher} {drive.family} {drive.seed}: {found.met} of {found.events} met, "
        f"{found.nuisances} nuisances, {took_s:.0f} s"
    )
    for event in drive.events:
        if event.outcome.counts and not event.outcome.is_credited:
            at_s = event.obliged_s or event.observable_s
            yield f"    {event.outcome} at {at_s:.0f} s: {event.kind}, {event.words}"
    for act in drive.acts:
        if act.worth.is_nuisance:
            yield f"    {act.worth} at {act.time_s:.0f} s: {act.words} {act.about}"


def main() -> None:
    parser = argparse.ArgumentParser(description="The events that drives stage, and how many occur.")
    parser.add_argument("families", nargs="*", default=list(FAMILIES))
    parser.add_argument("--seeds", nargs="+", type=int, default=[0])
    parser.add_argument("--watch", nargs="+", choices=WATCHERS, help="run these watchers instead of none")
    parser.add_argument("--keep", type=Path, help="folder of finished drives, which are not rerun")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="start no drive after this time")
    parser.add_argument("--errands", action="store_true", help="people aboard also ask for things")
    asked = parser.parse_args()
    if asked.keep is not None:
        asked.keep.mkdir(parents=True, exist_ok=True)
    whos = asked.watch or ["silent"]
    drives = run(whos, asked.families, asked.seeds, asked.keep, asked.minutes, errands=asked.errands)
    print(f"{len(drives)} drives, {sum(drive.driven_s for drive in drives) / 3600:.1f} h", end="\n\n")
    if asked.watch:
        print(*compared(asked.watch, drives), sep="\n", end="\n\n")
    for who in asked.watch or ():
        print(f"{who}:", *watched([drive for drive in drives if drive.watcher == who]), sep="\n", end="\n\n")
    print(*staged(drives), sep="\n")


if __name__ == "__main__":
    main()
