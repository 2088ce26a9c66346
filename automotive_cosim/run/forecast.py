"""What a plan will cost before it runs: wall time, tokens and money, each as a range.

Times and tokens come from the plan's own folder once a contestant has a few trials there; before that from figures
measured with the stand-in, whose prompts are those that a model gets.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import PromptLength, See
from automotive_cosim.episode.own_prompt import instructions
from automotive_cosim.models.base import CHARACTERS_PER_TOKEN
from automotive_cosim.models.remote import Settings
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.rows import TrialRow
from automotive_cosim.run.settings import Budget
from automotive_cosim.run.trial import TrialSetup, warm_up_s

KNOWN_FROM = 3
"""Trials of a contestant from which its own figures are taken."""
GRID_EPISODE_S, EPISODE_S, DRIVE_S = 0.5, 2.0, 20.0
"""Seconds of one worker on an idle machine, without the model's answers."""
TIME_WITHIN = 2.0
"""The time is told within this factor: machines differ by as much."""
LEAST, MOST = 0.5, 2.0
"""Models need half to twice as many tokens as the stand-in: some answer at length, some give up early."""
LEAST_KNOWN, MOST_KNOWN = 0.8, 1.25
"""The same where the contestant's own trials are known."""


@dataclass(frozen=True, slots=True)
class Tokens:
    """Tokens of one trial."""

    sent: float
    received: float


A_STEP: Mapping[str, Tokens] = {"t3a": Tokens(1450, 100), "m3a": Tokens(1450, 100), "asurada": Tokens(1950, 100)}
"""Text of one step with its reflection, as the built-in agents send it to the stand-in (40 tasks, grid, November
2026). Its answers are shorter than a model's, which gives reasons; 100 tokens are our estimate."""
BY_PROMPT: Mapping[PromptLength, float] = {PromptLength.STANDARD: 1.0, PromptLength.SHORT: 0.75}
"""What another prompt makes of that (nine tasks on grid: T3A's turns have 910 and 1,250 tokens)."""
LONGEST = 1.5
"""The longest question of a trial, of that."""
OTHER_STEP = Tokens(3000, 150)
"""The same for other agents, whose prompts are longer."""
DRIVE_STEPS, DRIVE_SHARE = 85, 1.5
"""Steps of a drive (81 and 91 with ASURADA on two families), whose prompt is longer by that factor."""
PICTURE = 1250
"""Tokens of a screenshot of 1280x720 (Anthropic counts width times height by 750; others count 750 to 1,500)."""
PICTURED: Mapping[str, int] = {"m3a": 2, "asurada": 2}
"""Pictures a step: the plain and the marked one. Agents of others send one."""


@dataclass(frozen=True, slots=True)
class Range:
    """From the least to the most that is likely."""

    low: float
    high: float

    def __add__(self, other: Range) -> Range:
        return Range(self.low + other.low, self.high + other.high)


@dataclass(frozen=True, slots=True)
class CostForecast:
    """What a plan will take."""

    runs: int
    """Trials that are still to run."""
    wall_s: Range
    """With the given workers, without the seconds that models take to answer."""
    tokens: Range
    """To and from the models."""
    usd: Range
    """At the prices in the models' names."""
    asks_models: bool
    """Whether models are asked that take time of their own."""

    def as_json(self) -> Json:
        return asdict(self)

    def beyond(self, budget: Budget) -> str:
        """What to fix if a budget will not last, or may not; empty if it will."""
        for form, limit, need in (
            ("{:,.0f} tokens", budget.tokens, self.tokens),
            ("${:,.2f}", budget.usd, self.usd),
        ):
            if limit is not None and need.high > limit:
                less = "is" if need.low > limit else "may be"
                given, low, high = map(form.format, (limit, need.low, need.high))
                return f"the budget of {given} {less} less than it will take: {low} to {high}"
        return ""


def forecast(jobs: Sequence[TrialSetup], workers: int, rows: Iterable[TrialRow] = ()) -> CostForecast:
    """What the jobs that have not run yet will take.

    Args:
        rows: the trials in the plan's folder so far."""
    judged = [row for row in rows if row.error is None]
    done = {row.id for row in judged}
    left = [job for job in jobs if job.id not in done]
    own = _own(judged)
    wall_s = sum(_seconds(job) for job in left)
    warm = {job.simulation for job in left}
    wall_s += sum(warm_up_s(place) for place, _ in warm)
    wall_s /= max(1, min(workers, len(warm)))
    tokens = usd = Range(0.0, 0.0)
    for job in left:
        if asks(job.model):
            sent, received = _tokens(job, own)
            tokens += Range(sent.low + received.low, sent.high + received.high)
            usd += _usd(job.model, sent, received)
    return CostForecast(
        len(left),
        Range(wall_s / TIME_WITHIN, wall_s * TIME_WITHIN),
        tokens,
        usd,
        any(asks(job.model) for job in left),
    )


def asks(model: str) -> bool:
    """Whether a model is asked at an endpoint; the stand-in and recordings cost nothing."""
    return not model.startswith(("rules", "none", "replay/"))


def _seconds(job: TrialSetup) -> float:
    if isinstance(job, DriveSetup):
        return DRIVE_S
    return GRID_EPISODE_S if job.in_scenario == "grid" else EPISODE_S


def _own(rows: Iterable[TrialRow]) -> dict[Hashable, Tokens]:
    """The mean tokens of a trial, by agent, model and kind of trial, where enough are known."""
    found: dict[Hashable, list[TrialRow]] = defaultdict(list)
    for row in rows:
        found[row.agent, row.model, type(row)].append(row)
    return {
        key: Tokens(sum(row.tokens_in for row in each) / len(each), sum(row.tokens_out for row in each) / len(each))
        for key, each in found.items()
        if len(each) >= KNOWN_FROM
    }


def pictures_of(job: TrialSetup) -> int:
    """How many pictures a step's question has, if the model sees any."""
    is_withheld = job.conditions.see in (See.TREE, See.NOTHING)
    return 0 if is_withheld else PICTURED.get(job.agent, int(job.agent not in A_STEP))


def _tokens(job: TrialSetup, own: Mapping[Hashable, Tokens]) -> tuple[Range, Range]:
    """What is sent and received in a trial."""
    known = own.get((job.agent, job.model, type(job.planned())))
    low, high = (LEAST, MOST) if known is None else (LEAST_KNOWN, MOST_KNOWN)
    known = known or expected(job)
    return Range(low * known.sent, high * known.sent), Range(low * known.received, high * known.received)


def expected(job: TrialSetup) -> Tokens:
    """The tokens of a trial before anything is known, with the steps of the reference solution or of a drive."""
    step = A_STEP.get(job.agent, OTHER_STEP)
    sent = _sent(job)
    if isinstance(job, EpisodeSetup):
        steps, text = 1 + len(job.entry.half(job.half).moves), sent
    else:
        steps, text = DRIVE_STEPS, DRIVE_SHARE * sent
    pictures = pictures_of(job)
    return Tokens(steps * (text + pictures * PICTURE), steps * step.received)


def longest_question(job: TrialSetup) -> int:
    """Tokens of the longest question in a trial, without its pictures and functions."""
    sent = _sent(job)
    return round(LONGEST * (DRIVE_SHARE * sent if isinstance(job, DriveSetup) else sent))


def _sent(job: TrialSetup) -> float:
    """Tokens of text that a step of a task sends."""
    agent, prompt = job.agent, job.conditions.prompt
    if agent not in A_STEP:
        return OTHER_STEP.sent
    return A_STEP[agent].sent * BY_PROMPT[prompt.length] + len(instructions(prompt)) / CHARACTERS_PER_TOKEN


def _usd(model: str, sent: Range, received: Range) -> Range:
    """The price of tokens; cached ones are counted at full price."""
    prices = Settings.read(model.partition("?")[2])
    per_sent, per_received = prices.usd_per_million_in / 1e6, prices.usd_per_million_out / 1e6
    return Range(
        sent.low * per_sent + received.low * per_received, sent.high * per_sent + received.high * per_received
    )
