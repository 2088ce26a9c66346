"""The notebook is made from its script, and what the script prints is what it says."""

import runpy

import pytest

from tests.docs.notebook import NOTEBOOK, SCRIPT, made


def test_the_notebook_is_that_of_the_script():
    assert NOTEBOOK.read_text(encoding="utf-8") == made(), "renew it: python -m tests.docs.notebook --renew"


@pytest.mark.slow
@pytest.mark.sumo
def test_the_first_episode_of_the_script_is_won(capsys):
    begins, rest = SCRIPT.read_text(encoding="utf-8").split("simulations = Simulations()")
    assert "outcomes" in rest
    told = {}
    exec(compile(begins, SCRIPT, "exec"), told)
    assert told["reward"] == 1.0
    assert "The driver says: " in capsys.readouterr().out


@pytest.mark.proof
@pytest.mark.long
@pytest.mark.slow
@pytest.mark.sumo
def test_only_the_agent_that_knows_its_place_wins_both():
    told = runpy.run_path(str(SCRIPT))
    won = {name: [told["outcomes"][name, half] for half in ("first", "second")] for name in ("t3a", "asurada")}
    assert won["asurada"] == [True, True]
    assert False in won["t3a"]
    assert not told["blind"].success
