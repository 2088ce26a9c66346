"""``automotive-cosim validate`` refuses what it cannot prove; ``tests/proof/test_validate.py`` tests its proofs."""

import pytest


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--gates", "orakel"), "did you mean 'oracle'?"),
        (("--gates", ","), "--gates is empty"),
        (("--tasks", "nothing_*"), "no task"),
        (("--workers", "0"), "whole number"),
        (("--out", "file"), "file is a file"),
    ],
)
def test_bad_input_is_one_line(cli, tmp_path, words, said):
    (tmp_path / "file").touch()
    ran = cli("validate", *words)
    assert (ran.code, ran.err.count("\n")) == (2, 1)
    assert ran.err.startswith("error: ")
    assert said in ran.err
