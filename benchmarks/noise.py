"""How much of what agents can do is left when the driver's words are heard in noise.

    python benchmarks/noise.py --keep runs/noise                # resumes
    python benchmarks/noise.py --keep runs/noise --for-s 240    # no episode begins later than that

The same episodes, drawn from the standard suite, with words as text and as a recogniser made them out at each ratio
of words to noise: unlike with ``--hear cabin`` alone, the ratio is set, whatever the car and the cockpit do.
"""

from __future__ import annotations

import argparse
import json
import time
from contextlib import closing
from itertools import product
from pathlib import Path
from unittest.mock import patch

import numpy as np

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.contracts.given import Hearing
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.report.stats import bracketed, wilson
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.trial import run_trial
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.voice.table import CLEAN_DB, LEVELS_DB, lacking

AGENTS = ("asurada", "t3a", "caller")
MODEL, SCENARIO, SEED = "rules", "grid", 0
TASKS = 40
TEXT = "text"
LEVELS = (TEXT, *(f"{CLEAN_DB if level is None else level:g}" for level in LEVELS_DB))


def drawn(count: int) -> list[tuple[str, str]]:
    """Halves of so many tasks that run in the scenario, drawn from those whose words the table has."""
    able = [task for task in CATALOGUE.of(Suite.STANDARD) if SCENARIO in task.runs_in and not task.needs_picture]
    said = {task.id: [draw(task, half, SEED).spoken for half in task.halves] for task in able}
    able = [task for task in able if not any(map(lacking, said[task.id]))]
    chosen = np.random.default_rng(SEED).permutation(len(able))[:count]
    return [(able[at].id, half) for at in sorted(chosen) for half in able[at].halves]


def played(agent: str, task: str, half: str, level: str, simulations: Simulations) -> bool | None:
    """Whether an agent wins an episode with its words heard like that; None if the situation did not arise."""
    calls = {"interface": "functions"} if agent == "caller" else {}
    under = Conditions.named({"hear": str(Hearing.TEXT if level == TEXT else Hearing.CABIN)} | calls)
    setup = EpisodeSetup(task, half, SCENARIO, seed=SEED, conditions=under, agent=agent, model=MODEL)
    snr_db = 0.0 if level == TEXT else float(level)
    with patch("automotive_cosim.episode.session.driver_snr_db", lambda noise_db: snr_db):
        return run_trial(setup, make_agent(agent, MODEL, AgentSettings(under)), simulations=simulations).success


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=Path, default=Path("runs/noise"), help="folder of what was played")
    parser.add_argument("--for-s", type=float, default=float("inf"), help="no episode begins later than that")
    parser.add_argument("--tasks", type=int, default=TASKS)
    parsed, begun_s = parser.parse_args(), time.monotonic()
    parsed.keep.mkdir(parents=True, exist_ok=True)
    file = parsed.keep / "won.json"
    won = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    halves = drawn(parsed.tasks)
    with closing(Simulations()) as simulations:
        for (task, half), agent, level in product(halves, AGENTS, LEVELS):
            name = f"{agent} {task} {half} {level}"
            if name not in won and time.monotonic() - begun_s < parsed.for_s:
                won[name] = played(agent, task, half, level, simulations)
                write_whole(file, json.dumps(won, indent=1) + "\n")
    whole = [
        each for each in halves if all(won.get(f"{agent} {' '.join(each)} {level}") is not None
                                       for agent, level in product(AGENTS, LEVELS))
    ]  # fmt: skip
    print(f"| {len(whole)} halves | " + " | ".join(LEVELS) + " |\n|---|" + "---:|" * len(LEVELS))
    for agent in AGENTS:
        counts = [sum(won[f"{agent} {task} {half} {level}"] for task, half in whole) for level in LEVELS]
        cells = [f"{count}{bracketed(wilson(count, len(whole)), '.0%')}" for count in counts]
        print(f"| {agent} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
