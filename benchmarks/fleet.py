"""Cars of one traffic beside as many copies of the environment: decisions a second, and memory.

    python benchmarks/fleet.py --cars 1 8 32 --copies 32
    python benchmarks/fleet.py --cars 8 128 --scenario town.sumocfg
    python benchmarks/fleet.py --cars 8 128 --minutes 5

Every car only looks on (`FlatDrive-v0`, lean, waits of two seconds), so the judges' do-nothing drives, which are
simulations of their own from the first alert on, are not in the figures, unless with `--act`. Memory is that of all
processes (PSS).
"""

from __future__ import annotations

import argparse
import os
import time
from contextlib import closing, suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from automotive_cosim.agents.cleanup import tree
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.cosim.simulation import couple
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.envs.flat_drive import CHANNELS, SOON, FlatDriveEnv
from automotive_cosim.envs.fleet import FleetVectorEnv
from automotive_cosim.envs.vector import ConcurrentVectorEnv
from automotive_cosim.episode.fleet import Fleet
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.run.bench import pss_mb
from automotive_cosim.studies.adoption.adoption import AdoptionPlan
from automotive_cosim.studies.calls.town import NOWHERE, driving
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked, RemoteTraffic

FAMILY = "paris_july"
"""Its drives are in paris_centre."""
ENTER_STEPS = 600
"""In these at most, all cars enter, each where its trip begins as soon as there is a gap; nothing is timed."""
COLUMNS = ("", "cars", "in traffic", "act in a step", "decisions a second", "ms a decision", "of a processor")
COLUMNS += ("MB", "MB a car")
ALERT = SOON + 1
"""Number of an action of the environment that is an alert; ``SOON`` is a wait of two seconds."""
LEAST_STEPS = 20
"""The same at least."""
LOOK_STEPS = 30
"""After so many steps each, the memory is looked at."""


def measured(kind: str, cars: int, scenario: str, steps: int, minutes: float | None, act: int) -> str:
    """A row of Markdown; with minutes, of a whole episode of drives that last so long. As each car has entered, it
    does the action of that number."""
    make = partial(FlatDriveEnv, FAMILY, scenario=scenario, lean=True, minutes=minutes)
    before_mb = pss_mb()
    if kind == "fleet":
        envs = FleetVectorEnv(cars, families=FAMILY, scenario=scenario, lean=True, minutes=minutes)
    else:
        envs = ConcurrentVectorEnv([make] * cars)
    envs.reset(seed=1)
    waits = np.full(cars, SOON)
    entered: set[str] = set()
    for number in range(0 if minutes else ENTER_STEPS):
        entered |= set(envs.fleet.agents) if isinstance(envs, FleetVectorEnv) else {str(car) for car in range(cars)}
        if number >= LEAST_STEPS and len(entered) == cars:
            break
        envs.step(waits)
    driven = len(envs.fleet.agents) if isinstance(envs, FleetVectorEnv) else cars
    decisions, number, most_mb, begun_s, worked_s = 0, 0, 0.0, time.perf_counter(), processor_s()
    info: dict[str, Any] = {}
    waits[:] = act
    while "final_obs" not in info if minutes else number < steps:
        info = envs.step(waits)[4]
        waits[np.broadcast_to(info.get("acted", True), cars)] = SOON
        decisions += int(info["acted"].sum()) if kind == "fleet" else cars
        number += 1
        if isinstance(envs, FleetVectorEnv) and minutes:
            entered |= set(envs.fleet.agents)
            driven = len(entered)
        if number % LOOK_STEPS == 0:
            most_mb = max(most_mb, pss_mb() - before_mb)
    took_s, worked_s = time.perf_counter() - begun_s, processor_s() - worked_s
    envs.close()
    return told(kind, cars, driven, decisions, number, took_s, worked_s, most_mb)


def equipped(cars: int, scenario: str, steps: int, scale: float) -> str:
    """The same of cars that drive anyway when they get a cockpit, all at once at the end of the warm-up."""
    plan = AdoptionPlan(scenario or "paris_centre", scale=scale)
    before_mb = pss_mb()
    with closing(Forked(plan.scene(), 1, allow_unprojected=True)) as warm, closing(warm.road()) as road:
        fleet, sessions = Fleet[None](road.step_s), dict[str, tuple[RemoteTraffic, DriveSession]]()
        for name in road.call(driving)[:cars]:
            car = road.equip(name, EgoPlan(NOWHERE))
            sessions[name] = car, session_of(car, plan)
        decisions, begun_s, worked_s = 0, time.perf_counter(), processor_s()
        for number in range(steps):
            for odd, (name, (car, session)) in enumerate(sessions.items()):
                if name not in fleet.busy and session.end is None:
                    wait = Action(ActionType.WAIT, seconds=2.0 if number or odd % 2 else 1.0)
                    fleet.begin(name, session.stepping(wait), partial(time_of, car))
            decisions += len(fleet.run())
        took_s, worked_s = time.perf_counter() - begun_s, processor_s() - worked_s
        return told("equipped", cars, len(sessions), decisions, steps, took_s, worked_s, pss_mb() - before_mb)


def time_of(car: RemoteTraffic) -> float:
    """To which a car has driven."""
    return car.state.time_s


def session_of(car: RemoteTraffic, plan: AdoptionPlan) -> DriveSession:
    """A cockpit without a screen in a car, and nobody at it."""
    scenario, draws = plan.scene(), (np.random.default_rng(seed) for seed in (1, 2))
    world = couple(
        car,
        Cockpit(car.network, rng=next(draws), lookout=True),
        scenario,
        gps_rng=next(draws),
        weather=scenario.weather or drawn_weather(car.state, scenario.start, 1),
        departure=scenario.start,
    )
    return DriveSession.depart_with(world, SessionSetup(CHANNELS, lean=True), judged=False)


def told(
    kind: str, cars: int, driven: int, decisions: int, steps: int, took_s: float, worked_s: float, memory_mb: float
) -> str:
    """A row of Markdown."""
    found = (
        kind,
        cars,
        driven,
        round(decisions / steps),
        f"{decisions / took_s:.1f}",
        f"{1000 * took_s / decisions:.2f}",
        f"{1000 * worked_s / decisions:.2f}",
        round(memory_mb),
        f"{memory_mb / driven:.1f}",
    )
    return f"| {' | '.join(map(str, found))} |"


def processor_s() -> float:
    """Processor time of this process and of all that it started and that still run, or that were waited for."""
    total = 0.0
    for pid in tree(os.getpid()):
        with suppress(OSError):
            fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            total += sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    return total


def main() -> None:
    """Measures what the command line says."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cars", type=int, nargs="*", default=[1, 8, 32], help="cars of a fleet")
    parser.add_argument("--copies", type=int, nargs="*", default=[], help="copies of the environment")
    parser.add_argument("--scenario", default="", help="a scenario or network; paris_centre if left out")
    parser.add_argument("--steps", type=int, default=30, help="steps to time")
    parser.add_argument("--equipped", type=int, nargs="*", default=[], help="cars that drive anyway, with cockpits")
    parser.add_argument("--scale", type=float, default=2.0, help="factor on the traffic of these")
    parser.add_argument("--minutes", type=float, help="time whole episodes of fleets, of drives that last so long")
    parser.add_argument("--act", action="store_true", help="let each car give an alert once, at first")
    given = parser.parse_args()
    act = ALERT if given.act else SOON
    print(f"| {' | '.join(COLUMNS)} |\n|---{(len(COLUMNS) - 1) * '|--:'}|")
    for kind, counts in (("fleet", given.cars), ("copies", given.copies)):
        for count in counts:
            print(measured(kind, count, given.scenario, given.steps, given.minutes, act), flush=True)
    for count in given.equipped:
        print(equipped(count, given.scenario, given.steps, given.scale), flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
