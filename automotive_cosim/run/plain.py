"""The reference for benchmarks: a plain libsumo loop in a separate process.

    python -m automotive_cosim.run.plain '{"command": [...], "folder": "...", "warm_up_steps": 9, "steps": 20}'

prints the wall seconds of the steps after the warm-up.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from time import perf_counter

from automotive_cosim.traffic.confinement import confine
from automotive_cosim.traffic.sumo import load_library


def main() -> None:
    """Runs the job in the first argument."""
    job = json.loads(sys.argv[1])
    sumo = load_library()
    os.chdir(job["folder"])
    confine([Path(job["folder"])])
    sumo.start(job["command"])
    for _ in range(job["warm_up_steps"]):
        sumo.step()
    began_s = perf_counter()
    for _ in range(job["steps"]):
        sumo.step()
    seconds = perf_counter() - began_s
    print(seconds)
    sumo.close()


if __name__ == "__main__":
    main()
