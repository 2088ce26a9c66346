"""Episodes on the small grid, whose warm traffic all tests of a session share."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from automotive_cosim.agents import Agent, make_agent
from automotive_cosim.episode.conditions import TABLE, Conditions
from automotive_cosim.run.episode import EpisodeResult, EpisodeSetup
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.trial import Shot, TrialObserver, run_trial
from automotive_cosim.traffic.fork import Simulations

TASK = "hvac_fan_max"


@dataclass
class Memory(TrialObserver):
    """Keeps what it was told."""

    shots: list[Shot] = field(default_factory=list)
    moved_s: list[float] = field(default_factory=list)
    rows: list[EpisodeRow] = field(default_factory=list)
    told: EpisodeResult | None = None

    def moved(self, moment, cockpit):
        self.moved_s.append(moment.time_s)

    def begun(self, session, shot):
        self.shots.append(shot)

    def stepped(self, shot):
        self.shots.append(shot)

    def finished(self, row, told):
        self.rows.append(row)
        self.told = told


@dataclass
class Episode:
    result: EpisodeRow
    folder: Path
    memory: Memory


@pytest.fixture
def run(tmp_path: Path, simulations: Simulations) -> Callable[..., Episode]:
    """Runs a recorded episode on the grid."""

    def run_(agent: str | Agent = "oracle", out: str = "out", **names: object) -> Episode:
        player = make_agent(agent) if isinstance(agent, str) else agent
        named = {name: names.pop(name) for name in [each.name for each in TABLE] if name in names}
        setup = EpisodeSetup(
            **({"task": TASK, "scenario": "grid", "agent": player.name, "model": player.model} | names),
            conditions=Conditions.named(named),
        )
        memory = Memory()
        watchers = [Recorder(setup, tmp_path / out, {}, whole=True), memory]
        return Episode(run_trial(setup, player, watchers, simulations=simulations), tmp_path / out, memory)

    return run_
