"""What the pages show of a record and of an evaluation, as plain values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import KMH_PER_MPS, Element, Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import parse_json, read_json
from automotive_cosim.report.page import PARTS, element
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.road import FORMAT, read_road
from automotive_cosim.run.road import NAME as ROAD
from automotive_cosim.run.road_recorder import is_being_written
from automotive_cosim.run.store import read_manifest, read_rows, read_trace
from automotive_cosim.run.words import action_in_words
from automotive_cosim.serve.shelf import NotHereError, Shelf, ShelfEntry

HEAD = (
    *("task", "half", "scenario", "agent", "model", "seed", "success", "steps", "sim_seconds", "end", "error"),
    *("goal", "geo", "see", "feedback", "screen", "language", "tokens_in", "tokens_out", "model_seconds"),
)
SHOWN = (
    *("id", "task", "half", "scenario", "agent", "model", "geo", "see", "feedback", "screen"),
    *("language", "seed", "repeat"),
    *("dimension", "module"),
    *("success", "error", "error_kind", "end", "steps", "sim_seconds", "held_out", "goal_s"),
)
"""Fields of a row that the table of results shows."""
OWN_ROAD = ("limit_kmh", "speed_kmh", "road")


class Content:
    """Reads records for the pages."""

    def __init__(self, shelf: Shelf) -> None:
        """Reads nothing yet."""
        self.shelf = shelf

    def runs(self) -> Json:
        """All records, the newest first, each on one line."""
        return {"records": [_safely(entry, self._line) for entry in self.shelf.entries()]}

    def run(self, name: str, episode: str | None = None) -> Json:
        """One recorded episode, or one of an evaluation, without its steps.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        entry = self.shelf.entry(name)
        result = self._result(entry, episode)
        head = _head(result) if result else self._unfinished(entry, episode)
        return {
            "id": entry.id,
            "episode": episode,
            "name": entry.folder.name,
            "running": self._is_running(entry, episode),
            "parts": dict(PARTS),
            **head,
            "verdict": result.get("verdict") if result else None,
            "timeline": result.get("timeline", ()) if result else (),
            "path": result.get("path", ()) if result else (),
            "violations": result.get("violations", ()) if result else (),
            "manifest": result.get("manifest") if result else None,
            "trace_sha256": result.get("trace_sha256") if result else None,
        }

    def steps(self, name: str, episode: str | None, skip: int) -> Json:
        """The steps of an episode from number ``skip`` on.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        entry = self.shelf.entry(name)
        lines = self._lines(entry, episode)
        steps = _steps(entry, self.shelf, episode, lines)
        return {"steps": steps[skip:], "running": self._is_running(entry, episode)}

    def road(self, name: str, episode: str | None, skip: int) -> Iterable[Json]:
        """The lines of the recorded road from number ``skip`` on; without a recording, a road with the ego alone.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        entry = self.shelf.entry(name)
        try:
            path = self._road(entry, episode)
        except NotHereError:
            result = self._result(entry, episode)
            return list(_alone(result) if result else ())[skip:]
        return _road_lines(path, *_stamp(path))[skip:]

    def evaluation(self, name: str) -> Json:
        """The plan and the rows of an evaluation.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        entry = self.shelf.entry(name)
        if not entry.is_evaluation:
            raise NotHereError(f"record {name!r} is not an evaluation")
        manifest = read_manifest(entry.folder)
        if "agents" not in manifest["plan"]:
            raise NotHereError(f"{entry.folder.name} has no episodes of agents")
        rows = read_rows(entry.folder, EpisodeRow)
        return {
            "id": entry.id,
            "name": entry.folder.name,
            "plan": manifest["plan"],
            "planned": manifest.get("episodes"),
            "running": sorted(
                path.parent.name for path in entry.folder.glob(f"pictures/*/{ROAD}") if is_being_written(path)
            ),
            "rows": [
                {name: getattr(row, name) for name in SHOWN}
                | {"missing": row.missing, "has_trace": (entry.folder / "traces" / f"{row.id}.jsonl.gz").is_file()}
                for row in rows.values()
            ],
        }

    # --- inside -----------------------------------------------------------------------------------------------

    def _line(self, entry: ShelfEntry) -> Json:
        shared = {"id": entry.id, "name": entry.folder.name, "folder": str(entry.folder)}
        if entry.is_evaluation:
            manifest = read_manifest(entry.folder)
            kind = "evaluation" if "agents" in manifest["plan"] else "other"
            done = (entry.folder / "episodes.jsonl").read_bytes().count(b"\n")
            started = manifest["starts"][-1]["started"]
            return {**shared, "kind": kind, "done": done, "planned": manifest.get("episodes"), "started": started}
        path = entry.folder / "episode.json"
        head = _head_of(self.shelf.file(entry, path.name), *_stamp(path)) if path.is_file() else None
        return {
            **shared,
            "kind": "run",
            "running": self._is_running(entry, None),
            **(head or self._unfinished(entry, None)),
        }

    def _result(self, entry: ShelfEntry, episode: str | None) -> Json | None:
        """The whole result; None while it runs, or if it was killed."""
        try:
            if episode is not None:
                return dict(self._trace(entry, episode)[-1]["result"])
            return _object(self.shelf.file(entry, "episode.json"))
        except NotHereError:
            if episode is not None:
                self._road(entry, episode)
            return None

    def _trace(self, entry: ShelfEntry, episode: str) -> list[Json]:
        self.shelf.file(entry, "traces", f"{episode}.jsonl.gz")
        return read_trace(entry.folder, episode)

    def _lines(self, entry: ShelfEntry, episode: str | None) -> list[Json]:
        if episode is not None:
            return self._trace(entry, episode)[:-1] if self._result(entry, episode) else []
        path = self.shelf.file(entry, "steps.jsonl")
        return _json_lines(path, *_stamp(path))

    def _road(self, entry: ShelfEntry, episode: str | None) -> Path:
        return self.shelf.file(entry, *(() if episode is None else ("pictures", episode)), ROAD)

    def _is_running(self, entry: ShelfEntry, episode: str | None) -> bool:
        """Whether the episode is being recorded now."""
        try:
            return is_being_written(self._road(entry, episode))
        except NotHereError:
            return False

    def _unfinished(self, entry: ShelfEntry, episode: str | None) -> Json:
        """What is known of an episode that runs or was killed."""
        try:
            begun = next(iter(read_road(self._road(entry, episode))), {})
        except NotHereError:
            begun = {}
        return {name: begun.get(name) for name in HEAD} | {
            "task": begun.get("task") or episode or entry.folder.name,
            "end": "running" if self._is_running(entry, episode) else "stopped before its end",
        }


def _stamp(path: Path) -> tuple[int, int]:
    """Changes when the file does."""
    stat = path.stat()
    return stat.st_mtime_ns, stat.st_size


@lru_cache(maxsize=4096)
def _head_of(path: Path, *_stamp: int) -> Json:
    return _head(_object(path))


@lru_cache(maxsize=4)
def _json_lines(path: Path, *_stamp: int) -> list[Json]:
    """The whole lines of a file that may still grow."""
    text = path.read_text(encoding="utf-8")
    return [parse_json(line) for line in text[: text.rfind("\n") + 1].splitlines()]


@lru_cache(maxsize=4)
def _road_lines(path: Path, *_stamp: int) -> list[Json]:
    return list(read_road(path))


def _head(result: Json) -> Json:
    started = (result.get("manifest") or {}).get("started")
    return {name: result.get(name) for name in HEAD} | {"started": started}


def _object(path: Path) -> Json:
    try:
        made = read_json(path)
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error
    if not isinstance(made, dict):
        raise UserError(f"{path} is not a record of an episode")
    return made


def _safely(entry: ShelfEntry, describe: Any) -> Json:
    """A line for a record that cannot be read, too."""
    try:
        made: Json = describe(entry)
    except (UserError, OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        return {"id": entry.id, "name": entry.folder.name, "kind": "unreadable", "error": str(error)}
    return made


def _steps(entry: ShelfEntry, shelf: Shelf, episode: str | None, lines: Sequence[Json]) -> list[Json]:
    """What the page shows of each step; an action refers to the elements of the step before."""
    shown = []
    seen: tuple[Element, ...] = ()
    for line in lines:
        action = None if line["action"] is None else parse(line["action"])
        shown.append(
            {
                "number": line["step"],
                "at_s": round(line["time_s"] - lines[0]["time_s"], 2),
                "local_time": line.get("local_time", ""),
                "words": action_in_words(action, seen) if line["step"] else "hand-over",
                "action": line["action"],
                "target": _target(line["action"], line["step"], seen),
                "feedback": line["feedback"],
                "thought": line.get("thought", ""),
                "stages": [_stage(stage) for stage in line.get("stages", ())],
                "context": line.get("context", ""),
                "speed_kmh": round(line["traffic"]["speed_mps"] * KMH_PER_MPS, 1),
                "has_picture": _has_picture(shelf, entry, episode, line["step"]),
            }
        )
        seen = tuple(map(element, line["elements"]))
    return shown


def _stage(stage: Json) -> Json:
    reply = stage.get("reply") or {}
    spent = {name: reply.get(name) for name in ("tokens_in", "tokens_out", "seconds")}
    return {"name": stage.get("stage", stage.get("name", "")), "text": stage.get("text", ""), **spent}


def _target(action: Json | None, step: int, seen: Sequence[Element]) -> list[int] | None:
    """The box on the previous screen that the action points at: left, top, right, bottom."""
    index = (action or {}).get("index")
    if not step or not isinstance(index, int) or not 0 <= index < len(seen):
        return None
    box = seen[index].bbox_pixels
    return [box.x_min, box.y_min, box.x_max, box.y_max]


def _has_picture(shelf: Shelf, entry: ShelfEntry, episode: str | None, step: int) -> bool:
    try:
        shelf.picture(entry, episode, step)
    except NotHereError:
        return False
    return True


def _alone(result: Json) -> Iterable[Json]:
    """A road on which nobody looked: the car alone, on the line that it drove."""
    path = result.get("path") or []
    yield {"format": FORMAT, "radius_m": 0.0, "left_hand": False, "has_place": True, "alone": True}
    line = [part for sample in path for part in (sample["x_m"], sample["y_m"])]
    yield {"lanes": [["road", 6.4, line, []]] if len(path) > 1 else [], "junctions": []}
    yield {"vehicles": [[0, "ego", "passenger", 4.5, 1.8]]}
    for sample in path:
        seen = [0, sample["x_m"], sample["y_m"], sample["heading_deg"], sample["speed_kmh"] / KMH_PER_MPS, 0]
        yield {
            "at_s": sample["at_s"],
            "seen": [seen],
            "lights": {},
            **{name: sample[name] for name in OWN_ROAD},
            "speed_unit": sample.get("speed_unit", "km/h"),
            "local_time": "",
            "sun_deg": 45.0,
            "weather_code": None,
            "incidents": [],
            "events": [],
        }
