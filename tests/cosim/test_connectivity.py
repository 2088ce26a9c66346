"""The car's link drops and comes back as the scenario's file says, beside what tunnels do to it."""

import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim import scenarios
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Connectivity
from automotive_cosim.cosim.simulation import couple
from automotive_cosim.geo.connectivity import ATTACH_S
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked

pytestmark = pytest.mark.sumo

TIMELINE = {8.0: "4g", 12.0: "none", 20.0: "5g"}


def links(folder: Path, trip: str, duration_s: float) -> dict[float, tuple[Connectivity, bool]]:
    """Link and tunnel by the seconds since departure."""
    scenario = scenarios.load(folder)
    with closing(Forked(scenario, seed=1)) as simulation:
        traffic = simulation.depart(EgoPlan(scenario.trip(trip), seed=1))
        world = couple(
            traffic,
            Cockpit(traffic.network, rng=np.random.default_rng(1)),
            scenario,
            gps_rng=np.random.default_rng(2),
            weather=scenario.weather,
            departure=scenario.start,
            links=scenario.connectivity,
        )
        with closing(world):
            start_s = world.moment.time_s
            moments = [world.moment, *world.advance(duration_s)]
    return {
        round(moment.time_s - start_s, 1): (moment.connectivity, moment.driving.road.in_tunnel)
        for moment in moments
    }


def test_by_time_and_in_tunnels(tmp_path: Path) -> None:
    folder = tmp_path / "grid"
    shutil.copytree(scenarios.load("grid").folder, folder)
    rows = "".join(f'[[connectivity]]\nat_s = {at_s}\nbest = "{best}"\n' for at_s, best in TIMELINE.items())
    path = folder / "scenario.toml"
    path.write_text(f"{path.read_text()}\n{rows}")

    seen = links(folder, "tunnel", 120.0)
    kinds = {at_s: link.kind for at_s, (link, _) in seen.items()}
    assert {kind for at_s, kind in kinds.items() if at_s < 8} == {"5g"}
    assert {kind for at_s, kind in kinds.items() if 8 <= at_s < 12} == {"4g"}
    assert {kind for at_s, kind in kinds.items() if 12 <= at_s < 20 + ATTACH_S - 1} == {"none"}
    back_s = 20 + ATTACH_S - 1
    assert kinds[back_s] == "5g", "it comes back"
    tunnel = [at_s for at_s, (_, in_tunnel) in seen.items() if in_tunnel]
    assert min(tunnel) > back_s
    assert {kinds[at_s] for at_s in tunnel} == {"none"}
    assert list(kinds.values())[-1] == "5g"
    assert all(link.online == (link.kind != "none") == (link.signal_bars > 0) for link, _ in seen.values())
