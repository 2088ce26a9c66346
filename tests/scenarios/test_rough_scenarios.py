"""A wrong value in scenario.toml is told by file, field and what was expected."""

import shutil

import pytest

from automotive_cosim import scenarios
from automotive_cosim.errors import ScenarioError


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("step_length_s = 0.1", 'step_length_s = "x"', "step_length_s is 'x'; it must be a number"),
        ("warm_up_s = 60.0", "warm_up_s = nan", "warm_up_s is nan"),
        ("warm_up_s = 60.0", "warm_up_s = 1e9", "warm_up_s is 1000000000.0; it must be a number from 0 to 86400"),
        ("warm_up_s = 60.0", "warm_up_s = -1", "warm_up_s is -1; it must be a number from 0 to 86400"),
        ("background_rerouting = 0.6", "background_rerouting = 7", "it must be a number from 0 to 1"),
        ('config = "grid.sumocfg"', "config = 1", "config is 1; it must be a text that is not empty"),
        ('driver = "average"', "driver = 3", "driver is 3; it must be a text"),
        ('from_edge = "cwc0"', "from_edge = 5", "from_edge is 5; it must be a text"),
        ('via = ["s3s4", "n4n3", "n1n0"]', "via = [1]", r"via\[0\] is 1; it must be a text"),
        ("temperature_2m = 9.0", 'temperature_2m = "x"', "temperature_2m is 'x'; it must be a number"),
        ("weather_code = 2", 'weather_code = "x"', "weather_code is 'x'; it must be a whole number"),
        ("[[weather]]", '[[connectivity]]\nat_s = 0\nbest = "3g"\n[[weather]]', "no best named '3g'"),
        (
            "[[weather]]",
            '[[connectivity]]\nat_s = 9\nbest = "4g"\n[[connectivity]]\nat_s = 9\nbest = "5g"\n[[weather]]',
            "in the order of their at_s",
        ),
        ('name = "grid"', "name = -1", "name is -1; it must be a text"),
        (
            'time_zone = "Europe/Paris"',
            'time_zone = "x"',
            "no such time zone; give an IANA name such as Europe/Paris",
        ),
    ],
)
def test_a_wrong_value_is_refused(tmp_path, old: str, new: str, said: str):
    folder = tmp_path / "grid"
    shutil.copytree(scenarios.load("grid").folder, folder)
    path = folder / "scenario.toml"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ScenarioError, match=said) as caught:
        scenarios.load(folder)
    assert "scenario.toml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_of_results_named_like_a_shipped_scenario_does_not_hide_it(tmp_path, monkeypatch):
    (tmp_path / "grid").mkdir()
    monkeypatch.chdir(tmp_path)
    assert scenarios.load("grid").folder.name == "grid"
    assert (scenarios.load("grid").folder / "scenario.toml").is_file()
