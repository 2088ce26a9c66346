"""What comes of what drives stage, and how well agents watch, over families and seeds.

    python benchmarks/drives.py                                  # all families, seed 0: nobody at the cockpit
    python benchmarks/drives.py beauce_june grid_january --seeds 0 1 2 3 4
    python benchmarks/drives.py --watch perfect late             # plays them, and scores what they do

Staged is what the plans ask for; it *came off* if an event of its kind (or a bait of its kind) was found on the
untouched drive by the time the next thing but two is staged. None of it depends on how busy the machine is.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from statistics import mean

from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.events.tracker import DriveEvent, Tracker
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.plan import DrivePlan, Staged
from automotive_cosim.drives.score import Score, score, together
from automotive_cosim.drives.watch import Watch
from automotive_cosim.drives.watchers import AlertAll, AlertOften, AlertOnWake, RulePerfect, Silent
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.specification import Conditions
from automotive_cosim.traffic.fork import Simulations

WATCHERS: Mapping[str, Callable[[], RulePerfect | Silent | AlertAll | AlertOnWake | AlertOften]] = {
    "perfect": RulePerfect,
    "late": lambda: RulePerfect(8.0),
    "silent": Silent,
    "always": AlertAll,
    "wakes": AlertOnWake,
    "often": AlertOften,
}
LATEST_S = 180.0
"""An event comes off by this time after it was staged; an incident ahead is met later than a belt."""
STEPS = 10**6


def found(plan: DrivePlan, simulations: Simulations) -> tuple[Sequence[DriveEvent], float]:
    """The events of the untouched drive, and its kilometres."""
    tracker = Tracker(KINDS)
    with closing(depart(plan, simulations)) as world:
        drive = [world.moment]
        tracker.see(drive)
        while world.moment.driving.end is None and world.moment.time_s - drive[0].time_s < plan.duration_s:
            for moment in world.advance(1.0):
                drive.append(moment)
                tracker.see(drive)
        begin_s = drive[0].time_s
        for event in tracker.events:
            event.observable_s -= begin_s
        return tracker.events, world.moment.driving.distance_m / 1000


def came_off(staged: Staged, events: Sequence[DriveEvent]) -> bool:
    """Whether something of its kind was found after it was staged."""
    return any(
        event.kind == staged.kind
        and event.bait == staged.is_bait
        and staged.at_s - 1 <= event.observable_s <= staged.at_s + LATEST_S
        for event in events
    )


def played(name: str, plan: DrivePlan, simulations: Simulations) -> Score:
    """The score of one watcher on one drive."""
    agent = WATCHERS[name]()
    conditions = Conditions(max_steps=STEPS, max_sim_s=plan.duration_s, channels=agent.channels)
    with closing(Watch.depart_with(depart(plan, simulations), conditions)) as watch:
        agent.reset(watch.goal)
        play(watch, agent)
        assert watch.judgement is not None
        return score(watch.judgement, watch.seconds)


def table(names: Sequence[str], seeds: Sequence[int], simulations: Simulations) -> Iterator[str]:
    """What came off, by family, then by kind."""
    asked: Counter[tuple[str, bool]] = Counter()
    came: Counter[tuple[str, bool]] = Counter()
    yield f"{'family':24}{'minutes':>9}{'km':>7}{'staged':>8}{'came off':>10}{'events':>8}{'baits':>7}"
    for name in names:
        plans = [FAMILIES[name].draw(seed) for seed in seeds]
        drives = [found(plan, simulations) for plan in plans]
        both = [
            (one, came_off(one, events))
            for plan, (events, _) in zip(plans, drives, strict=True)
            for one in plan.staged
        ]
        asked.update((one.kind, one.is_bait) for one, _ in both)
        came.update((one.kind, one.is_bait) for one, came_ in both if came_)
        due = [sum(event.obliged_s is not None and not event.bait for event in events) for events, _ in drives]
        baits = [sum(event.bait for event in events) for events, _ in drives]
        minutes, km = mean(plan.duration_s for plan in plans) / 60, mean(km for _, km in drives)
        share = mean(ok for _, ok in both)
        yield f"{name:24}{minutes:9.1f}{km:7.1f}{len(both):8}{share:10.0%}{mean(due):8.1f}{mean(baits):7.1f}"
    yield ""
    yield f"{'kind':24}{'staged':>8}{'came off':>10}{'baits':>8}{'came off':>10}"
    for kind in sorted({kind for kind, _ in asked}):
        parts = [(asked[kind, is_bait], came[kind, is_bait]) for is_bait in (False, True)]
        shares = [f"{many:8}{many_came / many if many else 0:10.0%}" for many, many_came in parts]
        yield f"{kind:24}{''.join(shares)}"


def watched(names: Sequence[str], seeds: Sequence[int], who: str, simulations: Simulations) -> Iterator[str]:
    """The scores of a watcher, by family and together."""
    yield f"{who:24}{'events':>8}{'recall':>8}{'false/h':>9}{'value':>7}"
    scores: dict[str, list[Score]] = {}
    for name in names:
        scores[name] = [played(who, FAMILIES[name].draw(seed), simulations) for seed in seeds]
        yield _line(name, together(scores[name]))
    yield _line("all", together([one for each in scores.values() for one in each]))


def _line(name: str, total: Score) -> str:
    recall = "-" if total.recall is None else f"{total.recall:.0%}"
    return f"{name:24}{total.events:8}{recall:>8}{total.false_alarms_per_h:9.1f}{total.value:7.0f}"


def main() -> None:
    parser = argparse.ArgumentParser(description="What drives stage, and what comes of it.")
    parser.add_argument("families", nargs="*", default=list(FAMILIES))
    parser.add_argument("--seeds", nargs="+", type=int, default=[0])
    parser.add_argument("--watch", nargs="+", choices=WATCHERS, help="play these watchers instead")
    asked = parser.parse_args()
    with closing(Simulations(count_limit=2)) as simulations:
        if not asked.watch:
            for line in table(asked.families, asked.seeds, simulations):
                print(line, flush=True)
        for who in asked.watch or ():
            for line in watched(asked.families, asked.seeds, who, simulations):
                print(line, flush=True)


if __name__ == "__main__":
    main()
