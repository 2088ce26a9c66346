"""Options that follow from the fields of a dataclass."""

from __future__ import annotations

from dataclasses import dataclass, fields, make_dataclass
from typing import Annotated, Any, Literal

import pytest
import typer
from annotated_types import Ge
from typer.testing import CliRunner

from automotive_cosim.cli.derived import settings_in, takes
from automotive_cosim.cli.main import app
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import Option
from automotive_cosim.formats.docs import inherited_field_docs
from automotive_cosim.formats.options import option
from automotive_cosim.studies.settings import CongestionSettings, DaysSettings, RerouteSettings, SuiteSettings
from tests.laws import over

COMMANDS = {
    "reroute": (RerouteSettings, ()),
    "suite": (SuiteSettings, ("scenario", "warm_up_s")),
    "congestion": (CongestionSettings, ()),
    "days": (DaysSettings, ()),
}


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
    line = "--whom Eva --wait 3 --often auto --seeds 0-2,7 --shares 0.5,1 --word a,b --word c --loud --name x"
    assert told(*line.split())[0] == {
        "whom": "Eva",
        "wait_s": 3.0,
        "often": "auto",
        "seeds": (0, 1, 2, 7),
        "shares": (0.5, 1.0),
        "words": ("a,b", "c"),
        "loud": True,
        "name": "x",
    }


def test_help_is_the_docstring_with_the_default() -> None:
    shown = " ".join(told("--help")[1].replace("│", " ").split())
    for text in ("Seconds to wait before it. [default: (2.5)]", "[default: (0-2)]", "[default: (the car's)]"):
        assert text in shown


def test_lists_of_numbers_refuse_anything_else() -> None:
    with pytest.raises(UserError, match="--shares has 'half'; give numbers separated by commas"):
        told("--shares", "0.5,half")
    with pytest.raises(UserError, match="--seeds has 'x'; give numbers and ranges"):
        told("--seeds", "x")


def test_a_new_field_is_an_option_by_itself() -> None:
    more = make_dataclass("More", [("new_thing_s", float, 1.0)], bases=(Settings,), frozen=True)
    more.__field_docs__ = {"new_thing_s": "A new thing."}  # type: ignore[attr-defined]
    one = typer.Typer()
    one.command()(takes(more)(lambda **settings: print(settings_in(more, settings))))
    assert CliRunner().invoke(one, ["--new-thing", "4"]).output.strip() == "{'new_thing_s': 4.0}"


@over(
    (name, field.name) for name, (kind, but) in COMMANDS.items() for field in fields(kind) if field.name not in but
)
def test_every_setting_of_a_study_is_an_option(name: str, field: str) -> None:
    command = typer.main.get_command(app).commands["study"].commands[name]  # type: ignore[attr-defined]
    (found,) = [each for each in command.params if each.name == field]
    kind = COMMANDS[name][0]
    assert found.opts == [option(kind, field)]
    assert found.help == inherited_field_docs(kind)[field].replace("`", "")
