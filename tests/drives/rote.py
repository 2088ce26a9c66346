"""The agent that gives one alert by rote."""

from collections import Counter
from collections.abc import Mapping

from automotive_cosim.contracts import AlertKind
from automotive_cosim.drives.events.base import EventKind
from automotive_cosim.drives.judge import Judgement


def most_frequent(judgement: Judgement, kinds: Mapping[str, EventKind]) -> AlertKind | None:
    """The kind of alert that would have settled most of the events; None without events."""
    due = (event for event in judgement.events if event.outcome.counts)
    counts = Counter(alert for event in due for alert in sorted(kinds[event.kind].alerts))
    return max(counts, key=counts.__getitem__, default=None)
