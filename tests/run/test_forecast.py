"""What a plan is expected to cost."""

from dataclasses import replace

import pytest

from automotive_cosim.run.forecast import asks, expected, forecast
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.settings import Budget
from automotive_cosim.run.trial import WARM_UP_S, WARM_UPS_S
from automotive_cosim.scenarios import shipped

PRICED = "nowhere/m?usd_per_million_in=2&usd_per_million_out=8"
GRID = {"tasks": ["hvac_fan_max", "hvac_driver_seat_heater"], "scenarios": ["grid"], "seeds": [0, 1]}


def jobs(**values):
    return make_plan({"agents": ["t3a"], "models": [PRICED], **GRID, **values}).jobs()


def judged(each, tokens_in=1000, tokens_out=100):
    return [replace(job.planned(), success=True, tokens_in=tokens_in, tokens_out=tokens_out) for job in each]


@pytest.mark.parametrize("model", ["rules", "replay/t3a", "none"])
def test_what_needs_no_endpoint_costs_nothing(model):
    assert not asks(model)
    needs = forecast(jobs(models=["rules"]), 2)
    assert (needs.tokens.high, needs.usd.high, needs.asks_models) == (0, 0, False)
    assert 0 < needs.wall_s.low < needs.wall_s.high


def test_a_model_costs_its_price():
    whole = jobs()
    needs, each = forecast(whole, 1), [expected(job) for job in whole]
    assert needs.runs == len(whole) == 4
    assert needs.tokens.low <= sum(one.sent + one.received for one in each) <= needs.tokens.high
    assert needs.usd.low <= sum(one.sent * 2 + one.received * 8 for one in each) / 1e6 <= needs.usd.high


def test_its_own_trials_narrow_the_range_and_are_not_counted_again():
    whole = jobs()
    needs = forecast(whole, 1, judged(whole[:3]))
    assert needs.runs == 1
    assert needs.tokens.low <= 1100 <= needs.tokens.high < 2 * needs.tokens.low
    again = [replace(row, error="broken", success=None) for row in judged(whole)]
    assert forecast(whole, 1, again).runs == 4, "errors are run again"


def test_more_trials_never_cost_less():
    few, more = forecast(jobs(seeds=[0]), 1), forecast(jobs(seeds=[0, 1, 2]), 1)
    assert few.tokens.high < more.tokens.high
    assert few.wall_s.high < more.wall_s.high


def test_drives_and_pictures_cost_more():
    episode, drive = jobs()[0], jobs(tasks=[], scenarios=[], drives=["grid_june"], seeds=[0])[0]
    assert expected(drive).sent > 10 * expected(episode).sent
    seen, listed = (jobs(agents=["m3a"], see=[see])[0] for see in ("both", "tree"))
    assert expected(seen).sent > expected(listed).sent


@pytest.mark.parametrize(
    ("budget", "words"),
    [
        (Budget(tokens=10**12), ""),
        (Budget(tokens=1), "the budget of 1 tokens is less than"),
        (Budget(usd=0.01), "the budget of $0.01 is less than"),
        (Budget(), ""),
    ],
)
def test_a_budget_is_held_against_it(budget, words):
    told = forecast(jobs(), 1).beyond(budget)
    assert words in told
    assert bool(told) == bool(words)


def test_every_shipped_scenario_has_its_own_warm_up():
    assert set(WARM_UPS_S) == set(shipped())
    assert all(0 < seconds < WARM_UP_S for seconds in WARM_UPS_S.values())


def test_the_readmes_evaluation_takes_what_was_forecast():
    """Two warm-ups of Paris and two of a small place, which took 53 s on two shared cores."""
    plan = {"agents": ["t3a", "asurada"], "tasks": ["road_speed_80_in_50", "hvac_fan_max"], "seeds": [0, 1]}
    whole = make_plan(plan).jobs()
    needs = forecast(whole, 1)
    assert needs.wall_s.low < 36 < 53 < needs.wall_s.high
    small, large = (
        {job.warm_up_weight for job in whole if job.in_scenario == name} for name in ("beauce", "paris_centre")
    )
    assert max(small) < min(large) / 2
