"""Trials as evidence for a protocol's rows, and the calculator that runs beside this package."""

import json
import os
import shutil
import sys
from collections import Counter
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from automotive_cosim.contracts import Limit, LimitSource
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.judge import EventOutcome, JudgedEvent
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.staging import BRINGS, NOT_BINDING, ON_REQUEST
from automotive_cosim.drives.watchers import Silent
from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import kind_of
from automotive_cosim.run.store import opened
from automotive_cosim.run.trial import run_trial
from automotive_cosim.safety.dossier.subject import Subject, read_subject
from automotive_cosim.safety.protocol.calculator import COMMAND, Scores, points
from automotive_cosim.safety.protocol.evidence import PARTS, Evidence, evidence, protocol, told_on
from automotive_cosim.safety.protocol.page import NO_RATING, write_protocol
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from tests.drives.scenes import found as events_on
from tests.drives.scenes import limit, stream
from tests.laws import over

PROTOCOL = protocol("euroncap-2026")
TASKS = "road_motorway_in_rain", "road_unsigned_town", "road_blue_light", "hvac_fan_max", "hvac_seat_airing"


def run(folder: Path, failed: str = "") -> Path:
    """Episodes of some tasks and a drive with five events; what begins with ``failed`` fails."""
    plan = make_plan({"agents": ["asurada"], "tasks": list(TASKS), "drives": ["grid_june"], "seeds": [0]})
    jobs = plan.jobs()
    with opened(folder, plan.as_json(), kind_of, planned=len(jobs)) as store:
        for job in jobs:
            row = job.planned()
            ok = not (failed and row.subject.startswith(failed))
            if hasattr(row, "half"):
                country = "FR" if row.half == "first" else "DE"
                store.append(replace(row, success=ok, country=country, trace_sha256="0" * 64))
                continue
            outcomes = EventOutcome.HIT, EventOutcome.MISSED, EventOutcome.AVOIDED, EventOutcome.VOID
            events = tuple(
                JudgedEvent("phone", "a hand", False, 1.0, each, 1.0, 2.0, 9.0, 9.0) for each in outcomes
            )
            store.append(replace(row, country="AT", score=None, events=events))
    return folder


def found(folder: Path) -> dict[str, Evidence]:
    return {each.row.name: each for each in evidence(PROTOCOL, read_subject(folder))}


@over([(row, glob) for row in PROTOCOL.rows for glob in row.tasks])
def test_every_glob_of_tasks_finds_some(row, glob):
    assert any(fnmatchcase(task, glob) for task in CATALOGUE), (row.name, glob)


@over(PROTOCOL.rows)
def test_every_row_is_of_a_part_and_knows_its_events(row):
    assert row.part in PARTS
    assert {each.partition(": ")[0] for each in row.events} <= set(KINDS)
    assert row.tasks or row.events or row.lacks


@over(PROTOCOL.rows)
def test_every_row_is_tried_or_says_why_not(row):
    kinds = {each.partition(": ")[0] for each in row.events}
    for stage in (each.partition(",")[0] for each in row.stages):
        assert stage in ON_REQUEST
        assert kinds & {*BRINGS.get(stage, (stage,))}, (row.name, stage)
    assert all(any(fnmatchcase(name, each) for name in FAMILIES) for each in row.drives)
    assert bool(row.stages) <= bool(row.events)
    if row.part == "limits":
        assert bool(row.tasks) <= bool(row.stages), "what tasks try can be tried on a network of one's own"
    assert row.tried_by or row.part == "accuracy" or row.lacks.startswith(("no", "the driver"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("row", "stage"), [(row, stage) for row in PROTOCOL.rows for stage in row.stages if stage.endswith("_sign")]
)
def test_a_sign_staged_on_the_grid_makes_a_case_of_its_row(row, stage, simulations: Simulations) -> None:
    driver = "hurried" if stage == "left_sign" else None  # the others hurry for it
    settings = DriveSettings(stage=stage, stage_s=30.0, minutes=6.0, driver=driver, coarse=True)
    spec = DriveSetup("grid_june", 2, settings=settings, agent="silent", model="none")
    drive = run_trial(spec, Silent(), simulations=simulations)
    (made,) = evidence(replace(PROTOCOL, rows=(row,)), cast("Subject", SimpleNamespace(judged=[drive])))
    found = {each.ok for each in made.trials}
    assert found == {True} if stage in NOT_BINDING else False in found, "signs for others are to be left alone"


PLATE = {"limit": limit(30), "limit_by_clock": True}
SHOWN = Limit(30 / 3.6, LimitSource.VARIABLE)


@pytest.mark.parametrize(
    ("road", "name"),
    [
        (PLATE | {"limit_hours": "30 km/h when wet"}, "Rain / Wetness"),
        (PLATE | {"limit_hours": "30 km/h in snow"}, "Snow / Icy"),
        (PLATE | {"limit_hours": "30 km/h Mo-Fr 06:00-22:00"}, "Time / Season"),
        ({"limit": SHOWN}, "Non-lane relevant"),
        ({"limit": SHOWN, "lane_alone": True}, "Lane relevant"),
    ],
)
def test_what_a_sign_shows_speaks_for_its_row_alone(road, name):
    (event,) = events_on(stream(12, kmh=50, **road), "over_limit")
    told = f"over_limit: {event.words}"
    assert {row.name for row in PROTOCOL.rows if any(fnmatchcase(told, each) for each in row.events)} == {name}


def test_no_row_stands_twice_and_points_are_shared_only_where_the_calculator_shares_them():
    assert max(Counter((row.part, row.name) for row in PROTOCOL.rows).values()) == 1
    shared = {name for name, count in Counter(row.points_of for row in PROTOCOL.rows).items() if count > 1}
    assert shared == {"Implicit speed limits - Highway, city and residential zones"}


def test_trials_speak_for_their_rows_by_country(tmp_path: Path) -> None:
    rows = found(run(tmp_path / "runs", failed="road_unsigned"))
    rain, towns, snow = (rows[name] for name in ("Rain / Wetness", "City entry / City exit", "Snow / Icy"))
    assert {country: each.holds for country, each in rain.by_country.items()} == {"FR": True, "DE": True}
    assert {country: each.holds for country, each in towns.by_country.items()} == {"FR": False, "DE": False}
    assert (rain.holds, towns.holds, snow.holds) == (True, False, None)
    assert len(rows["Climate controls"].trials) == 2


TIMELINE = {
    "time_s": [0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
    "limit_kmh": [None, 50.0, 50.0, 50.0, 30.0, 30.0],
    "speed_kmh": [36.0] * 6,
}


@pytest.mark.parametrize(
    ("told", "share", "first", "second"),
    [
        ([(2.0, 50.0), (4.0, 30.0)], 4 / 5, (50.0, 1.0, 10.0), (30.0, 0.0, 0.0)),
        ([(1.0, 50.0)], 3 / 5, (50.0, 0.0, 0.0), (None, None, None)),
        ([(1.0, 70.0), (3.0, 50.0)], 1 / 5, (70.0, 2.0, 20.0), (None, None, None)),
    ],
)
def test_a_limit_is_told_so_many_seconds_and_metres_late_and_so_far_off(told, share, first, second):
    row = make_plan({"agents": ["asurada"], "drives": ["grid_june"], "seeds": [0]}).jobs()[0].planned()
    made = told_on(row, told, TIMELINE)
    assert made.share == pytest.approx(share)
    assert [(each.told_kmh, each.after_s, each.after_m) for each in made.limits] == [first, second]
    assert made.limits[0].off_kmh == first[0] - 50.0
    assert made.limits[0].in_time


def fake(folder: Path, monkeypatch: pytest.MonkeyPatch, answer: object) -> None:
    """A calculator on the PATH whose Python says something."""
    folder.mkdir()
    said = answer if isinstance(answer, str) else f"print({json.dumps(json.dumps(answer))})"
    for name, text in ((COMMAND, ""), ("python", f"#!{sys.executable}\nimport sys; sys.stdin.read()\n{said}\n")):
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(folder))


ABOUT = {"version": PROTOCOL.version, "sha256": PROTOCOL.sha256}


@pytest.mark.skipif(os.name == "nt", reason="the made-up calculator is a script with a shebang")
@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (ABOUT | {"version": "9.9.9"}, r"9\.9\.9 is installed"),
        (ABOUT | {"sha256": "0" * 64}, "this report knows"),
        ("raise SystemExit('broken')", "failed: broken"),
        ("raise SystemExit(3)", "without a word"),
    ],
)
def test_a_calculator_that_cannot_serve_is_told_in_a_line(tmp_path, monkeypatch, answer, why):
    fake(tmp_path / "bin", monkeypatch, answer)
    with pytest.raises(SetupError, match=why) as error:
        points(PROTOCOL, ())
    assert "\n" not in str(error.value)


@pytest.mark.skipif(os.name == "nt", reason="the made-up calculator is a script with a shebang")
def test_the_page_says_first_that_it_is_no_rating_and_gives_points_from_to(tmp_path, monkeypatch):
    name = "Conditional speed limits - Rain / Wetness"
    fake(tmp_path / "bin", monkeypatch, ABOUT | {"points": [{name: [0.0, 0.4]}, {name: [0.4, 0.4]}]})
    page, unscored = write_protocol(run(tmp_path / "runs"), "euroncap-2026")
    text = page.read_text("utf-8")
    assert not unscored
    assert text.index(NO_RATING) < text.index("<h1>")
    assert "0 to 0.4 of 0.4" in text
    rows = (page.parent / "limits.csv").read_text("utf-8")
    assert "not tried" in rows
    assert "hvac_fan_max" in (page.parent / "trials.csv").read_text("utf-8")


def test_without_a_calculator_the_page_says_how_to_install_it(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    page, unscored = write_protocol(run(tmp_path / "runs"), "euroncap-2026")
    assert "pipx install euroncap-rating-2026==5.4.9" in unscored
    assert "not scored" in page.read_text("utf-8")
    with pytest.raises(UserError, match="no protocol 'ncap'"):
        write_protocol(tmp_path / "runs", "ncap")


@pytest.mark.proof
def test_the_official_calculator_scores_a_row_that_holds_in_every_country(tmp_path: Path) -> None:
    if shutil.which(COMMAND) is None:
        pytest.skip(f"{COMMAND} is not installed")
    every = [
        Evidence(
            each.row, tuple(replace(trial, country=code) for code in PROTOCOL.countries for trial in each.trials)
        )
        for each in found(run(tmp_path / "runs")).values()
    ]
    least, most = points(PROTOCOL, every)

    def told(name: str) -> tuple[float, float]:
        scores: list[Scores] = [least, most]
        low, high = (score[name][0] for score in scores)
        return low, high

    assert told("Conditional speed limits - Rain / Wetness") == (0.4, 0.4)
    assert told("Conditional speed limits - Snow / Icy") == (0.0, 0.4)
    assert told("Climate controls") == (0.5, 0.5)
