"""No control character of others reaches a terminal."""

import ast
import io
import json
import os
import shlex
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from threading import Event

import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

import automotive_cosim.cli
from automotive_cosim import scenarios
from automotive_cosim.cli.console import Console
from automotive_cosim.cli.live import Live, LongWait
from automotive_cosim.cli.main import CLOSED_PIPE, app
from automotive_cosim.cli.terminal import Plain, escaped
from automotive_cosim.formats.plain import plain
from automotive_cosim_main import LOADING
from tests.cli.streams import OUTPUTS
from tests.cli.test_main import every_command

EVIL = "\x1b[2J\x1b]0;owned\x07\x9b1A\r\x08\u202e"


def _controls(text: str) -> list[str]:
    return [each for each in text if each not in "\n\t" and plain(each) != each]


@given(st.text())
def test_a_plain_text_keeps_everything_else(text: str) -> None:
    assert _controls(plain(text)) == []
    assert len(plain(text)) == len(text)
    assert plain(plain(text)) == plain(text)
    if text.isprintable():
        assert plain(text) == text


@given(st.text())
def test_json_says_the_same_without_them(text: str) -> None:
    told = escaped(json.dumps({text: text}, ensure_ascii=False))
    assert _controls(told) == []
    assert json.loads(told) == {text: text}


@pytest.mark.parametrize("terminal", [False, True])
def test_rich_writes_its_own_controls_alone(terminal: bool) -> None:
    def written(name: str) -> str:
        stream = io.StringIO()
        colours = "standard" if terminal else None
        console = Console(file=stream, force_terminal=terminal, width=90, color_system=colours, highlight=False)
        table = Table(name, title=name)
        table.add_row(name, Text(name, style="bold red"))
        for what in (name, Text(name), Panel(name, title=name), table, f"[link={name}]x[/link] [/nothing]"):
            console.print(what)
        return stream.getvalue()

    evil = written(EVIL)
    assert "owned" in evil
    assert "[2J" in evil
    assert "\x1b[2J" not in evil
    assert not set(EVIL[-5:]) & {"\x07", "\x9b", "\r", "\x08", "\u202e"} & set(evil)
    assert ("\x1b" in evil) is terminal
    assert written("x").count("\x1b") == evil.count("\x1b")


def test_a_name_is_no_markup() -> None:
    stream = io.StringIO()
    live = Live(Console(file=stream, force_terminal=True, width=90))
    name = "[/x] [bold]"
    live.loading(replace(scenarios.load("grid"), title=name, notes=(name,)))
    live.warming(name, 1.0, 2.0)
    assert stream.getvalue().count(name) >= 3


def test_rich_finds_the_stream_behind_a_plain_one(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr("sys.stdout", Plain(stream))
    Console(force_terminal=True, color_system="standard").print(Text(EVIL, style="red"))
    print(EVIL)
    assert "\x1b[31m" in stream.getvalue()
    assert stream.getvalue().splitlines()[-1].startswith("\ufffd[2J")


@pytest.mark.parametrize("encoding", ["ascii", "utf-8", "latin-1"])
def test_no_encoding_is_a_way_round(monkeypatch: pytest.MonkeyPatch, encoding: str) -> None:
    data = io.BytesIO()
    monkeypatch.setattr("sys.stdout", Plain(io.TextIOWrapper(data, encoding=encoding, errors="replace")))
    typer.echo(f"{EVIL}é")
    print(f"{EVIL}é", flush=True)
    told = data.getvalue().decode(encoding)
    assert _controls(told) == []
    assert told.count("owned") == 2


def test_names_and_errors_are_shown_plain(cli, tmp_path: Path) -> None:
    shutil.copytree(scenarios.load("grid").folder, tmp_path / "town")
    toml = tmp_path / "town" / "scenario.toml"
    toml.write_text(toml.read_text().replace('title = "', 'title = "\\u001b[2J\\u0007'))
    shown = cli("scenarios", "show", "town")
    assert shown.code == 0
    assert "\ufffdGrid" in shown.out
    assert _controls(shown.out) == []
    refused = cli("scenarios", "show", f"x{EVIL}y")
    assert refused.code == 2
    assert _controls(refused.err) == []


def test_every_command_writes_through_our_console() -> None:
    for path in Path(automotive_cosim.cli.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module == "rich.console" and path.name != "console.py":
                assert "Console" not in [name.name for name in node.names], path.name


def test_every_command_prints_its_json_through_what_keeps_it_alone() -> None:
    package = Path(automotive_cosim.cli.__file__).parent
    for path in package.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("print", "typer.echo"):
                assert "dumps(" not in ast.unparse(node), f"{path.relative_to(package)} prints JSON itself"


def _chatter(**named: object) -> object:
    print("CHATTER of Python", flush=True)
    os.write(1, b"CHATTER of a compiled library\n")
    subprocess.run(["echo", "CHATTER of a program"], check=True)
    return app(**named)


def test_json_stands_alone_whatever_else_prints(cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """``main`` runs all commands alike."""
    monkeypatch.setattr("automotive_cosim.cli.main.made", lambda *asked: _chatter)
    asked = cli("agents", "list", "--json")
    assert json.loads(asked.out)["agents"]
    assert asked.err.count("CHATTER") == 3
    for words in (("agents", "list"), ("agents", "list", "--json", "--help")):
        told = cli(*words)
        assert (told.out.count("CHATTER"), told.err) == (3, "")


@pytest.mark.slow
@pytest.mark.parametrize("closed", [">&-", "<&-", "2>&-", "<&- >&- 2>&-"])
def test_a_command_does_its_work_without_the_streams_that_it_lacks(tmp_path: Path, closed: str) -> None:
    program = shlex.join([sys.executable, "-m", "automotive_cosim_main"])
    table = tmp_path / "plan.schema.json"
    done = subprocess.run(
        ["sh", "-c", f"{program} show schema plan --out {table} {closed}"], capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(table.read_text("utf-8"))["title"] == "plan"


@pytest.mark.slow
def test_a_reader_that_has_had_enough_is_no_failed_check() -> None:
    program = shlex.join([sys.executable, "-m", "automotive_cosim_main"])
    done = subprocess.run(
        ["bash", "-c", f"{program} tasks list | head -1; exit ${{PIPESTATUS[0]}}"], capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (CLOSED_PIPE, "")
    assert len(done.stdout.splitlines()) == 1


@pytest.mark.slow
def test_a_name_of_any_letters_ends_without_a_traceback(tmp_path: Path) -> None:
    surroundings = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    done = subprocess.run(
        [sys.executable, "-m", "automotive_cosim_main", "report", tmp_path / "gr\u00f6\u00dfe\udcf6"],
        capture_output=True,
        env=surroundings,
    )
    assert done.returncode == 2
    assert [line.partition(b" ")[0] for line in done.stderr.splitlines()] == [b"loading", b"error:"]


PRINTS = ("--help", "agents list --json", "show signals", "show drives", "show schema plan")


@pytest.mark.slow
def test_no_command_ends_with_a_traceback_whatever_its_output_and_names(tmp_path: Path) -> None:
    """A name that is neither ASCII nor UTF-8, for every command; some that print, with every output."""
    every = [command for command in every_command() if command]
    asked = [
        *(("ascii", [*command, "größe-東京-\udcf6"]) for command in every),
        *((output, words.split()) for output in OUTPUTS for words in PRINTS),
    ]
    done = subprocess.run(
        [sys.executable, "-m", "tests.cli.streams"],
        input=json.dumps(asked),
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
    )
    ends = json.loads(done.stdout)
    assert [end for end in ends if "Traceback" in end[3] or end[2] not in (0, 2, CLOSED_PIPE)] == []
    codes = {output: {code for kind, words, code, _ in ends if kind == output} for output in OUTPUTS}
    assert codes["closed"] == {0}
    assert codes["without a reader"] == {CLOSED_PIPE}
    assert codes["full"] == {2}


def test_what_loads_is_told_before_anything_is_imported(tmp_path: Path) -> None:
    (tmp_path / "typer.py").write_text("raise SystemExit(9)\n", encoding="utf-8")
    for words, told in (
        (["run"], "loading tasks and agents\n"),
        (["--debug", "scenarios", "import", "x.osm"], "loading the importer\n"),
        (["scenarios", "list"], ""),
        (["run", "--help"], ""),
        (["compare", "run"], "loading results\n"),
    ):
        code = "from automotive_cosim_main import main; main()"
        done = subprocess.run([sys.executable, "-c", code, *words], cwd=tmp_path, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (9, told), words


def test_every_command_that_loads_long_is_one() -> None:
    assert set(LOADING) <= {" ".join(path) for path in every_command()}


def test_who_waits_is_told_how_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("automotive_cosim.cli.live.WAITING_S", 0.02)
    told: list[str] = []
    twice = Event()

    def tell(line: str) -> None:
        told.append(line.strip())
        if len(told) == 2:
            twice.set()

    waiting = LongWait(tell)
    waiting.start("the agent's action")
    assert twice.wait(10.0)
    waiting.stop()
    assert told[0] == "waiting for the agent's action, 0:00 so far"


def test_no_line_interrupts_who_acts_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[str] = []
    monkeypatch.setattr(LongWait, "start", lambda self, of: started.append(of))
    for by_hand in (True, False):
        Live(Console(file=io.StringIO()), by_hand=by_hand)._wait()
    assert started == ["the agent's action"]


SWALLOWED = """
import os, signal, sys, time, weakref
from automotive_cosim.cli import main

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it

class Thing: pass

def command():
    thing = Thing()
    callback = weakref.ref(thing, lambda gone: (os.kill(os.getpid(), int(sys.argv[1])), sum(range(10**5))))
    try:
        del thing
        time.sleep(20)
    except KeyboardInterrupt:
        return main.INTERRUPTED
    return 0

main._run = command
main.main()
"""


@pytest.mark.parametrize(("number", "code"), [(15, 143), (2, 130)])
def test_a_signal_that_lands_in_a_callback_is_not_lost(number, code):
    """What is raised in a callback of a weak reference is swallowed by the interpreter."""
    ended = subprocess.run(
        [sys.executable, "-c", SWALLOWED, str(number)], capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stderr) == (code, "error: interrupted\n")
