"""Which act did it: what each act of a stored trial changed, measured by leaving it out.

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

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from copy import deepcopy
from dataclasses import asdict, dataclass, field, replace
from itertools import combinations, pairwise
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from automotive_cosim.cockpit import actions
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    Action,
    ActionType,
    Alert,
    Json,
    Observation,
    PullOver,
    Redraw,
    SlowDown,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.drives.acts import acts_of, spoken
from automotive_cosim.drives.driver import driver_events
from automotive_cosim.drives.events import KINDS, DriveAct
from automotive_cosim.drives.faults import faults
from automotive_cosim.drives.followed import followed
from automotive_cosim.drives.harm import distraction_s, harm
from automotive_cosim.drives.judge import BACK, EventOutcome, JudgedAct, Worth, facts_of, judge
from automotive_cosim.drives.result import judged_since
from automotive_cosim.drives.score import LEAST_WORTH, score
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.episode.episode import Episode, counterfactual
from automotive_cosim.episode.specification import ROUNDING_S
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.interface.observe import Channel
from automotive_cosim.run.figures import drive_figures
from automotive_cosim.run.observer import Shot, TrialObserver
from automotive_cosim.run.rerun import Player, Recorded, compare, played, recorded
from automotive_cosim.run.row import from_json
from automotive_cosim.run.trial_folder import is_trial
from automotive_cosim.tasking.verdict import PARTS
from automotive_cosim.tasking.verdict import judge as judged
from automotive_cosim.traffic.chance import SEED_RANGE
from automotive_cosim.traffic.fork import Simulations

FILE = "attribution.json"
FIGURES: Mapping[str, tuple[str, str, float]] = {
    "over_s": ("above the limit", "s", 0.9),
    "over_m": ("above the limit", "m", 5.0),
    "near_s": ("near collision", "s", 0.9),
    "nearest_s": ("least time to collision", "s", 0.2),
    "arrival_s": ("time to the destination", "s", 1.0),
    "driven_m": ("way driven", "m", 20.0),
    "energy_wh": ("energy", "Wh", 5.0),
}
"""What an act may change: its name, its unit, and up to what a difference is none."""
NO_ACT, LACKING = "no act", frozenset({"goal", "in_time", "declared"})
"""In place of an act that is missing; the parts of a verdict that fail for want of one."""
FAR_S = 20.0
"""A time to collision above it is no approach."""
REDRAWS = 4
"""Further draws of both, with and without, where leaving an act out changed anything on the road."""
FOLLOWED_S = 180.0
"""On a drive, how long after an act its effects are followed: advice ends after two minutes
(``departure.ADVICE_S``)."""
MOST_ACTS = 40
"""Acts that are measured; each keeps a fork of the traffic until the end."""
TOGETHER_S, MOST_PAIRS = 60.0, 15
"""Two acts that change nothing alone are left out together if they are no farther apart; the nearest first."""


@dataclass(frozen=True, slots=True)
class ActEffect:
    """What leaving out an act, or two together, changed. A difference is with minus without."""

    steps: tuple[int, ...]
    """Their numbers in the trace; none of an act that is missing."""
    at_s: float
    """Seconds since the beginning of the trial, of the first."""
    act: str
    """In words."""
    came: str = ""
    """What became of it: the driver's answer, and what the car then did."""
    verdict: str = ""
    """How the verdict, or on a drive what became of events, would be another without it; empty if it would not."""
    points: float | None = None
    """On a drive, how many points of the score it brought, or cost."""
    glance_s: float = 0.0
    """For how long it took the driver's eyes off the road."""
    changed: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """By figure: the median difference of all draws, and how much draws without the act differ from each other."""
    chance: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Differences of the recorded draw that other draws show without the act, too, or do not confirm."""
    draws: int = 1
    """How many draws were compared, the recorded one among them."""

    @property
    def is_neutral(self) -> bool:
        """Whether it changed nothing that is more than chance."""
        return not self.changed and not self.verdict and not self.points

    @property
    def effect(self) -> str:
        """In words."""
        told = [self.verdict] if self.verdict else []
        if self.points:
            told.append(f"{self.points:+.0f} points".replace("-", "−"))
        told += [_said(name, *found) for name, found in self.changed.items()]
        if not told:
            told.append("neutral")
        if self.chance:
            parts = ", ".join(_said(name, *found) for name, found in self.chance.items())
            told.append(f"no more than chance: {parts}")
        if self.glance_s:
            told.append(f"a glance of {_digits(self.glance_s)} s")
        return "; ".join(told)


def _said(name: str, difference: float, noise: float) -> str:
    what, unit, _ = FIGURES[name]
    beside = f" (draws differ by {_digits(noise)})" if noise >= 0.05 else ""
    return f"{_digits(difference, '+')} {unit} {what}{beside}".replace("-", "−")


def _words(act: DriveAct) -> str:
    """An act with the speed that it asks for."""
    slow = next((request for request in act.requests if isinstance(request, SlowDown)), None)
    return act.words if slow is None else f"asks for {slow.speed_kmh:.0f} km/h"


def _digits(value: float, sign: str = "") -> str:
    return f"{value:{sign}.{0 if abs(value) >= 9.95 else 1}f}"


def attribute(
    folder: Path,
    trial: str = "",
    only: Collection[int] | None = None,
    *,
    simulations: Simulations | None = None,
) -> list[ActEffect]:
    """Measures what each act of a stored trial changed, and keeps it (``path_of``) unless it was asked for some.

    Args:
        folder: an evaluation's, a search's, or that of a single trial.
        trial: an id of the evaluation, or its unique beginning; a single trial needs none.
        only: numbers of steps, which are left out together; by default each act by itself, then those pairs that
            change nothing alone.
        simulations: warm simulations to use; by default its own.

    Raises:
        UserError: no such trial or act, or its trace cannot be read.
        InfrastructureError: the simulation failed, or does not repeat the trial.
    """
    stored = recorded(folder, trial)
    with ExitStack() as ends, forked(stored, simulations or ends.enter_context(closing(Simulations()))) as forks:
        if only is not None:
            return [forks.without(only)]
        found = forks.effects() + forks.unmeasured() + forks.missing()
    path = path_of(folder, stored[0].id)
    make_folder(path.parent)
    write_whole(path, json.dumps({"acts": [asdict(each) for each in found]}, indent=1) + "\n")
    return found


@contextmanager
def forked(trial: Recorded, simulations: Simulations) -> Iterator[Forks]:
    """A stored trial, played again, with a fork from before each of its acts; arguments and errors as above."""
    job, stored, channels, failure = trial
    with closing(Forks(job.seed)) as forks:
        player = _Forking(stored[1:], channels, failure, forks)
        _, record = played(
            job, stored, channels, failure, simulations=simulations, observers=(forks,), player=player
        )
        again = compare(stored, [line for line in record.lines if "step" in line])
        if wrong := next((step for step in again if step.differs), None):
            raise InfrastructureError(
                f"step {wrong.number} differs from the record in {', '.join(wrong.differs)}; nothing can be said "
                "of the acts of a run that does not repeat"
            )
        yield forks


def path_of(folder: Path, trial: str = "") -> Path:
    """Where the effects of a trial's acts are kept: in its folder, or that of its evaluation."""
    return folder / FILE if is_trial(folder) else folder / "attribution" / f"{trial}.json"


def read_effects(path: Path) -> list[ActEffect]:
    """The effects of a trial's acts; none if they were not measured.

    Raises:
        UserError: they cannot be read.
    """
    if not path.is_file():
        return []
    try:
        return [from_json(ActEffect, each) for each in read_json(path)["acts"]]
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise UserError(f"{path} holds no effects of acts; `automotive-cosim attribute` measures them") from error


@dataclass(slots=True)
class _Act:
    """A step that commanded or said something."""

    step: int
    time_s: float
    records: list[CommandRecord]
    acts: list[DriveAct]
    fork: _Fork
    text: str

    @property
    def words(self) -> str:
        """In words, for reports."""
        return "; ".join(map(_words, self.acts))


@dataclass(slots=True)
class _Fork:
    """The trial at one instant, which stays as it is."""

    world: CoSimulation
    at: int
    """Number of its moment."""
    given: int
    """Number of commands before it."""
    tracker: Any
    """Of a drive, its events so far; None of a task."""


class Forks(TrialObserver):
    """Watches a trial, keeps a fork from before each of its acts, and drives on from them."""

    def __init__(self, seed: int) -> None:
        """Nothing has begun. The seed is that of the redraws."""
        self._seed = seed
        self._ends = ExitStack()
        self.moments: list[Moment] = []
        self.acts: list[_Act] = []
        self._session: Any = None
        self._forks: list[_Fork] = []
        self._given = self._more = 0
        self._untouched: tuple[Moment, ...] = ()
        self._seen: dict[tuple[int, frozenset[int], int], list[Moment]] = {}

    # --- while it runs ------------------------------------------------------------------------------------

    def begun(self, session: Any, shot: Shot) -> None:
        """Forks at the beginning."""
        self._session = session
        self.moments = [session.moments[0]]
        self._given = len(session.world.cockpit.given)
        self._fork()

    def moved(self, moment: Moment, cockpit: Any) -> None:
        """Notes what was driven; what comes before the beginning is not asked for."""
        if self._session is not None:
            self.moments.append(moment)

    def foresee(self, action: Action) -> None:
        """Forks before an action that will command something."""
        world = self._session.world
        copy = world.cockpit.copy()
        actions.perform(action, copy, self._session.elements)
        if copy.given[len(world.cockpit.given) :] and len(self.acts) < MOST_ACTS:
            self._fork()

    def stepped(self, shot: Shot) -> None:
        """Notes an act."""
        given = self._session.world.cockpit.given
        new, self._given = list(given[self._given :]), len(given)
        action, step = shot.step.action, shot.step
        at_s = new[0].time_s if new else self._session.steps[-2].moment.time_s + step.thought_s
        said = None if action is None else spoken(action, at_s)
        acts = [*acts_of(new, step.moment.driving), *([] if said is None else [said])]
        if acts and len(self.acts) == MOST_ACTS:
            self._more += 1
        elif acts:
            text = (action.text or "") if action is not None else ""
            self.acts.append(_Act(step.number, at_s, new, acts, self._forks[-1], text))

    def finished(self, row: Any, told: Any) -> None:
        """Keeps what the judge needs beside the trial itself."""
        if self._session is not None:
            self._untouched = self._session.baseline_moments

    def close(self) -> None:
        """Ends all forks."""
        self._ends.close()

    def _fork(self) -> None:
        world = self._session.world.branch()
        self._ends.callback(world.close)
        tracker = deepcopy(getattr(self._session, "tracker", None))
        self._forks.append(_Fork(world, len(self.moments) - 1, len(self._session.world.cockpit.given), tracker))

    # --- afterwards ---------------------------------------------------------------------------------------

    def effects(self) -> list[ActEffect]:
        """What each act changed, and of those that changed nothing, each pair that did."""
        found = [self.without((act.step,)) for act in self.acts]
        idle = [act for act, effect in zip(self.acts, found, strict=True) if effect.is_neutral]
        if len(idle) < 2 or self.without([act.step for act in idle], redraws=0).is_neutral:
            return found
        near = [pair for pair in combinations(idle, 2) if pair[1].time_s - pair[0].time_s <= TOGETHER_S]
        near.sort(key=lambda pair: (pair[1].time_s - pair[0].time_s, pair[0].time_s))
        together = (self.without([act.step for act in pair]) for pair in near[:MOST_PAIRS])
        return found + [effect for effect in together if not effect.is_neutral]

    def unmeasured(self) -> list[ActEffect]:
        """A line about acts beyond ``MOST_ACTS``; none without any."""
        last_s = round(self.acts[-1].time_s - self.moments[0].time_s, 1) if self.acts else 0.0
        return [ActEffect((), last_s, "later acts", verdict=f"not measured: {self._more}")] if self._more else []

    def missing(self) -> list[ActEffect]:
        """What went wrong because nobody acted: events that were missed, or parts of the verdict that failed."""
        session = self._session
        if isinstance(session, Episode):
            parts = {} if session.verdict is None else session.verdict.parts
            end_s = round(session.seconds, 1)
            return [
                ActEffect((), end_s, NO_ACT, verdict=f"{name.replace('_', ' ')}: {part.why}")
                for name, part in parts.items()
                if not part.ok and name in LACKING
            ]
        assert session.judgement is not None
        events, acts, _ = judged_since(session.judgement, self.moments[0].time_s, session.seconds)
        return [
            ActEffect((), fault.time_s, NO_ACT, verdict=f"missed {fault.about}: {fault.why}")
            for fault in faults(events, acts)
            if fault.what == EventOutcome.MISSED
        ]

    def without(self, steps: Collection[int], redraws: int = REDRAWS) -> ActEffect:
        """What leaving out these acts changed.

        Raises:
            UserError: there is no such step.
        """
        last = self._session.steps[-1].number
        if not steps or not all(0 < step <= last for step in steps):
            raise UserError(f"there is no step {', '.join(map(str, steps))}; the run's steps are 1 to {last}")
        left = [act for act in self.acts if act.step in steps]
        if not left:
            return ActEffect(tuple(steps), 0.0, "commands nothing")
        begun_s = self.moments[0].time_s
        told = ActEffect(
            tuple(act.step for act in left),
            round(left[0].time_s - begun_s, 1),
            " and ".join(act.words for act in left),
            came="; ".join(filter(None, map(self._came, left))),
            glance_s=round(sum(distraction_s(act.acts, [act.text]) for act in left), 1),
        )
        both = [self._compared(left, 0)]
        if not any(_differ(name, *pair) for name, pair in both[0].items()):
            points, verdict = self._judged(left, [0])
            return replace(told, points=points, verdict=verdict)
        both += [self._compared(left, draw) for draw in range(1, redraws + 1)]
        changed: dict[str, tuple[float, float]] = {}
        chance: dict[str, tuple[float, float]] = {}
        for name in both[0]:
            pairs = [each[name] for each in both]
            if _differ(name, *pairs[0]):
                noise = max(without for _, without in pairs) - min(without for _, without in pairs)
                first, middle = pairs[0][0] - pairs[0][1], median(one - other for one, other in pairs)
                is_one = abs(middle) > max(noise, FIGURES[name][2]) and middle * first > 0
                (changed if is_one else chance)[name] = (middle if is_one else first), noise
        points, verdict = self._judged(left, range(len(both)))
        return replace(told, points=points, verdict=verdict, changed=changed, chance=chance, draws=len(both))

    def _compared(self, left: Sequence[_Act], draw: int) -> dict[str, tuple[float, float]]:
        """Every figure, with the acts and without them."""
        is_drive = isinstance(self._session, DriveSession)
        both = [_figures(moments, is_drive=is_drive) for moments in self._both(left, draw)]
        return {name: (both[0][name], both[1][name]) for name in both[0] if name in both[1]}

    def _both(self, left: Sequence[_Act], draw: int) -> tuple[list[Moment], list[Moment]]:
        """What was driven from the fork of the first of them on, with and without them."""
        fork, gone = left[0].fork, frozenset(act.step for act in left)
        runs = []
        for without in (frozenset[int](), gone):
            key = fork.at, without, draw
            if key not in self._seen and (without or draw):
                runs.append((key, self._driving(fork, without, draw, self._until_s(left))))
        for key, moments in zip([key for key, _ in runs], _together([run for _, run in runs]), strict=True):
            self._seen[key] = moments
        until_s = self._until_s(left)
        mine = self._seen.get((fork.at, frozenset(), draw), self.moments[fork.at :])
        return [moment for moment in mine if moment.time_s <= until_s], self._seen[fork.at, gone, draw]

    def _until_s(self, left: Sequence[_Act]) -> float:
        """To the end of the trial, on a drive only for some time."""
        end_s = self.moments[-1].time_s + ROUNDING_S
        return min(end_s, left[-1].time_s + FOLLOWED_S) if isinstance(self._session, DriveSession) else end_s

    def _driving(
        self, fork: _Fork, without: frozenset[int], draw: int, until_s: float
    ) -> Iterator[list[Moment] | None]:
        """Drives on from a fork without some acts; gives None while others may go on, then the drive."""
        given: Sequence[CommandRecord] = self._session.world.cockpit.given
        gone = {id(record) for act in self.acts if act.step in without for record in act.records}
        left = list(given[fork.given :])
        with closing(fork.world.branch()) as world:
            if draw:
                seed = np.random.default_rng((self._seed, fork.at, draw)).integers(SEED_RANGE)
                world.traffic.request(Redraw(int(seed)))
            moments = [self.moments[fork.at]]
            for before, now in pairwise(self.moments[fork.at :]):
                if now.time_s > until_s or world.moment.driving.end is not None:
                    break
                while left and left[0].time_s <= before.time_s + ROUNDING_S:
                    record = left.pop(0)
                    if id(record) not in gone:
                        world.give(record)
                    else:
                        for _ in range(_draws(record)):
                            world.traffic.request(Redraw())
                tick_s = round(now.time_s - before.time_s, 6)
                world.traffic.start(min(TICK_S, tick_s))
                yield None
                moments += world.advance(tick_s)
            yield moments

    def _came(self, act: _Act) -> str:
        """What became of an act, as of those of a drive."""
        begun_s = self.moments[0].time_s
        timeline = {
            "time_s": [moment.time_s - begun_s for moment in self.moments],
            "speed_kmh": [moment.driving.speed_mps * KMH_PER_MPS for moment in self.moments],
            "limit_kmh": [limit_at(moment.context).kmh for moment in self.moments],
            "driver": [[event.time_s - begun_s, event.text] for event in driver_events(self.moments)],
        }
        told = [JudgedAct(each.time_s - begun_s, each.words, Worth.NEUTRAL) for each in act.acts]
        return "; ".join(filter(None, (came.words for came in followed(told, timeline))))

    # --- the judge ----------------------------------------------------------------------------------------

    def _judged(self, left: Sequence[_Act], draws: Collection[int]) -> tuple[float | None, str]:
        """On a drive, the points for acts in the middle of these draws, and which events came out otherwise."""
        session = self._session
        if not isinstance(session, DriveSession):
            return None, self._verdict(left, draws)
        gone = {(round(each.time_s, 3), each.words) for act in left for each in act.acts}
        kept = [act for act in session.acts if (round(act.time_s, 3), act.words) not in gone]
        found = []
        for draw in draws:
            mine, others = self._both(left, draw)
            found.append((self._watch(left[0].fork, mine, session.acts), self._watch(left[0].fork, others, kept)))
        gains = [one[0] - other[0] for one, other in found]
        assert session.judgement is not None
        worth = score(session.judgement, session.seconds).worth or LEAST_WORTH
        points = round(100 * median(gains) / (2 * worth), 1)
        if points * gains[0] <= 0:
            return 0.0, ""
        one, other = (dict(each) for _, each in found[0])
        told = []
        for kind in [kind for kind in {**one, **other} if one.get(kind) != other.get(kind)]:
            alone = "left alone" if one.get(kind) == EventOutcome.TAKEN else "not due"
            told.append(f"{kind}: {one.get(kind, 'not due')}, without it {other.get(kind, alone)}")
        return points, ", ".join(told)

    def _watch(
        self, fork: _Fork, moments: Sequence[Moment], acts: Sequence[DriveAct]
    ) -> tuple[float, Mapping[str, str]]:
        """What acts are worth on a drive that went on so from a fork, in weights of events, and what became of each
        kind of event."""
        session, tracker = self._session, deepcopy(fork.tracker)
        drive = [*self.moments[: fork.at], *moments]
        for count in range(fork.at + 2, len(drive) + 1):
            tracker.see(drive[max(0, count - BACK) : count])
        anyway = {
            (event.kind, event.subject, event.observable_s): session.due_anyway.get(number)
            for number, event in enumerate(session.events)
        }
        due = {
            number: anyway.get((event.kind, event.subject, event.observable_s))
            for number, event in enumerate(tracker.events)
        }
        done = [act for act in acts if act.time_s <= drive[-1].time_s]
        commands, untouched = session.moments[0].commands, session.untouched
        found = judge(KINDS, tracker.events, done, due, facts_of(drive), commands, untouched)
        since = drive[fork.at].time_s
        became = {
            event.kind.replace("_", " "): str(event.outcome)
            for event in found.events
            if event.ends_s >= since and (event.outcome.counts or event.outcome is EventOutcome.TAKEN)
        }
        return score(found, session.seconds).utility, became

    def _verdict(self, left: Sequence[_Act], draws: Collection[int]) -> str:
        """How the verdict of a task is another without acts, in most draws; empty if it is not."""
        if not isinstance(self._session, Episode):
            return ""
        steps = frozenset(act.step for act in left)
        found = []
        for draw in draws:
            mine, others = self._both(left, draw)
            found.append((self._parts(mine, frozenset()), self._parts(others, steps)))
        is_other = [all(one.values()) is not all(other.values()) for one, other in found]
        if not is_other[0] or 2 * sum(is_other) <= len(is_other):
            return ""
        one, other = found[0]
        parts = ", ".join(part.replace("_", " ") for part in PARTS if one[part] != other[part])
        return f"{'success' if all(one.values()) else 'no success'}, the opposite without it ({parts})"

    def _parts(self, moments: Sequence[Moment], without: frozenset[int]) -> dict[str, bool]:
        """The parts of the verdict of a task, had it gone on so without some acts."""
        episode: Episode = self._session
        end_s = episode.moments[-1].time_s + ROUNDING_S
        before = [moment for moment in self.moments if moment.time_s < moments[0].time_s - ROUNDING_S]
        trace = before + [moment for moment in moments if moment.time_s <= end_s]
        gone = {id(record) for act in self.acts if act.step in without for record in act.records}
        given = [record for record in episode.world.cockpit.given if id(record) not in gone]
        said = [
            step.action.text or ""
            for step in episode.steps
            if step.action is not None
            and step.action.action_type is ActionType.ANSWER
            and step.number not in without
        ]
        found = judged(
            episode.instance,
            trace,
            self._untouched,
            lambda: counterfactual(episode.at_hand_over, given, trace, episode.instance.half.allowed_writes),
            episode.declared,
            episode.reason,
            episode.failure,
            said,
        )
        return {name: part.ok for name, part in found.parts.items()}


class _Forking(Player):
    """Plays the recorded actions, and says before each what comes."""

    def __init__(
        self, steps: Sequence[Json], channels: frozenset[Channel], failure: str | None, forks: Forks
    ) -> None:
        super().__init__(steps, channels, failure)
        self._forks = forks

    def act(self, observation: Observation) -> Action:
        """The next recorded action."""
        action = super().act(observation)
        self._forks.foresee(action)
        return action


def _together(drives: Sequence[Iterator[list[Moment] | None]]) -> list[list[Moment]]:
    """What drives come to that go on at the same time, in their order."""
    ended: dict[int, list[Moment]] = {}
    while len(ended) < len(drives):
        for number, drive in enumerate(drives):
            if number not in ended and (moments := next(drive)) is not None:
                ended[number] = moments
                drive.close()  # type: ignore[attr-defined]
    return [ended[number] for number in range(len(drives))]


def _figures(moments: Sequence[Moment], *, is_drive: bool) -> dict[str, float]:
    """What an act may change, of a drive from a fork on; a destination that it does not reach has no figure."""
    harmed, figures = harm(moments), drive_figures(moments, moments[-1].time_s)
    found = {
        "over_s": harmed.over_limit_s,
        "over_m": figures.overspeed_m,
        "near_s": harmed.short_ttc_s,
        "nearest_s": min(FAR_S, figures.min_time_to_collision_s or FAR_S),
        "arrival_s": None if is_drive else figures.arrival_s,
        "driven_m": harmed.distance_m if is_drive else None,
        "energy_wh": figures.energy_wh,
    }
    return {name: round(value, 3) for name, value in found.items() if value is not None}


def _differ(name: str, one: float, other: float) -> bool:
    return abs(one - other) > FIGURES[name][2]


def _draws(record: CommandRecord) -> int:
    """How often the driver drew because of a command."""
    return sum(
        answer.accepted and isinstance(request, Alert | SlowDown | PullOver) for request, answer in record.answers
    )
