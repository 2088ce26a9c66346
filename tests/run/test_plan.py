import re
from dataclasses import replace

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts.given import Clock, See
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.coverage import Coverage
from automotive_cosim.run.hidden import commitment, drawn, read_key
from automotive_cosim.run.plan import make_plan, read_plan
from automotive_cosim.run.trial import Limits
from automotive_cosim.tasking.sets import Split, Suite
from automotive_cosim.tasking.split import split_of
from automotive_cosim.tasking.task import Hurry, Subset
from automotive_cosim.tasks import CATALOGUE

STANDARD = {task.id: task for task in CATALOGUE.of(Suite.STANDARD)}
HARD = tuple(task.id for task in CATALOGUE.of(Suite.HARD))


def plan(**values):
    return make_plan({"agents": ["oracle"]} | values)


def test_words_choose_tasks_by_id_pattern_and_kind():
    assert choose(["all"]) == tuple(STANDARD)
    assert choose(["hvac_fan_max"]) == ("hvac_fan_max",)
    assert set(choose(["hvac_*"])) == {name for name in STANDARD if name.startswith("hvac_")}
    general, safety = set(choose(["general"])), set(choose(["safety"]))
    assert general | safety == set(STANDARD)
    assert not general & safety
    assert all(CATALOGUE[name].dimension.is_safety for name in safety)
    assert set(choose(["hvac"])) == {name for name, task in STANDARD.items() if task.module == "hvac"}
    with pytest.raises(UnknownNameError, match="did you mean 'safety'"):
        choose(["safty"])


def test_subsets_part_the_catalogue():
    parts = [choose([subset]) for subset in Subset]
    assert sorted(task for part in parts for task in part) == sorted(STANDARD)
    assert all(
        {CATALOGUE[task].subset for task in part} == {name} for name, part in zip(Subset, parts, strict=True)
    )


def test_the_suite_live_is_of_pairs_that_hurry_and_has_the_model_s_clock_unless_told_otherwise():
    chosen = choose(["all"], "live")
    assert len(chosen) >= 30
    assert {CATALOGUE[name].hurries for name in chosen} == set(Hurry)
    assert all(len(CATALOGUE[name].halves) == 2 for name in chosen)
    assert plan(suite="live").clock == (Clock.MODEL,)
    assert plan(suite="live", clock=["fixed"]).clock == (Clock.FIXED,)
    assert make_plan(plan(suite="live", clock=["fixed"]).as_json()).clock == (Clock.FIXED,)
    assert plan(suite="hard").clock == (Clock.FIXED,)


def test_the_suite_camera_is_run_with_the_view_of_the_road_and_left_out_without_it():
    assert plan(suite="camera").see == (See.CAMERA,)
    assert not plan(suite="camera").beyond_the_list()
    blind = plan(suite="camera", see=["both"])
    assert set(blind.beyond_the_list()) == set(choose(["all"], "camera"))
    with pytest.raises(UserError, match="see = camera"):
        blind.check(dry=True)


def test_a_suite_bounds_words_but_not_ids():
    assert choose(["all"], "hard") == HARD
    assert set(choose(["all"], "all")) == set(CATALOGUE)
    assert choose([HARD[0], "hvac_fan_max"]) == ("hvac_fan_max", HARD[0])
    with pytest.raises(UnknownNameError, match="hard_"):
        choose(["hard_*"])
    with pytest.raises(UnknownNameError, match="suite"):
        choose(["all"], "harder")
    with pytest.raises(UserError, match="suite"):
        plan(suite="harder")


def test_the_hard_suite_has_its_own_limit_of_steps():
    jobs = plan(tasks=[HARD[0], "hvac_fan_max"], limits={"steps": 7, "hard_steps": 31}).jobs()
    assert {(job.task, job.max_steps) for job in jobs} == {(HARD[0], 31), ("hvac_fan_max", 7)}
    usual = plan(tasks=[HARD[0], "hvac_fan_max"]).jobs()
    assert {(job.task, job.max_steps) for job in usual} == {(HARD[0], 40), ("hvac_fan_max", 20)}


@pytest.mark.slow
def test_a_key_draws_seeds_and_places_that_nobody_else_can_tell(tmp_path):
    asked = plan(split="hidden", tasks=["hvac_parched", "hvac_fan_max"], drives=["grid_june"], seeds=[0, 1])
    first, again, other = (drawn(asked, key) for key in (b"a" * 16, b"a" * 16, b"b" * 16))
    assert first == again
    assert commitment(b"a" * 16, first) == commitment(b"a" * 16, again)
    assert len({*commitment(b"a" * 16, first), *commitment(b"b" * 16, first), *commitment(b"b" * 16, other)}) == 5
    seeds = [{trial.seed for trial in each.trials} for each in (first, other)]
    assert [len(each) for each in seeds] == [2, 2]
    assert not seeds[0] & seeds[1]
    halves = {(name, half) for name in asked.tasks for half in CATALOGUE[name].halves}
    assert {(trial.task, trial.half) for trial in first.trials if trial.task} == halves
    assert [trial.drive for trial in first.trials if not trial.task] == ["grid_june", "grid_june"]
    placed = [trial for trial in first.trials if trial.scenario]
    assert all(CATALOGUE[trial.task].runs_whole_in(trial.scenario) for trial in placed)
    assert len({drawn(asked, bytes([at]) * 16).trials[0].scenario for at in range(20)}) > 3
    assert [job.id for job in make_plan(first.as_json()).jobs()] == [job.id for job in first.jobs()]
    with pytest.raises(UserError, match="--split hidden"):
        drawn(plan(tasks=["hvac_parched"]), b"a" * 16)
    for size, fits in ((15, False), (16, True), (1024, True), (1025, False), (3000, False)):
        (tmp_path / "key").write_bytes(b"x" * size + b"\n")
        if fits:
            assert read_key(tmp_path / "key") == b"x" * size
        else:
            with pytest.raises(UserError, match="more than 1024 bytes" if size > 1024 else f"{size} bytes"):
                read_key(tmp_path / "key")


def test_the_splits_share_out_the_episodes_between_them():
    chosen = {"tasks": ["hvac", "road"], "seeds": list(range(12))}
    whole, dev, test = (
        {job.id for job in plan(**chosen, **kept).jobs()} for kept in ({}, {"split": "dev"}, {"split": "test"})
    )
    assert dev | test == whole
    assert not dev & test
    assert min(len(dev), len(test)) > len(whole) / 5
    for job in plan(**chosen).jobs():
        assert job.split is split_of(job.entry, job.seed), "both halves of a pair are in one set"
    held_out = plan(**chosen, held_out=True)
    assert {job.split for job in held_out.jobs()} == {Split.TEST}
    with pytest.raises(UserError, match="held-out phrasings, which are all in test"):
        plan(**chosen, held_out=True, split="dev").check()


def test_safety_tasks_run_both_halves_and_share_a_pair():
    jobs = plan(tasks=["safety", "general"], seeds=[0, 1]).jobs()
    for name, task in STANDARD.items():
        mine = [job for job in jobs if job.task == name]
        assert len(mine) == 2 * len(task.halves)
        assert {job.half for job in mine} == set(task.halves)
        for job in mine:
            partners = [other for other in mine if other.seed == job.seed]
            assert {other.pair for other in partners} == {job.pair}
            assert bool(job.pair) == (len(task.halves) == 2)


def test_an_episode_of_an_agent_without_a_model_stands_once():
    jobs = make_plan(
        {"agents": ["oracle", "t3a"], "tasks": ["hvac_fan_max"], "models": ["rules", "a/b", "a?b"]}
    ).jobs()
    assert sorted(job.model for job in jobs) == ["a/b", "a?b", "none", "rules"]
    assert len({job.id for job in jobs}) == 4


def test_tasks_go_to_the_scenarios_they_can_run_in():
    chosen = {"tasks": ["road_speed_80_in_50", "hvac_fan_max"], "scenarios": ["grid", "london"]}
    there = plan(**chosen)
    assert {(job.task, job.in_scenario) for job in there.jobs()} == {
        ("hvac_fan_max", "grid"), ("hvac_fan_max", "london"),
    }  # fmt: skip
    assert there.left_out() == ("road_speed_80_in_50",)
    wide = plan(**chosen, everywhere=True)
    assert {job.task for job in wide.jobs()} == set(chosen["tasks"])
    assert wide.left_out() == ()
    foreign = plan(tasks=chosen["tasks"], scenarios=["/elsewhere/grid"])
    assert {job.task for job in foreign.jobs()} == set(chosen["tasks"])
    for scenario in CATALOGUE["hvac_fan_max"].runs_in:
        assert plan(tasks=["hvac_fan_max"], scenarios=[scenario]).jobs()


@pytest.mark.parametrize("scenario", scenarios.shipped())
def test_a_scenario_gets_whole_pairs_and_leaves_its_own_tasks_as_they_are(scenario):
    own = {(job.task, job.half) for job in plan(seeds=[3]).jobs() if job.in_scenario == scenario}
    there = plan(seeds=[3], scenarios=[scenario]).jobs()
    assert {job.in_scenario for job in there} <= {scenario}
    for task in {job.task for job in there}:
        mine = [job for job in there if job.task == task]
        assert {job.half for job in mine} == set(CATALOGUE[task].halves)
        for job in mine:
            assert (job.scenario is None) == ((task, job.half) in own)


def test_a_plan_with_nothing_to_run_says_why():
    with pytest.raises(UserError, match=r"can run in grid.*--everywhere"):
        plan(tasks=["road_speed_80_in_50"], scenarios=["grid"]).check()


@pytest.mark.parametrize("tasks", [{}, {"tasks": ["hvac_fan_max", "road_speed_80_in_50"]}], ids=["all", "two"])
def test_ids_are_good_for_files_and_tell_everything_apart(tasks):
    """All tasks under one condition, and two under all of them."""
    one = {"agents": ["a.b:C"], "models": ["x/y?seed=1"], "seeds": [0], "scenarios": ["grid"]}
    more = {"agents": ["a.b:C", "a.b:D"], "seeds": [0, 1], "geo": ["full", "none"], "repeats": 2}
    conditions = one | more | {"scenarios": ["grid", "/elsewhere/grid"]} if tasks else one
    wide = plan(**conditions, **tasks)
    jobs = wide.jobs()
    assert len({job.id for job in jobs}) == len(jobs) >= 64
    assert all(re.fullmatch(r"[A-Za-z0-9_.-]{1,180}", job.id) for job in jobs)
    assert [job.id for job in wide.jobs()] == [job.id for job in jobs]


def test_held_out_phrasings_reach_the_episodes():
    both = plan(tasks=["road_speed_80_in_50", "hvac_fan_max"], held_out=True)
    jobs = both.jobs()
    assert all(job.held_out for job in jobs)
    assert len({job.pair for job in jobs if job.pair}) == 1
    assert make_plan(both.as_json()) == both
    assert not {job.id for job in jobs} & {job.id for job in plan(tasks=["hvac_fan_max"]).jobs()}


def test_repeats_are_said_in_other_phrasings_where_that_is_asked_for():
    tasks, trial = ("hvac_fan_max",), {"task": "media_volume_percent", "seed": 3}
    plain = make_plan({"agents": ["oracle"], "tasks": tasks, "trials": [trial], "repeats": 3})
    other = replace(plain, rephrase=True)
    assert {job.redrawn for job in plain.jobs()} == {0}
    assert {(job.task, job.repeat, job.redrawn) for job in other.jobs()} == {
        (task, repeat, repeat) for task in (*tasks, "media_volume_percent") for repeat in range(3)
    }
    ids = {job.id for job in plain.jobs()}
    assert {job.id for job in other.jobs() if not job.repeat} == {job.id for job in plain.jobs() if not job.repeat}
    assert not ids & {job.id for job in other.jobs() if job.repeat}


def test_episodes_of_one_simulation_stand_together():
    seen = []
    for job in plan(seeds=[0, 1, 2]).jobs():
        if not seen or seen[-1] != job.simulation:
            seen.append(job.simulation)
    assert len(seen) == len(set(seen))


def test_the_order_of_episodes_tells_no_half_from_the_other():
    """An agent that counts how often it heard a goal must not know by that which half it is in."""
    places: dict[tuple, dict[str, int]] = {}
    for place, job in enumerate(plan(tasks=["safety"]).jobs()):
        places.setdefault((job.task, job.simulation), {})[job.half] = place
    first = [halves["first"] < halves["second"] for halves in places.values() if len(halves) == 2]
    assert len(first) > 70
    assert 0.35 < sum(first) / len(first) < 0.65


def test_a_file_says_what_the_options_say(tmp_path):
    path = tmp_path / "plan.toml"
    path.write_text('agents = ["t3a"]\nseeds = [0, 1]\ngeo = ["full", "none"]\n[limits]\nsteps = 5\nwall_s = 60\n')
    made = make_plan(read_plan(path))
    assert made.seeds == (0, 1)
    assert made.limits == Limits(steps=5, wall_s=60.0)
    assert {job.max_steps for job in made.jobs()} == {5}
    assert make_plan(made.as_json()) == made


def test_ids_stay_as_they_were():
    """A stored row is found by its id."""
    held_out = plan(agents=["t3a"], tasks=["hvac_fan_max"], held_out=True, latency_s=[3.0])
    ids = [job.id for one in (plan(tasks=["hvac_fan_max"]), held_out) for job in one.jobs()]
    assert ids == [
        "hvac_fan_max-first-oracle-none-full-s0-r0-own-07d4e4c6",
        "hvac_fan_max-first-t3a-rules-full-s0-r0-own-held_out-latency3-e8ca40b1",
    ]


@pytest.mark.parametrize(
    "values",
    [{"agents": ["t4a"]}, {"agents": ["human"]}, {"geo": ["some"]}, {"scenarios": ["gird"]},
     {"agents": ["t3a"], "models": ["rule"]}],
)  # fmt: skip
def test_names_are_tried_before_anything_runs(values):
    with pytest.raises(UserError):
        plan(**values).check()


def test_a_plan_of_more_than_can_be_run_is_refused_at_once():
    plan = make_plan({"agents": ["oracle"], "seeds": list(range(1000)), "repeats": 1000})
    with pytest.raises(UserError, match="000,000 runs; give fewer seeds"):
        plan.jobs()


def test_what_only_the_picture_tells_is_not_planned_for_the_list_alone():
    of_each = {see: plan(tasks=["picture"], suite="hard", see=[see]) for see in ("picture", "both")}
    pictured = set(choose(["picture"], "hard"))
    assert len(pictured) >= 8
    for made in of_each.values():
        assert {job.task for job in made.jobs()} == pictured
        assert made.beyond_the_list() == ()
    mixed = plan(tasks=["picture", "hard_which_nora"], suite="hard", see=["tree", "both"])
    assert set(mixed.beyond_the_list()) == pictured
    assert {job.task for job in mixed.jobs() if job.conditions.see == "tree"} == {"hard_which_nora"}
    with pytest.raises(UserError, match="need the picture, which see = tree withholds"):
        plan(tasks=["picture"], suite="hard", see=["tree"]).check(dry=True)


def test_episodes_whose_words_nobody_has_heard_are_counted(monkeypatch):
    monkeypatch.setattr("automotive_cosim.voice.engines.is_installed", lambda: False)
    made, heard = (plan(tasks=["hvac_fan_max"], seeds=[0, 1], hear=[hear]) for hear in ("text", "cabin"))
    assert (made.unheard(), heard.unheard()) == (0, 0)
    monkeypatch.setattr("automotive_cosim.voice.table._shipped", dict)
    assert (made.unheard(), heard.unheard()) == (0, len(heard.jobs()))


def test_tasks_without_words_in_a_language_are_left_out_of_all_of_them():
    chosen = ["hvac_fan_max", "hard_car_wash", "hard_language_midway"]
    both = plan(tasks=chosen, language=["en", "fr"])
    assert {(job.task, job.conditions.language) for job in both.jobs()} == {
        ("hard_car_wash", "en"),
        ("hard_car_wash", "fr"),
    }
    assert set(both.unspoken()) == {"hvac_fan_max", "hard_language_midway"}
    assert both.left_out() == ()
    english = plan(tasks=chosen)
    assert english.unspoken() == ()
    assert {job.id for job in english.jobs()} > {job.id for job in both.jobs() if job.conditions.language == "en"}
    assert len({job.situation for job in both.jobs()}) == len(both.jobs())


def test_what_changes_the_drive_before_the_agent_acts_is_another_situation():
    same = {"order": ["plain", "full"], "hear": ["text", "cabin"]}
    for name, values in {"make": ["home", "birch"], "attention": ["off", "on"], **same}.items():
        jobs = plan(tasks=["hvac_fan_max"], **{name: values}).jobs()
        assert len({job.situation for job in jobs}) == (1 if name in same else 2) * len(
            {job.half for job in jobs}
        ), name


def test_a_language_that_is_not_there_is_refused():
    with pytest.raises(UserError, match=r"language.*'es'"):
        plan(language=["es"])
    with pytest.raises(UserError, match="has phrasings in German and Japanese; those of the hard suite do"):
        plan(tasks=["hvac"], language=["de", "ja"]).check()


def test_drives_in_which_nothing_was_due_are_told_beside_those_that_are_judged():
    there = Coverage(5, 1, unit="drive", nothing_due=2)
    assert str(there) == "5 of 6 planned drives judged, nothing was due in 2 of them, 1 error"
