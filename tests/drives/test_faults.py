"""The list of what went wrong: as long as the losses of the score, and in order."""

from __future__ import annotations

from automotive_cosim.drives.faults import faults
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, JudgedEvent, Judgement, Worth
from automotive_cosim.drives.score import score


def test_every_loss_of_the_score_is_listed_once() -> None:
    alike = EventOutcome.AVOIDED, EventOutcome.TAKEN
    events = tuple(
        JudgedEvent("tunnel", f"a tunnel in {number} m", True, 1.0, each, 10.0 * number, None, None, 99.0)
        if each in alike
        else JudgedEvent(
            "tunnel", f"a tunnel in {number} m", False, 1.0, each, from_s, from_s + 5, from_s + 9, 99.0, 75.0
        )
        for number, each in enumerate(EventOutcome)
        for from_s in (10.0 * number,)
    )
    acts = tuple(JudgedAct(7.0 * number, f"alert {each}", each, "", "a fact") for number, each in enumerate(Worth))
    found, counted = faults(events, acts), score(Judgement(events, acts), 600.0)
    assert len(found) == counted.events - counted.met + counted.nuisances
    assert [each.time_s for each in found] == sorted(each.time_s for each in found)
    told = {each.what: each.line for each in found}
    assert (
        "0:35 late: tunnel (a tunnel in 3 m; to be known from 0:30; too late after 0:39; acted at 1:15)"
        in told["late"]
    )
    assert told["missed"].endswith("right: an alert of tunnel or visibility)")
    assert told["needless repeat"].endswith("alert repeat (a fact)")
