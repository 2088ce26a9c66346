"""A kept trial: the road second by second, and what the agent did."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from automotive_cosim.contracts import ActionType, Json
from automotive_cosim.errors import UserError
from automotive_cosim.run.road import RoadRecord, read_record, road_in
from automotive_cosim.run.trial_folder import read_steps


@dataclass(frozen=True, slots=True)
class RecordedAct:
    """Something that the agent did, other than wait."""

    at_s: float
    """When it acted, on the clock of the recorded road."""
    action: Json
    words: str


@dataclass(frozen=True, slots=True)
class Recording:
    """A kept trial."""

    folder: Path
    road: RoadRecord
    acts: tuple[RecordedAct, ...]

    @property
    def begin_s(self) -> float:
        """The first recorded second; before 0 in an episode, which counts from the hand-over."""
        return self.road.seconds[0].at_s

    @property
    def scenario(self) -> str:
        """Name or path of the scenario."""
        return str(self.road.about.get("scenario", ""))

    @property
    def title(self) -> str:
        """What was run, in a line."""
        about = self.road.about
        return (
            f"{about.get('task', 'a drive')} in {self.scenario}, {about.get('agent', '')}, seed {about.get('seed')}"
        )


def read_recording(folder: Path) -> Recording:
    """Reads a folder of ``run``, or a trial's in ``pictures/`` of an evaluation.

    Raises UserError: it has no recorded road, or cannot be read."""
    path = road_in(folder)
    road = read_record(path)
    if not road.seconds:
        raise UserError(f"{path} has no second of a drive; record the run again")
    try:
        return Recording(folder, road, tuple(_acts(folder)))
    except (LookupError, TypeError, ValueError) as error:
        raise UserError(f"cannot read the steps of {folder}: {type(error).__name__}: {error}") from error


def _acts(folder: Path) -> Iterator[RecordedAct]:
    """The acts, each at the instant of the observation that it answers."""
    for before, now in pairwise(read_steps(folder)):
        if _acted(now["action"]):
            yield RecordedAct(before["at_s"], now["action"], now["words"])


def _acted(action: Json | None) -> bool:
    return action is not None and action.get("action_type") != ActionType.WAIT
