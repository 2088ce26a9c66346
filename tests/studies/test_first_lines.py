"""What somebody new reads first: the first line of every kind of report says what was found, in what unit, against
what, and of how many."""

import re
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.report.answer import answer
from automotive_cosim.report.regression import changes, plain
from automotive_cosim.report.results import read_results
from automotive_cosim.run.attribution import NO_ACT, ActEffect
from automotive_cosim.run.attribution import sentence as of_acts
from automotive_cosim.safety.dossier.document import dossier
from automotive_cosim.safety.dossier.subject import read_subject
from automotive_cosim.safety.findings import sentence as of_search
from automotive_cosim.studies.calibration.page import sentence as of_calibration
from automotive_cosim.studies.calibration.result import Met
from automotive_cosim.studies.congestion.page import answer as of_congestion
from automotive_cosim.studies.days.page import answer as of_days
from automotive_cosim.studies.reroute.networks import sentence as of_networks
from automotive_cosim.studies.reroute.page import answer as of_rerouting
from automotive_cosim.studies.versions import answer as of_versions
from tests.report.test_regression import scored, write
from tests.report.test_stopped import JOBS
from tests.report.test_stopped import write as stopped
from tests.safety.test_dossier import run as driven
from tests.safety.test_search import searched
from tests.studies.test_congestion import study as congestion
from tests.studies.test_days import study as days
from tests.studies.test_statistics import parted, seeds
from tests.studies.test_statistics import study as rerouting


def people(folder: Path) -> str:
    """Two people on the same episodes."""
    write(folder, lost={1}, agent="human", model="heron")
    return answer(read_results(folder))


def safety(folder: Path) -> str:
    made = dossier(read_subject(folder))
    return f"{made.title}. {made.sentence}"


def versions() -> Any:
    """Two runs of a study whose rows differ in part."""
    return SimpleNamespace(name="01_a", rows=(40, 28, 0), is_same=False)


def calibrated() -> Any:
    def met(*, held_out: bool, unfitted: bool = False) -> Met:
        good = (3, 9) if not held_out else (1, 2)
        return Met(12 if not held_out else 4, good[not unfitted], 4.0, 1.0)

    return SimpleNamespace(source="the town", met=met)


def acts() -> list[ActEffect]:
    changed = ActEffect((4,), 12.0, "reroutes", changed={"over_s": (9.0, 0.0)}, draws=5)
    idle = ActEffect((2,), 3.0, "opens climate")
    return [idle, changed, ActEffect((), 60.0, NO_ACT, verdict="missed tunnel: due from 0:40 to 1:00")]


PASSED = r"\(\d+%, \d+% to \d+%\)"
"""A share, and its interval."""

REPORTS: dict[str, tuple[Callable[[Path], str], tuple[str, ...]]] = {
    "one agent": (
        lambda folder: answer(read_results(write(folder, lost={1}))),
        ("asurada, rules stand-in solves", r"\d of \d pairs", "no run ended in an error"),
    ),
    "two agents": (
        lambda folder: answer(read_results(stopped(folder, range(len(JOBS))))),
        (r"asurada.* and t3a.* are level, \d won each", r"on 4 pairs of 2 tasks", "no run ended in an error"),
    ),
    "a stopped evaluation": (
        lambda folder: answer(read_results(stopped(folder, range(11)))),
        ("and", "pair|episode", r"of \d tasks?", "too few to tell"),
    ),
    "people": (people, ("heron solves", r"of \d pairs")),
    "drives": (
        lambda folder: answer(read_results(scored(folder, [40] * 6))),
        (
            r"silent \(negative control\): score 40",
            r"0% of 6 events met",
            "6 drives",
            "0 is doing nothing, 100 the rule-perfect watcher",
        ),
    ),
    "a comparison": (
        lambda folder: plain(changes(write(folder / "a"), write(folder / "b", lost={1, 2})), 0.0).splitlines()[0],
        ("asurada, rules stand-in is worse", r"success 100% before, 83% after", "of 12 episodes"),
    ),
    "rerouting": (
        lambda _: of_rerouting(rerouting(seeds(30, parted(50.0, 80.0, 90.0)))),
        ("“always” saves 50 s", "a decision", "against keeping the route", "over 30 decisions of 30 seeds"),
    ),
    "several networks": (
        lambda _: of_networks([rerouting(seeds(30, parted(50.0, 80.0, 90.0)))] * 2),
        (r"“always”", "a decision, against keeping the route", r"grid \+50 s \(30 decisions\), grid"),
    ),
    "congestion": (
        lambda _: of_congestion(congestion(*[3600.0] * 10)),
        ("“c1c2 closed” costs 1.0", "vehicle-hours an hour of delay", "against no intervention", "over 10 seeds"),
    ),
    "days": (
        lambda _: of_days(days()),
        ("100% of the drivers advised: 150 s", "less than with nobody advised", "user equilibrium", "over 2 seeds"),
    ),
    "two versions of a study": (
        lambda _: of_versions((versions(),)),
        ("do not give the same answer", "01_a: 12 of 40 rows differ"),
    ),
    "a search": (
        lambda _: of_search(searched(), "asurada"),
        (r"asurada failed in \d+ of 64 runs in which something was due", r"minimal failure", r"at most \d+ %"),
    ),
    "safety": (
        lambda folder: safety(driven(folder, 1)),
        (
            "Safety report: asurada",
            r"2\.40 h and 84 km",
            "in 6 of them",
            "Up to 58 % of such situations",
            "1 of 6 units did",
        ),
    ),
    "attribution": (
        lambda _: of_acts(acts()),
        (
            "1 of 2 acts",
            "each left out of the same traffic",
            "changed the verdict or the road: step 4",
            "missed tunnel",
        ),
    ),
    "calibration": (
        lambda _: of_calibration(calibrated()),
        ("demand of the town meets 9 of 12 calibrated", r"before: 3", "2 of 4 held out", "GEH of 5"),
    ),
}
"""By name: the first line of a small report of that kind, and what it must hold."""


@pytest.mark.parametrize("name", REPORTS)
def test_the_first_line_says_what_was_found(tmp_path: Path, name: str) -> None:
    made, wanted = REPORTS[name]
    line = made(tmp_path / "runs")
    assert "\n" not in line
    assert {each for each in wanted if not re.search(each, line)} == set(), line
    assert len(line.split()) <= 60
