"""How much later SUMO's drivers brake the less aware they are, beside what studies found of people; SUMO alone.

    python benchmarks/braking.py --plot docs/images/attention.svg

One car follows another at 25 m/s, 1.4 s behind, which brakes at 3 m/s2. ``netconvert`` makes the road.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from automotive_cosim.cosim.attention import CALLED, FADES_S, MIND, SPENT, SPENT_H, Asked, Attention
from automotive_cosim.traffic.sumo_programs import run

AWARE = (1.0, 0.9, 0.85, 0.8, 0.78, 0.76, 0.73, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1)
STEP_S, MPS, HEADWAY_S = 0.1, 25.0, 1.4
STUDIES = {
    "Strayer and others 2006: +0.07 s": 0.072,
    "Horrey and Wickens 2006: +0.13 s": 0.13,
    "Caird and others 2008: +0.25 s": 0.25,
}
"""How much later people on the phone react."""
ROUTES = """<routes><vType id="lead" sigma="0" speedDev="0"/><route id="r" edges="e"/>
<vType id="car" sigma="0.3" tau="1.4" speedDev="0" speedFactor="1.1">
<param key="has.driverstate.device" value="true"/></vType>
<vehicle id="L" type="lead" depart="0" route="r" departSpeed="25" departPos="80"/>
<vehicle id="E" type="car" depart="0" route="r" departSpeed="25" departPos="37.5"/></routes>"""


def road(folder: Path) -> list[str]:
    """A straight road of eight kilometres with both cars on it, as SUMO's options."""
    net, routes = folder / "n.net.xml", folder / "n.rou.xml"
    (folder / "n.nod.xml").write_text('<nodes><node id="a" x="0" y="0"/><node id="b" x="8000" y="0"/></nodes>')
    (folder / "n.edg.xml").write_text('<edges><edge id="e" from="a" to="b" speed="30"/></edges>')
    routes.write_text(ROUTES)
    run("netconvert", ["-n", folder / "n.nod.xml", "-e", folder / "n.edg.xml", "-o", net])
    return ["-n", str(net), "-r", str(routes), "--step-length", str(STEP_S), "--no-step-log", "--no-warnings"]


def braked(libsumo: Any, options: list[str], awareness: float, seed: int) -> tuple[float, float, float]:
    """Seconds until the car brakes at 1 m/s2, how uneven its gap was before in seconds, and its hardest braking."""
    libsumo.load([*options, "--seed", str(seed)])
    libsumo.simulationStep()
    car = libsumo.vehicle
    car.setParameter("E", "device.driverstate.awareness", str(awareness))
    car.setSpeed("L", MPS)
    gaps, braking = [], []
    for _ in range(round(40 / STEP_S)):
        libsumo.simulationStep()
        gaps.append(car.getLeader("E", 500)[1] / MPS)
    car.setSpeed("L", -1)
    car.slowDown("L", 7, 6)
    for _ in range(round(15 / STEP_S)):
        libsumo.simulationStep()
        braking.append(-car.getAcceleration("E"))
    late = next((number for number, mps2 in enumerate(braking) if mps2 > 1), len(braking))
    return late * STEP_S, float(np.std(gaps[len(gaps) // 2 :])), max(braking)


def drawn(path: Path, delays_s: np.ndarray, ends_s: np.ndarray) -> None:
    """The three curves beside their data."""
    import matplotlib.pyplot as plt

    figure, (eyes, mind, fade) = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    for look_s, colour in ((2.0, "C0"), (5.0, "C1")):
        attention = Attention()
        attention.ask(Asked(0.0, look_s=look_s))
        stores = [attention.eyes_s]
        for _ in range(120):
            attention.glanced(0.1)
            stores.append(attention.eyes_s)
        eyes.plot(np.arange(121) / 10, stores, colour, label=f"the screen asks for {look_s:g} s")
    eyes.axhline(0, color="C3", linestyle=":", label="2 s away: NHTSA's longest glance")
    eyes.set(xlabel="seconds", ylabel="store, s", title="Eyes", ylim=(-0.9, 2.1))
    eyes.legend(fontsize=7, loc="lower right")
    mind.errorbar(AWARE, delays_s, ends_s, marker="o", markersize=3, label="SUMO 1.28, with 95 %")
    for number, (study, late_s) in enumerate(STUDIES.items()):
        mind.axhline(late_s, color=f"C{number + 1}", linestyle="--", linewidth=1, label=study)
    mind.axvline(1 - MIND * CALLED, color="black", linewidth=0.8, label=f"a call: {1 - MIND * CALLED:.2f}")
    mind.axvline(SPENT, color="black", linestyle=":", linewidth=0.8, label=f"{SPENT_H:g} hours: {SPENT}")
    mind.set(xlabel="awareness", ylabel="brakes later by, s", title="Mind", xlim=(1.02, 0.05), ylim=(-0.05, 1.3))
    mind.legend(fontsize=7, loc="upper left")
    seconds = np.arange(0, 41)
    fade.plot(seconds, 100 * np.exp(-seconds / FADES_S), label="what is left of the load")
    fade.axvline(27, color="C3", linestyle=":", label="27 s: Strayer and others 2015")
    fade.set(xlabel="seconds after the last word", ylabel="per cent", title="After words")
    fade.legend(fontsize=7)
    figure.savefig(path, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=150)
    parser.add_argument("--plot", type=Path, help="file of the plot")
    parsed = parser.parse_args()
    import libsumo

    with tempfile.TemporaryDirectory() as folder:
        options = road(Path(folder))
        libsumo.start(["sumo", *options])
        found = np.array([[braked(libsumo, options, each, seed) for seed in range(parsed.seeds)] for each in AWARE])
    later_s = found[:, :, 0] - found[:1, :, 0]
    ends_s = 1.96 * later_s.std(axis=1) / parsed.seeds**0.5
    print("| awareness | delay, s (95 %) | gap varies by, s | hardest braking, m/s² |\n|---:|---:|---:|---:|")
    for number, each in enumerate(AWARE):
        spread_s, hardest = found[number, :, 1].mean(), found[number, :, 2].mean()
        print(
            f"| {each:g} | {later_s[number].mean():.2f} (±{ends_s[number]:.2f}) | {spread_s:.3f} | {hardest:.1f} |"
        )
    if parsed.plot:
        drawn(parsed.plot, later_s.mean(axis=1), ends_s)


if __name__ == "__main__":
    main()
