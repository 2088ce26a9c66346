"""The same tasks by touch, by functions and by both: success, time, tokens, cost and distraction.

    python benchmarks/interfaces.py --out runs/interfaces --scenario grid --workers 2    # rerun to resume
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
from automotive_cosim.run.processes import Processes
from automotive_cosim.tasks import CATALOGUE


def sample(count: int, seed: int, scenario: str) -> list[str]:
    """Ids of so many tasks, of all suites; a smaller sample is part of a larger one."""
    tasks = (task for task in CATALOGUE.values() if not scenario or task.runs_whole_in(scenario))
    plain = [task.id for task in tasks if not task.needs_picture]
    return [str(name) for name in np.random.default_rng(seed).permutation(plain)[:count]]


def table(folder: Path, plan: Json, workers: int) -> str:
    """Runs what is left of an evaluation; its table, in Markdown."""
    run_plan(make_plan(plan), folder, executor=Processes(workers))
    return interfaces(read_results(folder).shared()).markdown()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="folder of the two evaluations")
    parser.add_argument("--tasks", type=int, default=90, help="how many tasks (90)")
    parser.add_argument("--agent-tasks", type=int, default=30, help="how many of them the agents get (30)")
    parser.add_argument("--seed", type=int, default=0, help="of the sample (0)")
    parser.add_argument("--agents", default="caller", help="separated by commas (caller)")
    parser.add_argument("--models", default="rules", help="separated by commas (rules)")
    parser.add_argument("--prompt", default="standard", help="standard, short or long")
    parser.add_argument("--scenario", default="", help="where to run what can run there, e.g. grid")
    parser.add_argument("--workers", type=int, default=1, help="processes (1)")
    given = parser.parse_args()
    where = {"scenarios": [given.scenario]} if given.scenario else {}
    tasks, few = (sample(count, given.seed, given.scenario) for count in (given.tasks, given.agent_tasks))
    by_either = [str(Interface.TOUCH), str(Interface.FUNCTIONS)]
    plan: Json = {"agents": ["oracle"], "tasks": tasks, "interface": by_either} | where
    print(table(given.out / "reference", plan, given.workers))
    plan |= {"agents": given.agents.split(","), "models": given.models.split(","), "prompt": [given.prompt]}
    plan |= {"tasks": few, "interface": [str(each) for each in Interface]}
    print(table(given.out / "agents", plan, given.workers))


if __name__ == "__main__":
    main()
