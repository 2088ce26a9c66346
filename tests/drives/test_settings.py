"""What of a drive can be set, and plans with single trials."""

import pytest

from automotive_cosim.drives.departure import scenario_of
from automotive_cosim.drives.families import FAMILIES, family_named
from automotive_cosim.drives.script import read_script, script_json
from automotive_cosim.drives.settings import AS_SCRIPTED, DriveSettings
from automotive_cosim.drives.staging import ON_REQUEST
from automotive_cosim.errors import UserError
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.plan import make_plan

SETTINGS = DriveSettings(22.5, 80.0, None, 3.0, 0.5, "hurried", 90.0)


def test_settings_change_what_they_say_in_every_family() -> None:
    for family in FAMILIES:
        drawn = family_named(family).draw(3)
        made = SETTINGS.applied(drawn)
        assert made.start == f"{drawn.start[:10]}T22:30:00"
        assert max(each.weather.visibility for each in made.weather) <= 80.0
        assert {each.weather.temperature_2m for each in made.weather} == {3.0}
        assert (made.density, made.driver, made.driven_s) == (0.5, "hurried", 5400.0)
        assert made.staged == drawn.staged
        assert read_script(script_json(made)) == made
        assert AS_SCRIPTED.applied(drawn) == drawn


def test_a_coarse_drive_runs_in_steps_of_a_second_and_has_another_name() -> None:
    drawn = family_named("grid_june").draw(0)
    settings = DriveSettings(coarse=True)
    made = settings.applied(drawn)
    sumo = scenario_of(made).sumo
    assert (sumo.step_length_s, sumo.action_step_length_s) == (1.0, 1.0)
    assert scenario_of(drawn).sumo.step_length_s == 0.1
    assert read_script(script_json(made)) == made
    assert "coarse" not in script_json(drawn)
    assert settings.tags == ("coarseon",)


def test_rain_only_adds() -> None:
    drawn = family_named("grid_june").draw(0)
    made = DriveSettings(rain_mm_h=10.0).applied(drawn)
    assert all(each.weather.precipitation >= 10.0 for each in made.weather)
    assert all(51 <= each.weather.weather_code <= 99 for each in made.weather)


def test_one_thing_is_staged_instead_of_all_others() -> None:
    for number, kind in enumerate(("nothing", *ON_REQUEST)):
        drawn = family_named("autobahn_july").draw(number)
        made = DriveSettings(stage=kind, stage_s=90.0, ahead_m=700.0, aboard="child").applied(drawn)
        assert [(one.kind, one.at_s) for one in made.staged] == ([] if kind == "nothing" else [(kind, 90.0)])
        assert [(one.seat, one.kind) for one in made.aboard] == [("rear_right", "child")]
        assert all(each.from_s == 90.0 for each in made.incidents)
        assert made.weather[0].at_s == 0
        assert made.weather[0].weather == drawn.weather[0].weather
        assert (made.start, made.trips, made.arrivals) == (drawn.start, drawn.trips, drawn.arrivals)
        assert read_script(script_json(made)) == made
        causes = (*made.moods, *made.halts, *made.changes, *made.incidents, *made.weather[1:])
        assert bool(causes or made.driven_s) == (kind != "nothing")
    (ahead,) = DriveSettings(stage="breakdown", ahead_m=700.0).applied(drawn).incidents
    assert ahead.ahead_m == 700.0
    assert DriveSettings(aboard="nobody").applied(drawn).aboard == ()
    assert DriveSettings(aboard="nobody").applied(drawn).staged == drawn.staged


def test_settings_name_another_drive() -> None:
    plain, other = (DriveSetup("grid_june", 1, settings=each) for each in (AS_SCRIPTED, SETTINGS))
    assert plain.id != other.id
    assert plain.instance != other.instance
    assert other.planned().settings == SETTINGS


def test_a_plan_lists_single_trials() -> None:
    trials = [
        {"drive": "grid_june", "seed": 2, "settings": {"hour": 22}},
        {"task": "road_speed_80_in_50", "half": "second", "conditions": {"latency_s": 4}},
    ]
    plan = make_plan({"agents": ["oracle"], "trials": trials})
    drive, task = sorted(plan.jobs(), key=lambda job: type(job).__name__)
    assert isinstance(drive, DriveSetup)
    assert drive.settings == DriveSettings(hour=22)
    assert task.conditions.latency_s == 4
    assert "trials" not in make_plan({"agents": ["oracle"]}).as_json()


@pytest.mark.parametrize(
    ("trial", "error"),
    [
        ({}, "names a task or a drive"),
        ({"task": "hvac_fan_max", "settings": {"hour": 3}}, "hour 3 can be set for drives alone"),
        ({"task": "hvac_fan_max", "conditions": {"language": "ja"}}, "no phrasings in Japanese"),
        ({"drive": "grid_june", "settings": {"hour": 30}}, "hour"),
        ({"drive": "grid_june", "settings": {"driver": "huried"}}, "did you mean 'hurried'"),
    ],
)
def test_a_wrong_trial_is_refused_in_a_line(trial: dict[str, object], error: str) -> None:
    with pytest.raises(UserError, match=error):
        make_plan({"agents": ["oracle"], "trials": [trial]}).jobs()
