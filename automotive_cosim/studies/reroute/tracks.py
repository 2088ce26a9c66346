"""Where the ego was in every future of a drive: one file per drive, one row per step of a future."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from automotive_cosim.formats.csvs import write_packed_csv
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.points import Drawn, Point

TRACKS = "trajectories"
"""Their folder in a study's."""

COLUMNS = ("id", "draw", "branch", "is_placebo", "time_s", "x_m", "y_m", "speed_mps", "edge")
"""As in ``futures.csv``: without a branch, the route is kept."""


def write_tracks(folder: Path, drive_id: str, stay: Future, points: Sequence[Point]) -> None:
    """Writes all futures of a drive from their decisions on, as gzipped CSV.

    Args:
        stay: the drive itself, in which the ego keeps its route.

    Raises OSError: it cannot be written."""
    lines = (
        (f"{drive_id}-{number}", draw, branch, str(is_placebo), *each)
        for number, point in enumerate(points)
        for draw, branch, is_placebo, future in _futures(stay, point)
        for each in future.settled.track
        if each[0] >= point.decision.at_s
    )
    write_packed_csv(folder / f"{drive_id}.csv.gz", COLUMNS, lines)


def _futures(stay: Future, point: Point) -> Iterator[tuple[int, int | None, bool, Future]]:
    """Draw, branch, whether it is a placebo, and the future."""
    branches = [stay if branch is None else branch for branch in point.branches]
    for draw, each in enumerate((Drawn(0, stay, branches), *point.replicates)):
        yield draw, None, False, each.stay
        for branch, future in enumerate(each.branches):
            yield draw, branch, False, future
    if point.placebo is not None:
        yield 1, None, True, point.placebo
