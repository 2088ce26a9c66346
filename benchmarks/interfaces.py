"""The same tasks by touch, by functions and by both: success, time, tokens, cost and distraction.

    python benchmarks/interfaces.py --out runs/interfaces            # rerun to resume
    python benchmarks/interfaces.py --out runs/mine --models openai/NAME --agents caller,t3a

A sample of all tasks that do not hang on the picture, drawn by seed. The first table is of the reference solutions,
by touch and translated into calls, and shows what the interface alone does; the second is of agents on a model.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Interface
from automotive_cosim.report.interfaces import interfaces
from automotive_cosim.report.results import read_results
from automotive_cosim.run.batch import run_plan
from automotive_cosim.run.plan import make_plan
from automotive_cosim.tasks import CATALOGUE


def sample(count: int, seed: int) -> list[str]:
    """Ids of so many tasks, of all suites; a smaller sample is part of a larger one."""
    plain = [task.id for task in CATALOGUE.values() if not task.needs_picture]
    return [str(name) for name in np.random.default_rng(seed).permutation(plain)[:count]]


def table(folder: Path, plan: Json) -> str:
    """Runs what is left of an evaluation; its table, in Markdown."""
    run_plan(make_plan(plan), folder)
    return interfaces(read_results(folder).shared()).markdown()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="folder of the two evaluations")
    parser.add_argument("--tasks", type=int, default=75, help="how many tasks (75)")
    parser.add_argument("--agent-tasks", type=int, default=12, help="how many of them the agents get (12)")
    parser.add_argument("--seed", type=int, default=0, help="of the sample (0)")
    parser.add_argument("--agents", default="caller", help="separated by commas (caller)")
    parser.add_argument("--models", default="rules", help="separated by commas (rules)")
    parser.add_argument("--prompt", default="standard", help="standard, short or long")
    given = parser.parse_args()
    tasks = sample(given.tasks, given.seed)
    by_either = [str(Interface.TOUCH), str(Interface.FUNCTIONS)]
    print(table(given.out / "reference", {"agents": ["oracle"], "tasks": tasks, "interface": by_either}))
    plan = {"agents": given.agents.split(","), "models": given.models.split(","), "prompt": [given.prompt]}
    few = sample(min(given.agent_tasks, given.tasks), given.seed)
    print(table(given.out / "agents", plan | {"tasks": few, "interface": [str(each) for each in Interface]}))


if __name__ == "__main__":
    main()
