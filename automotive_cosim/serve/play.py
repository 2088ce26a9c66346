"""Play: a person at the cockpit, in real time, judged as agents are.

The episode is one of ``eval``, or in practice one of ``run``: found, recorded and judged by the same code. Only its
agent is a person, whose acts come from a page. An act takes a simulated second, as any agent's does; in a second
without an act, the car drives on. If the person acts faster than that, the next act waits; if the simulation is
slower than real time, the clock slips. Leaving an episode that counts is a failure.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import closing, nullcontext, suppress
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Json, Observation
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.families import family_named
from automotive_cosim.episode.session import JudgedSession
from automotive_cosim.errors import UserError
from automotive_cosim.report.film import Film
from automotive_cosim.report.page import write_page
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.record import Recorder, default_folder, stamped_folder
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.run.rows import TrialRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.trial import HUMAN, NO_MODEL, Shot, TrialObserver, TrialSetup, run_trial
from automotive_cosim.run.worker import run_with
from automotive_cosim.serve.person import SPEEDS, Person, PersonLeftError, Preview
from automotive_cosim.serve.played import (
    DRIVES,
    FOLDER,
    MOST_S,
    MOST_STEPS,
    PlayedDrives,
    PlayedEpisodes,
    check_code_name,
)
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

QUALITY = 88


class PlayState(StrEnum):
    """The state of play."""

    IDLE = "idle"
    WARMING = "warming"
    DRIVING = "driving"
    """The car is driving to the situation."""
    ACTING = "acting"
    ENDING = "ending"
    """The aftermath is simulated, and the record is written."""
    OVER = "over"
    FAILED = "failed"


class _StoppedError(KeyboardInterrupt):
    """The person has left before there was anything to record."""


@dataclass(frozen=True, slots=True)
class PlayScene:
    """What the page shows at one instant."""

    version: int = 0
    state: PlayState = PlayState.IDLE
    progress: float = 0.0
    """Of the warm-up, 0 to 1."""
    told: Json | None = None
    """What an agent would be told, as JSON."""
    screen: bytes = b""
    """The cockpit as a JPEG."""
    look: int = 0
    """Changes when the screen changes."""
    error: str = ""
    folder: Path | None = None
    """The record, or the evaluation that it is in, once the episode is over."""
    episode: str | None = None
    """Its id in the evaluation."""
    is_practice: bool = False
    is_paused: bool = False
    speed: float = 1.0
    """Simulated seconds per second."""


class Game(TrialObserver):
    """One person's episodes, one at a time. Any method may be called from any thread."""

    def __init__(self, folder: Path, scenario: str | None = None, simulations: Simulations | None = None) -> None:
        """Nothing runs yet.

        Args:
            folder: where practice is recorded, each episode in a folder of its own, and the rest as an evaluation
                in ``people``.
            scenario: instead of the tasks' own.
            simulations: warm simulations to use, which the caller closes; by default its own."""
        self._scenario = scenario
        self._folder = folder
        self._rows = PlayedEpisodes(folder / FOLDER, scenario)
        self._drives = PlayedDrives(folder / DRIVES)
        self._own = Simulations() if simulations is None else None
        self._simulations = simulations or self._own
        self._news = threading.Condition()
        self._scene = PlayScene()
        self._thread: threading.Thread | None = None
        self._person = Person()
        self._preview = Preview()
        self._shown = _ShownScreen()
        self._hand = threading.Lock()
        """Held while an act or a step changes what is shown, so that they stay in order."""
        self._cockpit: Cockpit | None = None
        """The real cockpit of the running episode."""

    def start(self, task: str, half: str, seed: int, name: str, *, practice: bool) -> None:
        """Begins an episode.

        Args:
            half: ``first``, ``second``, or empty to let the seed choose.
            practice: it may be paused and slowed, and gives no row.

        Raises UserError: one is running, there is no such task or half, or the name is no code name."""
        chosen = CATALOGUE[task]
        half = half or chosen.halves[int(np.random.default_rng([seed, 5]).integers(len(chosen.halves)))]
        chosen.half(half)
        if name or not practice:
            check_code_name(name)
        if not practice:
            self.begin(self._rows.job(task, half, seed, name), self._rows.folder, self._rows.keep)
            return
        setup = EpisodeSetup(
            task, half, self._scenario, seed=seed, agent=HUMAN, model=name or NO_MODEL, max_steps=MOST_STEPS,
            max_sim_s=MOST_S,
        )  # fmt: skip
        folder = self._folder / default_folder(setup).name
        self._begin(Person(setup.model), lambda: self._practise(setup, folder))

    def drive(self, family: str, seed: int, name: str, *, practice: bool) -> None:
        """Begins a drive.

        Args:
            practice: it may be paused and slowed, and does not count.

        Raises UserError: an episode is running, there is no such family, or the name is no code name."""
        family_named(family)
        if name or not practice:
            check_code_name(name)
        if practice:
            setup = DriveSetup(family, seed, agent=HUMAN, model=name or NO_MODEL)
            folder = self._folder / stamped_folder(f"{family}-{HUMAN}-seed{seed}").name
            self._begin(Person(setup.model), lambda: self._practise(setup, folder))
            return
        self.begin(self._drives.drive(family, seed, name), self._drives.folder, self._drives.keep)

    def begin(self, job: TrialSetup, folder: Path, keep: Callable[[Any], None]) -> None:
        """Begins a trial that counts.

        Args:
            folder: the evaluation that it belongs to.
            keep: takes its row.

        Raises UserError: one is running."""
        self._begin(Person(job.model, counts=True), lambda: self._count(job, folder, keep))

    @property
    def is_running(self) -> bool:
        """Whether an episode is running."""
        return self._thread is not None and self._thread.is_alive()

    def pace(self, speed: float, *, paused: bool) -> None:
        """Slows an episode of practice, or stops its clock.

        Raises UserError: the episode counts, nothing runs, or the speed is none of ``SPEEDS``."""
        if speed not in SPEEDS:
            raise UserError(f"speed {speed:g} is not one of {', '.join(f'{each:g}' for each in SPEEDS)}")
        if not self._scene.is_practice or self._scene.state is not PlayState.ACTING:
            raise UserError("only practice can be paused or slowed, and only while it runs")
        self._person.pace(speed, paused=paused)
        self._tell(speed=speed, is_paused=paused)

    def act(self, action: Json) -> bytes:
        """Performs an action in its second.

        Returns:
            The screen as the action will leave it, as a JPEG, before the road has taken that second.

        Raises UserError: it is malformed, too many wait, or no action is possible now."""
        given = parse(action)
        with self._hand:
            if self._scene.state is not PlayState.ACTING:
                raise UserError("no action is possible now; wait until the episode has started")
            self._person.give(given)
            self._shown.show(self._preview.after(given))
            with self._news:  # the page gets it from here, so nobody else needs to be notified
                self._scene = replace(self._scene, screen=self._shown.jpeg, look=self._shown.look)
            return self._shown.jpeg

    def leave(self) -> None:
        """Ends the episode soon, if one is running."""
        self._person.stop()
        if self._scene.state is PlayState.ACTING:
            self._tell(state=PlayState.ENDING)

    def close(self) -> None:
        """Aborts what is running, without a row, and waits until it has ended."""
        self._person.counts = False
        self.leave()
        if self._thread is not None:
            self._thread.join()
        if self._own is not None:
            self._own.close()
        self._rows.close()
        self._drives.close()

    def scene(self, seen: int = -1, wait_s: float = 0.0) -> PlayScene:
        """The newest scene.

        Args:
            seen: version that is known already.
            wait_s: how long to wait for a newer one."""
        with self._news:
            self._news.wait_for(lambda: self._scene.version != seen, wait_s)
            return self._scene

    # --- the episode ------------------------------------------------------------------------------------------

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """Reports the progress of the warm-up."""
        self._check_stays()
        self._tell(state=PlayState.WARMING, progress=done_s / total_s if total_s else 1.0)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Reports that the car is driving to the situation."""
        if self._scene.state is PlayState.WARMING:
            self._tell(state=PlayState.DRIVING)
        if self._scene.state in (PlayState.WARMING, PlayState.DRIVING):
            self._check_stays()

    def begun(self, session: JudgedSession, shot: Shot) -> None:
        """Shows the screen, and starts the clock."""
        self._cockpit = session.world.cockpit
        self._preview.follow(self._cockpit)
        self._show(session.observation, shot.screenshot)
        self._person.listen(self._show_told)

    def stepped(self, shot: Shot) -> None:
        """Shows the screen after a second, unless a waiting act has changed what the person sees."""
        with self._hand:
            if not self._person.has_acts:
                assert self._cockpit is not None
                self._preview.follow(self._cockpit)
                self._shown.show(shot.screenshot)
                self._tell(screen=self._shown.jpeg, look=self._shown.look)
            if shot.session.end is not None:
                self._tell(state=PlayState.ENDING)

    def _check_stays(self) -> None:
        """Stops an episode that is left before the hand-over, as there is nothing to record."""
        if self._person.has_left:
            raise _StoppedError

    def _show(self, observation: Observation, screenshot: npt.NDArray[np.uint8]) -> None:
        self._shown.show(screenshot)
        told, shown = _told(observation), self._shown
        self._tell(state=PlayState.ACTING, told=told, screen=shown.jpeg, look=shown.look)

    def _show_told(self, observation: Observation) -> None:
        self._tell(told=_told(observation))

    def _begin(self, person: Person, play: Callable[[], None]) -> None:
        with self._news:
            if self.is_running:
                raise UserError("an episode is already running; finish or leave it first")
            self._person = person
            state = PlayState.WARMING
            self._scene = PlayScene(self._scene.version + 1, state, is_practice=not person.counts)
            self._thread = threading.Thread(target=self._run, args=(play,), name="play", daemon=True)
            self._thread.start()

    def _run(self, play: Callable[[], None]) -> None:
        try:
            play()
        except (_StoppedError, PersonLeftError):
            self._tell(state=PlayState.IDLE, told=None, screen=b"")
        except Exception as error:
            self._tell(state=PlayState.FAILED, error=str(error) or type(error).__name__)

    def _practise(self, job: TrialSetup, folder: Path) -> None:
        """Plays a trial and records it as ``run`` does."""
        is_episode = isinstance(job, EpisodeSetup)
        recorder, road = Recorder(job, folder, {}, whole=is_episode), RoadRecorder(folder, job.about)
        everyone = (self, recorder, road, *([Film(folder)] if is_episode else []))  # the person first
        with suppress(PersonLeftError), closing(recorder), closing(road):
            run_trial(job, self._person, everyone, simulations=self._simulations)
        if not recorder.has_begun or (self._scene.error and not is_episode):
            self._tell(state=PlayState.FAILED, error=self._scene.error or "the situation did not arise")
            return
        if is_episode:
            with suppress(UserError, OSError):
                write_page(folder)
        self._tell(state=PlayState.OVER, folder=folder)

    def _count(self, job: TrialSetup, folder: Path, keep: Callable[[Any], None]) -> None:
        """Plays a trial and keeps its row."""
        assert self._simulations is not None
        row = run_with(nullcontext(self._person), job, folder, Pictures.ALL, self._simulations, (self,))
        keep(row)
        if row.trace_sha256 is None:
            self._tell(state=PlayState.FAILED, error=row.error or "the situation did not arise")
        else:
            self._tell(state=PlayState.OVER, folder=folder, episode=job.id)

    def finished(self, row: TrialRow, told: object) -> None:
        """Keeps the error of a trial that could not be judged."""
        if row.error is not None:
            self._tell(error=row.error)

    def _tell(self, **changes: object) -> None:
        with self._news:
            self._scene = replace(self._scene, version=self._scene.version + 1, **changes)  # type: ignore[arg-type]
            self._news.notify_all()


def _told(seen: Observation) -> Json:
    """What the person is told: the same as an agent is told."""
    return {
        "goal": seen.goal,
        "said": list(seen.said),
        "time_s": round(seen.time_s, 1),
        "feedback": [seen.feedback.code, seen.feedback.text],
        "context": seen.context or "",
        "readings": _readings(seen),
        "elements": [
            {
                "text": ": ".join(part for part in (element.text, element.content_description) if part)
                or element.class_name,
                "box": [box.x_min, box.y_min, box.x_max, box.y_max],
                "editable": element.is_editable,
                "checked": element.is_checked,
            }
            for element in seen.elements or ()
            for box in [element.bbox_pixels]
            if element.is_clickable or element.is_editable
        ],
    }


def _readings(seen: Observation) -> Json:
    """The readings of the car's sensors and receivers by name, without missing ones."""
    parts = {"": seen.vehicle, "link ": seen.connectivity, "gps ": seen.gps}
    named = {
        prefix + each.name: getattr(part, each.name)
        for prefix, part in parts.items()
        if part is not None
        for each in fields(part)
    }
    return {
        name: round(value, 5 if name.startswith("gps") else 1) if isinstance(value, float) else str(value)
        for name, value in named.items()
        if value is not None
    }


class _ShownScreen:
    """The screen that the page shows, as a JPEG with a number that changes with it."""

    def __init__(self) -> None:
        self.look = 0
        self.jpeg = b""
        self._screenshot: npt.NDArray[np.uint8] | None = None

    def show(self, screenshot: npt.NDArray[np.uint8]) -> None:
        """Takes another screenshot, (height, width, 3); the same array is the same screen."""
        if screenshot is self._screenshot:
            return
        data = BytesIO()
        Image.fromarray(screenshot).save(data, format="JPEG", quality=QUALITY, subsampling=0)
        self._screenshot, self.jpeg, self.look = screenshot, data.getvalue(), self.look + 1
