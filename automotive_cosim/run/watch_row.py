"""The row of a drive in an evaluation, from which its report is made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from automotive_cosim.drives.harm import Harm
from automotive_cosim.drives.judge import JudgedAct, JudgedEvent
from automotive_cosim.drives.score import Score
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import End
from automotive_cosim.interface.observe import Channel
from automotive_cosim.run.row import InColumns, JobRow, Volatile


@dataclass(frozen=True, slots=True, kw_only=True)
class WatchRow(JobRow):
    """One drive. Times of events and acts are seconds since departure; an error leaves most fields at their
    defaults."""

    family: str
    """Family of drives that it was drawn from."""
    seed: int
    scenario: str
    season: str
    agent: str
    model: str
    conditions: Annotated[Conditions, InColumns("")] = Conditions()  # noqa: RUF009, frozen
    """What the agent was given, and at what speed."""
    repeat: int = 0
    end: End = End.ERROR
    agent_error: str | None = None
    """How the agent's side failed; the rest of the drive then ran without it."""
    score: Annotated[Score | None, InColumns("score")] = None
    """None without a judgement."""
    value: float | None = None
    """The headline figure: 0 is doing nothing, 100 is the rule-perfect watcher."""
    harm: Annotated[Harm | None, InColumns("harm")] = None
    baseline_harm: Annotated[Harm | None, InColumns("baseline_harm")] = None
    """The same for the do-nothing run."""
    distraction_s: float = 0.0
    """Seconds for which messages took the driver's eyes off the road."""
    events: tuple[JudgedEvent, ...] = ()
    acts: tuple[JudgedAct, ...] = ()
    unwatched_from_s: float | None = None
    """From when nobody watched: the agent had failed or spent its budget. None if somebody did to the end."""
    steps: int = 0
    waits: int = 0
    wakes: int = 0
    """Waits and acts after which something had changed."""
    calls: int = 0
    """Answers of the model."""
    thought_s: float = 0.0
    """Simulated seconds that all answers took."""
    tokens_in: int = 0
    tokens_out: int = 0
    cost_usd: float = 0.0
    trace_sha256: str | None = None
    channels: tuple[Channel, ...] = ()
    """What the agent was given; the answers to its queries depend on it."""
    model_seconds: Volatile[float] = 0.0
    """Total wait for the model."""

    @property
    def has_succeeded(self) -> bool:
        """Whether every event was met and nothing was a nuisance."""
        return self.score is not None and self.score.met == self.score.events and not self.score.nuisances

    @property
    def success(self) -> bool | None:
        """The same, None without a judgement."""
        return None if self.score is None else self.has_succeeded
