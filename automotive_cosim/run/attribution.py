"""Which act did it: what each act of a stored trial changed, measured by leaving it out."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import asdict, replace
from itertools import combinations
from pathlib import Path

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.drives.driver import driver_events
from automotive_cosim.drives.faults import faults
from automotive_cosim.drives.followed import followed
from automotive_cosim.drives.harm import distraction_s
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, Worth
from automotive_cosim.drives.result import judged_since
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.run.effect import NO_ACT, ActEffect, compared, judged_without, weighed
from automotive_cosim.run.forks import ForkedAct, Forks, forked
from automotive_cosim.run.job_row import from_json
from automotive_cosim.run.rerun import recorded
from automotive_cosim.run.trial_folder import is_trial
from automotive_cosim.traffic.fork import Simulations

FILE = "attribution.json"
NOT_MEASURED = "not measured"
LATE_ACT = "an act too late"
LACKING = frozenset({"goal", "in_time", "declared"})
"""The parts of a verdict that fail for want of an act."""
REDRAWS, LEAST_REDRAWS = 4, 2
"""Further draws of both, with and without, where leaving an act out changed anything on the road; as many as the
fewer where it is no more than chance."""
DRIVEN, LEAST_REDRAWN = 11.0, 4.0
"""How much is driven in all, as a multiple of the trial, so that twelve acts cost three times it; and what
redraws and pairs may take even of many acts."""
PAIRED = 3.0
"""How much of it pairs take at most; there are none unless all acts that change nothing alone do so together in a
redraw, too."""
TOGETHER_S, MOST_PAIRS = 60.0, 15
"""Two acts that change nothing alone are left out together if they are no farther apart; the nearest first."""


def attribute(
    folder: Path, trial: str = "", only: Collection[int] | None = None, *, simulations: Simulations | None = None
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
        InfrastructureError: the simulation failed, or does not repeat the trial."""
    stored = recorded(folder, trial)
    with ExitStack() as ends, forked(stored, simulations or ends.enter_context(closing(Simulations()))) as forks:
        if only is not None:
            return [without(forks, only)]
        found = [*effects(forks), *_missing(forks)]
    path = path_of(folder, stored.job.id)
    make_folder(path.parent)
    write_whole(path, json.dumps({"acts": [asdict(each) for each in found]}, indent=1) + "\n")
    return found


def path_of(folder: Path, trial: str = "") -> Path:
    """Where the effects of a trial's acts are kept: in its folder, or that of its evaluation."""
    return folder / FILE if is_trial(folder) else folder / "attribution" / f"{trial}.json"


def read_effects(path: Path) -> list[ActEffect]:
    """The effects of a trial's acts; none if they were not measured. Raises UserError: they cannot be read."""
    if not path.is_file():
        return []
    try:
        return [from_json(ActEffect, each) for each in read_json(path)["acts"]]
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise UserError(f"{path} holds no effects of acts; `automotive-cosim attribute` measures them") from error


def sentence(effects: Sequence[ActEffect]) -> str:
    """What was found, in a sentence: of the acts, those that changed the verdict or the road."""
    acts, failed = [each for each in effects if each.steps], culprit(effects)
    beside = f" What made it fail: {failed}." if failed else ""
    routes = [each for each in effects if each.act not in (NO_ACT, LATE_ACT)]
    if routes and not acts:
        count = sum(not each.is_neutral for each in routes)
        of = counted(len(routes), "route beside the kept one", "routes beside the kept ones")
        return f"{count} of {of}, each driven from the same traffic, changed more than chance does."
    if not acts:
        return f"The agent commanded nothing: what happened is the do-nothing run.{beside}"
    changed = [each for each in acts if not each.is_neutral]
    steps = ", ".join(" and ".join(map(str, each.steps)) for each in changed)
    count = len({step for each in acts for step in each.steps})
    of = f"of {counted(count, 'act')}, each left out of the same traffic"
    if not changed:
        return f"None {of}, changed the verdict or the road.{beside}"
    return f"{len(changed)} {of}, changed the verdict or the road: step {steps}.{beside}"


def culprit(effects: Sequence[ActEffect], kinds: Collection[str] = ()) -> str:
    """The act, or the missing act, that made a trial fail, in words; empty if none is known.

    Args:
        kinds: of a drive, kinds of events; what became of others is told only if nothing of these is known."""
    found = [each for each in effects if each.verdict.startswith("no success") or (each.points or 0.0) < 0]
    lacking = [each for each in effects if each.act in (NO_ACT, LATE_ACT)]
    named = [
        each for each in lacking if any(f" {kind.replace('_', ' ')}: " in f" {each.verdict}" for kind in kinds)
    ]
    return "; ".join(
        f"{each.act} at {clock(each.at_s)} ({each.verdict or each.effect})"
        for each in (*(named or lacking), *found)
    )


def effects(forks: Forks) -> list[ActEffect]:
    """What each act changed, and of those that changed nothing, each pair that did, no act in two of them."""
    length_s = forks.moments[-1].time_s - forks.moments[0].time_s
    left_s = DRIVEN * length_s - sum(forks.length_s([act]) for act in forks.acts)
    found, left_s = _redrawn(forks, [[act] for act in forks.acts], max(left_s, LEAST_REDRAWN * length_s))
    idle = [act for act, effect in zip(forks.acts, found, strict=True) if effect.is_neutral]
    if len(idle) < 2 or left_s <= 0:
        return found
    (together,), _ = _redrawn(forks, [idle], min(left_s, length_s))
    if together.is_neutral:
        return found
    left_s = min(left_s, PAIRED * length_s)
    near = [pair for pair in combinations(idle, 2) if pair[1].time_s - pair[0].time_s <= TOGETHER_S]
    near.sort(key=lambda pair: (pair[1].time_s - pair[0].time_s, pair[0].time_s))
    told = set[int]()
    for pair in near[:MOST_PAIRS]:
        if left_s > 0 and not told & {act.step for act in pair}:
            (effect,), left_s = _redrawn(forks, [pair], left_s - forks.length_s(pair))
            if not effect.is_neutral:
                told |= set(effect.steps)
                found.append(effect)
    return found


def _moves(forks: Forks, left: Sequence[ForkedAct], draws: int) -> bool:
    """Whether further draws than these are wanted."""
    changed, chance = weighed([compared(forks, left, draw) for draw in range(draws + 1)])
    return bool(changed or (chance and draws < LEAST_REDRAWS))


def _redrawn(forks: Forks, several: Sequence[Sequence[ForkedAct]], left_s: float) -> tuple[list[ActEffect], float]:
    """What leaving each of several out changed, and how long may be driven yet: what changed the road is redrawn up
    to ``REDRAWS`` times, all of them once before any a second time."""
    forks.drive(several, 0)
    draws = {number: 0 for number, left in enumerate(several) if _moves(forks, left, 0)}
    for draw in range(1, REDRAWS + 1):
        for number, drawn in draws.items():
            takes_s = 2 * forks.length_s(several[number])
            if drawn == draw - 1 and takes_s <= left_s and _moves(forks, several[number], drawn):
                draws[number] = draw
                left_s -= takes_s
        forks.drive([several[number] for number, drawn in draws.items() if drawn == draw], draw)
    steps = [[act.step for act in left] for left in several]
    return [without(forks, some, draws.get(number, 0)) for number, some in enumerate(steps)], left_s


def without(forks: Forks, steps: Collection[int], redraws: int = REDRAWS) -> ActEffect:
    """What leaving out these acts changed. Raises UserError: there is no such step."""
    last = forks.session.steps[-1].number
    if not steps or not all(0 < step <= last for step in steps):
        raise UserError(f"there is no step {', '.join(map(str, steps))}; the run's steps are 1 to {last}")
    left = [act for act in forks.acts if act.step in steps]
    if not left:
        return ActEffect(tuple(steps), 0.0, "commands nothing")
    told = ActEffect(
        tuple(act.step for act in left),
        round(left[0].time_s - forks.moments[0].time_s, 1),
        " and ".join(act.words for act in left),
        came="; ".join(_came(forks, left)),
        glance_s=round(
            sum(distraction_s(act.acts, [each.said or each.text for each in act.acts]) for act in left), 1
        ),
    )
    draws = [compared(forks, left, 0)]
    if any(weighed(draws)):
        draws += [compared(forks, left, draw) for draw in range(1, redraws + 1)]
    changed, chance = weighed(draws)
    points, verdict = judged_without(forks, left, range(len(draws)))
    return replace(told, points=points, verdict=verdict, changed=changed, chance=chance, draws=len(draws))


def _came(forks: Forks, left: Sequence[ForkedAct]) -> Iterator[str]:
    """What became of each act, as of those of a drive."""
    begun_s = forks.moments[0].time_s
    timeline = {
        "time_s": [moment.time_s - begun_s for moment in forks.moments],
        "speed_kmh": [moment.driving.speed_mps * KMH_PER_MPS for moment in forks.moments],
        "limit_kmh": [limit_at(moment.context).kmh for moment in forks.moments],
        "driver": [[event.time_s - begun_s, event.text] for event in driver_events(forks.moments)],
    }
    told = [JudgedAct(each.time_s - begun_s, each.words, Worth.NEUTRAL) for act in left for each in act.acts]
    return (came.words for came in followed(told, timeline))


def _missing(forks: Forks) -> Iterator[ActEffect]:
    """The acts that are too many to be measured, and what went wrong because nobody acted: events that were missed,
    or parts of the verdict that failed."""
    session = forks.session
    if forks.more:
        last_s = round(forks.acts[-1].time_s - forks.moments[0].time_s, 1)
        yield ActEffect((), last_s, "later acts", verdict=f"not measured: {forks.more}")
    if forks.is_drive:
        events, acts, _ = judged_since(session.judgement, forks.moments[0].time_s, session.seconds)
        for fault in faults(events, acts):
            if fault.what in (EventOutcome.MISSED, EventOutcome.LATE):
                act = NO_ACT if fault.what == EventOutcome.MISSED else LATE_ACT
                yield ActEffect((), fault.time_s, act, verdict=f"{fault.what} {fault.about}: {fault.why}")
    elif session.verdict is not None:
        for name, part in session.verdict.parts.items():
            if not part.ok and name in LACKING:
                verdict = f"{name.replace('_', ' ')}: {part.why}"
                yield ActEffect((), round(session.seconds, 1), NO_ACT, verdict=verdict)
