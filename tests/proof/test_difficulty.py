"""How hard halves are: the model, the core subset, and what is on record."""

import json
from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.proof import difficulty
from automotive_cosim.proof.difficulty import agreement, core, correlation, fit, measured, merged, outcomes_of
from automotive_cosim.run import difficulty as record
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.difficulty import Difficulty, Outcomes, WonBy
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.job_row import as_json
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

NAMES = [f"{task.id}/{half}" for task in CATALOGUE.values() for half in task.halves]
ABILITIES = {"a": 3.0, "b": 1.5, "c": 0.0, "d": -1.0, "e": -2.5, "f": -4.0}


@pytest.fixture(scope="module")
def drawn():
    """Difficulties, and what contestants of known abilities make of them."""
    rng = np.random.default_rng(0)
    hard = dict(zip(NAMES, rng.normal(0.0, 2.0, len(NAMES)), strict=True))
    chance = {name: {who: 1 / (1 + np.exp(hard[name] - able)) for who, able in ABILITIES.items()} for name in NAMES}
    seen = {
        name: Outcomes(fingerprint(CATALOGUE[name.split("/")[0]], name.split("/")[1]), {
            who: (int(rng.random() < p), 1) for who, p in chance[name].items()
        })
        for name in NAMES
    }  # fmt: skip
    return hard, seen


def test_the_model_finds_what_outcomes_were_drawn_from(drawn):
    hard, seen = drawn
    found = fit(seen)
    for who, ability in ABILITIES.items():
        assert found.abilities[who] == pytest.approx(ability, abs=0.3)
    assert found.spread == pytest.approx(2.0, abs=0.2)
    within = [abs(found.difficulties[name][0] - hard[name]) < 2 * found.difficulties[name][1] for name in NAMES]
    assert 0.93 < np.mean(within) < 0.98


def test_what_all_win_or_lose_is_finite_and_further_out_the_more_have_tried():
    def of(won, tried):
        return Outcomes("", {f"{n}": (int(n < won), 1) for n in range(tried)})

    found = fit({"won": of(6, 6), "half": of(3, 6), "lost": of(0, 6), "lost by one": of(0, 1)}).difficulties
    order = ["won", "half", "lost by one", "lost"]
    assert sorted(order, key=lambda name: found[name][0]) == order
    assert all(np.isfinite(found[name]).all() and found[name][1] > 0 for name in order)


def test_the_core_is_as_large_as_asked_has_every_subset_and_keeps_the_order(drawn):
    _, seen = drawn
    chosen = core(seen, fit(seen))
    assert len(chosen) == 60
    assert chosen == core(seen, fit(seen))
    shares = {(task.suite, task.subset) for task in CATALOGUE.values()}
    assert {(CATALOGUE[each].suite, CATALOGUE[each].subset) for each in chosen} == shares
    kept = agreement(seen, chosen, draws=40)
    assert (kept.at_once, kept.left_out) == (1.0, 1.0)
    assert kept.low > 0.9


def test_a_task_that_few_have_tried_is_not_in_the_core(drawn):
    _, seen = drawn
    chosen = core(seen, fit(seen))
    few = {name: Outcomes(each.half, {who: each.won[who] for who in "abcd"}) for name, each in seen.items()
           if name.startswith(f"{chosen[0]}/")}  # fmt: skip
    assert chosen[0] not in core({**seen, **few}, fit({**seen, **few}))


def test_ranks_of_equals_are_equal():
    assert correlation(np.array([1.0, 2.0, 2.0]), np.array([0.1, 0.5, 0.5])) == pytest.approx(1.0)
    assert correlation(np.array([1.0, 2.0, 3.0]), np.array([3.0, 2.0, 1.0])) == pytest.approx(-1.0)


def test_trials_with_an_error_on_changed_halves_and_of_the_oracle_do_not_count(tmp_path):
    def row(agent, seed, **changes):
        setup = EpisodeSetup("system_dark_screen", "first", agent=agent, model="rules", seed=seed)
        return json.dumps(as_json(replace(setup.planned(), **changes)))

    rows = [
        row("t3a", 0, success=True),
        row("t3a", 1, success=False),
        row("t3a", 2, success=False, error="the traffic ended", error_kind="TrafficError"),
        row("asurada", 0, success=True),
        row("oracle", 0, success=True),
        row("t3a", 2, success=True, half_digest="of another wish"),
    ]
    (tmp_path / "episodes.jsonl").write_text("\n".join(rows) + "\n")
    ((half, found),) = outcomes_of([tmp_path]).items()
    assert (half, found.won) == ("system_dark_screen/first", {"t3a, rules": (1, 2), "asurada, rules": (1, 1)})
    assert outcomes_of([tmp_path], "both")[half].won == {"both": (2, 3)}


def test_new_outcomes_replace_older_ones_and_what_has_changed_goes():
    name, other = NAMES[:2]
    now = fingerprint(CATALOGUE[name.split("/")[0]], name.split("/")[1])
    old = {name: Outcomes(now, {"a": (0, 1), "b": (1, 1)}), other: Outcomes("as it was", {"a": (1, 1)})}
    assert merged(old, {name: Outcomes(now, {"a": (1, 1)})}) == {name: Outcomes(now, {"a": (1, 1), "b": (1, 1)})}


@pytest.mark.slow
def test_built_in_contestants_are_played_from_one_hand_over(sumo, monkeypatch):
    monkeypatch.setattr(difficulty, "BUILT_IN", ("always-ask", "oracle"))
    task = "system_dark_screen"
    found = dict(difficulty.play([task], "all", {}))
    assert {name: {who: won for who, (won, _) in each.won.items()} for name, each in found.items()} == {
        f"{task}/{half}": {"always-ask": 0, "oracle": 1} for half in CATALOGUE[task].halves
    }
    assert list(difficulty.play([task], "all", found)) == []


# --- the shipped record -----------------------------------------------------------------------------------


def test_the_record_is_what_its_outcomes_give(tmp_path):
    shipped = record.shipped()
    again = measured({name: each.outcomes for name, each in shipped.halves.items()})
    record.write(tmp_path / "again.json", again)
    assert record.read(tmp_path / "again.json") == shipped


def test_nearly_every_half_is_on_record_with_five_contestants():
    shipped = record.shipped()
    assert shipped.halves.keys() <= set(NAMES)
    tried = [name for name, each in shipped.halves.items() if len(each.outcomes.won) >= 5]
    told = [name for name in tried if record.measured(*name.split("/")) is not None]
    assert len(told) >= 0.6 * len(NAMES), "what is on record is of the tasks as they are"


def test_the_core_keeps_the_order_of_the_contestants():
    shipped = record.shipped()
    kept = agreement({name: each.outcomes for name, each in shipped.halves.items()}, shipped.core, draws=100)
    assert kept.at_once >= 0.95
    assert kept.mean >= 0.95


def test_core_is_a_word_that_chooses_sixty_tasks_of_all_suites():
    assert set(choose(["core"])) == set(record.shipped().core)
    assert len(choose(["core"])) == 60
    assert {CATALOGUE[each].suite for each in choose(["core"])} == set(Suite) - {
        Suite.SPEED,
        Suite.VOICE,
        Suite.PEOPLE,
        Suite.CAMERA,
    }, "untried so far"


def test_verified_chooses_what_two_careful_readers_have_won_as_it_is_now():
    chosen = choose(["verified"])
    assert chosen == record.verified()
    for task_id in chosen:
        for half in CATALOGUE[task_id].halves:
            won = record.measured(task_id, half).outcomes.won
            readers = [who for who, (times, of) in won.items() if who.startswith("careful") and 2 * times >= of]
            assert len(readers) >= 2, task_id


def test_readers_are_counted_one_by_one_and_no_other_contestant_is():
    won = {"careful": (1, 1), "careful 2": (0, 1), "careful 3": (1, 2), "carefully": (1, 1), "t3a, rules": (1, 1)}
    assert Outcomes("", won).readers == (2, 3)


def test_a_half_that_has_changed_is_not_measured(monkeypatch):
    name = next(iter(record.shipped().halves))
    task_id, half = name.split("/")
    monkeypatch.setattr(record, "_now", lambda: {name: "another"})
    record.measured.cache_clear()
    assert record.measured(task_id, half) is None
    assert record.level(record.hardest(CATALOGUE[task_id])) is WonBy.UNKNOWN
    record.measured.cache_clear()


def test_a_task_is_as_hard_as_its_harder_half():
    for task in CATALOGUE.values():
        found = [record.measured(task.id, half) for half in task.halves]
        if all(found):
            assert record.hardest(task) == max(found, key=lambda each: each.logits)


def test_levels_lie_between_the_contestants_they_name():
    able = record.shipped().abilities
    at = {
        able[record.PROGRAM] - 0.1: (WonBy.PROGRAM, WonBy.PROGRAM),
        able[record.PROGRAM] + 0.1: (WonBy.CAREFUL, WonBy.OPEN),
        able[record.CAREFUL] + 0.1: (WonBy.FEW, WonBy.OPEN),
    }
    for logits, levels in at.items():
        tried = [Outcomes("", {record.CAREFUL: (1, 1)}), Outcomes("", {})]
        assert tuple(record.level(Difficulty(logits, 1.0, each)) for each in tried) == levels


@over([task.id for task in CATALOGUE.values()])
def test_a_fingerprint_tells_halves_apart_and_follows_no_solution(task_id):
    task = CATALOGUE[task_id]
    prints = {fingerprint(task, half) for half in task.halves}
    assert len(prints) == len(task.halves)
