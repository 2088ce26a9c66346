"""The column "Input": what each method is given, and what its format cannot say."""

import pytest

from automotive_cosim.agents import FORMATS
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.report.results import Contestant
from automotive_cosim.report.summary import input_of


@pytest.mark.parametrize(
    ("agent", "model", "geo", "said"),
    [
        ("t3a", "rules", "full", "a11y tree"),
        ("m3a", "rules", "wrong", "a11y tree + screen (geo wrong)"),
        ("asurada", "rules", "full", "a11y tree + screen + GPS + context"),
        ("no-op", "none", "full", "–"),
        ("native", "local/m?format=qwen3-vl", "full", "screen"),
        ("native", "local/m?format=ui-tars-1.5", "full", "screen, no words for show_alert, not_needed"),
    ],
)
def test_the_input_is_named(agent: str, model: str, geo: str, said: str) -> None:
    assert input_of(Contestant(agent, model, Conditions.named({"geo": geo}))) == said


@pytest.mark.parametrize("form", FORMATS)
def test_a_gap_of_a_format_is_named(form: str) -> None:
    said = input_of(Contestant("native", f"local/m?format={form}"))
    assert ("show_alert" in said) == ("show_alert" in FORMATS[form].lacks)
