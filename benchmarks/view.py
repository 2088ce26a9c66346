"""Times the view through the windshield on drives of several places, and keeps pictures of it.

    python benchmarks/view.py [--drives grid_june,london_november] [--to FOLDER]

Of each drive, ten pictures in two minutes; the time is the process's own for one picture, without the look at the
traffic, which is told apart.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from statistics import median
from time import process_time

from PIL import Image

from automotive_cosim.cosim import simulation
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.view.paint import picture
from automotive_cosim.view.scene import Scene

PLACES = "grid_june,grid_january,autobahn_july,london_november,new_york_june,peripherique_november,paris_july"


def measure(family: str, simulations: Simulations, to: Path | None) -> str:
    """A line of the table."""
    seconds: list[float] = []
    whole: list[float] = []

    def timed(scene: Scene) -> object:
        began_s = process_time()
        made = picture(scene)
        seconds.append(process_time() - began_s)
        return made

    session = DriveSpec(family, seed=1).begin(simulations, frozenset(), lean=True)
    simulation.picture = timed  # type: ignore[assignment]
    try:
        for number in range(11):
            session.world.advance(12.0)
            began_s = process_time()
            view = session.world.view()
            whole.append(process_time() - began_s)
            if to is not None:
                Image.fromarray(view).save(to / f"{family}_{number:02d}.png")
    finally:
        simulation.picture = picture
        session.close()
    around_s = median(w - s for w, s in zip(whole[1:], seconds[1:], strict=True))
    return f"{family:24} {1000 * median(seconds[1:]):6.1f} {1000 * max(seconds[1:]):6.1f} {1000 * around_s:6.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--drives", default=PLACES, help="families of drives")
    parser.add_argument("--to", type=Path, help="keep the pictures in this folder")
    given = parser.parse_args()
    print(f"{'ms a picture':24} {'median':>6} {'most':>6} {'look':>6}")
    simulations = Simulations()
    for family in given.drives.split(","):
        print(measure(family, simulations, given.to), flush=True)
    simulations.close()


if __name__ == "__main__":
    main()
