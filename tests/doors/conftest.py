"""What every door is held to: the reference solution's actions, and their trace on the command line."""

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Json
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.trial import Shot, TrialObserver, run_trial
from automotive_cosim.traffic.fork import Simulations

DRIVE: Json = {"drive": "grid_june", "seed": 3, "minutes": 0.5}
"""Half a minute of a drive, as doors start it."""
CALLS: tuple[tuple[str, Json], ...] = (
    ("set_hvac_fan_speed", {"percent": 100}),
    ("status", {"goal_status": "complete"}),
)
"""What wins hvac_fan_max by functions."""
WAIT: Json = {"action_type": "wait"}


@pytest.fixture(scope="module")
def drive_trace(simulations: Simulations) -> str:
    """The trace of waiting on that drive until it is over."""
    setup = DriveSetup("grid_june", 3, agent="silent", settings=DriveSettings(minutes=0.5))
    row = run_trial(setup, make_agent("silent"), simulations=simulations)
    assert row.trace_sha256
    return row.trace_sha256


class Actions(TrialObserver):
    def __init__(self) -> None:
        self.played: list[Json] = []

    def stepped(self, shot: Shot) -> None:
        assert shot.step.action
        self.played.append(to_json(shot.step.action))


@pytest.fixture(scope="module")
def oracle(simulations: Simulations) -> tuple[list[Json], str | None]:
    """The reference solution's actions for hvac_fan_max on the grid, and their trace."""
    watcher = Actions()
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="oracle", model="none")
    result = run_trial(setup, make_agent("oracle"), (watcher,), simulations=simulations)
    return watcher.played, result.trace_sha256
