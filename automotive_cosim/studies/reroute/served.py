"""What the pages show of a study of rerouting: each decision, and its futures on one road."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.csvs import read_packed_csv
from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.serve.records import NotHereError
from automotive_cosim.studies.reroute.decisions import told
from automotive_cosim.studies.reroute.results import Study, all_decisions, choices_at
from automotive_cosim.studies.reroute.rows import Branch, DecisionPoint
from automotive_cosim.studies.reroute.tracks import TRACKS
from automotive_cosim.traffic.network import Network

AROUND_M = 400.0
"""How far beyond the routes roads are drawn."""
EVERY_S = 1.0
"""Between two positions of a car."""


def decisions(folder: Path) -> Json:
    """Every decision of a study with its futures and what each policy chose.

    Raises UserError: it is not a study's folder, or is damaged."""
    study = Study.read(folder)
    return {
        "name": folder.name,
        "scenario": study.plan.scenario,
        "planned": len(study.plan.jobs()),
        "done": len(study.rows),
        "running": is_being_written(folder / "lock"),
        "decisions": [_decision(study, point) for point in all_decisions(study.rows)],
    }


def decision_map(folder: Path, name: str) -> Json:
    """The roads around a decision and the routes of its futures; x to the east and y to the north, in metres.

    Raises:
        NotHereError: there is no such decision, or its row does not hold the routes.
        UserError: the study or its scenario cannot be read."""
    study = Study.read(folder)
    point = next((each for each in all_decisions(study.rows) if each.id == name), None)
    if point is None or not point.decision.ways:
        raise NotHereError(f"there are no routes of a decision {name!r}; older studies did not keep them")
    network = _network(study.plan.scenario)
    edges = network.edges
    ways = [
        [place for edge in way if edge in edges for place in edges[edge].shape_m] for way in point.decision.ways
    ]
    xs, ys = ([place[axis] for way in ways for place in way] for axis in (0, 1))
    left, right, bottom, top = min(xs) - AROUND_M, max(xs) + AROUND_M, min(ys) - AROUND_M, max(ys) + AROUND_M
    shapes = (*(edge.shape_m for edge in edges.values()), *network.joints_m)
    near = (shape for shape in shapes if any(left < x < right and bottom < y < top for x, y in shape))
    return {
        "box": [round(each) for each in (left, bottom, right, top)],
        "roads": [_flat(shape) for shape in near],
        "ways": [_flat(way) for way in ways],
        "tracks": _tracks(folder, point, len(ways)),
    }


def _tracks(folder: Path, point: DecisionPoint, count: int) -> list[list[list[float]]]:
    """Where the car is in each future, as ``[seconds since the decision, x, y]`` about once a second; empty lists
    without ``study --trajectories``.

    Raises UserError: what is stored cannot be read."""
    tracks: list[list[list[float]]] = [[] for _ in range(count)]
    path = folder / TRACKS / f"{point.drive.id}.csv.gz"
    try:
        for row in read_packed_csv(path):
            if row["id"] == point.id and row["draw"] == "0" and row["is_placebo"] == "False":
                track = tracks[0 if row["branch"] == "" else int(row["branch"]) + 1]
                at_s = round(float(row["time_s"]) - point.decision.at_s, 1)
                if not track or at_s >= track[-1][0] + EVERY_S:
                    track.append([at_s, round(float(row["x_m"]), 1), round(float(row["y_m"]), 1)])
    except (OSError, LookupError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error
    return tracks


def _decision(study: Study, point: DecisionPoint) -> Json:
    drive, decision = point.drive, point.decision
    chosen = choices_at(point, study.plan.policies, study.plan.compliance[0]) if not decision.excluded else ()
    return {
        "id": point.id,
        **{name: getattr(drive, name) for name in ("trip", "seed", "share", "departure_s")},
        **{name: getattr(decision, name) for name in ("at_s", "edge", "delay_s", "eta_s", "draws")},
        "complies": decision.complies(study.plan.compliance[0]),
        "excluded": decision.excluded,
        "why": decision.why,
        "has_ways": bool(decision.ways),
        "agents": dict(decision.agents),
        "told": list(told(decision)),
        "futures": [_future(branch, number, decision.gains(number).time_s)
                    for number, branch in enumerate(decision.branches)],
        "choices": [{"policy": each.policy, "age_s": each.age_s, "branch": each.branch} for each in chosen],
    }  # fmt: skip


def _future(branch: Branch, number: int, gain_s: float) -> Json:
    """What a route saves compared with keeping the route, for the ego as the mean over the draws."""
    return {
        "number": number,
        "gain_s": round(gain_s, 1),
        "stops": branch.gains.stops,
        "distance_m": round(branch.gains.distance_m),
        "co2_g": round(branch.gains.co2_g, 1),
        "others_s": round(branch.others.gain_s, 1),
        "others": branch.others.count,
        "changed": branch.others.changed,
    }


@lru_cache(maxsize=2)
def _network(scenario: str) -> Network:
    return network_of(open_scenario(scenario))


def _flat(shape: list[tuple[float, float]] | tuple[tuple[float, float], ...]) -> list[float]:
    return [round(part, 1) for place in shape for part in place]
