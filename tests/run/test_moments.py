"""What is kept for later judges, the figures of harm, and stored episodes judged again."""

import json
import lzma
import os
from dataclasses import replace
from types import SimpleNamespace

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts import NO_LIMIT, GoalStatus, GpsFix, Limit, LimitSource, PullOver, Reroute, SlowDown
from automotive_cosim.errors import UserError
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.geo.locate import Geo
from automotive_cosim.run.batch import run_plan
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.figures import drive_figures, nearest_s, overspeed
from automotive_cosim.run.moments import Judged, judged_file, read_judged, write_judged
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.regrade import regrade
from automotive_cosim.run.rows import PartsHeld
from automotive_cosim.run.trial import run_trial
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.verdict import judge
from automotive_cosim.tasks import CATALOGUE

from ..geo.conftest import CAR, CLEAR, NOON


@pytest.fixture(scope="session")
def collected(simulations):
    """An alert in vain on the grid: what is kept, and the row."""
    setup = EpisodeSetup("phenomenon_front_window_fogged", "first", "grid", agent="always-alert", model="none")
    recorder = Recorder(setup, None)
    row = run_trial(setup, make_agent("always-alert"), [recorder], simulations=simulations)
    assert row.success is False
    return recorder, row


@pytest.fixture
def kept(collected, tmp_path):
    judged = collected[0].judged
    (tmp_path / "traces").mkdir()
    write_judged(tmp_path, "a", judged)
    return tmp_path, judged


def test_moments_come_back_as_they_were(kept):
    folder, judged = kept
    first = judged_file(folder, "a").read_bytes()
    again = read_judged(folder, "a", Judged)
    assert again == judged
    # Types too; but a set has no order.
    same = replace(judged, parameters=dict(judged.parameters), allowed_writes=frozenset())
    assert repr(replace(again, allowed_writes=frozenset())) == repr(same)
    assert len(again.trace) == len(again.baseline) > 1
    write_judged(folder, "a", again)
    assert judged_file(folder, "a").read_bytes() == first
    assert len(first) < 5000 * (len(again.trace) + len(again.baseline))


def test_judging_the_stored_moments_gives_the_same_verdict(kept, collected):
    judged = read_judged(kept[0], "a", Judged)
    task = CATALOGUE["phenomenon_front_window_fogged"]
    instance = Instance(task, "first", judged.goal, judged.parameters)
    again = judge(
        instance, judged.trace, judged.baseline, lambda: judged.counterfactual, judged.declared, judged.reason
    )
    assert PartsHeld.of(again) == collected[1].parts


def test_the_cockpit_goes_through_a_drive_again_only_if_something_else_was_left_changed(collected):
    def asked():
        raise AssertionError("the counterfactual is asked for")

    judged = collected[0].judged
    instance = Instance(CATALOGUE["phenomenon_front_window_fogged"], "first", judged.goal, judged.parameters)
    untouched = judged.baseline
    assert judge(instance, untouched, untouched, asked, None, None).clean.ok
    last = untouched[-1]
    spoilt = replace(last, commands={**last.commands, "sent": ["a message"]})
    with pytest.raises(AssertionError, match="is asked for"):
        judge(instance, (*untouched[:-1], spoilt), untouched, asked, None, None)


def test_an_agent_that_failed_has_no_success_even_where_silence_is_right(collected):
    judged = collected[0].judged
    instance = Instance(CATALOGUE["phenomenon_front_window_fogged"], "first", judged.goal, judged.parameters)
    told = (instance, judged.baseline, judged.baseline, lambda: judged.counterfactual, None, None)
    failed = judge(*told, "it crashed")
    assert "it crashed" in failed.declared.why
    assert not failed.success
    assert judged.declared is GoalStatus.COMPLETE


def test_the_counterfactual_is_stored_and_an_older_file_without_it_refused(kept):
    folder, judged = kept
    other = {**judged.trace[-1].commands, "horn": 7}
    write_judged(folder, "a", replace(judged, counterfactual=other))
    assert read_judged(folder, "a", Judged).counterfactual == other
    path = judged_file(folder, "a")
    whole = json.loads(lzma.decompress(path.read_bytes()))
    names = next(names for kind, names in whole["classes"] if kind.endswith(":Judged"))
    names[names.index("counterfactual")] = "a_field_of_old"
    path.write_bytes(lzma.compress(json.dumps(whole).encode()))
    with pytest.raises(UserError, match="counterfactual"):
        read_judged(folder, "a", Judged)


def test_fields_that_come_and_go_are_borne_and_other_classes_refused(kept):
    folder, judged = kept
    path = judged_file(folder, "a")
    whole = json.loads(lzma.decompress(path.read_bytes()))

    def stored(changed):
        path.write_bytes(lzma.compress(json.dumps(changed).encode()))
        return read_judged(folder, "a", Judged)

    (number, (_, names)) = next(
        (number, kept) for number, kept in enumerate(whole["classes"]) if kept[0].endswith(":DrivingState")
    )
    assert names[-1] == "trailer"
    changed = json.loads(json.dumps(whole))
    changed["classes"][number][1] = [*names[:-1], "a_field_of_old"]
    assert stored(changed) == judged
    lacking = json.loads(json.dumps(whole))
    lacking["classes"][number][1] = ["another_clock", *names[1:]]
    with pytest.raises(UserError, match="cannot read"):
        stored(lacking)
    for name in ("os:system", "automotive_cosim.run.store:os"):
        other = json.loads(json.dumps(whole))
        other["classes"][0][0] = name
        with pytest.raises(UserError, match="cannot read"):
            stored(other)
    path.write_bytes(b"nothing")
    with pytest.raises(UserError, match="cannot read"):
        read_judged(folder, "a", Judged)
    with pytest.raises(UserError, match="does not exist"):
        read_judged(folder, "b", Judged)


def test_requests_to_the_road_come_back(kept):
    folder, judged = kept
    *before, last = judged.trace
    requests = [Reroute("A 4"), SlowDown(30.0), PullOver()]
    asked = replace(judged, trace=(*before, replace(last, commands={**last.commands, "requests": requests})))
    write_judged(folder, "a", asked)
    assert read_judged(folder, "a", Judged).trace[-1].commands["requests"] == requests


HAMBURG = GpsFix(True, 10.0, 53.55, 3.0, 0.0, 0.0)
RURAL = replace(CAR.road, road_class="secondary", built_up=False)


def drive_of(*seconds):
    """Moments of a drive through Germany: seconds, metres per second, and the limit."""
    moments = []
    for time_s, speed_mps, limit in seconds:
        state = replace(CAR, time_s=time_s, speed_mps=speed_mps, road=replace(RURAL, limit=limit))
        context = Geo().locate(state, HAMBURG, CLEAR, NOON)
        moments.append(SimpleNamespace(time_s=time_s, driving=state, passed=(state,), context=context))
    return moments


def test_overspeed_is_the_way_above_a_sign():
    sign, end_of_limits = Limit(15.0, LimitSource.POSTED), Limit(None, LimitSource.POSTED)
    moments = drive_of(
        (0.0, 20.0, sign), (1.0, 20.0, sign), (3.0, 18.0, sign), (4.0, 30.0, end_of_limits), (5.0, 10.0, sign)
    )
    assert overspeed(moments) == (5.0 + 2 * 3.0, 4.0)
    assert overspeed(moments, 2.0) == (5.0, 1.0)


def test_without_a_sign_the_law_binds_and_never_what_the_map_assumes():
    """100 km/h outside built-up areas (StVO § 3), whether the map assumes 50 or nothing at all."""
    for assumed in (Limit(50 / 3.6, LimitSource.ASSUMED), Limit(None, LimitSource.ASSUMED), NO_LIMIT):
        over_m, whole_s = overspeed(drive_of((0.0, 30.0, assumed), (2.0, 30.0, assumed)))
        assert over_m == pytest.approx(2 * (30.0 - 100 / 3.6))
        assert whole_s == 2.0
        assert limit_at(drive_of((0.0, 30.0, assumed))[0].context).source is LimitSource.LAW


def driving(time_s, speed_mps, closing_s=None):
    leader = None if closing_s is None else SimpleNamespace(time_to_collision_s=closing_s)
    return SimpleNamespace(time_s=time_s, speed_mps=speed_mps, around=SimpleNamespace(leader=leader))


def test_the_nearest_is_the_smallest_time_of_those_there_are():
    assert nearest_s([driving(0.0, 1.0), driving(1.0, 1.0, 4.0), driving(2.0, 1.0, 2.5)]) == 2.5
    assert nearest_s([driving(0.0, 1.0)]) is None


def test_a_baseline_run_differs_in_nothing_and_a_touched_one_in_what_was_done(collected, kept):
    result = collected[1]
    assert result.drive is not None
    judged = kept[1]
    end_s = judged.trace[-1].time_s
    assert drive_figures(judged.baseline, end_s) == drive_figures(judged.baseline[:], end_s + 5)
    assert drive_figures(judged.trace, end_s).energy_wh > 0
    whole = drive_figures(judged.trace, end_s)
    part = drive_figures(judged.trace, (judged.trace[0].time_s + end_s) / 2)
    assert part.energy_wh < whole.energy_wh
    assert whole.arrival_s is not None
    assert result.baseline_drive.arrival_s <= result.drive.arrival_s + 60


def test_doing_nothing_neither_harms_nor_averts(simulations):
    setup = EpisodeSetup(
        "phenomenon_front_window_fogged", "first", "grid", agent="no-op", model="none", max_steps=3
    )
    result = run_trial(setup, make_agent("no-op"), simulations=simulations)
    assert result.drive is not None
    assert result.drive == result.baseline_drive


@pytest.mark.sumo
def test_stored_episodes_are_judged_again_by_the_present_checks(tmp_path, monkeypatch):
    plan = make_plan({"agents": ["oracle", "no-op"], "tasks": ["hvac_fan_max"], "scenarios": ["grid"]})
    run_plan(plan, tmp_path / "e")
    before = {path: path.read_bytes() for path in (tmp_path / "e").rglob("*") if path.is_file()}
    same = list(regrade(tmp_path / "e"))
    assert [(each.now, each.differs) for each in same] == [(False, False), (True, False)]
    task = CATALOGUE["hvac_fan_max"]
    stricter = replace(task, first=replace(task.first, deadline=replace(task.first.deadline, seconds=0.5)))
    monkeypatch.setitem(CATALOGUE._tasks, task.id, stricter)
    idle, oracle = regrade(tmp_path / "e")
    assert not idle.differs
    assert (oracle.before, oracle.now) == (True, False)
    assert [(change.part, change.now) for change in oracle.changes] == [("in_time", False)]
    wider = replace(task, first=replace(task.first, may_write=frozenset({"horn"})))
    monkeypatch.setitem(CATALOGUE._tasks, task.id, wider)
    assert all(each.now is None and "have changed; rerun" in each.problem for each in regrade(tmp_path / "e"))
    others = {task_id: each for task_id, each in CATALOGUE.items() if task_id != task.id}
    monkeypatch.setattr(CATALOGUE, "_tasks", others)
    assert all(each.now is None and "no task" in each.problem for each in regrade(tmp_path / "e"))
    assert before == {path: path.read_bytes() for path in (tmp_path / "e").rglob("*") if path.is_file()}


def ends_its_process(*_: object) -> None:
    os._exit(9)


def test_what_cannot_be_judged_again_is_told_and_ends_nothing(tmp_path, monkeypatch):
    """Stored moments may be anybody's: malformed ones, and such as take more than they may."""
    jobs = make_plan({"agents": ["oracle", "no-op"], "tasks": ["hvac_fan_max"]}).episodes()[:2]
    held = PartsHeld(goal=True, clean=True, safe=True, in_time=True, declared=True)
    rows = {job.id: replace(job.planned(), success=True, parts=held) for job in jobs}
    monkeypatch.setattr("automotive_cosim.run.regrade.read_evaluation", lambda folder: None)
    monkeypatch.setattr("automotive_cosim.run.regrade.read_trials", lambda folder: rows)
    first, second = sorted(rows)
    judged_file(tmp_path, first).parent.mkdir()
    judged_file(tmp_path, first).write_bytes(lzma.compress(b'{"pool": [["#", 7]], "trace": 3}'))
    told = list(regrade(tmp_path))
    assert [(each.episode, each.now) for each in told] == [(first, None), (second, None)]
    assert all(each.problem and "\n" not in each.problem for each in told)
    monkeypatch.setattr("automotive_cosim.run.regrade.read_judged", ends_its_process)
    assert all("more memory or processor time" in each.problem for each in regrade(tmp_path))
