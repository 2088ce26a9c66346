import json
import subprocess
import sys

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from automotive_cosim import __version__
from automotive_cosim.agents import AGENTS
from automotive_cosim.cli.main import LIST, app, made
from automotive_cosim.errors import TriggerNotReachedError
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

HEAVY = ("libsumo", "pydantic", "shapely", "pyproj", "PIL", "openai", "matplotlib", "jinja2", "scipy", "pandas")


def test_help_names_every_command_and_loads_nothing_heavy():
    program = (
        "import sys; sys.argv = ['automotive-cosim', '--help']\n"
        "from automotive_cosim.cli.main import main\n"
        "try: main()\n"
        f"finally: print('LOADED', *[name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert done.stdout.splitlines()[-1] == "LOADED"
    for command in get_command(app).commands:
        assert f" {command} " in done.stdout


def every_command(command=None, path=()):
    command = command or get_command(app)
    yield path
    for name, below in getattr(command, "commands", {}).items():
        yield from every_command(below, (*path, name))


@pytest.mark.parametrize("command", list(every_command()), ids=" ".join)
def test_every_command_explains_itself(cli, command):
    ran = cli(*command, "--help")
    assert ran.code == 0
    assert "Usage" in ran.out
    assert ran.err == ""


def test_version(cli):
    assert cli("--version").out.split() == ["automotive-cosim", __version__]


def test_tasks_and_agents_are_listed(cli):
    listed = cli("tasks", "list").out.splitlines()
    standard = [task.id for task in CATALOGUE.of(Suite.STANDARD)]
    assert [line.split()[0] for line in listed[: listed.index("")]] == standard
    hard = cli("tasks", "list", "--suite", "hard").out.splitlines()
    assert [line.split()[0] for line in hard[: hard.index("")]] == [task.id for task in CATALOGUE.of(Suite.HARD)]
    every = cli("tasks", "list", "--suite", "all").out.splitlines()
    assert every.index("") == len(CATALOGUE)
    assert cli("tasks", "list", "--suite", "easy").code == 2
    assert set(AGENTS) <= set(cli("agents").out.split())


@pytest.mark.slow
@over(CATALOGUE)
def test_a_task_is_shown_with_its_words_and_halves(task, cli):
    text = cli("tasks", "show", task).out
    assert all(words in text for words in CATALOGUE[task].templates)
    assert all(f"{half} half" in text for half in CATALOGUE[task].halves)
    assert text.count("  won by    ") == len(CATALOGUE[task].halves)


@pytest.mark.parametrize(
    ("error", "code"), [(TriggerNotReachedError("the light\nwas red"), 3), (KeyboardInterrupt(), 130)]
)
def test_other_ends_have_codes_of_their_own(cli, monkeypatch, error, code):
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr("automotive_cosim.agents.make_agent", fail)
    ran = cli("run")
    assert ran.code == code
    assert ran.out == ""
    assert ran.err.startswith("error: ")
    assert len(ran.err.splitlines()) == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("tasks", "show"), "Missing argument 'task'; see `automotive-cosim tasks show --help`"),
        (("publish", "pack"), "No such command 'pack'; see `automotive-cosim publish --help`"),
        (("runn",), "No such command 'runn'. Did you mean 'run'?"),
        (
            ("run", "--latency", "-1"),
            "Invalid value for '--latency': '-1' is not a number from 0 to 600; see `automotive-cosim run --help`",
        ),
    ],
)
def test_wrong_words_are_named_with_where_to_read_the_right_ones(cli, words, said):
    ran = cli(*words)
    assert (ran.code, ran.out, ran.err) == (2, "", f"error: {said}\n")


OTHERS = {
    ("a2a",), ("mcp",), ("serve",), ("measures",), ("report",), ("show", "screens"), ("show", "schema"),
    ("scenarios", "render"), ("scenarios", "import"), ("scenarios", "day"),
    ("scenarios", "download"), ("publish", "bundle"), ("publish", "leaderboard"),
    ("export",), ("keep",), ("ci", "init"),
}  # fmt: skip
"""Commands whose result is a file, a server, or traffic that is kept."""


@pytest.mark.parametrize("command", list(filter(None, every_command())), ids=" ".join)
def test_every_command_that_lists_or_reports_does_so_as_json(cli, command):
    told = cli(*command, "--help").out
    is_group = "COMMAND" in told.split("Options")[0]
    knows = command not in OTHERS and not is_group
    assert ("--json" in told) is knows
    for words in (("--json", *command), (*command, "--json")):
        assert is_group or ("No such option: --json" in cli(*words, *["--nope"] * knows).err) is not knows


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("tasks validate --tasks --json", "no task, pattern or tag named '--json'"),
        ("tasks validate --seeds --json --tasks hvac_fan_max", "--seeds"),
        ("tasks show -- --json", "no task named '--json'"),
    ],
)
def test_what_stands_in_the_place_of_a_value_is_that_value(cli, words, said):
    ran = cli(*words.split())
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err


def test_every_command_stands_under_a_heading():
    panels = {command.rich_help_panel for command in get_command(app).commands.values()}
    assert 3 <= len(panels) <= 5
    assert all(isinstance(panel, str) for panel in panels)


@pytest.mark.parametrize(
    "command",
    [
        "agents list",
        "agents show t3a",
        "scenarios list",
        "scenarios show grid",
        "show signals",
        "show drives",
        "tasks show hvac_fan_max",
    ],
)
def test_json_is_one_object_and_nothing_else(cli, command):
    ran = cli(*command.split(), "--json")
    assert ran.code == 0
    assert isinstance(json.loads(ran.out), dict)
    assert ran.err == ""


def test_the_list_of_commands_is_that_of_the_commands_themselves():
    """It is read from their files, because to import all takes longer."""
    listed, imported = (CliRunner().invoke(each, ["--help"], env={"COLUMNS": "100"}) for each in (made(LIST), app))
    assert listed.output == imported.output
    assert "study" in listed.output
