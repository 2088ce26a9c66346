"""How the road goes on from before an act, with acts of a stored trial or without them.

    replay the trial, and fork it before each act
    with = what was driven            without = the same fork without the act, every later act given as recorded
    both again with other random numbers: what they change is no act's effect

An act is what a step commanded, or said to the driver, whatever touches it took. Later acts are given at their
recorded instants as commands, not as touches: without an act the screen may be another, and the same tap would hit
something else. They are kept rather than left out, so that the effect is that of the one act, the others being as
they were: an agent that had not done one thing would hardly have done nothing more. For each request that is left
out, the driver draws as for one, so that the answers to later ones stay what they were.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from copy import deepcopy
from dataclasses import dataclass
from itertools import chain, islice, pairwise, zip_longest
from math import inf
from typing import Any

import numpy as np

from automotive_cosim.cockpit import actions
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.contracts import Action, Alert, Observation, PullOver, Redraw, SlowDown
from automotive_cosim.cosim.attention import Asked
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.drives.acts import acts_of, spoken
from automotive_cosim.drives.events import DriveAct
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.episode.specification import ROUNDING_S
from automotive_cosim.errors import InfrastructureError
from automotive_cosim.run.rerun import Player, Recorded, compare, played
from automotive_cosim.run.trial import Shot, TrialObserver
from automotive_cosim.tasking.dialogue import is_lost
from automotive_cosim.traffic.chance import SEED_RANGE
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.running import fingerprint

FOLLOWED_S = 180.0
"""On a drive, how long after an act its effects are followed: advice ends after two minutes
(``departure.ADVICE_S``)."""
MOST_ACTS = 40
"""Acts that are measured; each keeps a fork of the traffic until the end."""


@dataclass(slots=True)
class TrialFork:
    """The trial at one instant, which stays as it is."""

    world: CoSimulation
    at: int
    """Number of its moment."""
    given: int
    """Number of commands before it."""
    asked: int
    """How often something was asked of the driver before it."""
    tracker: Any
    """Of a drive, its events so far; None of a task."""


@dataclass(slots=True)
class ForkedAct:
    """A step that commanded or said something, and the fork before it."""

    step: int
    time_s: float
    records: list[CommandRecord]
    asked: tuple[Asked, ...]
    """What it asked of the driver, where attention is limited."""
    acts: list[DriveAct]
    fork: TrialFork

    @property
    def words(self) -> str:
        """In words, for reports, with the speed that it asks for."""
        slows = [[each for each in act.requests if isinstance(each, SlowDown)] for act in self.acts]
        told = zip(self.acts, slows, strict=True)
        return "; ".join(f"asks for {slow[0].speed_kmh:.0f} km/h" if slow else act.words for act, slow in told)


@contextmanager
def forked(trial: Recorded, simulations: Simulations) -> Iterator[Forks]:
    """A stored trial, played again, with a fork from before each of its acts.

    Raises:
        UserError: something in it does not exist.
        InfrastructureError: the simulation failed, or does not repeat the trial."""
    with closing(Forks(trial.job.seed)) as forks:

        class Forking(Player):
            def act(self, observation: Observation) -> Action:
                action = super().act(observation)
                forks.foresee(action)
                return action

        player = Forking(trial.steps[1:], trial.channels, trial.failure)
        _, record = played(trial, simulations=simulations, observers=(forks,), player=player)
        again = compare(trial.steps, [line for line in record.lines if "step" in line])
        if wrong := next((step for step in again if step.differs), None):
            raise InfrastructureError(
                f"step {wrong.number} differs from the record in {', '.join(wrong.differs)}; nothing can be said "
                "of the acts of a run that does not repeat"
            )
        yield forks


class Forks(TrialObserver):
    """Watches a trial, keeps a fork from before each of its acts, and drives on from them."""

    def __init__(self, seed: int) -> None:
        """Nothing has begun. The seed is that of the redraws."""
        self._seed = seed
        self._ends = ExitStack()
        self.moments: list[Moment] = []
        self.acts: list[ForkedAct] = []
        self.session: Any = None
        self.more = 0
        """Acts that are too many to be measured."""
        self.untouched: tuple[Moment, ...] = ()
        """The do-nothing run from the beginning."""
        self._forks: list[TrialFork] = []
        self._given = self._asked = 0
        self._seen: dict[tuple[int, frozenset[int], int, float], list[Moment]] = {}
        """What was driven from a moment on without some acts, in a draw, until a time."""
        self.figures: dict[tuple[tuple[int, ...], int], Any] = {}
        """What was measured of acts, by their steps and the draw."""
        self._prints: dict[int, str] = {}
        """Of the traffic of the trial, at the end of each step (``fingerprint``)."""

    def begun(self, session: Any, shot: Shot) -> None:
        """Forks at the beginning."""
        self.session = session
        self.moments = [session.moments[0]]
        self._given, self._asked = len(session.world.cockpit.given), len(self._all_asked)
        self._fork()

    def moved(self, moment: Moment, cockpit: Any) -> None:
        """Notes what was driven; what comes before the beginning is not asked for."""
        if self.session is not None:
            self.moments.append(moment)
            world = self.session.world
            if world.moment is moment and (now := _print(world)):
                self._prints[len(self.moments) - 1] = now

    def foresee(self, action: Action) -> None:
        """Forks before an action that will command something."""
        world = self.session.world
        copy = world.cockpit.copy()
        actions.perform(action, copy, self.session.elements)
        tells = world.car.attention is not None and spoken(action, 0.0) is not None
        if (tells or copy.given[len(world.cockpit.given) :]) and len(self.acts) < MOST_ACTS:
            self._fork()

    def stepped(self, shot: Shot) -> None:
        given = self.session.world.cockpit.given
        new, self._given = list(given[self._given :]), len(given)
        asked, self._asked = self._all_asked[self._asked :], len(self._all_asked)
        action, step = shot.step.action, shot.step
        at_s = new[0].time_s if new else self.session.steps[-2].moment.time_s + step.thought_s
        lost = is_lost(step.said, step.feedback.text)
        said = None if action is None or lost else spoken(action, at_s)
        acts = [*acts_of(new, step.moment.driving), *([] if said is None else [said])]
        if acts and len(self.acts) == MOST_ACTS:
            self.more += 1
        elif acts:
            self.acts.append(ForkedAct(step.number, at_s, new, asked, acts, self._forks[-1]))

    def finished(self, row: Any, told: Any) -> None:
        """Keeps what the judge needs beside the trial itself."""
        if self.session is not None:
            self.untouched = self.session.baseline_moments

    def close(self) -> None:
        self._ends.close()

    @property
    def is_drive(self) -> bool:
        """Whether the trial is a drive, and no task."""
        return isinstance(self.session, DriveSession)

    def commands(self, steps: Collection[int]) -> set[int]:
        """What some steps commanded and asked of the driver, by identity."""
        return {id(each) for act in self.acts if act.step in steps for each in (*act.records, *act.asked)}

    @property
    def _all_asked(self) -> tuple[Asked, ...]:
        """All that was asked of the driver, where attention is limited."""
        attention = self.session.world.car.attention
        return () if attention is None else attention.asked

    def both(self, left: Sequence[ForkedAct], draw: int) -> tuple[list[Moment], list[Moment]]:
        """What was driven from the fork of the first of some acts on, with and without them; draw 0 is the recorded
        one."""
        self.drive([left], draw)
        at, until_s = left[0].fork.at, self._until_s(left)
        mine = self._seen.get((at, frozenset(), draw, until_s), self.moments[at:])
        return [moment for moment in mine if moment.time_s <= until_s], self._seen[at, _steps(left), draw, until_s]

    def drive(self, several: Iterable[Sequence[ForkedAct]], draw: int) -> None:
        """Drives on, with some acts and without them and so on, what has not been driven: as many at the same time
        as there are cores."""
        wanted = {
            key: (left, gone)
            for left in several
            for gone in (frozenset[int](), _steps(left))
            if (gone or draw) and (key := (left[0].fork.at, gone, draw, self._until_s(left))) not in self._seen
        }
        left_over = iter(wanted.items())
        while some := dict(islice(left_over, os.cpu_count() or 1)):
            runs = [self.driving(left[0].fork, gone, draw, self._until_s(left)) for left, gone in some.values()]
            self._seen.update(zip(some, together(runs), strict=True))

    def length_s(self, left: Sequence[ForkedAct]) -> float:
        """For how long acts are followed."""
        return self._until_s(left) - left[0].time_s

    def _until_s(self, left: Sequence[ForkedAct]) -> float:
        """To the end of the trial, on a drive only for some time."""
        return min(self.moments[-1].time_s + ROUNDING_S, left[-1].time_s + (FOLLOWED_S if self.is_drive else inf))

    def driving(
        self, fork: TrialFork, without: frozenset[int], draw: int, until_s: float
    ) -> Iterator[Sequence[Moment]]:
        """Drives on from a fork without some acts, second by second; gives nothing while others may go on. Where
        they make no difference any more, what comes is taken from the trial."""
        gone = self.commands(without)
        left: list[CommandRecord] = list(self.session.world.cockpit.given[fork.given :])
        asked = list(self._all_asked[fork.asked :])
        with closing(fork.world.branch()) as world:
            if draw:
                seed = np.random.default_rng((self._seed, fork.at, draw)).integers(SEED_RANGE)
                world.traffic.request(Redraw(int(seed)))
            yield [self.moments[fork.at]]
            is_same = bool(without) and not draw and world.car.attention is None  # which no moment has whole
            for number, (before, now) in enumerate(pairwise(self.moments[fork.at :]), fork.at + 1):
                if now.time_s > until_s or world.moment.driving.end is not None:
                    break
                while left and left[0].time_s <= before.time_s + ROUNDING_S:
                    if id(record := left.pop(0)) not in gone:
                        world.give(record)
                    for _ in range(_draws(record) if id(record) in gone else 0):
                        world.traffic.request(Redraw())
                while asked and asked[0].time_s <= before.time_s + ROUNDING_S:
                    if id(what := asked.pop(0)) not in gone:
                        world.ask(what)
                tick_s = round(now.time_s - before.time_s, 6)
                world.traffic.start(min(TICK_S, tick_s))
                yield ()
                yield world.advance(tick_s)
                is_same = is_same and world.moment.passed == now.passed
                is_over = number in self._prints and not gone.intersection(map(id, left))
                if not (is_same and is_over and world.moment.signals == now.signals):
                    continue
                if _print(world) == self._prints[number]:
                    yield [each for each in self.moments[number + 1 :] if each.time_s <= until_s]
                    break

    def _fork(self) -> None:
        world, tracker = self.session.world.branch(), deepcopy(getattr(self.session, "tracker", None))
        self._ends.callback(world.close)
        self._forks.append(TrialFork(world, len(self.moments) - 1, self._given, self._asked, tracker))


def _print(world: CoSimulation) -> str:
    """Of the traffic of a drive; empty if it cannot be told."""
    call = getattr(world.traffic.wrapped, "call", None)  # the traffic of some tests has none
    return "" if call is None else str(call(fingerprint))


def together(drives: Sequence[Iterator[Sequence[Moment]]]) -> list[list[Moment]]:
    """What drives come to that go on at the same time, in their order."""
    return [list(chain.from_iterable(parts)) for parts in zip(*zip_longest(*drives, fillvalue=()), strict=True)]


def _steps(left: Iterable[ForkedAct]) -> frozenset[int]:
    return frozenset(act.step for act in left)


def _draws(record: CommandRecord) -> int:
    """How often the driver drew because of a command."""
    return sum(
        answer.accepted and isinstance(request, Alert | SlowDown | PullOver) for request, answer in record.answers
    )
