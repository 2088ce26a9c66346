"""What is made of the futures: choices, ties, intervals, gridlock, the effect on the others."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from automotive_cosim.contracts import EgoEnd
from automotive_cosim.errors import UserError
from automotive_cosim.studies.calls.accounts import Account, Settled, TrafficSummary
from automotive_cosim.studies.gridlock import gridlock
from automotive_cosim.studies.intervals import LEAST_SEEDS, seed_mean
from automotive_cosim.studies.reroute import compare, policies
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.everyone import gini, spread
from automotive_cosim.studies.reroute.page import answer
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.reroute.points import Diverted, Drawn, Point, compared, shows_signs
from automotive_cosim.studies.reroute.policies import best, chosen, parse_policy
from automotive_cosim.studies.reroute.results import Noise, Study, choices, noise
from automotive_cosim.studies.reroute.rows import (
    NOBODY,
    NOTHING,
    Branch,
    Decision,
    News,
    OthersTotals,
    Replicate,
    TripRow,
)
from automotive_cosim.studies.reroute.tables import outcomes, parts
from automotive_cosim.studies.reroute.trip import left_out
from automotive_cosim.studies.reroute.warnings import warnings
from automotive_cosim.traffic.base import EgoPlan
from tests.scripted.traffic import Scripted, Stretch

STAY_LOST_S = 120.0
OTHERS = OthersTotals(count=3, gain_s=4.0, changed=1, unfinished_stay=0, unfinished=0)


def branch(gain_s: float) -> Branch:
    return Branch(gains=replace(NOTHING, time_s=gain_s), totals=NOTHING, others=OTHERS)


def decision(*gains_s: float, offered_s: float | None = 80.0, delay_s: float = 70.0, **more: Any) -> Decision:
    """One whose present way is said to take 100 s, with a branch for each gain; the first is the one offered."""
    number = None if offered_s is None else 0
    news = News(age_s=0.0, stay_s=100.0, delay_s=delay_s, offered_s=offered_s, branch=number)
    made = Decision(
        at_s=900.0,
        edge="a",
        delay_s=delay_s,
        eta_s=100.0,
        relative_speed=0.5,
        news=(news,),
        own=None,
        agents={},
        agents_rerouted=(),
        branches=tuple(branch(gain_s) for gain_s in gains_s),
    )
    return replace(made, **more)


def drive(*decisions: Decision, seed: int = 0) -> TripRow:
    return TripRow(
        id=f"d{seed}",
        scenario="grid",
        share=0.5,
        seed=seed,
        departure_s=0.0,
        trip="avenue",
        stay=replace(NOTHING, time_s=200.0, lost_s=STAY_LOST_S),
        decisions=decisions,
    )


@pytest.mark.parametrize(
    ("policy", "row", "expected"),
    [
        ("never", decision(30.0), None),
        ("always", decision(-30.0, offered_s=130.0), 0),
        ("always", decision(5.0, offered_s=None), None),
        ("delay:60", decision(-30.0), 0),
        ("delay:90", decision(30.0), None),
        ("delay:60", decision(30.0, offered_s=101.0), None),
        ("worthwhile:1.2:20", decision(-30.0), 0),
        ("worthwhile:1.3:20", decision(30.0), None),
        ("worthwhile:1.2:21", decision(30.0), None),
        ("worthwhile:1:0", decision(30.0, offered_s=100.0), None),
        ("sumo", decision(30.0, 2.0, own=1), 1),
        ("sumo", decision(30.0), None),
        ("agent:asurada", decision(30.0, 2.0, agents={"asurada": 1}), 1),
        ("best", decision(30.0, 31.0), 1),
        ("best", decision(-1.0, 0.0), None),
        ("always", decision(30.0, complies_above=1.0), None),
    ],
)
def test_who_chooses_what(policy: str, row: Decision, expected: int | None) -> None:
    assert chosen(parse_policy(policy), row, 0.0) == expected


@pytest.mark.parametrize(
    "text", ["alway", "delay:", "delay:-1", "delay:nan", "agent:", "rule", "worthwhile:1.2", "worthwhile:0.9:60"]
)
def test_a_policy_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(UserError, match=text.partition(":")[0]):
        parse_policy(text)


def test_nobody_beats_hindsight() -> None:
    """Over every pair of gains: whatever a policy chooses, what it regrets is what hindsight gains over it."""
    for gains in product((-20.0, 0.0, 15.0), repeat=2):
        row = decision(*gains, own=1)
        for each in choices([drive(row)], ("never", "always", "delay:60", "sumo", "best")):
            assert each.regret_s == max(0.0, *gains) - each.gain.time_s >= 0
            assert each.policy != "best" or each.regret_s == 0
        number = best(row)
        assert (0.0 if number is None else gains[number]) == max(0.0, *gains)


def drawn(*draws: tuple[float, ...], **more: Any) -> Decision:
    """A decision whose branches gain this in each draw."""
    again = [
        Replicate(seed=number, stay=branch(0.0), branches=tuple(map(branch, gains_s)))
        for number, gains_s in enumerate(draws[1:], start=1)
    ]
    return decision(*draws[0], replicates=tuple(again), **more)


def test_hindsight_is_chosen_by_the_other_draws() -> None:
    """Two branches that win once each by luck gain nothing; as single draws they would gain every time."""
    lucky = drawn((30.0, -30.0), (-30.0, 30.0))
    assert [policies.hindsight(lucky), best(lucky)] == [(1, 0), None]
    (each,) = choices([drive(lucky)], ("best",))
    assert (each.gain.time_s, each.regret_s, each.draws) == (-30.0, 0.0, 2)
    (sure,) = choices([drive(drawn((30.0, 10.0), (20.0, 0.0), (40.0, 90.0)))], ("best",))
    assert sure.gain.time_s == pytest.approx((10 + 0 + 40) / 3, abs=1e-3), "the third draw misleads the first two"
    (stay,) = choices([drive(drawn((30.0,), (20.0,), (40.0,)))], ("never",))
    assert (stay.gain, stay.regret_s, stay.chose_best) == (NOTHING, 30.0, 0.0)


def test_every_figure_is_the_mean_over_the_draws() -> None:
    (each,) = choices([drive(drawn((30.0,), (-10.0,), (40.0,)))], ("always",))
    assert each.gain.time_s == 20.0
    assert each.gain_error_s == pytest.approx(np.std([30, -10, 40], ddof=1) / np.sqrt(3), abs=1e-3)
    assert (each.won, each.lost) == (2 / 3, 0.0), "the loss is not confirmed by the others"
    assert (each.others_gain_s, each.others) == (4.0, 3)
    assert outcomes([each, each, each], Noise(0, 0.0, 0.0)) == pytest.approx((2, 1, 0))


def test_an_agent_that_keeps_the_route_chooses_what_never_does() -> None:
    """Its branch has a number of its own, but is the kept route; where that is the best, both have chosen it."""
    row = drawn((-30.0, 0.0), (-20.0, 0.0), (-10.0, 0.0), agents={"idle": 1})
    never, agent, always = choices([drive(row)], ("never", "agent:idle", "always"))
    assert (never.chose_best, agent.chose_best, always.chose_best) == (1, 1, 0)
    assert not agent.rerouted


def test_draws_that_were_added_for_the_sign_are_in_no_mean() -> None:
    """Added until the mean shows its sign, they would move it away from zero; they choose and tell the sign."""
    more = drawn((10.0,), (-4.0,), (90.0,), (90.0,), planned_draws=2)
    (each,) = choices([drive(more)], ("always",))
    assert (each.gain.time_s, each.draws) == (3.0, 4)
    assert (each.won, each.lost) == (0.5, 0.0)
    assert each.gain_error_s == pytest.approx(np.std([10, -4, 90, 90], ddof=1) / 2, abs=1e-3)
    (best_of,) = choices([drive(more)], ("best",))
    assert best_of.gain.time_s == 3.0, "all others choose the branch for both scored draws"
    rng = np.random.default_rng(0)
    means = []
    for _ in range(400):
        gains_s = list(rng.normal(8.0, 20.0, 5))
        while len(gains_s) < 14 and abs(np.mean(gains_s)) < 2 * np.std(gains_s, ddof=1) / len(gains_s) ** 0.5:
            gains_s.append(rng.normal(8.0, 20.0))
        row = drawn(*((float(gain_s),) for gain_s in gains_s), planned_draws=5)
        means.append(row.gains(0).time_s)
    assert abs(np.mean(means) - 8.0) < 3 * 20 / np.sqrt(5 * 400)


def test_one_draw_is_judged_by_the_noise_floor() -> None:
    (each,) = choices([drive(decision(30.0))], ("always",))
    assert (each.draws, each.won, each.lost, each.chose_best, each.gain_error_s) == (1, None, None, None, None)


@pytest.mark.slow
def test_cross_fitted_hindsight_is_unbiased_where_single_draws_gain_by_luck() -> None:
    """Keeping the route and both branches are equally good: nothing can be gained."""
    rng = np.random.default_rng(3)
    single, fitted = [], []
    for _ in range(2000):
        gains = [tuple(map(float, rng.normal(0, 10, 2) - rng.normal(0, 10))) for _ in range(4)]
        (one,) = choices([drive(drawn(gains[0]))], ("best",))
        (many,) = choices([drive(drawn(*gains))], ("best",))
        single.append(one.gain.time_s)
        fitted.append(many.gain.time_s)
    assert np.mean(single) > 5
    assert abs(np.mean(fitted)) < 3 * np.std(fitted) / np.sqrt(len(fitted))


def test_replicates_end_where_the_sign_shows() -> None:
    def shows(*gains_s: float) -> bool:
        return shows_signs([Drawn(0, future(900.0), [later(-gain_s)]) for gain_s in gains_s])

    assert shows(20.0, 22.0, 19.0, 25.0)
    assert shows(-20.0, -22.0, -19.0, -25.0)
    assert not shows(20.0, -22.0, 19.0, -25.0)
    assert shows(0.0, 0.0, 0.0, 0.0), "an agent that kept the route"


def later(seconds: float) -> Future:
    made = future(900.0)
    return replace(made, last=replace(made.last, time_s=made.last.time_s + seconds))


def test_who_stays_changes_nothing() -> None:
    (each,) = choices([drive(decision(30.0))], ("never",))
    assert not each.rerouted
    assert each.gain == NOTHING
    assert each.others_gain_s == 0
    assert each.stay.time_s == 200


def test_what_does_not_count_is_in_no_choice() -> None:
    rows = [drive(decision(30.0), decision(500.0, excluded="gridlock"))]
    assert [each.gain.time_s for each in choices(rows, ("always",))] == [30.0]


def test_gains_up_to_what_the_placebos_change_are_ties() -> None:
    placebos = [decision(0.0, placebo=branch(change)) for change in (-8.0, 1.0, 2.0, 0.0)]
    floor = noise([*placebos, decision(99.0)])
    assert floor.placebos == 4
    assert floor.time_s == pytest.approx(np.quantile([8, 1, 2, 0], 0.95))
    rows = [drive(*(decision(gain) for gain in (floor.time_s, -floor.time_s, 7.2, -7.2, 0.0)))]
    assert outcomes(list(choices(rows, ("always",))), floor) == (1, 3, 1)
    assert noise([decision(1.0)]).time_s == 0


def parted(gain_s: float, avoided_s: float, lost_s: float) -> Decision:
    """One whose kept route loses that time, and whose branch avoids some of it."""
    gains = replace(NOTHING, time_s=gain_s, lost_s=avoided_s)
    return replace(
        decision(0.0),
        branches=(replace(branch(0.0), gains=gains),),
        lost_s=STAY_LOST_S - lost_s,
        placebo=branch(3.0),
    )


def study(rows: Sequence[TripRow], **more: Any) -> Study:
    """Of the grid at its own steps, one drive a seed."""
    more = {"departures_s": (0.0,), "trips": ("avenue",), "seeds": range(len({row.seed for row in rows}))} | more
    return Study(Path(), {}, StudyPlan("grid", step_s=0.1, policies=("never", "always"), **more), tuple(rows))


def seeds(count: int, made: Decision, **more: Any) -> list[TripRow]:
    return [replace(drive(made, seed=seed), trip=f"t{seed % 2}", **more) for seed in range(count)]


def test_a_gain_is_congestion_avoided_and_way_saved() -> None:
    rows = seeds(30, parted(50.0, 80.0, 90.0))
    for each in choices(rows, ("always",)):
        assert (each.gain.lost_s, each.gain.way_s, each.lost_ahead_s) == (80.0, -30.0, 90.0)
    table = parts(study(rows))
    assert [cell.split(" ")[0] for cell in map(str, table.rows[0][3:6])] == ["+50.0", "+80.0", "−30.0"]
    assert answer(study(rows)).startswith(
        "Rerouting by “always” saves 50 s (50 to 50) a decision, as 80 s less is lost in congestion and the route "
        "itself takes 30 s more, against keeping the route, over"
    )
    old = replace(drive(decision(50.0)), stay=replace(NOTHING, lost_s=None))
    assert not parts(study([old])).rows, "rows of earlier versions do not say"


def test_a_policy_that_rerouted_nowhere_is_not_the_best() -> None:
    """At a delay of 90 s, one that waits for 600 s does nothing, which costs less than a long way round."""
    rows = seeds(30, parted(-50.0, 10.0, 90.0))
    found = study(rows)
    plan = replace(found.plan, policies=("never", "always", "delay:600"))
    told = answer(replace(found, plan=plan))
    assert told.startswith("Rerouting by “always” costs 50 s")
    assert told.endswith("; “delay:600” rerouted nowhere.")
    alone = replace(found, plan=replace(found.plan, policies=("never", "delay:600")))
    assert answer(alone) == "“delay:600” rerouted nowhere."


def test_the_answer_names_a_policy_to_follow_at_every_share_of_rerouting_cars() -> None:
    """``best`` knows the futures; a share at which a policy costs time is in the sentence too."""
    rows = [
        replace(each, share=share)
        for share, gain_s in ((0.0, -10.8), (0.5, 10.1))
        for each in seeds(30, parted(gain_s, 20.0, 90.0))
    ]
    found = study(rows)
    plan = replace(found.plan, policies=("never", "always", "best"), shares=(0.0, 0.5))
    assert answer(replace(found, plan=plan)).startswith(
        "Rerouting by “always” costs 11 s (11 to 11) a decision with 0% of the other cars rerouting and saves "
        "10 s (10 to 10) a decision with 50% of the other cars rerouting, against "
        "keeping the route, over 60 decisions of 30 seeds"
    )


def test_a_route_leaves_out_what_is_ahead_and_not_what_is_behind() -> None:
    route = ("a", "b", "c", "d", "goal")
    assert left_out(route, ("a", "x", "d", "goal"), ("c", "d", "goal")) == ["c"]
    assert left_out(route, ("d", "goal"), ("c", "d", "goal")) == [], "it has driven past it"
    assert left_out(route, ("b", "elsewhere"), ("b", "goal")) == ["goal"]
    assert left_out(route, ("x", "goal"), ("behind", "goal")) == []


FINE = parted(50.0, 60.0, 90.0)


@pytest.mark.parametrize(
    ("found", "told"),
    [
        (study(seeds(30, FINE)), None),
        (study([]), "No decision counted"),
        (study(seeds(12, FINE), seeds=range(20)), "8 of 20 drives are missing"),
        (study(seeds(12, FINE)), "12 seeds have a decision: run 30"),
        (study(seeds(9, FINE)), "9 seeds have a decision: confidence intervals need 10"),
        (
            study([*seeds(30, FINE), *seeds(9, FINE, share=0.0), replace(drive(seed=9), share=0.0)]),
            "9 of 10 seeds, where 0% of the others reroute, have a decision: confidence intervals",
        ),
        (study(seeds(30, parted(142.0, 20.0, 36.0))), "more than the 36 s that the kept route lost"),
        (
            study([replace(row, trip="round") for row in seeds(30, FINE)]),
            "All 30 decisions come from one trip, “round”",
        ),
        (study(seeds(30, replace(FINE, placebo=None))), "There is no placebo"),
        (
            study(seeds(30, replace(FINE, placebo=Branch(gains=NOTHING, totals=NOTHING, others=NOBODY)))),
            "30 placebos with fresh random numbers moved nothing",
        ),
        (
            replace(study(seeds(30, FINE)), plan=StudyPlan("grid")),
            "Driven at steps of 1 s, while the scenario's own",
        ),
    ],
)
def test_a_study_warns_of_what_its_figures_hide(found: Study, told: str | None) -> None:
    said = warnings(found)
    assert [each for each in said if told and told in each] if told else not said
    assert len(said) <= 2, "of nothing else, but for the shape of the case"


@pytest.mark.slow
def test_intervals_take_the_seeds_as_what_is_independent() -> None:
    """Repeating every decision of a seed adds nothing; and the true mean lies within about as often as it says."""
    rng = np.random.default_rng(1)
    once = [(seed, float(rng.normal(seed % 3, 1))) for seed in range(20)]
    one, many = seed_mean(once), seed_mean(once * 7)
    assert one is not None
    assert many is not None
    assert one.interval is not None
    assert many.interval is not None
    assert (many.interval.low, many.interval.high) == pytest.approx((one.interval.low, one.interval.high))
    assert (many.count, many.seeds) == (140, 20)
    covered = resampled = 0
    for _ in range(400):
        drawn = [
            (seed, float(shift + rng.normal(0, 1)))
            for seed, shift in enumerate(rng.normal(5, 2, 10))
            for _ in range(4)
        ]
        mean = seed_mean(drawn)
        assert mean is not None
        assert mean.interval is not None
        assert mean.resampled is not None
        covered += mean.interval.low <= 5 <= mean.interval.high
        resampled += mean.resampled.low <= 5 <= mean.resampled.high
    assert 0.93 <= covered / 400 <= 0.97
    assert resampled < covered


def test_too_few_seeds_have_no_interval() -> None:
    few = seed_mean((seed, 1.0) for seed in range(LEAST_SEEDS - 1))
    assert few is not None
    assert few.interval is None
    assert seed_mean([]) is None


FLOWING = TrafficSummary(1000.0, 400, 40, 0, 5, 1000, 2)


@pytest.mark.parametrize(
    ("summaries", "word"),
    [
        ([FLOWING], ""),
        ([replace(FLOWING, stuck=20)], ""),
        ([replace(FLOWING, stuck=21)], "waiting for long"),
        ([replace(FLOWING, teleported=10)], ""),
        ([replace(FLOWING, teleported=11)], "teleports"),
        ([replace(FLOWING, halted=201)] * 2, "standing"),
        ([replace(FLOWING, halted=201), FLOWING, replace(FLOWING, halted=201)], ""),
        ([replace(FLOWING, halted=200)] * 9, ""),
        ([replace(FLOWING, backlog=count) for count in (10, 200, 3000)], ""),
        ([replace(FLOWING, running=55, backlog=8, stuck=2)], ""),
        ([replace(FLOWING, running=3, halted=3)] * 5, ""),
        ([], ""),
    ],
)
def test_gridlock_is_seen(summaries: list[TrafficSummary], word: str) -> None:
    found = gridlock(summaries)
    assert (found.rule if found else "").startswith(word) if word else found is None


def future(until_s: float, **arrivals_s: float) -> Future:
    state = Scripted([Stretch()]).depart(EgoPlan(trip=None)).state  # type: ignore[arg-type]
    return Future(state, Settled(until_s, True, arrivals_s, Account(0.0, 0, 0.0, 0.0, 0.0), FLOWING))


def test_who_has_not_arrived_is_not_forgotten() -> None:
    """Whoever is late in only one of the futures counts there up to the instant both are known until."""
    stay, other = future(500.0, a=100.0, b=200.0, d=480.0), future(400.0, a=90.0, c=300.0)
    found = compare.others(stay, other, ["a", "b", "c", "d"])
    assert found.gain_s == (100 - 90) + (200 - 400) + (400 - 300) + (400 - 400)
    assert (found.unfinished_stay, found.unfinished) == (2, 2)
    assert (found.count, found.changed) == (4, 3)
    back = compare.others(other, stay, ["a", "b", "c", "d"])
    assert back.gain_s == -found.gain_s


def test_everyone_counts_once_and_the_classes_add_up() -> None:
    """The ego gains 50 s; of three others one gains 40 s, one loses 20 s, one has not arrived in either."""
    stay, other = future(1000.0, a=200.0, b=700.0), future(1000.0, a=220.0, b=660.0)
    found = spread([(ends(stay, 450.0), ends(other, 400.0))], ["a", "b", "c"], at_s=100.0)
    assert (found.count, found.earlier, found.later) == (4, 2, 1)
    assert found.mean_s == pytest.approx((50 - 20 + 40 + 0) / 4)
    assert sum(each.count for each in found.trips) == 4
    assert sum(each.gain_s for each in found.trips) == pytest.approx(70.0)
    assert {each.from_s: (each.count, each.later) for each in found.trips} == {0: (1, 1), 300: (1, 0), 600: (2, 0)}
    assert found.low_s <= found.lower_s <= found.median_s <= found.upper_s <= found.high_s
    assert found.gini_stay == pytest.approx(gini(np.array([350.0, 100.0, 600.0, 900.0])), abs=1e-4)


def test_everyone_is_the_mean_over_the_draws() -> None:
    """What one draw gains the other loses again: nobody gains."""
    one, two = ends(future(900.0, a=200.0), 300.0), ends(future(900.0, a=260.0), 340.0)
    found = spread([(one, two), (two, one)], ["a"], at_s=100.0)
    assert (found.mean_s, found.low_s, found.high_s, found.later) == (0, 0, 0, 0)
    assert found.gini == found.gini_stay


def test_a_horizon_ends_when_the_first_future_has_that_share_home() -> None:
    group = [f"v{number}" for number in range(10)]
    stay = future(990.0, **{name: 500.0 + 10 * number for number, name in enumerate(group)})
    slow = future(990.0, **{name: 505.0 + 10 * number for number, name in enumerate(group[:9])})
    gains = {each.share: each.gain_s for each in spread([(stay, slow)], group, at_s=400.0).horizons}
    assert gains[0.9] == pytest.approx(-5.0 * 8), "up to 580 s, when the ninth is home, and the last never differs"
    assert gains[0.99] == pytest.approx(-5.0 * 9)
    early = future(560.0, **{name: 505.0 + 10 * number for number, name in enumerate(group[:5])})
    assert {each.gain_s for each in spread([(early, early)], group, at_s=400.0).horizons} == {None}


@pytest.mark.parametrize(("values", "expected"), [([3.0] * 5, 0.0), ([0.0, 0.0, 0.0, 8.0], 0.75), ([0.0], 0.0)])
def test_gini(values: list[float], expected: float) -> None:
    assert gini(np.array(values)) == pytest.approx(expected)


def test_many_cars_that_jam_leave_the_decision_itself_in() -> None:
    """Sending everybody along ends in a gridlock: that future does not count, and the decision does."""
    good = ends(future(900.0, a=200.0), 450.0)
    jammed = replace(good, settled=replace(good.settled, summary=replace(FLOWING, stuck=200)))
    late = replace(good, settled=replace(good.settled, is_complete=False))
    sent = [Diverted(share, 0, made, ("a",), 1) for share, made in ((0.0, good), (0.5, late), (1.0, jammed))]
    point = Point(decision(), ("a",), FLOWING, [ends(future(900.0, a=190.0), 400.0)], together=sent)
    found = compared(point, good, [])
    assert found.excluded == ""
    assert found.branches[0].gains.time_s == 50
    assert [each.excluded for each in found.together] == ["", "traffic did not clear", ""]
    jam = compared(replace(point, together=[]), jammed, [])
    assert jam.excluded == "gridlock: waiting for long"


def ends(made: Future, at_s: float) -> Future:
    return replace(made, last=replace(made.last, time_s=at_s, end=EgoEnd.ARRIVED))


def test_drives_have_names_of_their_own_and_the_share_draws_nothing() -> None:
    jobs = StudyPlan("grid", shares=(0.0, 0.5)).jobs()
    assert len({job.id for job in jobs}) == len(jobs) == 4 * 3 * 10 * 2
    assert len({job.entropy for job in jobs}) == len(jobs) / 2
