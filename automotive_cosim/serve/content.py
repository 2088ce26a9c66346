"""What the pages show of a record and of an evaluation, as plain values."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import KMH_PER_MPS, Json
from automotive_cosim.drives.faults import OUTCOMES, WHY_VOID, times
from automotive_cosim.drives.followed import told
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, JudgedEvent
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import LIVE, PICTURES, ROAD, WATCHED, PictureOf, road_view, screenshot, sound
from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.report.hearing import can_sound, sounded, utterances
from automotive_cosim.report.page import PARTS as VERDICT_PARTS
from automotive_cosim.run.attribution import path_of, read_effects
from automotive_cosim.run.coverage import unit_of
from automotive_cosim.run.effect import ActEffect
from automotive_cosim.run.extensions import kind_of
from automotive_cosim.run.fleet_record import fleets_in
from automotive_cosim.run.job_row import from_json
from automotive_cosim.run.road import FORMAT, read_road
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, read_trials
from automotive_cosim.run.store import read_manifest, read_rows, trace_file
from automotive_cosim.run.trial_folder import READ, is_trial, read_steps, read_trial, trace_of
from automotive_cosim.safety.page import PAGE
from automotive_cosim.serve.fleets import PARTS
from automotive_cosim.serve.observers import StudyObservers
from automotive_cosim.serve.records import NotHereError, RecordEntry, RecordFolders

HEAD = (
    *("task", "half", "scenario", "agent", "model", "seed", "success", "steps", "sim_seconds", "end", "error"),
    *("agent_error", "goal", "tokens_in", "tokens_out", "model_seconds"),
)
SHOWN = (
    *("id", "task", "half", "pair", "scenario", "agent", "model", "seed", "repeat"),
    *("dimension", "module"),
    *("success", "error", "error_kind", "end", "steps", "sim_seconds", "held_out", "goal_s"),
)
"""Fields of a row that the table of results shows."""
OF_A_STEP = (
    *("at_s", "local_time", "words", "action", "target", "feedback", "thought", "context", "speed_kmh", "picture"),
    "cabin_db",
)
"""What a page shows of a step as it is."""
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

    def first_page(self) -> str:
        """The part of the address after ``#`` of what to show at first: a pair that was run last, else the list."""
        for entry in self.records.entries()[:2]:
            if other := self.records.beside(entry):
                return f"#/beside/{entry.id}/{other}"
        return ""

    def run(self, name: str, episode: str | None = None) -> Json:
        """One recorded trial, or one of an evaluation, without its steps.

        Raises UserError: it is not here, or cannot be read."""
        entry = self.records.entry(name)
        folder = self.records.trial(entry, episode)
        told = read_trial(folder)
        head, row, result = self._head(folder), told.get("row") or {}, told.get("result") or {}
        shared = {
            "id": entry.id,
            "episode": episode,
            "name": entry.folder.name,
            "of_study": folder.parent.name == LIVE,
            **head,
        }
        if head["kind"] == "drive":
            effects = read_effects(path_of(folder) if episode is None else path_of(entry.folder, episode))
            return shared | _drive(row, result.get("timeline") or {}, effects)
        return shared | {
            "parts": dict(VERDICT_PARTS),
            "verdict": result.get("verdict"),
            "timeline": result.get("timeline", ()),
            "path": result.get("path", ()),
            "violations": result.get("violations", ()),
            "manifest": told.get("manifest"),
            "trace_sha256": result.get("trace_sha256"),
        }

    def steps(self, name: str, episode: str | None, skip: int) -> Json:
        """The steps of an episode from number ``skip`` on. Raises UserError: it is not here, or cannot be read."""
        entry = self.records.entry(name)
        folder = self.records.trial(entry, episode)
        lines = _steps_in(folder, *_stamp(folder))[skip:]
        goal = self._head(folder)["goal"] or ""
        return {
            "steps": [
                {
                    "number": line["step"],
                    "uttered": [
                        uttered | {"can_sound": can_sound(folder, line["step"], number)}
                        for number, uttered in enumerate(utterances(line, goal))
                    ],
                    "has_picture": _has_picture(self.records, entry, folder, line.get("picture")),
                    "has_view": _has_picture(self.records, entry, folder, line["step"], road_view),
                    **{name: line[name] for name in OF_A_STEP if name in line},
                    "stages": [_stage(stage) for stage in line["stages"]],
                }
                for line in lines
            ],
            "running": _is_running(folder),
        }

    def sound(self, name: str, episode: str | None, step: int, number: int) -> bytes:
        """Words that were said by the end of a step, as the microphone had them: a WAV file.

        Raises UserError: nothing was said then, or it cannot be made."""
        entry = self.records.entry(name)
        folder = self.records.trial(entry, episode)
        lines = _steps_in(folder, *_stamp(folder))
        said = utterances(lines[step], self._head(folder)["goal"] or "") if step < len(lines) else []
        if number >= len(said):
            raise NotHereError(f"nothing with number {number} was said by the end of step {step}")
        if os.path.lexists(path := sound(folder, step, number)):
            self.records.file(entry, *path.relative_to(entry.folder).parts)
        return sounded(folder, step, number, said[number])

    def road(self, name: str, episode: str | None, skip: int) -> Iterable[Json]:
        """The lines of the recorded road from number ``skip`` on; without a recording, a road with the ego alone.

        Raises UserError: it is not here, or cannot be read."""
        folder = self.records.trial(self.records.entry(name), episode)
        if (folder / ROAD).is_file():
            return _road_lines(folder, *_stamp(folder))[skip:]
        return list(_alone(read_trial(folder).get("result") or {}))[skip:]

    def evaluation(self, name: str) -> Json:
        """The plan and the rows of an evaluation. Raises UserError: it is not here, or cannot be read."""
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
                path.parent.name for path in entry.folder.glob(f"{PICTURES}/*/{ROAD}") if is_being_written(path)
            ),
            "rows": [
                {name: getattr(row, name) for name in SHOWN}
                | {
                    "conditions": row.conditions.labels,
                    "missing": row.missing,
                    "has_trace": trace_file(entry.folder, row.id).is_file(),
                }
                for row in rows
            ],
            "drives": self._drive_rows(entry, [row for row in trials if isinstance(row, DriveTrialRow)]),
        }

    def reference(self, task: str) -> Json:
        """The reference solution of each half of a task, where it has been recorded with pictures.

        Raises UserError: a record cannot be read."""
        found: dict[str, Json] = {}
        for entry in self.records.entries():
            for half, episode in _safely(entry, lambda each: self._solved(each, task)).get("solved", ()):
                if half not in found:
                    steps = self.steps(entry.id, episode, 0)["steps"]
                    told = [
                        {name: each[name] for name in ("number", "words", "picture", "has_picture")}
                        for each in steps
                    ]
                    found[half] = {"run": entry.id, "episode": episode, "steps": told}
        return {"halves": found}

    def study(self, name: str, part: str, *items: str) -> Json:
        """A part of a study, of those that its kind has for pages, or of an evaluation's fleets.

        Raises UserError: it is not here, or cannot be read."""
        entry = self.records.entry(name)
        kind = kind_of(read_manifest(entry.folder)["plan"]) if entry.is_evaluation else None
        if kind is not None:
            shown = kind.shown(part, entry.folder, *items)
        else:
            shown = PARTS[part](entry.folder, *items) if entry.is_evaluation and part in PARTS else None
        if shown is None:
            raise NotHereError(f"record {name!r} has no such page")
        return shown

    def watched_study(self, name: str) -> Json:
        """The drives of a study that are running, the newest first; it reports them while somebody asks.

        Raises UserError: it is not here."""
        folder = self._study(name)
        with suppress(NotHereError):  # it is older
            self.observers.observe(self.records.file(self.records.entry(name), LIVE, WATCHED))
        found = [path.parent for path in (folder / LIVE).glob(f"*/{ROAD}") if is_being_written(path)]
        found.sort(key=lambda each: each.stat().st_mtime, reverse=True)
        return {
            "name": folder.name,
            "running": is_being_written(folder / "lock"),
            "drives": [each.name for each in found],
        }

    # --- inside -----------------------------------------------------------------------------------------------

    def _line(self, entry: RecordEntry) -> Json:
        shared = {"id": entry.id, "name": entry.folder.name, "folder": str(entry.folder)}
        if entry.is_evaluation:
            manifest = read_manifest(entry.folder)
            kind = _kind(manifest["plan"])
            *lines, _cut = (entry.folder / "episodes.jsonl").read_bytes().split(b"\n")
            done = len({line.partition(b",")[0] for line in lines})  # by id: what is run again has a line more
            started = manifest["starts"][-1]["started"]
            running = is_being_written(entry.folder / "lock")
            planned = manifest.get("episodes")
            told = {"kind": kind, "done": done, "planned": planned, "running": running, "started": started}
            if (study := kind_of(manifest["plan"])) is not None:
                told |= {
                    "study": manifest["plan"]["study"],
                    "unit": study.unit,
                    "seeds": len(manifest["plan"].get("seeds", ())),
                }
            told["is_search"] = (entry.folder / PAGE).is_file()
            return {**shared, **told}
        return {**shared, "beside": self.records.beside(entry), **self._head(self.records.trial(entry, None))}

    def _head(self, folder: Path) -> Json:
        """What is known about a trial, also of one that is running or was killed."""
        head, is_running = _head_of(folder, *_stamp(folder)), _is_running(folder)
        end = head["end"] or ("running" if is_running else "stopped before the end")
        return head | {"end": end, "running": is_running}

    def _solved(self, entry: RecordEntry, task: str) -> Json:
        """Half and id of each episode of a record in which the oracle solves a task and that has pictures."""
        solved: list[tuple[str, str | None]] = []
        if entry.is_evaluation:
            plan = read_manifest(entry.folder)["plan"]
            is_told = _kind(plan) == "evaluation" and "oracle" in plan["agents"]
            for row in read_trials(entry.folder).values() if is_told else ():
                is_solved = (row.subject, row.agent, row.outcome) == (task, "oracle", True)
                folder = entry.folder / PICTURES / row.id
                if is_solved and isinstance(row, EpisodeRow) and _has_picture(self.records, entry, folder, 0):
                    solved.append((row.half, row.id))
        else:
            head = self._head(self.records.trial(entry, None))
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
            "fleets": [fleet for fleet, _ in fleets_in(entry.folder)],
            "rows": self._drive_rows(entry, rows.values()),
        }

    def _drive_rows(self, entry: RecordEntry, rows: Iterable[DriveTrialRow]) -> list[Json]:
        names = ("id", "name", "family", "scenario", "season", "agent", "model", "seed", "repeat",
                 "value", "error", "error_kind", "end", "steps")  # fmt: skip
        return [
            {name: getattr(row, name) for name in names}
            | {
                "conditions": row.conditions.labels,
                "met": row.score and row.score.met,
                "events": row.score and row.score.events,
                "nuisances": row.score and row.score.nuisances,
                "has_road": is_trial(entry.folder / PICTURES / row.id),
            }
            for row in rows
        ]


def _drive(row: Json, timeline: Json, effects: Sequence[ActEffect]) -> Json:
    """What a page shows of a drive alone: its events and acts once it is over."""
    judged = from_json(DriveTrialRow, row) if row else None
    events, acts = (judged.events, judged.acts) if judged else ((), ())
    return {
        "parts": {},
        "success": None,
        "score": row.get("score"),
        "verdict": None,
        "spans": [_span(event, acts) for event in events],
        "acts": [{"at_s": act.time_s, "text": act.words, "worth": act.worth} for act in acts],
        "timeline": _drive_timeline(events, acts, told(acts, events, timeline), effects),
        "met": sum(event.outcome.is_credited for event in events),
        "path": (),
        "violations": (),
        "manifest": None,
        "trace_sha256": row.get("trace_sha256"),
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


def _drive_timeline(
    events: Sequence[JudgedEvent], acts: Sequence[JudgedAct], came: Sequence[str], effects: Sequence[ActEffect]
) -> list[Json]:
    """Every instant that the page lists, in order; ``came`` is what became of each act, ``effects`` what each
    changed, where that was measured."""
    lines = []
    is_explained = False
    for event in sorted(events, key=lambda each: each.observable_s):
        kind = event.kind.replace("_", " ")
        became = _became(event, acts)
        if event.outcome is EventOutcome.VOID and not is_explained:
            is_explained = True
            became += f": {WHY_VOID}"
        what = f"{'look-alike of ' if event.lookalike else ''}{kind}: {event.words} ({became})"
        lines.append((event.observable_s, "event", what))
        if event.deadline_s is not None and not event.lookalike:
            lines.append((event.deadline_s, "deadline", f"deadline of {kind}"))
    lines += [
        (act.time_s, "alert", f"{act.words.replace('_', ' ')} ({became})")
        for act, became in zip(acts, came, strict=True)
    ]
    lines += [(each.at_s, "alert", f"effect of {each.act}: {each.effect}") for each in effects]
    return [{"at_s": at_s, "kind": kind, "text": text} for at_s, kind, text in sorted(lines)]


def _stamp(folder: Path) -> tuple[tuple[int, int] | None, ...]:
    """Changes when a file of a trial does."""
    paths = [*(folder / name for name in READ), trace_of(folder)]
    return tuple(_state(path) if path is not None and path.is_file() else None for path in paths)


def _state(path: Path) -> tuple[int, int]:
    stat = path.stat()
    return stat.st_mtime_ns, stat.st_size


def _is_running(folder: Path) -> bool:
    """Whether a trial is being recorded now."""
    return is_being_written(folder / ROAD)


@lru_cache(maxsize=4096)
def _head_of(folder: Path, *_stamp: object) -> Json:
    told = read_trial(folder)
    manifest = told.get("manifest") or {}
    begun = next(iter(read_road(folder / ROAD)), {}) if (folder / ROAD).is_file() else {}
    setup = manifest.get("setup") or {}
    values = begun | (told.get("row") or {}) | (told.get("result") or {})
    given = (values if "conditions" in values else setup).get("conditions")
    conditions = from_json(Conditions, given) if given else Conditions()
    is_drive = "family" in setup or folder.parent.name == LIVE
    return {name: values.get(name) for name in HEAD} | {
        "task": values.get("family") or values.get("task") or folder.name,
        "kind": "drive" if is_drive else "run",
        "value": values.get("value"),
        "screen": conditions.screen,
        "conditions": conditions.labels,
        "started": manifest.get("started"),
    }


@lru_cache(maxsize=4)
def _steps_in(folder: Path, *_stamp: object) -> list[Json]:
    return read_steps(folder)


@lru_cache(maxsize=4)
def _road_lines(folder: Path, *_stamp: object) -> list[Json]:
    return list(read_road(folder / ROAD))


def _safely(entry: RecordEntry, describe: Any) -> Json:
    """A line for a record, even if it cannot be read."""
    try:
        made: Json = describe(entry)
    except (UserError, OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        return {"id": entry.id, "name": entry.folder.name, "kind": "unreadable", "error": str(error)}
    return made


def _stage(stage: Json) -> Json:
    reply = stage.get("reply") or {}
    spent = {name: reply.get(name) for name in ("tokens_in", "tokens_out", "seconds")}
    return {"name": stage.get("stage", stage.get("name", "")), "text": stage.get("text", ""), **spent}


def _has_picture(
    records: RecordFolders, entry: RecordEntry, folder: Path, step: int | None, of: PictureOf = screenshot
) -> bool:
    if step is None:
        return False
    try:
        records.picture(entry, folder, step, of)
    except NotHereError:
        return False
    return True


def _alone(result: Json) -> Iterable[Json]:
    """A road without recorded surroundings: the car alone, on the line that it drove."""
    path = result.get("path") or []
    if not result:
        return
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
