"""The conversations that ship with the package play to their recorded ends, without a model."""

from collections.abc import Iterable
from dataclasses import replace

import pytest

from automotive_cosim.agents import FORMATS, PROFILES, make_agent
from automotive_cosim.errors import ModelError, UnknownNameError
from automotive_cosim.models import ChatMessage, make_model
from automotive_cosim.models.replay import conversation, shipped
from automotive_cosim.replay.make import SETUP
from automotive_cosim.run.trial import run_trial
from automotive_cosim.traffic.fork import Simulations


def test_there_is_one_for_every_agent_with_a_model_and_every_way_in_which_native_formats_write_and_speak() -> None:
    def ways(names: Iterable[str]) -> set[tuple[type, type]]:
        return {(type(FORMATS[name].syntax), type(FORMATS[name].api)) for name in names}

    native = set(shipped()) - set(PROFILES)
    assert set(shipped()) == {*native, *PROFILES}
    assert ways(native) == ways(FORMATS)


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped())
def test_each_plays_to_its_recorded_end(name: str, simulations: Simulations) -> None:
    told = conversation(name)
    model = f"replay/{name}" + (f"?format={name}" if told["agent"] == "native" else "")
    setup = replace(SETUP, **told["episode"], agent=told["agent"], model=model)
    result = run_trial(setup, make_agent(told["agent"], model), simulations=simulations)
    assert result.error is None, "make them anew: python -m automotive_cosim.replay.make"
    assert (str(result.end), result.success) == (told["end"], told["success"])
    assert result.success
    assert result.tokens_out > 0


def test_another_question_says_with_what_it_was_recorded() -> None:
    with pytest.raises(ModelError, match="--task hvac_fan_max --half first --scenario grid --seed 0 --agent t3a"):
        make_model("replay/t3a").chat([ChatMessage("user", "hi")])


def test_an_unknown_name_is_told_with_a_known_one() -> None:
    with pytest.raises(UnknownNameError, match=r"did you mean 'ui-tars-1.5'"):
        make_model("replay/ui-tars-15")
