"""What can be watched of a running study: each drive up to its last decision, the decisions and their results.

``live/DRIVE/`` in the study's folder is a trial's folder (``formats.layout``), road and steps alone. They
are written only while somebody watches: the watcher locks the file ``live/watched``, and the system releases the
lock however the watcher ends. The simulation does not change.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from datetime import timedelta
from io import FileIO
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.formats.layout import LIVE, ROAD, STEPS, WATCHED
from automotive_cosim.formats.writing import add_line, growing, is_being_written, make_folder, remove
from automotive_cosim.run.road_recorder import RoadFacts, RoadWriter
from automotive_cosim.run.timeline import limit_kmh
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.data import choosers
from automotive_cosim.studies.reroute.decisions import told
from automotive_cosim.studies.reroute.plan import StudyJob
from automotive_cosim.studies.reroute.rows import Decision
from automotive_cosim.traffic.fork import RemoteTraffic

KEPT = 20
"""Number of drives whose records are kept when another one begins."""
KEEPS = "keeps its route"


class LiveTrip:
    """Shows one drive to those who watch it."""

    def __init__(self, job: StudyJob, traffic: RemoteTraffic, folder: Path | None) -> None:
        """Writes nothing yet.

        Args:
            traffic: its ego, which has departed.
            folder: the study's; None if nobody can watch."""
        self._job = job
        self._traffic = traffic
        self._folder = folder
        self._begun_s = traffic.state.time_s
        self._scenario = job.plan.scene(job.share)
        self._told: list[Json] = []
        """Steps so far, including those that nobody has watched."""
        self._road: RoadWriter | None = None
        self._lines: FileIO | None = None
        self._decisions = self._driven = 0
        self._tell("departure")

    def advance(self, duration_s: float) -> None:
        """Drives on, second by second if somebody watches: the same drive in shorter pieces."""
        if not self._is_watched():
            self._traffic.advance(duration_s)
            return
        with self._spared():
            if self._road is None:
                self._begin()
        step_s = self._job.plan.driven_step_s(self._job.plan.opened)
        left, second = round(duration_s / step_s), max(1, round(1 / step_s))
        while left > 0 and self._traffic.state.end is None:
            steps = min(second, left)
            self._traffic.advance(steps * step_s)
            left -= steps
            with self._spared():
                self._look()

    def decided(self, decision: Decision) -> None:
        """Shows a decision whose futures are now being driven."""
        self._decisions += 1
        chosen = choosers(self._job.plan, decision)
        lines = [f"{_way(number)}: {policies}" for number, policies in chosen.items()]
        self._tell(
            f"decision {self._decisions}: {decision.delay_s:.0f} s of delay ahead",
            thought=" ".join(told(decision)),
            stages=[{"name": "who chooses what", "text": "\n".join(lines)}],
        )

    def driven(self, branches: Sequence[Future | None]) -> None:
        """The branches of the next decision have ended; None is the drive itself."""
        self._driven += 1
        for number, future in enumerate(branches):
            if future is not None:
                time_s = future.totals().time_s
                self._tell(f"decision {self._driven}, {_way(number)}: arrives {time_s:.0f} s after the departure")

    def over(self, decisions: Sequence[Decision]) -> None:
        """The drive itself has ended, and the savings of each route are known."""
        for count, decision in enumerate(decisions, 1):
            for number, branch in enumerate(decision.branches):
                gain_s, others_s = decision.gains(number).time_s, branch.others.gain_s
                counts = f"; in no average: {decision.excluded}" if decision.excluded else ""
                self._tell(
                    f"decision {count}, {_way(number)}: saves {gain_s:+.0f} s, all others {others_s:+.0f} s{counts}"
                )

    def close(self) -> None:
        """Completes the files; may be called again."""
        road, lines, self._road, self._lines = self._road, self._lines, None, None
        for file in (road, lines):
            if file is not None:
                file.close()

    def _is_watched(self) -> bool:
        return self._folder is not None and is_being_written(self._folder / LIVE / WATCHED)

    @contextmanager
    def _spared(self) -> Iterator[None]:
        """A full disk ends the watching, not the study."""
        try:
            yield
        except OSError:
            self._folder = None
            with suppress(OSError):
                self.close()

    def _begin(self) -> None:
        """Begins the files, in place of the oldest."""
        assert self._folder is not None, "somebody watches it"
        live, job = self._folder / LIVE, self._job
        found = [each.parent for each in live.glob(f"*/{ROAD}") if not is_being_written(each)]
        for old in sorted(found, key=lambda each: each.stat().st_mtime)[: max(0, len(found) + 1 - KEPT)]:
            remove(old)
        folder = make_folder(live, job.id)
        about: Json = {
            "task": job.trip.name,
            "scenario": job.plan.scenario,
            "agent": f"departs after {job.departure_s:g} s",
            "model": "none",
            "seed": job.seed,
        }
        self._lines = growing(folder / STEPS, anew=True)
        for line in self._told:
            self._write(line)
        traffic = self._traffic
        self._road = RoadWriter(folder / ROAD, traffic.shapes(), traffic.network, about, self._begun_s)

    def _look(self) -> None:
        """A second of the road."""
        state, scenario = self._traffic.state, self._scenario
        if self._road is not None and state.end is None:
            limit = state.road.limit
            clock = scenario.start + timedelta(seconds=state.time_s - scenario.sumo.warm_up_s)
            posted = limit_kmh(limit) if limit.is_posted else None
            self._road.second(state, RoadFacts(posted, clock), self._traffic.look())

    def _tell(self, words: str, thought: str = "", stages: Sequence[Json] = ()) -> None:
        state = self._traffic.state
        line: Json = {
            "step": len(self._told),
            "at_s": round(state.time_s - self._begun_s, 2),
            "words": words,
            "action": None,
            "target": None,
            "feedback": {"code": "", "text": ""},
            "thought": thought,
            "stages": list(stages),
            "context": "",
        }
        self._told.append(line)
        with self._spared():
            self._write(line)

    def _write(self, line: Json) -> None:
        if self._lines is not None:
            add_line(self._lines, json.dumps(line, ensure_ascii=False))


def _way(number: int | None) -> str:
    return KEEPS if number is None else f"alternative {number + 1}"
