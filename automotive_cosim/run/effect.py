"""What leaving out an act changed: figures, verdict, events, and how much of it is chance."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from operator import attrgetter
from statistics import median

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events import KINDS, DriveAct
from automotive_cosim.drives.harm import harm
from automotive_cosim.drives.judge import BACK, EventOutcome, facts_of, judge
from automotive_cosim.drives.score import LEAST_WORTH, score
from automotive_cosim.episode.episode import Episode, counterfactual
from automotive_cosim.episode.specification import ROUNDING_S
from automotive_cosim.run.figures import drive_figures
from automotive_cosim.run.forks import ForkedAct, Forks, TrialFork
from automotive_cosim.tasking.dialogue import understood
from automotive_cosim.tasking.verdict import PARTS
from automotive_cosim.tasking.verdict import judge as judge_task

FIGURES: Mapping[str, tuple[str, str, float]] = {
    "over_s": ("above the limit", "s", 0.9),
    "over_m": ("above the limit", "m", 5.0),
    "near_s": ("near collision", "s", 0.9),
    "nearest_s": ("least time to collision", "s", 0.2),
    "unaware_s": ("of the driver's attention", "s", 0.9),
    "arrival_s": ("time to the destination", "s", 1.0),
    "driven_m": ("way driven", "m", 20.0),
    "energy_wh": ("energy", "Wh", 5.0),
    "co2_g": ("CO2", "g", 5.0),
}
"""What an act may change: its name, its unit, and up to what a difference is none."""
NO_ACT = "no act"
"""In place of an act that is missing."""
FAR_S = 20.0
"""A time to collision above it is no approach."""
FigurePairs = Mapping[str, tuple[float, float]]
"""Every figure of one draw, with the acts and without them."""


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
        if chance := ", ".join(_said(name, *found) for name, found in self.chance.items()):
            told.append(f"{'may be chance' if self.draws == 1 else 'no more than chance'}: {chance}")
        if self.glance_s:
            told.append(f"a glance of {_digits(self.glance_s)} s")
        return "; ".join(told)


def figures_of(moments: Sequence[Moment], *, is_drive: bool) -> dict[str, float]:
    """What an act may change, of a drive from a fork on; a destination that it does not reach has no figure."""
    harmed, figures = harm(moments), drive_figures(moments, moments[-1].time_s)
    found = {
        "over_s": harmed.over_limit_s,
        "over_m": figures.overspeed_m,
        "near_s": harmed.short_ttc_s,
        "nearest_s": min(FAR_S, figures.min_time_to_collision_s or FAR_S),
        "unaware_s": harmed.unaware_s if moments[0].awareness is not None else None,
        "arrival_s": None if is_drive else figures.arrival_s,
        "driven_m": harmed.distance_m if is_drive else None,
        "energy_wh": figures.energy_wh,
    }
    return {name: round(value, 3) for name, value in found.items() if value is not None}


def weighed(draws: Sequence[FigurePairs]) -> tuple[FigurePairs, FigurePairs]:
    """What acts changed, and what is no more than chance: by figure, a difference and how much draws without them
    differ among each other. The first draw is the recorded one, which alone cannot be told from chance."""
    changed: dict[str, tuple[float, float]] = {}
    chance: dict[str, tuple[float, float]] = {}
    for name, (with_, without) in draws[0].items():
        pairs, least = [each[name] for each in draws], FIGURES[name][2]
        if abs(with_ - without) <= least:
            continue
        others = [other for _, other in pairs]
        noise, first, middle = (
            max(others) - min(others),
            with_ - without,
            median(one - other for one, other in pairs),
        )
        is_one = len(draws) > 1 and abs(middle) > max(noise, least) and middle * first > 0
        (changed if is_one else chance)[name] = (middle if is_one else first), noise
    return changed, chance


def compared(forks: Forks, left: Sequence[ForkedAct], draw: int) -> FigurePairs:
    """Every figure of a draw, with acts and without them."""
    key = tuple(act.step for act in left), draw
    if key not in forks.figures:
        one, other = (figures_of(moments, is_drive=forks.is_drive) for moments in forks.both(left, draw))
        forks.figures[key] = {name: (one[name], other[name]) for name in one if name in other}
    found: FigurePairs = forks.figures[key]
    return found


def judged_without(forks: Forks, left: Sequence[ForkedAct], draws: Collection[int]) -> tuple[float | None, str]:
    """On a drive, the points that acts brought in the middle of some draws; and in words, how the verdict, or what
    became of events, would be another without them."""
    if not forks.is_drive:
        return None, _verdict(forks, left, draws)
    session, fork = forks.session, left[0].fork
    gone = {(round(each.time_s, 3), each.words) for act in left for each in act.acts}
    kept = [act for act in session.acts if (round(act.time_s, 3), act.words) not in gone]
    found = []
    for draw in draws:
        mine, others = forks.both(left, draw)
        found.append((_watched(forks, fork, mine, session.acts), _watched(forks, fork, others, kept)))
        if found[0][0][0] == found[0][1][0]:  # whatever further draws are worth
            return 0.0, ""
    gains = [one[0] - other[0] for one, other in found]
    worth = score(session.judgement, session.seconds).worth or LEAST_WORTH
    points = round(100 * median(gains) / (2 * worth), 1)
    if points * gains[0] <= 0:
        return 0.0, ""
    one, other = (each for _, each in found[0])
    told = []
    for kind in [kind for kind in {**one, **other} if one.get(kind) != other.get(kind)]:
        alone = "left alone" if one.get(kind) == EventOutcome.TAKEN else "not due"
        told.append(f"{kind}: {one.get(kind, 'not due')}, without it {other.get(kind, alone)}")
    return points, ", ".join(told)


def _watched(
    forks: Forks, fork: TrialFork, moments: Sequence[Moment], acts: Sequence[DriveAct]
) -> tuple[float, Mapping[str, str]]:
    """What acts are worth on a drive that went on so from a fork, in weights of events, and what became of each
    kind of event."""
    session, tracker = forks.session, deepcopy(fork.tracker)
    drive = [*forks.moments[: fork.at], *moments]
    for count in range(fork.at + 2, len(drive) + 1):
        tracker.see(drive[max(0, count - BACK) : count])
    key = attrgetter("kind", "subject", "observable_s")
    anyway = {key(event): session.due_anyway.get(number) for number, event in enumerate(session.events)}
    due = {number: anyway.get(key(event)) for number, event in enumerate(tracker.events)}
    done = [act for act in acts if act.time_s <= drive[-1].time_s]
    commands, untouched = session.moments[0].commands, session.untouched
    order = session.setup.conditions.order
    found = judge(KINDS, tracker.events, done, due, facts_of(drive), commands, untouched, order=order)
    since = drive[fork.at].time_s
    became = {
        event.kind.replace("_", " "): str(event.outcome)
        for event in found.events
        if event.ends_s >= since and (event.outcome.counts or event.outcome is EventOutcome.TAKEN)
    }
    return score(found, session.seconds).utility, became


def _verdict(forks: Forks, left: Sequence[ForkedAct], draws: Collection[int]) -> str:
    """How the verdict of a task is another without acts, in most draws; empty if it is not."""
    steps = frozenset(act.step for act in left)
    found = []
    is_other: list[bool] = []
    for draw in draws:
        mine, others = forks.both(left, draw)
        recorded = forks.session.verdict.parts.items()
        with_them = _parts(forks, mine, frozenset()) if draw else {name: part.ok for name, part in recorded}
        found.append((with_them, _parts(forks, others, steps)))
        one, other = found[-1]
        is_other.append(all(one.values()) is not all(other.values()))
        if not is_other[0]:  # whatever further draws say
            return ""
    if 2 * sum(is_other) <= len(is_other):
        return ""
    one, other = found[0]
    parts = ", ".join(part.replace("_", " ") for part in PARTS if one[part] != other[part])
    return f"{'success' if all(one.values()) else 'no success'}, the opposite without it ({parts})"


def _parts(forks: Forks, moments: Sequence[Moment], without: frozenset[int]) -> dict[str, bool]:
    """The parts of the verdict of a task, had it gone on so without some acts."""
    episode: Episode = forks.session
    end_s = episode.moments[-1].time_s + ROUNDING_S
    before = [moment for moment in forks.moments if moment.time_s < moments[0].time_s - ROUNDING_S]
    trace = before + [moment for moment in moments if moment.time_s <= end_s]
    gone = forks.commands(without)
    given = [record for record in episode.world.cockpit.given if id(record) not in gone]
    said = [text for step in episode.steps if step.number not in without for text in understood(step)]
    found = judge_task(
        episode.instance,
        trace,
        forks.untouched,
        lambda: counterfactual(episode.at_hand_over, given, trace, episode.instance.half.allowed_writes),
        episode.declared,
        episode.reason,
        episode.failure,
        said,
    )
    return {name: part.ok for name, part in found.parts.items()}


def _said(name: str, difference: float, noise: float) -> str:
    what, unit, _ = FIGURES[name]
    beside = f" (draws differ by {_digits(noise)})" if noise >= 0.05 else ""
    return f"{_digits(difference, '+')} {unit} {what}{beside}".replace("-", "−")


def _digits(value: float, sign: str = "") -> str:
    return f"{value:{sign}.{0 if abs(value) >= 9.95 else 1}f}"
