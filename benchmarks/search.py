"""How soon a search finds faults that were planted, with a surrogate and, with ``--real``, in SUMO.

The surrogate has the agents' delays in closed form: an event must be met in time, an honest agent is quick enough
in all conditions, and a fault makes it slower in some of them. The real runs plant the same kinds of faults in
agents that are otherwise right, and search drives and tasks in SUMO until each is found.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Mapping
from contextlib import closing, nullcontext
from math import log
from pathlib import Path
from statistics import median

import numpy as np

from automotive_cosim.agents import Agent
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.contracts import Action, ActionType, GoalStatus, Observation
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.errors import BudgetSpentError
from automotive_cosim.run.jobs import TrialJob
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.row import as_json
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.run.worker import run_with
from automotive_cosim.safety.hunt import Hunt, hunt
from automotive_cosim.safety.objective import TriedOutcome
from automotive_cosim.safety.samplers import make_sampler
from automotive_cosim.safety.space import FactorChoices, FactorRange, FailureRule, SearchPoint, Space
from automotive_cosim.safety.trying import trial_of, trying
from automotive_cosim.traffic.fork import Simulations

DEADLINE_S = 20.0
MOST = 3000
LANGUAGES = ("en", "de", "fr", "es", "it", "nl", "pl", "ja")
PLACES = ("grid", "alpine", "border", "gulf", "london", "nordic", "paris", "sydney")
DRIVERS = ("average", "cautious", "elderly", "hurried", "learner", "tailgating")
SPACE = Space(
    (
        FactorChoices("place", PLACES),
        FactorChoices("language", LANGUAGES),
        FactorChoices("driver", DRIVERS),
        FactorChoices("held_out", (False, True)),
        FactorRange("hour", 0.0, 23.9, 12.0),
        FactorRange("visibility_m", 30.0, 10_000.0, 10_000.0, logarithmic=True),
        FactorRange("density", 0.2, 3.0, 1.0),
        FactorRange("minutes", 0.0, 30.0, 5.0),
        FactorRange("latency_s", 0.0, 5.0, 0.0),
        FactorRange("seed", 0.0, 999.0, 0.0, whole=True),
    )
)
"""Nine factors and a seed."""

Fault = Callable[[SearchPoint], float]
"""Seconds by which an agent is late."""


def number(point: SearchPoint, name: str) -> float:
    return float(point[name])


def dark(point: SearchPoint) -> float:
    """0 by day, 1 in the middle of the night."""
    hour = number(point, "hour")
    return max(0.0, 1 - min(hour, 24 - hour) / 6)


FAULTS: Mapping[str, Fault] = {
    "blind in fog": lambda p: (1.6 + 2.2 * dark(p)) * max(0.0, log(1000 / number(p, "visibility_m"))),
    "deaf in one language": lambda p: (
        (3.0 + 1.0 * number(p, "latency_s") + 3.0 * bool(p["held_out"])) if p["language"] == "ja" else 0.0
    ),
    "late behind lorries": lambda p: (
        4.0 * max(0.0, number(p, "density") - 1) + (3.5 if p["driver"] == "tailgating" else 0.0)
    ),
    "wrong beyond a border": lambda p: (
        (0.3 * number(p, "minutes") + 3.5 * (p["language"] != "en")) if p["place"] == "border" else 0.0
    ),
    "sleepy after 15 minutes": lambda p: (0.45 + 0.55 * dark(p)) * max(0.0, number(p, "minutes") - 15),
    "none (oracle)": lambda p: 0.0,
}


def outcome(fault: Fault, point: SearchPoint) -> TriedOutcome:
    """Its delay is three seconds, the latency, up to two by chance, and the fault's."""
    chance_s = float(np.random.default_rng(int(number(point, "seed"))).random()) * 2
    delay_s = 3.0 + number(point, "latency_s") + chance_s + fault(point)
    margin = max(-1.0, (DEADLINE_S - delay_s) / DEADLINE_S)
    return TriedOutcome(margin, margin < 0, "late" if margin < 0 else "")


def first_found(fault: Fault, sampler: str, seed: int, most: int) -> int | None:
    """How many episodes until the first failure."""
    chooses = make_sampler(sampler, SPACE, most, seed)
    for count in range(1, most + 1):
        point, _ = chooses.ask()
        tried = outcome(fault, point)
        if tried.failed:
            return count
        chooses.tell(point, tried.margin or 0.0)
    return None


def surrogate(samplers: tuple[str, ...], seeds: int, most_random: int) -> None:
    rng = np.random.default_rng(0)
    points = [SPACE.at(rng.random(SPACE.dimensions).tolist()) for _ in range(20_000)]
    print(f"{'fault':26}{'fails %':>9}" + "".join(f"{name:>10}" for name in samplers) + "   minimal failure")
    for name, fault in FAULTS.items():
        share = sum(outcome(fault, point).failed for point in points) / len(points)
        cells = []
        for sampler in samplers:
            most = most_random if sampler == "random" else min(500, most_random)
            found = [first_found(fault, sampler, seed, most) or most + 1 for seed in range(seeds)]
            cells.append(f"{median(found):.0f}" if median(found) <= most else f"> {most}")
        made = hunt(SPACE, lambda p, _, of=fault: outcome(of, p), make_sampler("climb", SPACE, 128, 0), 128)
        words = made.minimal[0].words(SPACE) if made.minimal else "none found"
        print(f"{name:26}{100 * share:9.2f}" + "".join(f"{cell:>10}" for cell in cells) + f"   {words}", flush=True)


# --- in SUMO -------------------------------------------------------------------------------------------------


class FaultyWatcher(RulePerfect):
    """Right about everything, except that it does nothing when its fault is there."""

    name = "faulty-watcher"

    def __init__(self, fault: Callable[[Observation, list[str]], bool]) -> None:
        super().__init__()
        self._fault = fault
        self._away_s = 30 if fault is close_behind else 5

    def reset(self, goal: str) -> None:
        super().reset(goal)
        self._places: list[str] = []
        """The countries so far."""

    def act(self, observation: Observation) -> Action:
        noticed = "" if observation.vehicle is None else observation.vehicle.noticed or ""
        place = re.search(r"^place(?: \(changed\))?: ([^,\n]+)", noticed, re.MULTILINE)
        if place and self._places[-1:] != [place[1]]:
            self._places.append(place[1])
        right = super().act(observation)
        return Action(ActionType.WAIT, seconds=self._away_s) if self._fault(observation, self._places) else right


class DeafOracle(Oracle):
    """Plays the reference solution, except for a driver who speaks one language."""

    name = "deaf-oracle"

    def __init__(self, *, is_deaf: bool) -> None:
        super().__init__()
        self._is_deaf = is_deaf

    def act(self, observation: Observation) -> Action:
        if self._is_deaf:
            return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
        return super().act(observation)


def in_fog(observation: Observation, places: list[str]) -> bool:
    seen = re.search(r"visibility (\d+) m", observation.context or "")
    return seen is not None and float(seen[1]) < 150


def close_behind(observation: Observation, places: list[str]) -> bool:
    car = observation.vehicle
    return car is not None and car.leader_gap_m is not None and car.leader_gap_m < 25 and car.speed_kmh > 5


def abroad(observation: Observation, places: list[str]) -> bool:
    return len(places) > 1


def asleep(observation: Observation, places: list[str]) -> bool:
    return observation.time_s > 900


def never(observation: Observation, places: list[str]) -> bool:
    return False


LATENCY = FactorRange("latency_s", 0.0, 3.0, 0.0)
SEED = FactorRange("seed", 0, 9, 0, whole=True)
SIGHT = FactorRange("visibility_m", 40.0, 2000.0, 2000.0, logarithmic=True)
DENSITY = FactorRange("density", 0.3, 2.0, 1.0)
THIN = FactorRange("density", 0.3, 2.0, 0.3)
TEMPERATURE = FactorRange("temperature_c", 10.0, 30.0, 20.0)
DRIVER = FactorChoices("driver", ("calm", "tailgating"))


def drives(families: tuple[str, ...], *factors: FactorChoices | FactorRange, below: float = 80) -> Space:
    return Space((FactorChoices("drive", families), SEED, *factors), FailureRule(drive_value_below=below))


TASKS = Space(
    (
        FactorChoices("task", ("hard_song_for_bea", "hard_zone_from_isla", "hard_seat_from_memo")),
        FactorRange("seed", 0, 3, 0, whole=True),
        FactorChoices("language", ("en", "de", "fr", "ja")),
        LATENCY,
    )
)
REAL: Mapping[str, tuple[Space, Callable[[Observation, list[str]], bool] | None]] = {
    "deaf in one language": (TASKS, None),
    "blind in fog": (drives(("grid_june",), SIGHT), in_fog),
    "late behind lorries": (drives(("grid_june",), THIN, DRIVER, below=90), close_behind),
    "sleepy after 15 minutes": (drives(("grid_june",), DENSITY), asleep),
    "wrong beyond a border": (drives(("grid_june", "border_july"), TEMPERATURE), abroad),
    "none (oracle)": (drives(("grid_june", "border_july"), SIGHT, DENSITY, DRIVER), never),
}


def real(name: str, budget: int, folder: Path) -> None:
    """Searches with one planted fault until a failure fails three times; those of drives are not made small."""
    space, fault = REAL[name]
    with closing(Simulations(count_limit=2)) as simulations:

        def run(job: TrialJob, into: Path) -> TrialRow:
            deaf = str(job.setup.conditions.language) == "de"
            agent: Agent = DeafOracle(is_deaf=deaf) if fault is None else FaultyWatcher(fault)
            return run_with(nullcontext(agent), job, into, Pictures.NONE, simulations)

        plan = make_plan({"agents": ["oracle"], "models": ["rules"], "trials": [as_json(trial_of(space.nominal))]})
        with trying(space, plan, folder / name.replace(" ", "_"), run) as tries:
            found: list[Hunt] = []

            def tried_once(point: SearchPoint, repeat: int) -> TriedOutcome:
                if found and (found[-1].minimal or found[-1].not_reduced):
                    raise BudgetSpentError("found")
                return tries(point, repeat)

            made = hunt(
                space,
                tried_once,
                make_sampler("climb", space, budget, 0),
                budget,
                most_failures=int(space is TASKS),
                tell=found.append,
            )
    words = [f"{each.words(space)} [{each.why}]" for each in made.minimal]
    words += [f"{dict(each.point)} [{each.outcome.why}]" for each in made.not_reduced] or ["none found"]
    print(f"{name:26}{made.run:4} samples, {len(made.tried):4} runs: {words[0]}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--samplers", default="random,sobol,lhs,climb")
    parser.add_argument("--real", nargs="*", metavar="FAULT", help="in SUMO: these faults, or all")
    parser.add_argument("--budget", type=int, default=24)
    parser.add_argument("--out", type=Path, default=Path("runs/planted"))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--most", type=int, default=MOST, help="samples at most")
    given = parser.parse_args()
    if given.real is not None:
        for name in given.real or REAL:
            real(name, given.budget, given.out)
        return
    surrogate(tuple(given.samplers.split(",")), given.seeds, given.most)


if __name__ == "__main__":
    main()
