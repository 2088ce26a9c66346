"""What silence, help, talk and flicker do to a car whose driver's attention can run out.

    python benchmarks/attention.py --keep runs/attention                # 50 drives by 4 agents; resumes
    python benchmarks/attention.py --keep runs/attention --for-s 240    # no drive begins later than that

The four agents drive the same drives of three minutes: the same dense traffic, event and driver. What differs from
silence is what the agent did: the table has differences, drive by drive, with 95 % intervals from resampling.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from itertools import product
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Action, ActionType, Observation
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.harm import harm
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.watchers import READS, RulePerfect, Silent
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.session import play
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.measures.following import is_near
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS
from automotive_cosim.traffic.fork import Simulations

FAMILIES = ("grid_june", "grid_january")
SEEDS = 25
MINUTES = 3.0
FOLLOWS_S = 3.0
"""A car that is nearer to the one ahead follows it."""
RESAMPLED = 2000
REMARK = "There is a place on the left that is known for its fish, and its terrace is open until ten tonight."
QUESTION = "Would you like me to tell you more about what one can see around here?"
DOCK = frozenset({"dock.map", "dock.phone", "dock.climate", "dock.media"})
STAGED = ("leader_brakes", "jam_tail", "tractor", "cut_in", "over_limit", "leader_stops")
"""What is staged after a minute, a drive each in turn."""
DENSITY = 2.0
ON = Conditions.named({"attention": "on"})


class Chatty(Silent):
    """Talks to the driver, and asks, most of the time."""

    name = "chatty"

    def reset(self, goal: str) -> None:
        self._turn = 0

    def act(self, observation: Observation) -> Action:
        """A remark or a question of a sentence or two, then as long a wait."""
        self._turn += 1
        if self._turn % 2:
            return Action(ActionType.WAIT, seconds=5)
        if self._turn % 4:
            return Action(ActionType.ANSWER, text=REMARK)
        return Action(ActionType.ASK_DRIVER, text=QUESTION)


class Flickering(Silent):
    """Goes from screen to screen, a touch a second."""

    name = "flickering"
    channels = READS

    def reset(self, goal: str) -> None:
        self._turn = 0

    def act(self, observation: Observation) -> Action:
        """A touch of the next button of the dock."""
        self._turn += 1
        keys = [(key_of(each.resource_id), index) for index, each in enumerate(observation.elements or ())]
        dock = [index for key, index in keys if key in DOCK]
        return Action(ActionType.CLICK, index=dock[self._turn % len(dock)]) if dock else Action(ActionType.WAIT)


AGENTS: Mapping[str, Callable[[], RulePerfect | Silent]] = {
    "silent": Silent,
    "helpful": RulePerfect,
    "chatty": Chatty,
    "flickering": Flickering,
}


def figures(drive: Sequence[Moment]) -> dict[str, float]:
    """What is compared of one drive, from every step of SUMO's."""
    states = [state for moment in drive[1:] for state in moment.passed]
    gaps, least_s, harmed = [], 10.0, harm(drive)
    for state in states:
        leader = state.around.leader
        if leader is None or state.speed_mps < 5.0:
            continue
        if leader.gap_m / state.speed_mps < FOLLOWS_S:
            gaps.append(leader.gap_m / state.speed_mps)
        if leader.time_to_collision_s is not None:
            least_s = min(least_s, leader.time_to_collision_s)
    braking = [-state.acceleration_mps2 for state in states]
    step_s = states[1].time_s - states[0].time_s
    return {
        "attention lost, s": harmed.unaware_s,
        "hardest braking, m/s2": max(braking),
        "braking above 3.4 m/s2, s": sum(each > DEFAULT_THRESHOLDS.drac_mps2 for each in braking) * step_s,
        "least gap when following, s": min(gaps, default=FOLLOWS_S),
        "spread of that gap, s": float(np.std(gaps)) if gaps else 0.0,
        "least time to collision, s": least_s,
        "above the limit, m": harmed.over_limit_m,
        "near a collision, s": sum(map(is_near, states)) * step_s,
    }


def played(family: str, seed: int, who: str, simulations: Simulations) -> dict[str, float]:
    """The figures of one drive with one agent."""
    agent = AGENTS[who]()
    settings = DriveSettings(minutes=MINUTES, density=DENSITY, stage=STAGED[seed % len(STAGED)])
    spec = DriveSpec(family, seed, ON, settings=settings)
    with closing(spec.begin(simulations, agent.channels)) as session:
        session.judged = False
        agent.reset(session.goal)
        play(session, agent)
        return figures(session.moments)


def table(found: Mapping[str, Mapping[str, float]]) -> str:
    """The mean of each figure in silence, and how much it differs with each of the others, with an interval."""
    drives = sorted({name.rpartition(" ")[0] for name in found})
    drives = [each for each in drives if all(f"{each} {who}" in found for who in AGENTS)]
    rng, lines = np.random.default_rng(0), []
    for figure in next(iter(found.values())):
        values = {who: np.array([found[f"{each} {who}"][figure] for each in drives]) for who in AGENTS}
        cells = [f"{values['silent'].mean():.2f}"]
        for who in list(AGENTS)[1:]:
            apart = values[who] - values["silent"]
            means = apart[rng.integers(len(apart), size=(RESAMPLED, len(apart)))].mean(axis=1)
            low, high = np.percentile(means, (2.5, 97.5))
            cells.append(f"{apart.mean():+.2f} ({low:+.2f} to {high:+.2f})")
        lines.append(f"| {figure} | {' | '.join(cells)} |")
    head = (
        f"| {len(drives)} drives each | silent | {' | '.join(f'{who} less silent' for who in list(AGENTS)[1:])} |"
    )
    return "\n".join([head, "|---|" + "---:|" * len(AGENTS), *lines])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=Path, default=Path("runs/attention"), help="folder of what was driven")
    parser.add_argument("--for-s", type=float, default=float("inf"), help="no drive begins later than that")
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--families", nargs="*", default=FAMILIES)
    parsed, begun_s = parser.parse_args(), time.monotonic()
    parsed.keep.mkdir(parents=True, exist_ok=True)
    file = parsed.keep / "figures.json"
    found = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    seeds, families = range(parsed.seeds), parsed.families
    with closing(Simulations()) as simulations:
        for name in [f"{family} {seed} {who}" for seed, family, who in product(seeds, families, AGENTS)]:
            family, seed, who = name.split()
            if name not in found and time.monotonic() - begun_s < parsed.for_s:
                found[name] = played(family, int(seed), who, simulations)
                write_whole(file, json.dumps(found, indent=1) + "\n")
    print(table(found))
    print(f"{len(found)} drives")


if __name__ == "__main__":
    main()
