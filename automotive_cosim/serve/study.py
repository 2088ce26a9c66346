"""A study with people: dealt by ``dealing``, played by several at once, with three questions after each episode.

The folder is an evaluation of the agent ``human``, which every report reads, with one more file:

    log.jsonl    a line whenever an episode begins or ends, a stimulus is detected or missed (``detection``), or the
                 questions after an episode are answered

Both are on disk before the study continues, so that a killed server resumes where it was; the running episode
starts again, and the export says so.
"""

from __future__ import annotations

import json
import secrets
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.csvs import csv_text
from automotive_cosim.formats.files import read_whole_lines
from automotive_cosim.formats.layout import PICTURES, TRACES
from automotive_cosim.formats.writing import add_line, growing
from automotive_cosim.run.batch import kept
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.serve.dealing import PeoplePlan
from automotive_cosim.serve.detection import PHASES, TOLD, detected, figures
from automotive_cosim.serve.play import Game
from automotive_cosim.traffic.fork import Simulations

QUESTIONS: Mapping[str, str] = {
    "understood": "I understood what the driver wanted.",
    "sure": "I am confident that I finished it correctly.",
    "hard": "It was hard to do.",
}
SCALE = ("not at all", "a little", "somewhat", "mostly", "entirely")
"""Answers 1 to 5."""
LOG = "log.jsonl"
AWAY_S = 20.0
"""After this time without a request, another browser may take over a code name."""


@dataclass(slots=True)
class StudySeat:
    """A browser in which a person plays under a code name."""

    person: str
    game: Game
    heard_s: float


class PeopleStudy:
    """A running study. Any method may be called from any thread."""

    def __init__(self, plan: PeoplePlan, folder: Path, simulations: Simulations | None = None) -> None:
        """Starts or resumes it.

        Args:
            folder: of the study, new or started with the same plan.
            simulations: warm simulations to use, which the caller closes; by default its own.

        Raises UserError: the plan does not fit, or the folder belongs to something else or is in use."""
        self.name = folder.name
        self.folder = folder
        self._detects = plan.detection
        self._ends = ExitStack()
        self._store = self._ends.enter_context(kept(plan, folder, EpisodeRow, (TRACES, PICTURES)))
        self._orders = plan.orders()
        self._log = folder / LOG
        self._events = _read(self._log)
        self._own = Simulations() if simulations is None else None
        self._simulations = simulations or self._own
        self._seats: dict[str, StudySeat] = {}
        self._lock = threading.RLock()

    def overview(self) -> Json:
        """The participants and their progress; no verdicts."""
        with self._lock:
            return {
                "name": self.name,
                "questions": [{"name": name, "text": text} for name, text in QUESTIONS.items()],
                "scale": list(SCALE),
                "detection": TOLD if self._detects else None,
                "people": [
                    {"name": name, "done": self._done(name), "planned": len(order)}
                    for name, order in self._orders.items()
                ],
            }

    def join(self, person: str, seat: str = "") -> str:
        """Takes the seat of a code name, and returns its secret.

        Args:
            seat: an earlier secret, which keeps its seat.

        Raises UserError: there is no such person, or the seat is taken."""
        with self._lock:
            if person not in self._orders:
                raise UserError(f"this study has no code name {person[:40]!r}; choose one from the list")
            taken = next((each for each, its in self._seats.items() if its.person == person), None)
            if taken is not None and taken == seat:
                return taken
            now_s = time.monotonic()
            if taken is not None and now_s - self._seats[taken].heard_s < AWAY_S:
                raise UserError(f"{person} is already playing in another window; close it and wait {AWAY_S:.0f} s")
            game = self._seats.pop(taken).game if taken else Game(self.folder, simulations=self._simulations)
            made = secrets.token_urlsafe(16)
            self._seats[made] = StudySeat(person, game, now_s)
            return made

    def seat(self, secret: str) -> StudySeat:
        """The person in a seat. Raises UserError: the seat is empty, e.g. because the server was restarted."""
        with self._lock:
            if secret not in self._seats:
                raise UserError("this session is over; choose your code name again")
            self._seats[secret].heard_s = time.monotonic()
            return self._seats[secret]

    def turn(self, secret: str) -> Json:
        """A person's next task; the verdicts once everything is done. Raises UserError: the seat is empty."""
        person = self.seat(secret).person
        with self._lock:
            order = self._orders[person]
            asked, following = self._asked(person), self._next(person)
            told = {
                "person": person,
                "done": self._done(person),
                "planned": len(order),
                "phase": "ask" if asked else "play" if following else "over",
            }
            if asked or following:
                return told
            rows = self._store.rows
            return told | {
                "verdicts": [
                    {"task": job.task, "half": job.half, "success": row.success, "missing": row.missing,
                     "error": row.error}
                    for job in order
                    for row in [rows[job.id]]
                ]
            }  # fmt: skip

    def begin(self, secret: str) -> None:
        """Begins the next episode of a person.

        Raises UserError: the seat is empty, there is none, the last one's questions are open, or one is running."""
        seat = self.seat(secret)
        with self._lock:
            job = self._next(seat.person)
            if self._asked(seat.person) or job is None:
                raise UserError("answer the questions first" if job else "everything has been played")
            if seat.game.is_running:
                raise UserError("an episode is already running")
            self._note("begun", job)
            seat.game.begin(job, self.folder, lambda row: self._keep(job, row))

    def answer(self, secret: str, answers: Mapping[str, Any]) -> None:
        """Takes the answers to the questions, each 1 to 5.

        Raises UserError: the seat is empty, nothing is asked, or an answer is missing or invalid."""
        person = self.seat(secret).person
        for name in QUESTIONS:
            if type(answers.get(name)) is not int or not 1 <= answers[name] <= len(SCALE):
                raise UserError(f"answer {name!r} is {answers.get(name)!r}; give a number from 1 to {len(SCALE)}")
        with self._lock:
            job = self._asked(person)
            if job is None:
                raise UserError("there is no question to answer now")
            self._note("answered", job, {name: answers[name] for name in QUESTIONS})

    def detect(self, secret: str, asked: Json) -> None:
        """Takes what came of a stimulus of the episode that a person plays.

        Raises UserError: the seat is empty, nothing is played or to be detected, or it is no reaction."""
        person = self.seat(secret).person
        came = detected(asked)
        with self._lock:
            job = self._next(person)
            if not self._detects or job is None or not self._of("begun", job):
                raise UserError("there is nothing to detect now")
            self._note("detected", job, came)

    def seen(self) -> Json:
        """Hits and reactions of each person, by phase; nothing without the task."""
        with self._lock:
            return {name: self._seen(order) for name, order in self._orders.items()} if self._detects else {}

    def export(self) -> list[Json]:
        """A line for each planned episode, in each person's order: row, answers and times."""
        with self._lock:
            return [self._line(job, place) for order in self._orders.values() for place, job in enumerate(order, 1)]

    def as_csv(self) -> str:
        lines = self.export()
        return csv_text(lines[0], (line.values() for line in lines))

    def close(self) -> None:
        """Ends the running episodes, which will start again."""
        for seat in list(self._seats.values()):
            seat.game.close()
        if self._own is not None:
            self._own.close()
        self._ends.close()

    # --- inside -----------------------------------------------------------------------------------------------

    def _next(self, person: str) -> EpisodeSetup | None:
        return next((job for job in self._orders[person] if job.id not in self._store.rows), None)

    def _asked(self, person: str) -> EpisodeSetup | None:
        """The judged episode whose questions are open."""
        rows = self._store.rows
        judged = (job for job in self._orders[person] if job.id in rows and rows[job.id].success is not None)
        return next((job for job in judged if not self._of("answered", job)), None)

    def _seen(self, jobs: Sequence[EpisodeSetup]) -> Json:
        """Hits and reactions of these episodes, each since it was begun last, by phase."""
        if not self._detects:
            return {}
        came: dict[str, list[Json]] = {job.id: [] for job in jobs}
        for event in self._events:
            if event["id"] in came and event["kind"] == "begun":
                came[event["id"]] = []
            elif event["id"] in came and event["kind"] == "detected":
                came[event["id"]].append(event)
        events = [event for each in came.values() for event in each]
        return {phase: figures(events, phase) for phase in PHASES}

    def _done(self, person: str) -> int:
        return sum(job.id in self._store.rows for job in self._orders[person])

    def _keep(self, job: EpisodeSetup, row: EpisodeRow) -> None:
        with self._lock:
            self._store.append(row)
            self._note("ended", job)

    def _note(self, kind: str, job: EpisodeSetup, values: Json | None = None) -> None:
        event = {"at": datetime.now().astimezone().isoformat(timespec="milliseconds"), "kind": kind, "id": job.id}
        event |= values or {}
        with growing(self._log) as file:
            add_line(file, json.dumps(event), lasting=True)
        self._events.append(event)

    def _of(self, kind: str, job: EpisodeSetup) -> list[Json]:
        return [event for event in self._events if event["kind"] == kind and event["id"] == job.id]

    def _line(self, job: EpisodeSetup, place: int) -> Json:
        row = self._store.rows.get(job.id)
        begun, ended, answered = (self._of(kind, job) for kind in ("begun", "ended", "answered"))
        answers = answered[-1] if answered else {}
        return {
            "person": job.model,
            "place": place,
            "task": job.task,
            "half": job.half,
            "seed": job.seed,
            "id": job.id,
            "success": row.success if row else None,
            **{f"part_{name}": getattr(row.parts, name) if row and row.parts else None for name in PARTS},
            "end": str(row.end) if row else None,
            "error": row.error if row else None,
            "steps": row.steps if row else None,
            "sim_seconds": row.sim_seconds if row else None,
            "times_begun": len(begun),
            "begun": begun[-1]["at"] if begun else None,
            "ended": ended[-1]["at"] if ended else None,
            "answered": answers.get("at"),
            **{name: answers.get(name) for name in QUESTIONS},
            **{
                f"{phase}_{name}": value
                for phase, seen in self._seen([job]).items()
                for name, value in seen.items()
            },
        }


PARTS = ("goal", "clean", "safe", "in_time", "declared")


def _read(path: Path) -> list[Json]:
    """The whole lines of a log. Raises UserError: another line cannot be read."""
    if not path.is_file():
        return []
    try:
        return read_whole_lines(path)
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}") from error
