"""Options that follow from the fields of a dataclass."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, make_dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Literal

import pytest
import typer
from annotated_types import Ge, Le
from typer.testing import CliRunner

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, settings_in, takes
from automotive_cosim.cli.main import app
from automotive_cosim.cli.options import DriveChanges
from automotive_cosim.doors.settings import A2aSettings, McpSettings
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.episode.settings import EpisodeSettings
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import OneOf, Option, option
from automotive_cosim.formats.docs import inherited_field_docs
from automotive_cosim.osm.settings import ImportOptions
from automotive_cosim.proof.settings import ProofSettings
from automotive_cosim.report.settings import CompareSettings
from automotive_cosim.run.settings import Budget, EvaluationSettings, RunSettings, SingleSettings
from automotive_cosim.safety.settings import SearchOrder, SearchSettings
from automotive_cosim.serve.settings import ServeSettings
from tests.laws import over

COMMANDS = (
    ("run", EpisodeSettings, {"seed"}),
    ("run", SingleSettings, set()),
    ("run", DriveChanges, set()),
    ("eval", EvaluationSettings, {each.name for each in TABLE}),
    ("eval", RunSettings, set()),
    ("eval", Budget, set()),
    ("eval", ExecutorSettings, set()),
    ("search", SearchOrder, set()),
    ("search", SearchSettings, set()),
    ("search", ExecutorSettings, set()),
    ("scenarios import", ImportOptions, set()),
    ("tasks validate", ProofSettings, set()),
    ("mcp", McpSettings, set()),
    ("a2a", A2aSettings, set()),
    ("serve", ServeSettings, set()),
    ("compare", CompareSettings, set()),
)
"""Commands, what they can be told, and the fields of it that are no options."""


class Tone(StrEnum):
    """How one may greet."""

    KIND = "kind"
    CURT = "curt"


@dataclass(frozen=True)
class Settings:
    """One field of each kind."""

    whom: str = ""
    """Whom to greet."""
    wait_s: Annotated[float, Ge(0)] = 2.5
    """Seconds to wait before it."""
    often: int | Literal["auto"] = 1
    """How often."""
    seeds: tuple[int, ...] = (0, 1, 2)
    """Seeds."""
    shares: Annotated[tuple[float, ...], Option(default="the car's")] = ()
    """Shares."""
    words: Annotated[tuple[str, ...], Option("word", repeats=True)] = ()
    """A word; may be repeated."""
    loud: bool = False
    """Whether it is loud."""
    waves: bool = True
    """Without it, nobody waves."""
    volume: Annotated[int, Ge(1), Le(11)] = 5
    """How loud."""
    tone: Annotated[Tone, OneOf(Tone, "tone of voice")] = Tone.KIND
    """How it sounds."""
    sign: Annotated[str, Option(variable="GREETING_SIGN")] = ""
    """What to sign with."""


def told(*arguments: str) -> tuple[dict[str, Any], str]:
    """What a command with these options is told, and what it printed."""
    found: dict[str, Any] = {}
    one = typer.Typer()

    @one.command()
    @takes(Settings)
    def greet(name: Annotated[str, typer.Option()] = "nobody", **settings: Any) -> None:
        found.update(settings_in(Settings, settings), name=name)

    ran = CliRunner().invoke(one, list(arguments), catch_exceptions=False)
    return found, ran.output


def test_what_was_not_given_stays_the_types_own() -> None:
    assert told() == ({"name": "nobody"}, "")


def test_each_form_is_read_as_its_field_has_it() -> None:
    line = (
        "--whom Eva --wait 3 --often auto --seeds 0-2,7 --shares 0.5,1 --word a,b --word c --loud --no-waves "
        "--volume 11 --tone curt --name x"
    )
    assert told(*line.split())[0] == {
        "whom": "Eva",
        "wait_s": 3.0,
        "often": "auto",
        "seeds": (0, 1, 2, 7),
        "shares": (0.5, 1.0),
        "words": ("a,b", "c"),
        "loud": True,
        "waves": False,
        "volume": 11,
        "tone": Tone.CURT,
        "name": "x",
    }


def test_a_variable_gives_what_the_option_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GREETING_SIGN", "E.")
    assert told()[0]["sign"] == "E."
    assert told("--sign", "Eva")[0]["sign"] == "Eva"


def test_help_is_the_docstring_with_the_default() -> None:
    shown = " ".join(told("--help")[1].replace("│", " ").split())
    for text in ("Seconds to wait before it. [default: 2.5]", "[default: 0-2]", "[default: (the car's)]"):
        assert text in shown


def test_lists_of_numbers_refuse_anything_else() -> None:
    with pytest.raises(UserError, match="--shares has 'half'; give numbers separated by commas"):
        told("--shares", "0.5,half")
    for wrong in ("x", "5-1"):
        with pytest.raises(UserError, match=f"--seeds has '{wrong}'; give numbers and rising ranges"):
            told("--seeds", wrong)


def test_a_zero_that_was_given_is_kept() -> None:
    assert told("--wait", "0", "--seeds", "0")[0] == {"wait_s": 0.0, "seeds": (0,), "name": "nobody"}


@pytest.mark.parametrize(
    ("option", "value", "why"),
    [
        ("--volume", "12", "'12' is not a whole number from 1 to 11"),
        ("--volume", "loud", "'loud' is not a whole number from 1 to 11"),
        ("--volume", "2.5", "'2.5' is not a whole number from 1 to 11"),
        ("--wait", "nan", "'nan' is not a number from 0"),
        ("--often", "never", "'never' is neither a whole number nor auto"),
    ],
)
def test_a_value_beyond_the_bounds_is_refused(option: str, value: str, why: str) -> None:
    assert why in " ".join(told(option, value)[1].replace("│", " ").split())


def test_a_word_that_is_no_member_is_refused() -> None:
    with pytest.raises(UserError, match="tone of voice"):
        told("--tone", "cold")


def test_a_new_field_is_an_option_by_itself() -> None:
    more = make_dataclass("More", [("new_thing_s", float, 1.0)], bases=(Settings,), frozen=True)
    more.__field_docs__ = {"new_thing_s": "A new thing."}  # type: ignore[attr-defined]
    one = typer.Typer()
    one.command()(takes(more)(lambda **settings: print(settings_in(more, settings))))
    assert CliRunner().invoke(one, ["--new-thing", "4"]).output.strip() == "{'new_thing_s': 4.0}"


@dataclass(frozen=True)
class Card:
    """One that must be told to whom it goes."""

    to: str
    """Who gets it."""
    file: Path = Path("card.txt")
    """File to write."""


def test_a_field_without_a_default_must_be_given_and_a_path_keeps_its_own() -> None:
    one = typer.Typer()
    one.command()(takes(Card)(lambda **settings: print(filled(Card, settings))))
    assert "Missing option '--to'" in CliRunner().invoke(one, []).output
    assert CliRunner().invoke(one, ["--to", "Eva"]).output.strip() == repr(Card("Eva"))
    assert CliRunner().invoke(one, ["--to", "Eva", "--file", "x"]).output.strip() == repr(Card("Eva", Path("x")))
    assert "File to write. [default: card.txt]" in " ".join(
        CliRunner().invoke(one, ["--help"]).output.replace("│", " ").split()
    )


def settings_of(commands: Iterable[tuple[str, type, set[str]]]) -> Iterator[tuple[str, type, str]]:
    """Each field that is an option of a command."""
    return (
        (name, kind, each.name) for name, kind, but in commands for each in fields(kind) if each.name not in but
    )


@over(settings_of(COMMANDS))
def test_every_setting_is_an_option(name: str, kind: type, field: str) -> None:
    is_option(name, kind, field)


def is_option(name: str, kind: type, field: str) -> None:
    command: Any = typer.main.get_command(app)
    for word in name.split():
        command = command.commands[word]
    (found,) = [each for each in command.params if each.name == field]
    assert found.opts[0].replace("--no-", "--") == option(kind, field)
    assert found.help == inherited_field_docs(kind)[field].replace("`", "")
