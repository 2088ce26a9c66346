"""The search: samplers, minimal failures, findings, and the space's file."""

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from numpy.random import default_rng

from automotive_cosim.cli.search import too_many
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, JudgedEvent, Worth
from automotive_cosim.drives.score import together
from automotive_cosim.drives.staging import BRINGS, ON_REQUEST
from automotive_cosim.errors import BudgetSpentError, UserError
from automotive_cosim.report.stats import upper_bound
from automotive_cosim.run.budget import Meter, Spent
from automotive_cosim.run.plan import make_plan, read_plan
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.run.settings import Budget
from automotive_cosim.safety.budget import SearchBudget, SearchLimit, progress_in_words
from automotive_cosim.safety.findings import as_json, coverage, prevented, sensitivity, sentence, tables, unseen
from automotive_cosim.safety.hunt import REPEATS, Hunt, Phase, blame, hunt, try_carefully
from automotive_cosim.safety.objective import TriedOutcome, outcome_of
from automotive_cosim.safety.page import curves, means, regression_plan
from automotive_cosim.safety.samplers import SAMPLERS, RandomSampler, even_points, make_sampler
from automotive_cosim.safety.space import (
    FACTORS,
    FactorChoices,
    FactorRange,
    FailureRule,
    SearchPoint,
    Space,
    label_of,
    read_space,
    said,
    space_file,
)

SPACE = Space(
    (
        FactorChoices("drive", ("grid_june", "grid_january")),
        FactorChoices("driver", ("average", "hurried", "calm")),
        FactorRange("visibility_m", 40.0, 10_000.0, 10_000.0, logarithmic=True),
        FactorRange("hour", 6.0, 22.0, 12.0),
        FactorRange("seed", 0, 99, 0, whole=True),
    )
)


def margin(point: SearchPoint) -> float:
    """Below 0 if a hurried driver goes through fog of less than 200 m."""
    late = 0.6 if point["driver"] == "hurried" else 0.0
    return (float(point["visibility_m"]) - 200) / 10_000 + 0.6 - late


def judged(of: Callable[[SearchPoint], float]) -> Callable[[SearchPoint, int], TriedOutcome]:
    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        return TriedOutcome(of(point), of(point) < 0, "late", f"trial {sorted(point.items())} {repeat}")

    return evaluate


def searched(sampler: str = "climb", budget: int = 64, of: Callable[[SearchPoint], float] = margin) -> Hunt:
    return hunt(SPACE, judged(of), make_sampler(sampler, SPACE, budget, 1), budget)


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_a_sampler_stays_in_the_space_and_repeats_itself(sampler: str) -> None:
    for package in {"cma": ["cma"], "bayes": ["optuna"], "sobol": ["scipy"]}.get(sampler, []):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            pytest.importorskip(package)
    asked = []
    for _ in range(2):
        chooses = make_sampler(sampler, SPACE, 24, 5)
        points = []
        for _ in range(30):
            point, _ = chooses.ask()
            chooses.tell(point, margin(point))
            points.append(dict(point))
        asked.append(points)
    assert asked[0] == asked[1]
    assert all(0 <= SPACE.factor(name).unit(value) <= 1 for point in asked[0] for name, value in point.items())
    assert len({point["driver"] for point in asked[0]}) > 1


def test_a_failure_is_repeated_and_made_small() -> None:
    found = searched()
    (minimal,) = found.minimal
    assert minimal.changed == ("driver", "visibility_m")
    assert minimal.point["driver"] == "hurried"
    assert margin(minimal.point) < 0 <= margin(minimal.neighbour or {})
    differing = [name for name in minimal.point if minimal.point[name] != (minimal.neighbour or {})[name]]
    assert differing == [minimal.differs] == ["visibility_m"]
    assert 100 < float(minimal.point["visibility_m"]) < 200
    assert minimal.words(SPACE).startswith("driver hurried and visibility at most ")
    assert minimal.words(SPACE).endswith(" m")
    repeats = [each.repeat for each in found.tried if each.phase is Phase.REPEAT and each.point == minimal.point]
    assert repeats == list(range(1, REPEATS))
    assert found.run == 64


def test_a_search_passes_with_as_many_failures_as_are_allowed() -> None:
    found = searched()
    failed = as_json(found)["failed"]
    assert failed > 0
    assert too_many(found, failed) == ""
    assert (
        too_many(found, failed - 1)
        == f"{failed} of 64 runs in which something was due failed, more than {failed - 1}"
    )


def test_nothing_is_found_where_nothing_fails() -> None:
    found = searched(of=lambda point: 0.5)
    assert too_many(found, 0) == ""
    assert not found.minimal
    bound = unseen(found)
    assert bound.failed == 0
    assert bound.upper == pytest.approx(3 / bound.even, rel=0.25)


def test_what_fails_only_once_is_no_failure() -> None:
    def flaky(point: SearchPoint, repeat: int) -> TriedOutcome:
        wrong = point != SPACE.nominal and repeat == 0
        return TriedOutcome(-0.5 if wrong else 0.5, wrong, "late")

    found = hunt(SPACE, flaky, make_sampler("random", SPACE, 3, 0), 3)
    assert not found.minimal
    assert len(found.unsteady) == 3


@pytest.mark.parametrize("odd", [0, 1])
def test_neither_a_minimal_failure_nor_what_is_beside_it_is_chance(odd: int) -> None:
    """Between 100 and 400 m, every second point fails at first and never again, the others the other way round."""

    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        seen_m = float(point["visibility_m"])
        is_chance = 100 < seen_m < 400
        fails = (round(seen_m) % 2 == odd) == (repeat == 0) if is_chance else seen_m <= 100
        return TriedOutcome(-0.5 if fails else 0.5, fails, "late", "t")

    found = hunt(SPACE, evaluate, make_sampler("climb", SPACE, 64, 1), 64)
    assert found.minimal
    for each in found.minimal:
        assert each.neighbour is not None
        assert each.neighbour_passes
        for repeat in range(REPEATS):
            assert evaluate(each.point, repeat).failed
            assert evaluate(each.neighbour, repeat).passed


def test_a_nominal_point_that_fails_is_a_finding_with_what_passes_beside_it() -> None:
    found = searched(of=lambda point: -0.5 if point["driver"] == "average" else 0.5)
    (minimal,) = found.minimal
    assert (minimal.point, minimal.changed, minimal.words(SPACE)) == (SPACE.nominal, (), "everything nominal")
    assert minimal.differs == "driver"
    assert minimal.beside in ("passes with driver calm", "passes with driver hurried")
    assert all(minimal.covers(SPACE, each.point) for each in found.samples if each.outcome.failed)
    assert too_many(found, 64) == "it fails with everything nominal"
    assert sentence(found, "me").startswith("me fails with everything nominal. Beside that, me failed in ")
    (alone,) = searched(of=lambda point: -1.0).minimal
    assert (alone.neighbour, alone.beside) == (None, "")
    with pytest.raises(UserError, match="the nominal combination is not judged"):
        hunt(SPACE, lambda *_: TriedOutcome(None, False, error="SUMO"), RandomSampler(SPACE, 9, default_rng(0)), 9)


def test_combinations_that_cannot_be_run_cost_nothing() -> None:
    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        if point["driver"] == "calm":
            return TriedOutcome(None, False, error="cannot be run")
        return TriedOutcome(0.5, False, trial="t")

    found = hunt(SPACE, evaluate, make_sampler("random", SPACE, 20, 0), 20)
    assert found.run == 20 < len(found.samples)
    assert tables(found)[-1].name == "search_errors"


def test_what_has_nothing_due_is_neither_a_pass_nor_a_failure() -> None:
    """It fails in the afternoon, unless the driver is calm; before that, and then, nothing is due."""

    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        if float(point["hour"]) < 14 or point["driver"] == "calm":
            return TriedOutcome(None, False, trial="t", nothing_due="no event required an act")
        return TriedOutcome(-0.5, True, "late", "t")

    found = hunt(SPACE, evaluate, make_sampler("random", SPACE, 30, 0), 30)
    empty, told = [each for each in found.samples if each.outcome.nothing_due], as_json(found)
    assert 0 < len(empty) == told["nothing_due"] < 30
    assert (told["samples"], told["not_judged"]) == (30 - len(empty), 0)
    assert f"in {len(empty)} more nothing was due" in sentence(found, "me")
    assert any(table.name == "nothing_due" for table in tables(found))
    rates = next(each for each in tables(found) if each.name == "rates")
    calm = next(row for row in rates.rows if row[1] == "calm")
    assert (calm[2], calm[3], calm[6]) == ("0", "0", "–")
    (minimal,) = found.minimal
    assert 14 <= float(minimal.point["hour"]) < 15
    assert minimal.beside.startswith("nothing is due with hour 13")


def test_where_nothing_is_ever_due_nothing_is_known() -> None:
    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        return TriedOutcome(None, False, trial="t", nothing_due="no event required an act")

    class Listener(RandomSampler):
        def tell(self, point: SearchPoint, margin: float) -> None:
            told.append(margin)

    told: list[float] = []
    found = hunt(SPACE, evaluate, Listener(SPACE, 9, default_rng(0)), 9)
    assert min(told) > 1, "further from failing than any pass"
    assert (as_json(found)["samples"], unseen(found).upper) == (0, None)
    assert sentence(found, "me") == "Nothing was due in any of 9 runs, so that nothing is known."
    assert too_many(found, 9) == "nothing was due in any run, so that nothing is known"


@pytest.mark.parametrize("sampler", ["climb", "random", "sobol"])
def test_points_at_which_nothing_comes_due_are_given_to_no_agent(sampler: str) -> None:
    """Something is due in the afternoon alone; who looks first tries nothing else, and finds what fails there."""

    def is_due(point: SearchPoint) -> bool:
        return float(point["hour"]) >= 14 or point == SPACE.nominal

    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        if not is_due(point):
            return TriedOutcome(None, False, trial="t", nothing_due="no event required an act")
        return TriedOutcome(margin(point), margin(point) < 0, "late", "t")

    blind, looking = (
        hunt(
            SPACE,
            evaluate,
            make_sampler(sampler, SPACE, 32, 1),
            32,
            most_failures=0,
            place=lambda point, looks=looks: point if looks(point) else None,
        )
        for looks in (lambda point: True, is_due)
    )
    due = [sum(each.outcome.margin is not None for each in found.samples) for found in (blind, looking)]
    assert len(looking.samples) == 32
    assert due[0] < 0.8 * len(blind.samples)
    assert due[1] >= 31, due
    assert looking.passed_over > 0 == blind.passed_over
    assert unseen(looking).even >= unseen(blind).even
    assert sentence(looking, "me").startswith("me failed in ")
    assert " of 32 runs in which something was due" in sentence(looking, "me")


def test_a_search_where_nothing_comes_due_goes_on_all_the_same() -> None:
    found = hunt(SPACE, judged(margin), RandomSampler(SPACE, 5, default_rng(0)), 5, place=lambda point: None)
    assert found.run == 5


def test_a_failure_is_told_with_the_act_that_made_it() -> None:
    found = searched()
    blame(found, lambda each: f"no act at {each.trial[:5]}")
    (minimal,) = found.minimal
    assert minimal.act == "no act at trial"
    (table,) = [table for table in tables(found) if table.name == "failures"]
    assert minimal.act in table.rows[0]
    assert as_json(found)["failures"][0]["act"] == minimal.act


def test_an_interrupted_search_keeps_what_it_has() -> None:
    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        nonlocal asked
        asked += 1
        if asked > 5:
            raise KeyboardInterrupt
        return TriedOutcome(0.5, False, trial="t")

    asked = 0
    found = hunt(SPACE, evaluate, make_sampler("random", SPACE, 9, 0), 9)
    assert (found.run, found.stopped, found.interrupted) == (4, "interrupted", True)
    with pytest.raises(KeyboardInterrupt):
        hunt(SPACE, evaluate, make_sampler("random", SPACE, 9, 0), 9)


@pytest.mark.parametrize(
    ("events", "acts", "rule", "margin"),
    [
        ((), (), FailureRule(), None),
        ((EventOutcome.VOID, EventOutcome.AVOIDED), (), FailureRule(), None),
        ((EventOutcome.VOID, EventOutcome.AVOIDED), (), FailureRule(drive_value_below=60), None),
        ((), (Worth.FALSE,), FailureRule(), -1.0),
        ((), (Worth.FALSE,), FailureRule(events=("tunnel",)), None),
        ((EventOutcome.TAKEN,), (), FailureRule(events=("tunnel",)), -1.0),
        ((EventOutcome.MISSED, EventOutcome.AVOIDED), (), FailureRule(events=("tunnel",)), -0.5),
        ((EventOutcome.MISSED,), (), FailureRule(events=("belt",)), None),
        ((EventOutcome.HIT, EventOutcome.VOID), (), FailureRule(), 0.5),
        ((EventOutcome.HIT,), (Worth.RIGHT, Worth.FALSE), FailureRule(events=("tunnel",)), 0.5),
        ((EventOutcome.HIT,), (Worth.RIGHT, Worth.FALSE, Worth.WRONG), FailureRule(events=("tunnel",)), -0.666667),
    ],
)
def test_a_drive_with_nothing_due_has_no_margin(
    events: tuple[EventOutcome, ...], acts: tuple[Worth, ...], rule: FailureRule, margin: float | None
) -> None:
    planned = make_plan({"agents": ["silent"], "drives": ["grid_june"]}).jobs()[0].planned()
    assert isinstance(planned, DriveTrialRow)
    alike = EventOutcome.AVOIDED, EventOutcome.TAKEN
    row = replace(
        planned,
        score=together([]),
        events=tuple(
            JudgedEvent("tunnel", "", each in alike, 1.0, each, 10.0, 12.0, 20.0, 30.0, 15.0) for each in events
        ),
        acts=tuple(JudgedAct(3.0, "alert tunnel", each, "") for each in acts),
    )
    found = outcome_of(row, rule)
    assert found.margin == margin
    assert bool(found.nothing_due) is (margin is None)
    assert found.failed is (margin is not None and margin < 0)


def test_a_search_whose_budget_is_spent_keeps_what_it_has() -> None:
    """The budget ends in the repeats of the first failure, which is then told but not made small."""
    asked = 0

    def evaluate(point: SearchPoint, repeat: int) -> TriedOutcome:
        nonlocal asked
        asked += 1
        if repeat:
            raise BudgetSpentError("spent")
        return TriedOutcome(0.5 if asked < 4 else -0.5, asked >= 4, trial="t")

    found = hunt(SPACE, evaluate, make_sampler("random", SPACE, 9, 0), 9)
    assert (found.run, found.stopped, found.minimal) == (3, "spent", [])
    assert [each.outcome.failed for each in found.not_reduced] == [True]


def test_a_space_of_few_points_is_used_up() -> None:
    few = Space((FactorChoices("drive", ("a", "b")),))
    found = hunt(few, judged(lambda p: 0.5), make_sampler("random", few, 9, 0), 1_000_000)
    assert "nothing new" in found.stopped
    assert len(found.samples) < 1100


@pytest.mark.parametrize(
    ("budget", "told"),
    [
        (SearchBudget(64), "8 of 64 combinations, about 28 minutes left for the combinations"),
        (SearchBudget(64, hours=1 / 3), "8 of 64 combinations, 10 of 20 minutes, about 10 minutes left at most"),
        (SearchBudget(hours=2), "8 combinations, 10 of 120 minutes, about 110 minutes left at most"),
        (SearchBudget(usd=5), "8 combinations"),
    ],
)
def test_progress_is_told_by_the_limit_that_ends_the_search(budget: SearchBudget, told: str) -> None:
    assert progress_in_words(budget, 8, 600.0, 30.0) == told


@pytest.mark.parametrize(
    ("text", "budget"),
    [
        ("64", SearchBudget(64)),
        ("2h", SearchBudget(hours=2)),
        ("90min", SearchBudget(hours=1.5)),
        ("$5", SearchBudget(usd=5)),
        ("64, 2H ,0.5usd", SearchBudget(64, 2, 0.5)),
    ],
)
def test_a_budget_is_points_hours_or_money(text: str, budget: SearchBudget) -> None:
    assert SearchBudget.read(text) == budget


@pytest.mark.parametrize("text", ["", "0", "-3", "1.5", "2 days", "64,32", "1h,30min", "$5h", "5eur", "inf"])
def test_a_wrong_budget_is_refused(text: str) -> None:
    with pytest.raises(UserError, match="64, 2h, 90min, 5usd"):
        SearchBudget.read(text)


def test_a_limit_is_that_of_time_or_that_of_the_meter() -> None:
    used_s = 3500.0
    limit = SearchLimit(SearchBudget(hours=1), Meter(Budget(usd=1.0), Spent(usd=0.4)), lambda: used_s)
    assert not limit.refusal()
    limit.spend(10, 0.7)
    assert "dollars" in limit.refusal()
    assert limit.spent() == Spent(10, 1.1)
    used_s = 3601.0
    assert "1 of 1 hours" in limit.refusal()


def test_findings_count_every_sample() -> None:
    found = searched("random", 50)
    told = as_json(found)
    assert told["samples"] == 50
    assert told["failed"] == sum(margin(each.point) < 0 for each in found.samples)
    covered, total = coverage(found)
    assert 0 < covered <= total
    rates = next(table for table in tables(found) if table.name == "rates")
    of_driver = [int(str(row[2])) for row in rates.rows if row[0] == "driver"]
    assert sum(of_driver) == 50


def test_a_grid_has_every_value_with_every_other() -> None:
    factors = (
        FactorChoices("drive", ("a", "b", "c")),
        FactorRange("hour", 0.0, 8.0, 4.0),
        FactorRange("seed", 0, 1, 0, whole=True),
    )
    space = Space(factors)
    sampler = make_sampler("grid", space, 24, 0)
    asked = [sampler.ask()[0] for _ in range(24)]
    assert {tuple(point.values()) for point in asked} == {
        (drive, hour, seed) for drive in "abc" for hour in (1.0, 3.0, 5.0, 7.0) for seed in (0, 1)
    }
    small = make_sampler("grid", space, 2, 0)
    assert len({small.ask()[0]["drive"] for _ in range(2)}) == 2, "as many as the budget, though there are more"


def test_response_curves_are_means_of_the_margin() -> None:
    found = searched("grid", 128)
    sight = SPACE.factor("visibility_m")
    assert isinstance(sight, FactorRange)
    line = means(found, sight)
    assert line[0][1] < line[-1][1]
    made = curves(found)
    assert set(made) == {"curve-visibility_m", "curve-hour"}
    assert all(chart.svg.startswith("<svg") for chart in made.values())


def test_triples_are_counted_as_pairs_are() -> None:
    found = searched("random", 40)
    pairs, of_pairs = coverage(found)
    triples, of_triples = coverage(found, 3)
    assert (of_pairs, of_triples) == (6 + 5 * 12 + 3 * 16, 6 * 12 + 5 * 48 + 64)
    assert 0 < pairs < of_pairs
    assert triples / of_triples < pairs / of_pairs


def test_maps_of_two_factors_count_every_sample() -> None:
    found = searched("sobol", 128)
    maps = [table for table in tables(found) if table.name.startswith("map_")]
    assert "driver and visibility" in maps[0].title
    for table in maps:
        cells = [str(cell).split(" of ") for row in table.rows for cell in row[1:] if str(cell) != "–"]
        assert sum(int(failed) for failed, _ in cells) == sum(each.outcome.failed for each in found.samples)
        assert sum(int(of) for _, of in cells) == len(found.samples)


def test_a_careful_watcher_prevents_what_it_passes() -> None:
    found = searched()
    assert prevented(found) == (0, 0)
    try_carefully(found, judged(lambda p: 0.5))
    assert prevented(found) == (len(found.minimal), len(found.minimal))
    assert "prevents it" in {cell for row in tables(found)[0].rows for cell in row}
    try_carefully(found, lambda point, repeat: TriedOutcome(None, False, error="lost"))
    assert prevented(found) == (0, 0)
    try_carefully(found, judged(lambda p: -0.5))
    assert prevented(found) == (0, len(found.minimal))
    assert not any(as_json(found)["failures"][0][name] for name in ("careful_prevents",))


def test_few_whole_numbers_are_levels_of_their_own() -> None:
    few, many = (FactorRange("seed", 0, most, 0, whole=True) for most in (3, 40))
    assert few.levels == ("0", "1", "2", "3")
    assert {few.level(few.at(step / 100)) for step in range(101)} == set(few.levels)
    assert len(many.levels) == 4


def test_the_bound_is_the_rule_of_three() -> None:
    assert upper_bound(0, 300) == pytest.approx(0.01, rel=0.01)
    assert upper_bound(5, 5) == 1.0
    assert upper_bound(1, 30) > upper_bound(0, 30)


def test_the_regression_suite_is_a_plan_with_both_sides(tmp_path: Path) -> None:
    found = searched()
    path = tmp_path / "regression.toml"
    path.write_text(regression_plan(found, "rule-perfect", "rules"))
    plan = make_plan(read_plan(path))
    fails, passes = plan.trials
    assert (fails.drive, fails.settings.driver) == ("grid_june", "hurried")
    assert fails.settings.visibility_m == found.minimal[0].point["visibility_m"]
    assert passes.settings.visibility_m != fails.settings.visibility_m
    assert len({job.id for job in plan.jobs()}) == len({job.instance for job in plan.jobs()}) == 2
    assert make_plan(plan.as_json()) == plan
    found.not_reduced.append(found.minimal[0].first)
    path.write_text(regression_plan(found, "rule-perfect", "rules"))
    assert len(make_plan(read_plan(path)).trials) == 3, "a failure that was not reduced is saved as it was found"


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("[factors]\ntask = ['hvac_fan_max']\nhour = [3]", "hour can be varied for drives alone"),
        ("[factors]\ndrive = ['grid_june']\ncolour = ['red']", "no factor named 'colour'"),
        ("[factors]\ndrive = ['grid_june']\nhour = { least = 9, most = 3 }", "hour is empty"),
        *(
            (f"[factors]\ndrive = ['grid_june']\nhour = {given}", error)
            for given, error in (
                ("{ least = 3, most = 9, nominal = 'a' }", "nominal is 'a'; it must be a number"),
                ("{ least = 3, most = 9, nominal = [4] }", "nominal is"),
                ("{ least = 3, most = 9, whole = 'x' }", "whole is 'x'"),
                ("{ least = true, most = 9 }", "least is true"),
                ("{ least = 3 }", "hour lacks 'most'"),
                ("[1, nan]", "neither a list of values nor"),
                ("[[1], [2]]", "neither a list of values nor"),
            )
        ),
        ("[factors]\ndrive = ['grid_june']\nseed = [0.5]", "whole numbers from 0"),
        ("[factors]\ndrive = ['grid_june']\nseed = [true]", "whole numbers from 0"),
        ("[factors]\ndrive = ['grid_june']\nseed = { least = -1, most = 3 }", "whole numbers from 0"),
        ("[factors]\nhour = [3]", "give one of the two"),
        ("[factors]\ndrive = ['grid_yune']", "did you mean 'grid_june'"),
        (
            "[factors]\ndrive = ['grid_june']\n[failure]\nevents = ['blue_ligt']",
            r"did you mean 'blue_light'\? There are: .*belt, .*cut_in, .*wipers\.",
        ),
        (
            "[factors]\ndrive = ['grid_june']\n[failure]\nevents = ['nothing']",
            r"named 'nothing'.*: arrow_sign, .*wipers\.",
        ),
        ("[factors]\ntask = ['hvac_fan_max']\nlanguage = ['xx']", "language has a value that does not exist"),
    ],
)
def test_a_wrong_space_is_refused_in_a_line(tmp_path: Path, text: str, error: str) -> None:
    path = tmp_path / "space.toml"
    path.write_text(text)
    with pytest.raises(UserError, match=error):
        read_space(path)


def test_a_staging_stands_for_the_events_that_it_brings_about(tmp_path: Path) -> None:
    path = tmp_path / "space.toml"
    path.write_text("[factors]\ndrive = ['grid_june']\n[failure]\nevents = ['cut_in', 'leader_brakes', 'belt']")
    assert read_space(path).rule.events == ("leader_close", "leader_brakes", "belt")
    assert space_file("cut_in") == space_file("cut-in")
    assert set(BRINGS) == ON_REQUEST.keys() - KINDS.keys()
    assert {kind for kinds in BRINGS.values() for kind in kinds} <= KINDS.keys()
    with pytest.raises(UserError, match=r"did you mean 'cut-in'\? There are: .*wrong-sign-after-roadworks\."):
        space_file("cut_inn")


def test_a_space_is_read_with_its_nominal_values(tmp_path: Path) -> None:
    path = tmp_path / "space.toml"
    path.write_text(
        "[factors]\ndrive = ['grid_*']\nlatency_s = { least = 0, most = 9 }\n"
        "visibility_m = { least = 50, most = 5000, nominal = 5000, logarithmic = true }\n"
        "[failure]\ndrive_value_below = 50"
    )
    space = read_space(path)
    assert dict(space.nominal) == {"drive": "grid_january", "latency_s": 0.0, "visibility_m": 5000.0}
    assert space.at([0.9, 0.5, 0.5]) == {"drive": "grid_june", "latency_s": 4.5, "visibility_m": 500.0}
    assert space.rule.drive_value_below == 50


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_the_even_points_are_known_before_anything_is_learnt(sampler: str) -> None:
    for package in {"cma": ["cma"], "bayes": ["optuna"], "sobol": ["scipy"]}.get(sampler, []):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            pytest.importorskip(package)
    ahead = list(even_points(make_sampler(sampler, SPACE, 24, 1), 24))
    even = [each.point for each in searched(sampler, 24).samples if each.even]
    assert ahead == even
    assert len(ahead) >= 6


def test_sensitivity_is_that_of_the_margin() -> None:
    def additive(point: SearchPoint) -> float:
        return 0.5 + (0.3 if point["driver"] == "hurried" else 0.0) - (float(point["hour"]) - 14) / 100

    found = searched("sobol", 128, additive)
    shares = {factor.name: (share, rank) for factor, share, rank in sensitivity(found)}
    assert next(iter(shares)) == "driver"
    assert shares["driver"][0] == pytest.approx(0.9, abs=0.06)
    assert shares["hour"][0] == pytest.approx(0.1, abs=0.06)
    assert shares["hour"][1] is not None
    assert shares["hour"][1] < -0.2
    assert shares["visibility_m"][0] < 0.05

    def folded(point: SearchPoint) -> float:  # the same at both ends and in the middle of the range
        return abs(((float(point["hour"]) - 6) / 16 * 4) % 2 - 1)

    shares_of_folded = {factor.name: share for factor, share, _ in sensitivity(searched("sobol", 128, folded))}
    assert shares_of_folded["hour"] > 0.6
    assert "Sensitivity" in [table.title for table in tables(found)]
    assert sensitivity(searched("sobol", 8, additive)) == []


def test_factors_are_told_with_their_units_and_every_number_of_a_drive_has_one() -> None:
    assert said("visibility_m", 118.0, "at most") == "visibility at most 118 m"
    assert said("driver", "hurried") == "driver hurried"
    assert said("rain_mm_h", 2.5) == "rain 2.5 mm/h"
    bare = {name for name in FACTORS if "_" in name and not label_of(name)[1]}
    assert bare <= {"held_out"}, "a name with an unknown unit"
