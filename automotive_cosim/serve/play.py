"""Play: a person at the cockpit, in real time, judged as agents are.

The episode is one of ``run``: found, paced, recorded and judged by the same code. Only its agent is a person, whose
acts come from a page. An act takes a simulated second, as any agent's does; in a second without an act, the car
drives on. If the person acts faster than that, the next act waits; if the simulation is slower than real time, the
clock slips.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from io import BytesIO
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Action, ActionType, Json, Observation
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.episode import Episode
from automotive_cosim.errors import CosimError, UserError
from automotive_cosim.interface.observe import ALL
from automotive_cosim.report.film import Film
from automotive_cosim.report.page import write_page
from automotive_cosim.run.episode import EpisodeResult, EpisodeSetup, Shot, Watcher, run_episode
from automotive_cosim.run.record import Recorder, default_folder
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

MOST_S, MOST_STEPS = 120.0, 1000
"""Simulated seconds, and acts, after which an episode ends."""
TICK_S = 1.0
"""Time that an act takes."""
QUALITY = 88
WAITING = 4
"""Acts that may wait for their second; more are refused."""


class PlayState(StrEnum):
    """What is going on."""

    IDLE = "idle"
    WARMING = "warming"
    DRIVING = "driving"
    """The car is on its way to the situation."""
    ACTING = "acting"
    ENDING = "ending"
    """The road is watched a little longer, and the record is written."""
    OVER = "over"
    FAILED = "failed"


class StoppedError(CosimError):
    """The person has left."""


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
    error: str = ""
    folder: Path | None = None
    """The record, once the episode is over."""


class Game(Watcher):
    """One person's episodes, one at a time. Any method may be called from any thread."""

    def __init__(self, folder: Path, scenario: str | None = None) -> None:
        """Nothing runs yet.

        Args:
            folder: where episodes are recorded, each in a folder of its own.
            scenario: instead of the tasks' own.
        """
        self._scenario = scenario
        self._folder = folder
        self._simulations = Simulations()
        self._news = threading.Condition()
        self._scene = PlayScene()
        self._thread: threading.Thread | None = None
        self._person = Person()

    def start(self, task: str, half: str, seed: int, name: str) -> None:
        """Begins an episode.

        Args:
            task: id of the task.
            half: ``first``, ``second``, or empty to be dealt one by the seed.
            seed: seed of the episode.
            name: code name of the person.

        Raises:
            UserError: one is running, or there is no such task or half.
        """
        chosen = CATALOGUE[task]
        half = half or chosen.halves[int(np.random.default_rng([seed, 5]).integers(len(chosen.halves)))]
        chosen.half(half)
        if len(name) > 40 or not all(letter.isalnum() or letter in " -_" for letter in name):
            raise UserError(f"{name[:40]!r} is not a code name; give up to 40 letters, digits, spaces, - or _")
        with self._news:
            if self._thread is not None and self._thread.is_alive():
                raise UserError("an episode is running already; finish or leave it first")
            setup = EpisodeSetup(
                task,
                half,
                self._scenario,
                seed=seed,
                agent="human",
                model=name or "none",
                max_steps=1000,
                max_sim_s=MOST_S,
            )
            folder = self._folder / default_folder(setup).name
            self._person = Person(name or "none")
            self._scene = PlayScene(self._scene.version + 1, PlayState.WARMING)
            self._thread = threading.Thread(target=self._run, args=(setup, folder), name="play", daemon=True)
            self._thread.start()

    def act(self, action: Json) -> None:
        """Performs an action in its second.

        Raises:
            UserError: it is malformed, too many wait, or nobody can act now.
        """
        if self._scene.state is not PlayState.ACTING:
            raise UserError("nobody can act now")
        self._person.give(parse(action))

    def leave(self) -> None:
        """Ends the episode, if one is running, soon."""
        self._person.stop()
        if self._scene.state is PlayState.ACTING:
            self._tell(state=PlayState.ENDING)

    def close(self) -> None:
        """Ends everything, and waits until it has ended."""
        self.leave()
        if self._thread is not None:
            self._thread.join()
        self._simulations.close()

    def scene(self, seen: int = -1, wait_s: float = 0.0) -> PlayScene:
        """The newest scene.

        Args:
            seen: version that is known already.
            wait_s: how long to wait for another.
        """
        with self._news:
            self._news.wait_for(lambda: self._scene.version != seen, wait_s)
            return self._scene

    # --- the episode ------------------------------------------------------------------------------------------

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """Tells how far the warm-up is."""
        self._check_stays()
        self._tell(state=PlayState.WARMING, progress=done_s / total_s if total_s else 1.0)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Tells that the car is on its way."""
        if self._scene.state is PlayState.WARMING:
            self._tell(state=PlayState.DRIVING)
        if self._scene.state in (PlayState.WARMING, PlayState.DRIVING):
            self._check_stays()

    def handed_over(self, episode: Episode, shot: Shot) -> None:
        """Shows the screen, and starts the clock."""
        self._show(episode.observation, shot.screenshot)
        self._person.listen(self._show_told)

    def stepped(self, shot: Shot) -> None:
        """Shows the screen after a second."""
        action = shot.step.action
        has_declared = action is not None and action.action_type is ActionType.STATUS
        self._tell(screen=_jpeg(shot.screenshot), state=PlayState.ENDING if has_declared else self._scene.state)

    def _check_stays(self) -> None:
        """Before the hand-over, there is nothing to record of an episode that is left."""
        if self._person.has_left:
            raise StoppedError("the person has left")

    def _show(self, observation: Observation, screenshot: npt.NDArray[np.uint8]) -> None:
        self._tell(state=PlayState.ACTING, told=_told(observation), screen=_jpeg(screenshot))

    def _show_told(self, observation: Observation) -> None:
        self._tell(told=_told(observation))

    def _run(self, setup: EpisodeSetup, folder: Path) -> None:
        recorder = Recorder(folder, setup, {})
        watchers = (self, recorder, RoadRecorder(folder, setup), Film(folder))  # the person first
        try:
            run_episode(setup, self._person, watchers, simulations=self._simulations)
        except StoppedError:
            self._tell(state=PlayState.IDLE, told=None, screen=b"")
        except KeyboardInterrupt:  # how a person's leaving ends an episode that has begun
            self._end(recorder)
        except Exception as error:
            self._tell(state=PlayState.FAILED, error=str(error) or type(error).__name__)
        else:
            self._end(recorder)

    def finished(self, result: EpisodeResult) -> None:
        """Keeps the error of an episode that could not be judged."""
        if result.error is not None:
            self._tell(error=result.error)

    def _end(self, recorder: Recorder) -> None:
        if not recorder.begun:
            self._tell(state=PlayState.FAILED, error=self._scene.error or "the situation did not arise")
            return
        with suppress(UserError, OSError):
            write_page(recorder.folder)
        self._tell(state=PlayState.OVER, folder=recorder.folder)

    def _tell(self, **changes: object) -> None:
        with self._news:
            self._scene = replace(self._scene, version=self._scene.version + 1, **changes)  # type: ignore[arg-type]
            self._news.notify_all()


class Person:
    """The agent: whoever gives actions."""

    name = "human"
    channels = ALL

    def __init__(self, model: str = "none", clock: Callable[[], float] = time.monotonic) -> None:
        """Nobody is there yet.

        Args:
            model: the code name, which stands where agents have their model.
            clock: wall seconds.
        """
        self.model = model
        self.has_left = False
        self._clock = clock
        self._given: queue.Queue[Action | None] = queue.Queue()
        self._due_s = 0.0
        """Wall time at which the present second is over."""
        self._told: Callable[[Observation], None] | None = None

    def give(self, action: Action) -> None:
        """Hands in an action.

        Raises:
            UserError: too many wait already.
        """
        if self._given.qsize() >= WAITING:
            raise UserError("an act takes a second; wait until the last ones are done")
        self._given.put(action)

    def stop(self) -> None:
        """The person leaves."""
        self.has_left = True
        self._given.put(None)

    def listen(self, told: Callable[[Observation], None]) -> None:
        """Sets who hears what the person is told, and starts the clock."""
        self._told = told
        self._due_s = self._clock() + TICK_S

    def reset(self, goal: str) -> None:
        """Does nothing: the page shows the driver's words."""

    def act(self, observation: Observation) -> Action:
        """The action given within the present second, else to wait.

        Raises:
            KeyboardInterrupt: the person has left.
        """
        if self._told is not None:
            self._told(observation)
        now_s = self._clock()
        ahead_s = self._due_s - now_s - TICK_S
        if ahead_s > 0:  # time has run ahead of the clock by an act
            time.sleep(ahead_s)
            now_s = self._clock()
        self._due_s = max(self._due_s, now_s)
        try:
            action = self._given.get(timeout=max(0.0, self._due_s - now_s))
        except queue.Empty:
            action = Action(ActionType.WAIT, seconds=1)
        if action is None:
            raise KeyboardInterrupt
        self._due_s += TICK_S * (action.seconds or 1 if action.action_type is ActionType.WAIT else 1)
        return action


def _told(seen: Observation) -> Json:
    """What the person is told: the same as an agent."""
    car = seen.vehicle
    return {
        "goal": seen.goal,
        "said": list(seen.said),
        "time_s": round(seen.time_s, 1),
        "feedback": [seen.feedback.code, seen.feedback.text],
        "context": seen.context or "",
        "speed_kmh": None if car is None else round(car.speed_kmh),
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


def _jpeg(screenshot: npt.NDArray[np.uint8]) -> bytes:
    data = BytesIO()
    Image.fromarray(screenshot).save(data, format="JPEG", quality=QUALITY, subsampling=0)
    return data.getvalue()
