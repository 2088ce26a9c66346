"""Progress as lines: nothing is said twice, and an estimate never counts upwards."""

from io import StringIO

from automotive_cosim.cli.batches import ProgressView
from automotive_cosim.cli.console import Console
from automotive_cosim.run.batch import Progress
from automotive_cosim.run.forecast import Range
from automotive_cosim.run.rows import TrialRow


def told(*states: tuple[float, int, float | None], expected: Range | None = None) -> list[str]:
    """The lines after these: seconds since the start, runs that have ended of two, and seconds left."""
    text = StringIO()
    view: ProgressView[TrialRow] = ProgressView(Console(file=text), "drives", lambda _: "so far", expected)
    for seconds, done, left_s in states:
        doing = () if done else ("warming up traffic, 60 of 600 s", "")
        view.tell(Progress(2, done, done, done, 0, done, seconds, left_s, None, doing))
    return text.getvalue().splitlines()


def test_what_is_the_same_is_said_again_only_after_a_while() -> None:
    lines = told(*((10.0 * step, 0, None) for step in range(13)))
    assert lines == ["0 of 2 drives; so far; warming up traffic, 60 of 600 s"] * 2


def test_before_a_run_has_ended_the_time_counts_against_what_was_expected() -> None:
    lines = told((65.0, 0, None), (200.0, 1, None), expected=Range(120.0, 300.0))
    assert lines == [
        "0 of 2 drives; so far, 1:05 of 2 to 5 minutes; warming up traffic, 60 of 600 s",
        "1 of 2 drives; so far",
    ]


def test_what_is_left_of_the_budget_stands_beside_the_time() -> None:
    text = StringIO()
    view: ProgressView[TrialRow] = ProgressView(Console(file=text), "runs", lambda _: "so far")
    view.tell(Progress(9, 1, 1, 1, 0, 1, 20.0, 60.0, None, budget="38,000 of 50,000 tokens left"))
    assert text.getvalue() == "1 of 9 runs; so far, 1:00 left, 38,000 of 50,000 tokens left\n"


def test_an_estimate_that_rises_is_not_told() -> None:
    states = [
        (100.0, 1, 60.0),
        (120.0, 1, 40.0),
        (160.0, 1, 1.0),
        (180.0, 1, 15.0),
        (200.0, 1, 25.0),
        (210.0, 2, 0.0),
    ]
    assert told(*states) == [
        "1 of 2 drives; so far, 1:00 left",
        "1 of 2 drives; so far, 0:40 left",
        "1 of 2 drives; so far, 0:01 left",
        "1 of 2 drives; so far; it takes longer than expected",
        "2 of 2 drives; so far",
    ]
