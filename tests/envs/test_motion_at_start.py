"""A task can say in which driving states it starts."""

from dataclasses import replace

import pytest

from automotive_cosim.cockpit.restrictions import Motion
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.tasking.triggers import Trigger
from automotive_cosim.tasks import CATALOGUE


class Always:
    """Holds at any time."""

    def __call__(self, moment):
        return True


def started(simulations, *motions):
    task = CATALOGUE["hvac_fan_max"]
    first = replace(task.first, trigger=Trigger(Always(), 0.0, 120.0))
    start = replace(task.first.start, scenario="grid", trip="avenue", motions=frozenset(motions))
    env = CockpitEnv(replace(task, first=replace(first, start=start)), scenario="grid", simulations=simulations)
    env.reset(seed=4)
    speed_mps = env.episode.moments[0].driving.speed_mps
    env.close()
    return speed_mps


@pytest.mark.parametrize(("motion", "stands"), [(Motion.IDLING, True), (Motion.MOVING, False)])
def test_the_hand_over_waits_for_the_motion(simulations, motion, stands):
    assert (started(simulations, motion) < 0.14) == stands
