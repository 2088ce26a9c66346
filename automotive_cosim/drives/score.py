"""The score of one drive, and of many.

    U = sum of weight x credit over the events - cost of the nuisances
    score = 100 (U - U_noop) / (U_perfect - U_noop)

Doing nothing misses every event (credit -1), a rule-perfect watcher meets each at once (credit 1) and does nothing
else; both are taken over the events that arose on the agent's own drive, since it diverges from any other after the
first act, and over those that would have arisen had the agent not held the car back for no reason. Doing nothing is
0, on a drive without events too, where nothing can be gained.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from automotive_cosim.drives.judge import EventOutcome, JudgedAct, Judgement, Worth

HARM_PER_S = 1.0
"""Cost of each second near a collision that the do-nothing drive does not have, where attention is limited: our
choice, as much as missing a usual event."""
STOP_PER_MIN = 1.0
"""Cost of each minute for which a car is held back for no reason, besides that of a nuisance."""
LEAST_WORTH = 8.0
"""Scale of a drive without events: what the events of a usual drive weigh together."""


@dataclass(frozen=True, slots=True)
class Score:
    """The score of one drive, or of several together."""

    drives: int
    driven_s: float
    events: int
    """Events in which something had to be done."""
    hits: int
    prepared: int
    prevented: int
    late: int
    missed: int
    caused: int
    evaded: int
    void: int
    lookalikes: int
    lookalikes_taken: int
    acts: int
    false_alarms: int
    nuisances: int
    """False alarms and repeats."""
    cost: float
    """What nuisances and harm cost, without the time for which the car was held back."""
    held_s: float
    """For how long the car was held back for no reason."""
    gained: float
    """Sum of weight x credit, without nuisances."""
    worth: float
    """Sum of the weights of the events that count."""
    delays_s: tuple[float, ...]
    """From the instant at which an event could be known to the act, of those that were met."""
    delays_due_s: tuple[float, ...]
    """From the obligation to the act, of those met after it."""

    @property
    def met(self) -> int:
        """Events that were met in time."""
        return self.hits + self.prepared + self.prevented

    @property
    def recall(self) -> float | None:
        """Share of the events that were met in time; None without events."""
        return self.met / self.events if self.events else None

    @property
    def precision(self) -> float | None:
        """Share of what told or did something that was not a nuisance; None if nothing was."""
        told = self.met + self.late + self.nuisances
        return self.met / told if told else None

    @property
    def false_alarms_per_h(self) -> float:
        """False alarms per driving hour."""
        return _per_h(self.false_alarms, self.driven_s)

    @property
    def nuisances_per_h(self) -> float:
        return _per_h(self.nuisances, self.driven_s)

    @property
    def median_delay_s(self) -> float | None:
        """Median of ``delays_s``."""
        return median(self.delays_s) if self.delays_s else None

    @property
    def median_due_s(self) -> float | None:
        """Median of ``delays_due_s``."""
        return median(self.delays_due_s) if self.delays_due_s else None

    @property
    def utility(self) -> float:
        """What it is worth more than doing nothing, in weights of events; twice ``worth`` at best."""
        return self.gained + self.worth - self.cost - STOP_PER_MIN * self.held_s / 60

    @property
    def value(self) -> float:
        """0 is doing nothing, 100 the rule-perfect watcher."""
        scale = self.worth or LEAST_WORTH * self.drives
        return 100 * self.utility / (2 * scale)


def score(judgement: Judgement, driven_s: float, harmed_s: float = 0.0) -> Score:
    """The score of one judged drive.

    Args:
        judgement: its events and acts.
        driven_s: how long it lasted.
        harmed_s: for how much longer than the do-nothing drive it was near a collision, where attention is limited.
    """
    events, acts = judgement.events, judgement.acts
    counts = Counter(event.outcome for event in events)
    met = [event for event in events if event.outcome.is_credited]
    return Score(
        drives=1,
        driven_s=driven_s,
        events=sum(event.outcome.counts for event in events),
        hits=counts[EventOutcome.HIT],
        prepared=counts[EventOutcome.PREPARED],
        prevented=counts[EventOutcome.PREVENTED],
        late=counts[EventOutcome.LATE],
        missed=counts[EventOutcome.MISSED],
        caused=counts[EventOutcome.CAUSED],
        evaded=counts[EventOutcome.EVADED],
        void=counts[EventOutcome.VOID],
        lookalikes=sum(event.lookalike for event in events),
        lookalikes_taken=counts[EventOutcome.TAKEN],
        acts=sum(act.worth is not Worth.NEUTRAL for act in acts),
        false_alarms=sum(act.worth.is_false for act in acts),
        nuisances=sum(act.worth.is_nuisance for act in acts),
        cost=sum(act.cost for act in acts) + HARM_PER_S * harmed_s,
        held_s=held_s(acts),
        gained=sum(event.weight * event.credit for event in events),
        worth=sum(event.weight for event in events if event.outcome.counts),
        delays_s=tuple(event.delay_s for event in met if event.delay_s is not None),
        delays_due_s=tuple(
            event.acted_s - event.obliged_s
            for event in met
            if event.outcome is EventOutcome.HIT and event.acted_s is not None and event.obliged_s is not None
        ),
    )


def held_s(acts: Sequence[JudgedAct]) -> float:
    """For how long acts held the car back for no reason; of two at a time, one counts."""
    total, until_s = 0.0, 0.0
    for act in acts:
        if act.holds_s:
            total += act.time_s + act.holds_s - max(act.time_s, until_s)
            until_s = act.time_s + act.holds_s
    return total


def together(scores: Sequence[Score]) -> Score:
    """Several drives as one: every count and every second added up."""
    total = {
        name: sum(getattr(each, name) for each in scores)
        for name in Score.__dataclass_fields__
        if not name.startswith("delays")
    }
    return Score(
        **total,
        delays_s=tuple(delay for each in scores for delay in each.delays_s),
        delays_due_s=tuple(delay for each in scores for delay in each.delays_due_s),
    )


def _per_h(count: int, seconds: float) -> float:
    return 3600 * count / seconds if seconds > 0 else 0.0
