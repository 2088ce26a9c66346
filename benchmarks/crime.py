"""Compares gap, TTC, DRAC, TET and TIT with commonroad-crime on the same states.

    python -m benchmarks.crime [--environment crime] TRIAL ...

It makes an environment of its own for commonroad-crime (over a gigabyte), where this script runs again without this
package. States are closed-form approaches, and readings of recorded trials (`drive --out`) in which one vehicle
closes in on another; each vehicle keeps its speed from there on, as the measures suppose. commonroad-crime rounds
to two decimals, measures along a lane, and takes a leader's length along it too, whatever its heading.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import venv
from pathlib import Path
from typing import Any

PACKAGE = "commonroad-crime==0.4.5"
MOST_READINGS = 100
"""About so many of a trial, evenly over it: each takes a third of a second."""
STEP_S, STEPS = 0.1, 120
TTC_S, MOST_TTC_S = 3.0, 30.0
"""The threshold of TET and TIT, and the longest TTC that is compared."""
APPROACHES = ((20.0, 10.0, 99.0), (20.0, 10.0, 39.0), (15.0, 5.0, 60.0), (30.0, 28.0, 10.0))
"""Follower and leader in m/s, and the gap in metres, of the closed-form approaches."""
TILT = 0.001
"""The lane's heading in radians: at 0 commonroad-crime takes a vehicle for outside of its lane."""


# --- here ----------------------------------------------------------------------------------------------------


def approaches() -> list[dict[str, Any]]:
    """Two vehicles on a straight, with TET and TIT until they touch."""
    from automotive_cosim.measures.formulas import drac_mps2, time_exposed, time_to_collision_s

    found = []
    for follower_mps, leader_mps, gap_m in APPROACHES:
        closing_mps = follower_mps - leader_mps
        times = []
        for step in range(STEPS):
            left_m = gap_m - closing_mps * STEP_S * step
            times.append((STEP_S * step, time_to_collision_s(left_m, closing_mps) if left_m > 0 else None))
        tet_s, tit_s2 = time_exposed(times, TTC_S)
        found.append(
            {
                "of": "closed form",
                "follower": [0.0, 0.0, 0.0, follower_mps, 4.5, 1.8],
                "leader": [gap_m + 4.5, 0.0, 0.0, leader_mps, 4.5, 1.8],
                "gap_m": gap_m,
                "ttc_s": time_to_collision_s(gap_m, closing_mps),
                "drac_mps2": drac_mps2(gap_m, closing_mps),
                "tet_s": tet_s,
                "tit_s2": tit_s2,
            }
        )
    return found


def readings(trial: Path) -> list[dict[str, Any]]:
    """Readings of a recorded trial, in the frame of the follower: x along its heading from its front bumper."""
    from automotive_cosim.exchange.recording import read_recording
    from automotive_cosim.measures.encounters import EncounterKind, PairOrder, pair_readings

    seconds = read_recording(trial).road.seconds
    vehicles = {second.at_s: {each.vehicle_id: each for each in second.vehicles} for second in seconds}
    found = []
    for each in pair_readings(((second.at_s, second.vehicles) for second in seconds), None):
        if each.kind is not EncounterKind.FOLLOWING or each.ttc_s is None or each.ttc_s > MOST_TTC_S:
            continue
        at, other = vehicles[each.time_s][each.vehicle], vehicles[each.time_s][each.other]
        back, front = (at, other) if each.order is PairOrder.FOLLOWS else (other, at)
        ahead = math.radians(90 - back.heading_deg)
        dx_m, dy_m = front.x_m - back.x_m, front.y_m - back.y_m
        x_m, y_m = dx_m * math.cos(ahead) + dy_m * math.sin(ahead), dy_m * math.cos(ahead) - dx_m * math.sin(ahead)
        turned = math.radians((back.heading_deg - front.heading_deg + 180) % 360 - 180)
        found.append(
            {
                "of": trial.name,
                "follower": [0.0, 0.0, 0.0, back.speed_mps, back.length_m, back.width_m],
                "leader": [x_m, y_m, turned, front.speed_mps, front.length_m, front.width_m],
                "gap_m": each.gap_m,
                "ttc_s": each.ttc_s,
                "drac_mps2": each.drac_mps2,
            }
        )
    return found[:: max(1, len(found) // MOST_READINGS)]


def python_of(environment: Path) -> Path:
    """The interpreter of an environment with commonroad-crime, made if there is none."""
    python = environment / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    if not python.is_file():
        venv.create(environment, with_pip=True)
    known = subprocess.run([python, "-c", "import commonroad_crime"], capture_output=True, check=False)
    if known.returncode:
        subprocess.run([python, "-m", "pip", "install", "-q", PACKAGE], check=True)
    return python


def told(states: list[dict[str, Any]], theirs: list[dict[str, float]], of: str) -> None:
    """Prints the lines of a table."""
    for name, unit in (("gap_m", "m"), ("ttc_s", "s"), ("drac_mps2", "m/s2"), ("tet_s", "s"), ("tit_s2", "s2")):
        pairs = [
            (mine[name], other[name])
            for mine, other in zip(states, theirs, strict=True)
            if mine["of"] == of and mine.get(name) is not None
        ]
        if pairs:
            off = sorted(abs(mine - other) for mine, other in pairs)
            print(
                f"| {of} | {name} | {len(pairs)} | {off[len(off) // 2]:.3f} {unit} | "
                f"{off[int(0.95 * (len(off) - 1))]:.3f} {unit} | {off[-1]:.3f} {unit} |"
            )


# --- in the other environment ----------------------------------------------------------------------------------


def measured(states: list[dict[str, Any]]) -> list[dict[str, float]]:
    """What commonroad-crime finds, under the names used here."""
    import logging

    import numpy as np
    from commonroad.geometry.shape import Rectangle
    from commonroad.prediction.prediction import TrajectoryPrediction
    from commonroad.scenario.lanelet import Lanelet
    from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
    from commonroad.scenario.scenario import Scenario, ScenarioID
    from commonroad.scenario.state import InitialState, KSState
    from commonroad.scenario.trajectory import Trajectory
    from commonroad_crime.data_structure.configuration import CriMeConfiguration
    from commonroad_crime.measure import HW, TET, TIT, TTC, ALongReq

    logging.disable(logging.CRITICAL)
    along, across = np.array([math.cos(TILT), math.sin(TILT)]), np.array([-math.sin(TILT), math.cos(TILT)])
    points = np.linspace(-60.0, 700.0, 77)

    def line(aside_m: float) -> Any:
        return points[:, None] * along + aside_m * across

    def vehicle(number: int, state: list[float], steps: int) -> Any:
        x_m, y_m, turned, speed_mps, length_m, width_m = state
        begin = (x_m - math.cos(turned) * length_m / 2) * along + (y_m - math.sin(turned) * length_m / 2) * across
        way = (begin + speed_mps * STEP_S * step * along for step in range(steps + 1))
        places = list(way)
        first = InitialState(
            time_step=0, position=places[0], orientation=TILT, velocity=speed_mps, acceleration=0.0, yaw_rate=0.0,
            slip_angle=0.0,
        )  # fmt: skip
        later = [
            KSState(time_step=step, position=places[step], orientation=TILT, velocity=speed_mps, steering_angle=0.0)
            for step in range(1, steps + 1)
        ]
        shape = Rectangle(length_m, width_m)
        lanes = {step: {1} for step in range(steps + 1)}
        prediction = TrajectoryPrediction(Trajectory(1, later), shape, lanes, lanes)
        return DynamicObstacle(number, ObstacleType.CAR, shape, first, prediction)

    found = []
    for state in states:
        steps = STEPS if "tet_s" in state else 4
        scenario = Scenario(STEP_S, ScenarioID())
        scenario.add_objects(Lanelet(line(5.0), line(0.0), line(-5.0), 1))
        scenario.add_objects([vehicle(11, state["follower"], steps), vehicle(12, state["leader"], steps)])
        config = CriMeConfiguration()
        config.general.set_scenario_name("states")
        config.time.tau = TTC_S
        config.update(ego_id=11, sce=scenario)
        values = {
            "gap_m": HW(config).compute(12, 0, verbose=False),
            "ttc_s": TTC(config).compute(12, 0, verbose=False),
            "drac_mps2": -ALongReq(config).compute(12, 0, verbose=False),
        }
        if "tet_s" in state:
            values["tet_s"] = TET(config).compute(12, 1, verbose=False)
            values["tit_s2"] = TIT(config).compute(12, 1, verbose=False)
        found.append({name: float(value) for name, value in values.items()})
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", nargs="*", type=Path, help="folders of recorded trials")
    parser.add_argument("--environment", type=Path, default=Path("crime"), help="folder for commonroad-crime")
    parser.add_argument("--states", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.states:
        states = json.loads(given.states.read_text("utf-8"))
        given.states.write_text(json.dumps(measured(states)), "utf-8")
        return
    states = [*approaches(), *(each for trial in given.trials for each in readings(trial))]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "states.json"
        file.write_text(json.dumps(states), "utf-8")
        subprocess.run([python_of(given.environment), __file__, "--states", file], check=True)
        theirs = json.loads(file.read_text("utf-8"))
    print("| states | measure | readings | median off | 95 % off by less | most |")
    print("|---|---|---:|---:|---:|---:|")
    for of in dict.fromkeys(state["of"] for state in states):
        told(states, theirs, of)


if __name__ == "__main__":
    main()
