"""``automotive-cosim show context``."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.main import made
from automotive_cosim.errors import UserError
from automotive_cosim.geo.forecast import OpenMeteo

APP = made("show", "context")


def _run(*arguments: str) -> str:
    result = CliRunner().invoke(APP, ["show", "context", *arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stdout


def test_negative_numbers_are_plain_arguments() -> None:
    found = json.loads(_run("-33.87", "151.21", "--json", "--time", "2026-01-03T12:00"))
    assert (found["country"], found["driving_side"]) == ("AU", "left")
    assert json.loads(_run("-33.9", "-70.6", "--json"))["country"] == "CL"


def test_text_and_json_state_the_same_lines() -> None:
    arguments = (
        "48.2",
        "1.8",
        "--time",
        "2026-03-20T18:30",
        "--weather",
        "63",
        "--speed",
        "90",
        "--road",
        "motorway",
    )
    text = _run(*arguments)
    found = json.loads(_run(*arguments, "--json"))
    assert text.splitlines() == [line["text"] for line in found["lines"]]
    assert found["default_limits"][0]["law"] == "Code de la route R413-2"
    assert [limit["value_now"] for limit in found["reduced_limits"]] == [None, 110]
    assert "Speed: 90 km/h" in text


@pytest.mark.parametrize(
    ("time", "local"),
    [
        ("2026-03-29T02:30", "2026-03-29T03:30:00+02:00"),
        ("2026-07-01T12:00", "2026-07-01T12:00:00+02:00"),
        ("2026-07-01T12:00Z", "2026-07-01T14:00:00+02:00"),
        ("1931-07-01", "1931-07-01T00:00:00+01:00"),
    ],
)
def test_times_are_the_places_own(time: str, local: str) -> None:
    assert json.loads(_run("48.87", "2.3", "--json", "--time", time))["local_time"] == local


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("91", "0"), "latitude 91 is not on earth"),
        (("0", "-181"), "longitude -181 is not on earth"),
        (("0", "0", "--time", "yesterday"), "not a date and time"),
        (("0", "0", "--weather", "4"), "weather code 4 is not one of"),
        (("0", "0", "--visibility", "40"), "--visibility requires --weather"),
        (("48.8", "2.3", "--online", "--weather", "3"), "omit --online"),
        (("0", "0", "--rules", "/no/such/folder"), "is not a folder"),
        (("0", "0", "--rules", str(Path(__file__).parents[1])), "has no rule files"),
        (("0", "0", "--road", "spaceway"), "no road class named 'spaceway'"),
    ],
)
def test_bad_input_is_one_line(arguments: tuple[str, ...], message: str) -> None:
    with pytest.raises(UserError, match=message) as error:
        _run(*arguments)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "arguments",
    [
        ("--speed", "nan"),
        ("--speed", "-1"),
        ("--speed", "inf"),
        ("--weather", "45", "--visibility", "-5"),
        ("--weather", "45", "--visibility", "nan"),
    ],
)
def test_a_number_that_cannot_be_says_what_can(arguments: tuple[str, ...]) -> None:
    result = CliRunner().invoke(APP, ["show", "context", "48.8", "2.3", *arguments])
    assert result.exit_code == 2
    assert f"{arguments[-1]!r} is not a " in result.stderr
    assert "number from" in result.stderr


def test_the_poles_and_the_sea_have_a_context() -> None:
    for arguments in (("90", "0"), ("-90", "0"), ("0", "180"), ("40", "-30")):
        assert "Default limit: unknown" in _run(*arguments, "--time", "2026-12-21T12:00")


def test_own_rules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "GE.toml").write_text(
        '[jurisdiction]\ncode = "GE"\nname = "Sakartvelo"\nstatus = "knowledge"\ndriving_side = "right"\n'
        'speed_unit = "km/h"\ntemperature_unit = "C"\nemergency = ["112"]\n',
        encoding="utf-8",
    )
    text = _run("41.72", "44.79", "--rules", str(tmp_path))
    assert text.startswith("Place: Sakartvelo (GE)")


def test_online_without_a_service_falls_back_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("no_proxy", "*")
    monkeypatch.setattr(OpenMeteo.__init__, "__defaults__", ("http://127.0.0.1:9/", 1.0))
    place = ("48.82", "2.34", "--time", "2026-01-20T10:00")
    result = CliRunner().invoke(APP, ["show", "context", *place, "--online"], catch_exceptions=False)
    assert "Open-Meteo cannot be reached" in result.stderr
    assert "drawn from the climate of Paris (Montsouris) (seed 0) instead" in result.stderr
    assert "Weather: unknown" not in result.stdout
