"""What came of a drive that is over; times of events and acts are seconds since departure."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cosim.exposed import states_of, stretches
from automotive_cosim.drives.harm import distraction_s
from automotive_cosim.drives.judge import JudgedAct, JudgedEvent, Judgement
from automotive_cosim.drives.score import Score, score
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.measures.exposure import exposure
from automotive_cosim.measures.following import following_figures


def figures(session: DriveSession) -> dict[str, Any]:
    """The figures of a session that is over, by the names that they have in a row."""
    judgement = session.judgement
    assert judgement is not None
    events, acts, found = judged_since(judgement, session.moments[0].time_s, session.seconds, session.harmed_s)
    mine, baseline = session.harms
    texts = [str(step.action.text) for step in session.steps if step.action is not None and step.action.text]
    return {
        "agent_error": session.failure,
        "score": found,
        "value": found.value,
        "harm": mine,
        "baseline_harm": baseline,
        "distraction_s": distraction_s(session.acts, texts),
        "events": events,
        "acts": acts,
        "breaches": session.breaches,
        "unwatched_from_s": session.unwatched_from_s,
        "steps": len(session.steps) - 1,
        "malformed": len(session.malformed),
        "malformed_why": next(iter(session.malformed), ""),
        "waits": session.waits,
        "wakes": session.wakes,
        "trace_sha256": session.trace_sha256,
        "measures": following_figures(states_of(session.moments)),
        "exposure": exposure(stretches(session.moments)),
    }


def judged_since(
    judgement: Judgement, begun_s: float, seconds: float, harmed_s: float = 0.0
) -> tuple[tuple[JudgedEvent, ...], tuple[JudgedAct, ...], Score]:
    """Events and acts with times since departure, and the score of the drive."""
    events = tuple(_since(event, begun_s) for event in judgement.events)
    acts = tuple(replace(act, time_s=round(act.time_s - begun_s, 3)) for act in judgement.acts)
    return events, acts, score(judgement, seconds, harmed_s)


def _since(event: JudgedEvent, begun_s: float) -> JudgedEvent:
    """The event with times since departure."""

    def since(time_s: float | None) -> float | None:
        return None if time_s is None else round(time_s - begun_s, 3)

    return replace(
        event,
        observable_s=round(event.observable_s - begun_s, 3),
        obliged_s=since(event.obliged_s),
        deadline_s=since(event.deadline_s),
        ends_s=round(event.ends_s - begun_s, 3),
        acted_s=since(event.acted_s),
    )
