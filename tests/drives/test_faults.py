"""The list of what went wrong: as long as the losses of the score, and in order."""

import pytest

from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.faults import became, faults, key_of, was
from automotive_cosim.drives.followed import NOT_ASKED, followed, told
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
        "0:35 late: tunnel (a tunnel in 3 m; to be known from 0:30; due from 0:35 to 0:39; acted at 1:15, "
        "36 s too late)" in told["late"]
    )
    assert told["missed"].endswith("right: an alert of tunnel or visibility)")
    assert told["needless repeat"].endswith("alert repeat (a fact)")


def missed(observable_s: float = 10.0, due_s: float = 100.0) -> JudgedEvent:
    return JudgedEvent(
        "tunnel", "a tunnel", False, 1.0, EventOutcome.MISSED, observable_s, due_s, due_s + 9, due_s + 20
    )


@pytest.mark.parametrize(
    ("warned_s", "observable_s", "came"),
    [
        (29.0, 10.0, "warned 71 s before, too early (a warning holds for 60 s)"),
        (29.0, 80.0, "warned 71 s before, too early (before it could be known)"),
        (150.0, 10.0, "warned 41 s after the deadline"),
        (900.0, 10.0, "nothing came"),
    ],
)
def test_what_was_missed_says_what_came(warned_s: float, observable_s: float, came: str) -> None:
    event, act = missed(observable_s), JudgedAct(warned_s, "alert tunnel, 30 km/h", Worth.NEUTRAL)
    (fault,) = faults([event], [act])
    assert f"due from 1:40 to 1:49; {came}; right: an alert of" in fault.line
    assert became(event, [act]) == f"missed; due from 1:40 to 1:49; {came}"


def test_a_warning_of_something_else_is_not_told_of_what_was_missed() -> None:
    assert became(missed(), [JudgedAct(99.0, "alert seat_belt", Worth.NEUTRAL, "belt")]).endswith("nothing came")


def test_a_false_alarm_says_when_it_would_have_been_right_and_what_was_due() -> None:
    act = JudgedAct(52.0, "alert tunnel", Worth.WRONG, "", "no tunnel is ahead")
    belt = JudgedEvent("belt", "open", False, 1.0, EventOutcome.HIT, 40.0, 45.0, 60.0, 70.0, 55.0)
    assert was(act, [belt, missed(80.0)]) == (
        "wrong: no tunnel is ahead; 28 s before tunnel could be known, at 1:20; due was belt, from 0:45"
    )


def test_the_words_of_outcomes_are_explained_where_they_occur() -> None:
    void = JudgedEvent("tunnel", "a tunnel", False, 1.0, EventOutcome.VOID, 1.0, None, None, 9.0)
    assert key_of((void, missed(), void)).startswith("void, nothing was due (it needed no act, passed by itself")
    assert key_of((missed(),)) == ""


def test_a_wet_road_is_no_contradiction_of_what_slippery_means() -> None:
    assert "not while it is only wet" in KINDS["slippery"].about


def test_a_word_beside_a_bar_is_left_out_where_another_bar_of_its_kind_is_in_the_way() -> None:
    from automotive_cosim.report.drivechart import _is_free

    before, last = missed(40.0, 70.0), missed(560.0, 570.0)
    assert _is_free(last, False, (before, last), 600.0)
    near = missed(500.0, 530.0)
    assert not _is_free(last, False, (before, near, last), 600.0)
    assert _is_free(before, True, (before, near, last), 600.0)


KINDS_OF_ANSWERS = [
    ("alert speed", "driver slows to 50 km/h, 1.2 s after the alert", "obeyed", 1.2),
    ("alert vehicle, critical", "driver looks for a place to stop, 1.2 s after the alert", "obeyed", 1.2),
    ("SlowDown", "driver slows to 50 km/h, 1.2 s after the request", "obeyed", 1.2),
    ("alert vehicle", "driver takes note of the vehicle alert, 1.2 s after the alert", "heard", 1.2),
    ("alert yield", "driver cannot give way: no kerb, 1.2 s after the alert", "heard", 1.2),
    ("alert speed", "driver hears the speed alert but does not react", "ignored", 1.2),
    ("SlowDown", "driver hears the request but does not react", "ignored", 1.2),
    ("alert speed", "driver hears the belt alert but does not react", "unanswered", None),
    ("alert speed", "driver slows to 50 km/h, 9.0 s after the alert", "unanswered", None),
    ("alert speed", "driver drives as before; what was advised has ended", "unanswered", None),
    ("wipers are ON", "driver slows to 50 km/h, 1.2 s after the alert", "", None),
]


@pytest.mark.parametrize(("words", "answer", "kind", "after_s"), KINDS_OF_ANSWERS)
@pytest.mark.parametrize("worth", Worth)
def test_an_act_in_time_whose_driver_goes_on_speeding_is_told_so(
    words: str, answer: str, kind: str, after_s: float | None, worth: Worth
) -> None:
    seconds = [float(second) for second in range(200)]
    timeline = {
        "time_s": seconds,
        "speed_kmh": [81.0 if second < 86 else 49.0 for second in seconds],
        "limit_kmh": [50.0] * 200,
        "driver": [[11.2, answer]],
    }
    act = JudgedAct(10.0, words, worth)
    (came,) = followed([act], timeline)
    assert (came.answer, came.answered_s) == (kind, after_s)
    assert (came.before_kmh, came.after_kmh, came.over_s) == (81.0, 81.0, 75.0)
    (line,) = told([act], [], timeline)
    assert line.startswith(str(worth))
    assert "75 s above the limit" in line
    assert (NOT_ASKED in line) is not kind
    assert told([act], [], {}) == [was(act, [])]


def test_each_of_several_acts_gets_its_own_answer() -> None:
    acts = [JudgedAct(10.0 * number, "alert speed", Worth.RIGHT) for number in range(1, 5)]
    answers = [
        [11.5, "driver hears the speed alert but does not react"],
        [22.0, "driver holds, 2.0 s after the alert"],
        [22.0, "driver keeps 2 s behind, 2.0 s after the alert"],
        [41.0, "driver hears the speed alert but does not react"],
    ]
    empty = [0.0] * 60
    timeline = {"time_s": list(range(60)), "speed_kmh": empty, "limit_kmh": [None] * 60, "driver": answers}
    came = followed(acts, timeline)
    assert [each.answer for each in came] == ["ignored", "obeyed", "unanswered", "ignored"]
    assert came[1].did == "holds; keeps 2 s behind"
