"""What README and docs tell a reader to type is what the program takes."""

import re
import shlex
from pathlib import Path

import pytest
from typer import TyperException
from typer.main import get_command

from automotive_cosim.cli.main import app
from automotive_cosim.tasks.folder import VARIABLE

TOP = Path(__file__).parents[2]
PAGES = sorted(
    [TOP / "README.md", TOP / "CONTRIBUTING.md", *(TOP / "docs").glob("*.md"), *(TOP / "docs/studies").glob("*.md")]
)
PROGRAM = re.compile(r"^(?:\S*/)?automotive-cosim\b")


def blocks(page):
    """The text of every block of code, fenced or indented, with its language."""
    language, lines = "", []
    for line in [*page.read_text(encoding="utf-8").splitlines(), ""]:
        fence = re.match(r"^\s*```(\S*)", line)
        is_indented = line.startswith("    ") and not line.lstrip().startswith(("*", "|"))
        if language == "indented" and not is_indented:
            yield "shell", "\n".join(lines)
            language = ""
        if fence and not language:
            language, lines = fence[1] or "text", []
        elif fence:
            yield language, "\n".join(lines)
            language = ""
        elif language:
            lines.append(line)
        elif is_indented:
            language, lines = "indented", [line]


def commands():
    """Every call of the program in a block, with its page."""
    for page in PAGES:
        for language, text in blocks(page):
            if language in ("shell", "text", "bash", "sh", "console"):
                for line in text.replace("\\\n", " ").splitlines():
                    if PROGRAM.match(line.strip()):
                        yield pytest.param(line.strip(), id=f"{page.stem}: {line.strip()[:60]}")


def parse(command, arguments):
    context = command.make_context(command.name or "automotive-cosim", arguments)
    below = [*getattr(context, "_protected_args", ()), *context.args]
    if hasattr(command, "resolve_command") and below:
        _, inner, rest = command.resolve_command(context, below)
        parse(inner, rest)


@pytest.mark.parametrize("line", list(commands()))
def test_every_command_in_the_docs_is_understood(line, monkeypatch):
    monkeypatch.setenv(VARIABLE, "")  # --tasks-from sets it for every process to come; this takes that back
    words = shlex.split(line.split(" | ")[0].split(" > ")[0], comments=True)
    try:
        parse(get_command(app), [re.sub(r"\$\w+", "x", word) for word in words[1:]])
    except TyperException as error:
        pytest.fail(f"{line}: {error.format_message()}")


def test_there_are_commands_to_try():
    assert len(list(commands())) > 40


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_python_block_compiles(page):
    for language, text in blocks(page):
        if language == "python":
            compile(text, page.name, "exec")
