"""``automotive-cosim tasks validate`` refuses what it cannot prove; ``tests/proof`` has what it proves."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.cli.validate import _summary
from automotive_cosim.proof.prover import GATES, Proof
from automotive_cosim.proof.settings import PartOf


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--gates", "orakel"), "did you mean 'oracle'?"),
        (("--gates", ","), "--gates is empty"),
        (("--tasks", "nothing_*"), "no task"),
        (("--workers", "0"), "whole number"),
        (("--part", "0/10"), "'0/10' is not a part such as 3/10"),
        (("--part", "11/10"), "not a part"),
        (("--part", "third"), "not a part"),
        (("--tasks", "hvac_fan_max", "--part", "2/10"), "--part 2/10 contains none of 1 task"),
        (("--tasks", "hvac_fan_max", "--out", "file"), "file is a file"),
    ],
)
def test_bad_input_is_one_line(cli, tmp_path, words, said):
    (tmp_path / "file").touch()
    ran = cli("tasks", "validate", *words)
    assert (ran.code, ran.err.count("\n")) == (2, 1)
    assert ran.err.startswith("error: ")
    assert said in ran.err


@given(st.integers(0, 40), st.integers(1, 12))
def test_the_parts_together_are_all(tasks, parts):
    ids = tuple(map(str, range(tasks)))
    taken = [PartOf(number, parts).taken(ids) for number in range(1, parts + 1)]
    assert sorted(sum(taken, ())) == sorted(ids)
    assert max(map(len, taken)) - min(map(len, taken)) <= 1


def test_what_is_printed_fits_a_narrow_terminal_and_names_what_failed():
    good, bad = {gate: [] for gate in GATES}, {gate: [] for gate in GATES} | {"near": ["first: succeeded"]}
    proofs = [
        Proof(id=f"{task}-seed{seed}", task=task, seed=seed, wrong=wrong)
        for task, wrong in (("hvac_fan_max", good), ("hvac_cold_hands", bad))
        for seed in range(3)
    ]
    lines = list(_summary(proofs, GATES))
    assert max(map(len, lines)) <= 80
    assert [line.split()[:2] for line in lines[:-1]] == [
        ["FAIL" if gate == "near" else "ok", gate] for gate in GATES
    ]
    assert lines[-1] == "hvac_cold_hands: near"
