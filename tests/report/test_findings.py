"""Tables that say why and at what price, on rows made by hand whose figures can be reckoned in the head."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.report import findings
from automotive_cosim.report.evaluation import contrast
from automotive_cosim.report.results import Results
from automotive_cosim.report.stats import clustered_mean
from automotive_cosim.run.coverage import Coverage
from automotive_cosim.run.difficulty import WonBy, level, measured, shipped
from automotive_cosim.run.figures import DriveFigures
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import write_trace
from automotive_cosim.tasking.task import Dimension, Module


def row(task="t", half="first", geo="full", success=True, *, agent="asurada", **more):
    named = {"module": Module.ROAD, "dimension": Dimension.DRIVING_ALIGNMENT} | more
    return EpisodeRow(
        id=f"{task}-{half}-{agent}-{geo}", pair=f"{task}-{agent}-{geo}", task=task, half=half, agent=agent,
        conditions=Conditions.named({"geo": geo}),
        model="rules", seed=0, repeat=0, scenario="grid", success=success, **named,
    )  # fmt: skip


def under(row, **values):
    """The row under other conditions."""
    return replace(row, conditions=Conditions.named(row.conditions.as_json() | values))


def by(name, found):
    """The table of success by a condition."""
    return next(table for table in findings.by_condition(found) if table.name == f"by_{name}")


def results(*rows, folder=None):
    whole = Coverage(len(rows), 0, shared=frozenset(row.id for row in rows))
    return Results(folder, {"plan": {"repeats": 1}, "starts": []}, rows, whole)


def figures(overspeed_m, ttc_s=5.0):
    return DriveFigures(overspeed_m, ttc_s, arrival_s=60.0, energy_wh=8.0)


def test_success_by_language_stands_side_by_side():
    rows = [
        replace(under(row(task, success=success), language=language), id=f"{task}-{language}")
        for task in "ab"
        for language, success in (("en", True), ("ja", task == "a"))
    ]
    assert by("language", results(*rows[::2])).rows == ()
    table = by("language", results(*rows))
    assert table.columns == ("Contestant", "en", "ja")
    ((_, english, japanese),) = table.rows
    assert str(english).startswith("100%")
    assert str(japanese).startswith("50%")
    assert [each.label for each in results(*rows).contestants][1].endswith("in Japanese")


def test_harm_is_the_difference_to_the_baseline_run():
    found = results(
        row("a", drive=figures(10.0), baseline_drive=figures(100.0)),
        row("b", drive=figures(20.0, None), baseline_drive=figures(30.0)),
        row("a", half="second", drive=None),
    )
    ((label, half, overspeed, ttc, delay, energy),) = findings.harm(found).rows
    assert (label, half) == ("asurada, rules stand-in", "first")
    assert str(overspeed) == "-50.0, n=2", "too few for an interval"
    assert str(ttc).endswith("n=1")
    assert str(delay).startswith("+0.0")
    assert overspeed.episodes == tuple(each.id for each in found.rows[:2])
    assert str(energy).startswith("+0.0")


def test_a_clustered_mean_draws_whole_clusters():
    rng = np.random.default_rng(0)
    values = [(task, float(value)) for task in range(30) for value in [rng.normal()] * 20]
    clustered, alone = clustered_mean(values), clustered_mean(enumerate(value for _, value in values))
    assert clustered.value == pytest.approx(alone.value)
    assert clustered.count == 600
    wide, narrow = (each.interval.high - each.interval.low for each in (clustered, alone))
    assert 3 < wide / narrow < 6  # the root of 20 is 4.5
    assert clustered_mean([("a", 1.0), ("a", 2.0)]).interval is None
    assert clustered_mean([]) is None


def test_success_by_condition_is_set_side_by_side():
    rows = [
        replace(under(row(task, success=success), see=see), id=f"{task}-{see}")
        for task, see, success in [("a", "tree", True), ("b", "tree", True), ("a", "picture", False)]
    ]
    table = by("see", results(*rows))
    ((label, tree, picture),) = table.rows
    assert table.columns == ("Contestant", "tree", "picture")
    assert label == "asurada, rules stand-in"
    assert str(tree).startswith("100%")
    assert str(picture).startswith("0%")
    assert by("feedback", results(*rows)).rows == ()
    assert {each.label for each in results(*rows).contestants} == {
        "asurada, rules stand-in, tree alone",
        "asurada, rules stand-in, picture alone",
    }
    heard = [
        under(each, see="both", feedback=how) for each, how in zip(rows, ("quiet", "quiet", "verbose"), strict=True)
    ]
    assert by("feedback", results(*heard)).columns == ("Contestant", "quiet", "verbose")
    assert "verbose feedback" in results(heard[2]).contestants[0].label
    sizes = ("1280x720", "1920x720", "1080x1920")
    drawn = [under(each, see="both", screen=size) for each, size in zip(rows, sizes, strict=True)]
    assert by("screen", results(*drawn)).columns == ("Contestant", *sizes)
    assert "1080x1920 screen" in results(drawn[2]).contestants[0].label


def test_place_is_worth_what_decided_pairs_lose_without_it_and_placebo_nothing():
    rows = []
    for number in range(6):
        for half in ("first", "second"):
            for geo in ("full", "none"):
                rows.append(row(f"p{number}", half, geo, geo == "full" or half == "first", tags=("place",)))
                rows.append(row(f"q{number}", half, geo, number % 2 == 0))
    ((_, other, decided, placebo),) = findings.place_effect(results(*rows)).rows
    assert other == "none"
    assert str(decided).startswith("+100%")
    assert "n=6" in str(decided)
    assert str(placebo).startswith("+0%")
    assert len(decided.episodes) == 24
    alone = [replace(each, agent="always-alert") for each in rows]
    assert findings.place_effect(results(*alone)).rows == ()


def test_labels_count_an_episode_for_each_it_has():
    found = results(row("a", skills=("type", "infer")), row("b", skills=("type",), success=False), row("c"))
    told = findings.by_label(found, "skill", "skills", lambda row: row.skills)
    rows = {each[0]: str(each[1]) for each in told.rows}
    assert list(rows) == ["infer", "type"]
    assert rows["infer"].endswith("1/1")
    assert rows["type"].endswith("1/2")


def test_prompts_tell_their_percentiles():
    found = results(row("a", prompt_tokens=(100, 200, 300)), row("b", prompt_tokens=(400, 500)), row("c"))
    (told,) = findings.prompts(found).rows
    assert [str(cell) for cell in told[1:]] == ["full", "5", "120", "200", "300", "400", "480"]


def test_tasks_are_counted_once_and_add_up():
    found = results(
        row("a"),
        row("a", geo="none"),
        row("b", dimension=Dimension.ENVIRONMENT_ALERTS),
        row("c", module=Module.HVAC),
    )
    rows = {each[0]: each[1:] for each in findings.distribution(found).rows}
    assert rows["Road"] == ("0", "0", "1", "1", "2")
    assert rows["HVAC"] == ("0", "0", "1", "0", "1")
    assert rows["All"] == ("0", "0", "2", "1", "3")


def test_the_case_is_one_that_place_decides_and_shows_both_sides(tmp_path, episode):
    (tmp_path / "traces").mkdir()
    rows = [
        row("a", geo="full"), row("a", geo="none", success=False),
        row("b", geo="full", tags=("place",)), row("b", geo="wrong", success=False, tags=("place",)),
        row("c", geo="full", success=False), row("c", geo="none", success=True),
    ]  # fmt: skip
    step = {"step": 0, "time_s": 5.0, "elements": [], "action": None, "thought": "", "traffic": {"speed_mps": 9.0}}
    alert = {"action_type": "show_alert", "kind": "speed"}
    lines = [step, step | {"step": 1, "time_s": 6.0, "action": alert, "thought": "80 is more than 50"}]
    for each in rows:
        write_trace(tmp_path, each.id, [*lines, {"result": episode(success=each.success)}])
    pictures = tmp_path / "pictures" / rows[2].id / "screenshots"
    pictures.mkdir(parents=True)
    Image.new("RGB", (64, 36)).save(pictures / "step_000.jpg")
    sides = contrast(results(*rows, folder=tmp_path))
    assert sides is not None
    assert [side.row.id for side in sides] == [rows[2].id, rows[3].id]
    assert sides[0].steps == (("+0.0 s", "warns the driver of speed", "80 is more than 50"),)
    assert sides[0].picture.startswith("data:image/jpeg")
    assert sides[1].picture == ""
    assert contrast(results(*rows[4:], folder=tmp_path)) is None


def test_success_by_difficulty_goes_from_easy_to_hard():
    levels = {}
    for name in shipped().halves:
        task, half = name.split("/")
        if (found := measured(task, half)) is not None:  # not changed since
            levels.setdefault(level(found), (task, half))
    rows = [row(*levels[each], success=each is WonBy.PROGRAM) for each in reversed(WonBy) if each in levels]
    table = findings.by_difficulty(results(*rows, row("own_task")))
    told = [each for each in WonBy if each in {*levels, WonBy.UNKNOWN}]
    assert [str(line[0]) for line in table.rows] == [str(each) for each in told]
    won = [str(line[1]).startswith("100%") for line in table.rows]
    assert won == [each in (WonBy.PROGRAM, WonBy.UNKNOWN) for each in told]
