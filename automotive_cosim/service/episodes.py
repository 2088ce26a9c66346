"""The service of episodes."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from typing import Any, Protocol

from automotive_cosim.cockpit.actions import check, parse
from automotive_cosim.contracts import Action, Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.specification import End, EpisodeSpec
from automotive_cosim.errors import ActionError, InfrastructureError, UserError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.service.turn import EpisodeTurn
from automotive_cosim.traffic.fork import Simulations

SWEEP_S = 10.0
"""Longest time between two looks for idle episodes."""


@dataclass(frozen=True, slots=True)
class ServiceLimits:
    """The service's limits."""

    episodes: int = 16
    """Most episodes at once, those that are starting included."""
    idle_s: float = 900.0
    """Wall seconds after which an episode that nobody has asked for is closed."""

    def __post_init__(self) -> None:
        if self.episodes < 1 or not self.idle_s > 0:
            raise UserError(
                f"the limits are {counted(self.episodes, 'episode')}, idle for {self.idle_s:g} s; give both above 0"
            )


class Startable(Protocol):
    """What the service can run."""

    def begin(self, simulations: Simulations, channels: frozenset[Channel], observer: Observer | None) -> Session:
        """The session, which the service closes."""
        ...

    def outcome(self, session: Any) -> Json:
        """What came of the session that ``begin`` returned, once it is over."""
        ...


@dataclass(frozen=True, slots=True)
class _OnTask:
    """An episode on a task."""

    spec: EpisodeSpec

    def begin(self, simulations: Simulations, channels: frozenset[Channel], observer: Observer | None) -> Episode:
        episode = Episode.begin_at(self.spec, simulations, lambda: channels, observer)
        episode.observer = Observer()  # told of the way to the hand-over alone
        return episode

    def outcome(self, session: Episode) -> Json:
        verdict = session.verdict
        assert verdict is not None
        return {
            "task": self.spec.task,
            "half": self.spec.half,
            "seed": self.spec.seed,
            "success": verdict.success,
            "steps": len(session.steps) - 1,
            "verdict": verdict.as_json(),
            "breaches": [asdict(each) for each in session.breaches],
        }


@dataclass(slots=True)
class _Running:
    spec: Startable
    episode: Session
    used_s: float
    lock: threading.Lock = field(default_factory=threading.Lock)


class EpisodeService:
    """Runs many episodes side by side; any method may be called from any thread.

    Calls for one episode wait for each other; those for different episodes do not. Warm traffic is shared."""

    def __init__(
        self,
        simulations: Simulations | None = None,
        limits: ServiceLimits = ServiceLimits(),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Begins without episodes.

        Args:
            simulations: warm traffic, which the caller closes; by default its own.
            clock: wall seconds, for the expiry."""
        self._own = Simulations(limits.episodes) if simulations is None else None
        self._simulations = simulations or self._own or Simulations()
        self._limits = limits
        self._clock = clock
        self._running: dict[str, _Running] = {}
        self._starting: set[str] = set()
        self._lock = threading.Lock()
        self._closed = threading.Event()
        threading.Thread(target=self._sweep, name="expiry of idle episodes", daemon=True).start()

    def start(
        self, spec: EpisodeSpec | Startable, channels: frozenset[Channel] = ALL, observer: Observer | None = None
    ) -> EpisodeTurn:
        """Drives to a task's hand-over, or begins what else is given, and returns the first turn, with its id.

        Args:
            spec: the task's episode, or something else to run.
            channels: what the agent wants to see.
            observer: notified of the progress up to the hand-over, on this thread.

        Raises:
            UserError: something in the specification does not exist, or there are too many episodes.
            TriggerNotReachedError: the situation did not arise within its time limit.
            TrafficError: the traffic simulation failed."""
        with self._room() as episode_id:
            startable = _OnTask(spec) if isinstance(spec, EpisodeSpec) else spec
            episode = startable.begin(self._simulations, channels, observer)
            with self._lock:
                self._running[episode_id] = _Running(startable, episode, self._clock())
                self._starting.discard(episode_id)
            if self._closed.is_set():
                self._drop(episode_id)
        return _turn(episode_id, episode)

    def observe(self, episode_id: str) -> EpisodeTurn:
        """The present turn; no time passes. Raises UserError: there is no such episode."""
        with self._held(episode_id) as running:
            return _turn(episode_id, running.episode)

    def act(self, episode_id: str, action: Action | Json | str) -> EpisodeTurn:
        """Performs one action and lets its time pass. One that cannot be read counts as a step, as in any episode.

        Raises:
            UserError: there is no such episode, or it is over.
            TrafficError: the traffic simulation failed; the episode is gone."""
        with self._held(episode_id) as running:
            episode = running.episode
            if episode.end is not None:
                raise UserError(f"episode {episode_id!r} is over ({episode.end}); finish it to get the verdict")
            try:
                known = check(action) if isinstance(action, Action) else parse(action)
            except ActionError as error:
                episode.refuse(str(error))
            else:
                episode.step(known)
            return _turn(episode_id, episode)

    def finish(self, episode_id: str) -> Json:
        """Judges the episode and closes it. One that is not over is cut off and judged as it is.

        The rest of a drive that is cut off is driven without the agent.

        Returns:
            What came of it, as a JSON object: ``end``, ``sim_seconds`` since its beginning, ``trace_sha256`` (equal
            for the same specification and actions, whoever sent them); of a task ``success``, ``steps`` and the
            ``verdict``, of a drive its ``result``.

        Raises:
            UserError: there is no such episode.
            TrafficError: the traffic simulation failed; the episode is gone."""
        with self._held(episode_id) as running:
            episode = running.episode
            if episode.end is None:
                episode.cut_off(End.OUT_OF_BUDGET)
            outcome = running.spec.outcome(episode)
            self._drop(episode_id)
            return outcome | {
                "episode_id": episode_id,
                "end": str(episode.end),
                "sim_seconds": round(episode.seconds, 3),
                "trace_sha256": episode.trace_sha256,
            }

    def expire(self) -> None:
        """Closes the episodes that have been idle for too long; called regularly."""
        with self._lock:
            known = list(self._running.items())
        for episode_id, running in known:
            if not running.lock.acquire(blocking=False):
                continue  # somebody is using it
            try:
                if self._clock() - running.used_s >= self._limits.idle_s:
                    self._drop(episode_id)
            finally:
                running.lock.release()

    def close(self) -> None:
        """Closes every episode and its own simulations; may be called again."""
        self._closed.set()
        with self._lock:
            known = list(self._running)
        for episode_id in known:
            self._drop(episode_id)
        if self._own is not None:
            self._own.close()

    def _sweep(self) -> None:
        while not self._closed.wait(min(SWEEP_S, self._limits.idle_s)):
            self.expire()

    @contextmanager
    def _room(self) -> Iterator[str]:
        """Keeps a place for an episode that is starting, and gives its id."""
        self.expire()
        episode_id = secrets.token_hex(8)  # not to be guessed: whoever knows it is at the wheel
        with self._lock:
            if len(self._running) + len(self._starting) >= self._limits.episodes:
                at_once = counted(self._limits.episodes, "episode")
                raise UserError(f"{at_once} at once is the limit; finish one before you start another")
            self._starting.add(episode_id)
        try:
            yield episode_id
        finally:
            with self._lock:
                self._starting.discard(episode_id)

    @contextmanager
    def _held(self, episode_id: str) -> Iterator[_Running]:
        """The episode, for one caller at a time; one whose simulation failed is gone afterwards."""
        with self._lock:
            running = self._running.get(episode_id)
        if running is not None:
            with running.lock:
                if episode_id in self._running:  # it may have ended while this caller waited
                    try:
                        yield running
                    except InfrastructureError:
                        self._drop(episode_id)
                        raise
                    finally:
                        running.used_s = self._clock()
                    return
        raise UserError(
            f"no episode {episode_id[:40]!r}: finished, failed, or idle for {self._limits.idle_s:g} s; start one"
        )

    def _drop(self, episode_id: str) -> None:
        with self._lock:
            running = self._running.pop(episode_id, None)
        if running is not None:
            running.episode.close()


def _turn(episode_id: str, episode: Session) -> EpisodeTurn:
    return EpisodeTurn(episode_id, len(episode.steps) - 1, episode.observation, episode.end)
