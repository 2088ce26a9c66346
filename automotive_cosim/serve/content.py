"""What the pages show of a record and of an evaluation, as plain values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import KMH_PER_MPS, Element, Json
from automotive_cosim.drives.faults import OUTCOMES, WHY_VOID, times, was
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, JudgedEvent
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import parse_json, read_json
from automotive_cosim.report.page import PARTS, element
from automotive_cosim.run.coverage import unit_of
from automotive_cosim.run.drive_recorder import SHOWN as DRIVE_STEPS
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.former import trial_values
from automotive_cosim.run.road import FORMAT, read_road
from automotive_cosim.run.road import NAME as ROAD
from automotive_cosim.run.road_recorder import is_being_written
from automotive_cosim.run.row import from_json
from automotive_cosim.run.rows import read_trials
from automotive_cosim.run.store import read_manifest, read_rows, read_trace
from automotive_cosim.run.words import action_in_words
from automotive_cosim.safety.page import PAGE
from automotive_cosim.serve.decisions import decision_map, decisions, drives_under_way
from automotive_cosim.serve.observers import StudyObservers
from automotive_cosim.serve.records import NotHereError, RecordEntry, RecordFolders
from automotive_cosim.studies.live import LIVE, WATCHED

HEAD = (
    *("task", "half", "scenario", "agent", "model", "seed", "success", "steps", "sim_seconds", "end", "error"),
    *("goal", "tokens_in", "tokens_out", "model_seconds"),
)
SHOWN = (
    *("id", "task", "half", "scenario", "agent", "model", "seed", "repeat"),
    *("dimension", "module"),
    *("success", "error", "error_kind", "end", "steps", "sim_seconds", "held_out", "goal_s"),
)
"""Fields of a row that the table of results shows."""
OWN_ROAD = ("limit_kmh", "speed_kmh", "road")


class Content:
    """Reads records for the pages."""

    def __init__(self, records: RecordFolders) -> None:
        """Content of these folders; files are read when they are first asked for."""
        self.records = records
        self.observers = StudyObservers()

    def runs(self) -> Json:
        """All records, the newest first, each on one line."""
        return {"records": [_safely(entry, self._line) for entry in self.records.entries()]}

    def run(self, name: str, episode: str | None = None) -> Json:
        """One recorded episode, or one of an evaluation, without its steps.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        entry = self.records.entry(name)
        drive = self._drive_in(entry, episode)
        if drive is not None:
            return self._drive(entry, drive, episode)
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
        entry = self.records.entry(name)
        drive = self._drive_in(entry, episode)
        if drive is not None:
            path = self.records.file(entry, *drive, DRIVE_STEPS)
            lines = _json_lines(path, *_stamp(path))[skip:]
            return {
                "steps": [{**line, "has_picture": "picture" in line} for line in lines],
                "running": self._is_running(entry, episode),
            }
        lines = self._lines(entry, episode)
        steps = _steps(entry, self.records, episode, lines)
        return {"steps": steps[skip:], "running": self._is_running(entry, episode)}

    def road(self, name: str, episode: str | None, skip: int) -> Iterable[Json]:
        """The lines of the recorded road from number ``skip`` on; without a recording, a road with the ego alone.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        entry = self.records.entry(name)
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
        entry = self.records.entry(name)
        if not entry.is_evaluation:
            raise NotHereError(f"record {name!r} is not an evaluation")
        manifest = read_manifest(entry.folder)
        kind = _kind(manifest["plan"])
        if kind == "drives":
            return self._drives(entry, manifest)
        if kind != "evaluation":
            raise NotHereError(f"{entry.folder.name} holds no agents' episodes")
        trials = read_trials(entry.folder).values()
        rows = [row for row in trials if isinstance(row, EpisodeRow)]
        return {
            "id": entry.id,
            "kind": kind,
            "name": entry.folder.name,
            "is_search": (entry.folder / PAGE).is_file(),
            "plan": manifest["plan"],
            "planned": manifest.get("episodes"),
            "running": sorted(
                path.parent.name for path in entry.folder.glob(f"pictures/*/{ROAD}") if is_being_written(path)
            ),
            "rows": [
                {name: getattr(row, name) for name in SHOWN}
                | {
                    "conditions": row.conditions.labels,
                    "missing": row.missing,
                    "has_trace": (entry.folder / "traces" / f"{row.id}.jsonl.gz").is_file(),
                }
                for row in rows
            ],
            "drives": self._drive_rows(entry, [row for row in trials if isinstance(row, DriveTrialRow)]),
        }

    def reference(self, task: str) -> Json:
        """The reference solution of each half of a task, where it has been recorded with pictures.

        Raises:
            UserError: a record cannot be read.
        """
        found: dict[str, Json] = {}
        for entry in self.records.entries():
            for half, episode in _safely(entry, lambda each: self._solved(each, task)).get("solved", ()):
                if half not in found:
                    steps = self.steps(entry.id, episode, 0)["steps"]
                    told = [{name: each[name] for name in ("number", "words", "has_picture")} for each in steps]
                    found[half] = {"run": entry.id, "episode": episode, "steps": told}
        return {"halves": found}

    def decisions(self, name: str) -> Json:
        """Every decision of a study of rerouting.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        return decisions(self._study(name))

    def watched_study(self, name: str) -> Json:
        """The drives of a study that are running, which it reports while somebody asks for them.

        Raises:
            UserError: it is not here.
        """
        folder = self._study(name)
        with suppress(NotHereError):  # it is older
            self.observers.observe(self.records.file(self.records.entry(name), LIVE, WATCHED))
        return drives_under_way(folder)

    def decision_map(self, name: str, decision: str) -> Json:
        """The routes of a decision's futures on one map.

        Raises:
            UserError: it is not here, or cannot be read.
        """
        return decision_map(self._study(name), decision)

    # --- inside -----------------------------------------------------------------------------------------------

    def _line(self, entry: RecordEntry) -> Json:
        shared = {"id": entry.id, "name": entry.folder.name, "folder": str(entry.folder)}
        if entry.is_evaluation:
            manifest = read_manifest(entry.folder)
            kind = _kind(manifest["plan"])
            done = (entry.folder / "episodes.jsonl").read_bytes().count(b"\n")
            started = manifest["starts"][-1]["started"]
            running = is_being_written(entry.folder / "lock")
            planned = manifest.get("episodes")
            told = {"kind": kind, "done": done, "planned": planned, "running": running, "started": started}
            told["is_search"] = (entry.folder / PAGE).is_file()
            return {**shared, **told}
        if entry.is_drive:
            drive = self._drive(entry, (), None)
            return {
                **shared,
                "kind": "drive",
                **{name: drive[name] for name in (*HEAD, "running", "value", "started")},
                "conditions": drive.get("conditions", ()),
            }
        path = entry.folder / "episode.json"
        head = _head_of(self.records.file(entry, path.name), *_stamp(path)) if path.is_file() else None
        return {
            **shared,
            "kind": "run",
            "running": self._is_running(entry, None),
            **(head or self._unfinished(entry, None)),
        }

    def _result(self, entry: RecordEntry, episode: str | None) -> Json | None:
        """The whole result; None while it runs, or if it was killed."""
        try:
            if episode is not None:
                return dict(self._trace(entry, episode)[-1]["result"])
            return _object(self.records.file(entry, "episode.json"))
        except NotHereError:
            if episode is not None:
                self._road(entry, episode)
            return None

    def _solved(self, entry: RecordEntry, task: str) -> Json:
        """Half and id of each episode of a record in which the oracle solves a task and that has pictures."""
        solved: list[tuple[str, str | None]] = []
        if entry.is_evaluation:
            plan = read_manifest(entry.folder)["plan"]
            is_told = _kind(plan) == "evaluation" and "oracle" in plan["agents"]
            for row in read_trials(entry.folder).values() if is_told else ():
                is_solved = (row.subject, row.agent, row.outcome) == (task, "oracle", True)
                if is_solved and isinstance(row, EpisodeRow) and _has_picture(self.records, entry, row.id, 0):
                    solved.append((row.half, row.id))
        elif not entry.is_drive and (entry.folder / "episode.json").is_file():
            path = entry.folder / "episode.json"
            head = _head_of(self.records.file(entry, path.name), *_stamp(path))
            if (head["task"], head["agent"], head["success"]) == (task, "oracle", True):
                solved.append((head["half"], None))
        return {"solved": solved}

    def _study(self, name: str) -> Path:
        entry = self.records.entry(name)
        if not entry.is_evaluation or _kind(read_manifest(entry.folder)["plan"]) != "study":
            raise NotHereError(f"record {name!r} is not a study")
        return entry.folder

    def _drives(self, entry: RecordEntry, manifest: Json) -> Json:
        """The plan and the rows of an evaluation of drives."""
        rows = read_rows(entry.folder, DriveTrialRow)
        return {
            "id": entry.id,
            "kind": "drives",
            "name": entry.folder.name,
            "is_search": (entry.folder / PAGE).is_file(),
            "plan": manifest["plan"],
            "planned": manifest.get("episodes"),
            "rows": self._drive_rows(entry, rows.values()),
        }

    def _drive_rows(self, entry: RecordEntry, rows: Iterable[DriveTrialRow]) -> list[Json]:
        names = ("id", "family", "scenario", "season", "agent", "model", "seed", "repeat",
                 "value", "error", "error_kind", "end", "steps")  # fmt: skip
        return [
            {name: getattr(row, name) for name in names}
            | {
                "conditions": row.conditions.labels,
                "met": row.score and row.score.met,
                "events": row.score and row.score.events,
                "nuisances": row.score and row.score.nuisances,
                "has_road": self._drive_in(entry, row.id) is not None,
            }
            for row in rows
        ]

    def _drive_in(self, entry: RecordEntry, episode: str | None) -> tuple[str, ...] | None:
        """Where in a record the drive is; None if it is not a drive."""
        if entry.is_drive:
            return ()
        for kept in () if episode is None else (("pictures", episode), (LIVE, episode)):
            with suppress(NotHereError):
                self.records.file(entry, *kept, DRIVE_STEPS)
                return kept
        return None

    def _drive(self, entry: RecordEntry, parts: tuple[str, ...], episode: str | None) -> Json:
        """A drive, with its events and acts once it is over."""
        head = self._unfinished(entry, episode)
        try:
            row = trial_values(_object(self.records.file(entry, *parts, "row.json")))
        except NotHereError:
            row = {}
        judged = from_json(DriveTrialRow, row) if row else None
        events, acts = (judged.events, judged.acts) if judged else ((), ())
        head |= {name: row[name] for name in HEAD if row.get(name) is not None}
        if row:
            head |= {name: value for name, value in _head(row).items() if name in ("screen", "conditions")}
        head["task"] = row.get("family", head["task"])
        return {
            **head,
            "id": entry.id,
            "episode": episode,
            "name": entry.folder.name,
            "kind": "drive",
            "of_study": LIVE in parts,
            "running": self._is_running(entry, episode),
            "started": None,
            "parts": {},
            "success": None,
            "value": row.get("value"),
            "score": row.get("score"),
            "verdict": None,
            "spans": [_span(event, acts) for event in events],
            "acts": [{"at_s": act.time_s, "text": act.words, "worth": act.worth} for act in acts],
            "timeline": _drive_timeline(events, acts),
            "met": sum(event.outcome.is_credited for event in events),
            "path": (),
            "violations": (),
            "manifest": None,
            "trace_sha256": row.get("trace_sha256"),
        }

    def _trace(self, entry: RecordEntry, episode: str) -> list[Json]:
        self.records.file(entry, "traces", f"{episode}.jsonl.gz")
        return read_trace(entry.folder, episode)

    def _lines(self, entry: RecordEntry, episode: str | None) -> list[Json]:
        if episode is not None:
            return self._trace(entry, episode)[:-1] if self._result(entry, episode) else []
        path = self.records.file(entry, "steps.jsonl")
        return _json_lines(path, *_stamp(path))

    def _road(self, entry: RecordEntry, episode: str | None) -> Path:
        if episode is None:
            return self.records.file(entry, ROAD)
        with suppress(NotHereError):
            return self.records.file(entry, LIVE, episode, ROAD)
        return self.records.file(entry, "pictures", episode, ROAD)

    def _is_running(self, entry: RecordEntry, episode: str | None) -> bool:
        """Whether the episode is being recorded now."""
        try:
            return is_being_written(self._road(entry, episode))
        except NotHereError:
            return False

    def _unfinished(self, entry: RecordEntry, episode: str | None) -> Json:
        """What is known about an episode that is running or was killed."""
        try:
            begun = next(iter(read_road(self._road(entry, episode))), {})
        except NotHereError:
            begun = {}
        return {name: begun.get(name) for name in HEAD} | {
            "task": begun.get("task") or episode or entry.folder.name,
            "end": "running" if self._is_running(entry, episode) else "stopped before the end",
        }


def _kind(plan: Json) -> str:
    """The kind of a folder with rows, by its plan."""
    if "study" in plan:
        return "study"
    if unit_of(plan) == "drive":
        return "drives"
    return "evaluation" if "agents" in plan else "other"


def _span(event: JudgedEvent, acts: Sequence[JudgedAct]) -> Json:
    """An event of a drive, from when it becomes observable to its deadline or its end."""
    return {
        "kind": event.kind,
        "words": event.words,
        "lookalike": event.lookalike,
        "outcome": event.outcome,
        "became": _became(event, acts),
        "obliged_s": event.obliged_s,
        "deadline_s": event.deadline_s,
        "from_s": event.observable_s,
        "to_s": event.deadline_s or event.ends_s,
    }


def _became(event: JudgedEvent, acts: Sequence[JudgedAct]) -> str:
    """What became of an event, with the times of one that was lost."""
    return "; ".join((OUTCOMES.get(event.outcome, event.outcome), *times(event, acts)))


def _drive_timeline(events: Sequence[JudgedEvent], acts: Sequence[JudgedAct]) -> list[Json]:
    """Every instant that the page lists, in order."""
    told = []
    is_explained = False
    for event in sorted(events, key=lambda each: each.observable_s):
        kind = event.kind.replace("_", " ")
        became = _became(event, acts)
        if event.outcome is EventOutcome.VOID and not is_explained:
            is_explained = True
            became += f": {WHY_VOID}"
        what = f"{'look-alike of ' if event.lookalike else ''}{kind}: {event.words} ({became})"
        told.append((event.observable_s, "event", what))
        if event.deadline_s is not None and not event.lookalike:
            told.append((event.deadline_s, "deadline", f"deadline of {kind}"))
    told += [(act.time_s, "alert", f"{act.words.replace('_', ' ')} ({was(act, events)})") for act in acts]
    return [{"at_s": at_s, "kind": kind, "text": text} for at_s, kind, text in sorted(told)]


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
    told = trial_values(result)
    conditions = from_json(Conditions, told["conditions"]) if told.get("conditions") else Conditions()
    seen = {"screen": conditions.screen, "conditions": conditions.labels}
    return {name: told.get(name) for name in HEAD} | seen | {"started": started}


def _object(path: Path) -> Json:
    try:
        made = read_json(path)
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error
    if not isinstance(made, dict):
        raise UserError(f"{path} is not a record of an episode")
    return made


def _safely(entry: RecordEntry, describe: Any) -> Json:
    """A line for a record, even if it cannot be read."""
    try:
        made: Json = describe(entry)
    except (UserError, OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        return {"id": entry.id, "name": entry.folder.name, "kind": "unreadable", "error": str(error)}
    return made


def _steps(entry: RecordEntry, records: RecordFolders, episode: str | None, lines: Sequence[Json]) -> list[Json]:
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
                "has_picture": _has_picture(records, entry, episode, line["step"]),
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


def _has_picture(records: RecordFolders, entry: RecordEntry, episode: str | None, step: int) -> bool:
    try:
        records.picture(entry, episode, step)
    except NotHereError:
        return False
    return True


def _alone(result: Json) -> Iterable[Json]:
    """A road without recorded surroundings: the car alone, on the line that it drove."""
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
