"""README and docs say what is so: every command in them is understood, and every block is run.

As it stands where that is quick, on the small grid or with ``--dry-run`` where it is not, and not at all where it
needs what only the reader has, or another test runs it.
"""

import ast
import re
import shlex
import shutil
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import fields
from importlib.util import find_spec
from pathlib import Path

import pytest
from typer import TyperException
from typer.main import get_command

from automotive_cosim.cli.main import app
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.interface.functions import functions
from automotive_cosim.tasking.own_files import VARIABLE
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Hurry
from automotive_cosim.tasks import CATALOGUE
from docs import tables
from tests.laws import over

TOP = Path(__file__).parents[2]
PAGES = sorted([TOP / "README.md", TOP / "CONTRIBUTING.md", *(TOP / "docs").glob("**/*.md")])
PAGES = [page for page in PAGES if not {"_made", "_site"} & set(page.parts)]
LOOKED_UP = {"glossary", "CONTRIBUTING"}
"""Pages beside docs/reference that nobody reads from beginning to end."""
MOST_WORDS = 1_000
MOST_WORDS_OF_ALL = 18_000
PROGRAM = re.compile(r"^(?:\S*/)?automotive-cosim\b")


LINKED = [*TOP.glob("*.md"), *PAGES, *TOP.glob("[!.]*/README.md"), *TOP.glob("sumo_scenarios/*/*.md")]
"""Every page that a reader of a checkout opens."""
LINK = re.compile(r"\]\(([^)\s]+)\)|(?:href|src)=\"([^\"]+)\"")


def blocks(page: Path) -> Iterator[tuple[str, str]]:
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


def commands() -> Iterator[tuple[str, str]]:
    """Every call of the program in a block, with its page's name."""
    for page in PAGES:
        for language, text in blocks(page):
            if language in ("shell", "text", "bash", "sh", "console"):
                for line in re.sub(r"\\\n\s*", "", text).splitlines():
                    if PROGRAM.match(line.strip().removeprefix("$ ")):
                        yield page.stem, line.strip().removeprefix("$ ")


def parse(command, arguments):
    context = command.make_context(command.name or "automotive-cosim", arguments)
    below = [*getattr(context, "_protected_args", ()), *context.args]
    if hasattr(command, "resolve_command") and below:
        _, inner, rest = command.resolve_command(context, below)
        parse(inner, rest)


@over(list(dict.fromkeys(line for _, line in commands())))
def test_every_command_in_the_docs_is_understood(line, monkeypatch, tmp_path):
    monkeypatch.setenv(VARIABLE, "")  # --tasks-from sets it for every process to come; this takes that back
    monkeypatch.chdir(tmp_path)
    for folder in re.findall(r"--tasks-from (\S+)", line):
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        (tmp_path / folder / "own.py").touch()
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


GUIDES = [page for page in PAGES if page.parent.name != "reference" and page.stem not in LOOKED_UP]


@over(GUIDES)
def test_a_guide_can_be_read_in_five_minutes(page):
    looked_up = r"^```[^`]*^```|^    [^\n]*$|\]\(\S+?\)|\| `[\w./:]+` (?=\|)|\|"
    prose = re.sub(looked_up, "", page.read_text("utf-8"), flags=re.MULTILINE)
    assert len(prose.split()) <= MOST_WORDS, "move what is looked up to docs/reference"


def test_all_guides_can_be_read_in_an_hour_and_a_half():
    """Tables and code count here, as for ``wc -w``."""
    words = sum(len(page.read_text("utf-8").split()) for page in GUIDES)
    assert words <= MOST_WORDS_OF_ALL, "say it once, or move what is looked up to docs/reference"


def without_code(page):
    return re.sub(r"^( *)```.*?^\1```|^    [^\n]*$", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)


def anchors(page):
    """The anchors of a page's headings, as code hosts and the site name them."""
    named: Counter[str] = Counter()
    for title in re.findall(r"^#+ (.+)$", without_code(page), re.MULTILINE):
        words = re.sub(r"\]\(.*?\)|[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
        named[words] += 1
        yield words if named[words] == 1 else f"{words}-{named[words] - 1}"


@over(dict.fromkeys(LINKED))
def test_every_link_leads_to_a_page_and_a_heading_of_the_checkout(page):
    assert set(re.findall(r"^```\{(.+)\}", page.read_text("utf-8"), re.MULTILINE)) <= {"eval-rst"}
    text = re.sub(r"`[^`\n]*`", "", without_code(page))
    links = {link for found in LINK.findall(text) for link in found if link and "://" not in link}
    for link in links:
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        assert not {"_made", "_site"} & set(target.parts), f"{link} exists only after `make docs`"
        assert not anchor or anchor in anchors(target), link


@pytest.mark.slow
@over(tables.pages())
def test_the_tables_of_a_page_are_what_the_code_says(page):
    assert not tables.stale(page), "`python -m docs.tables` makes them anew"


def test_every_table_stands_on_a_page():
    placed = [mark[2] for page in tables.pages() for mark in tables.MARKED.finditer(page.read_text("utf-8"))]
    assert sorted(placed) == sorted(tables.MADE)


# --- run -------------------------------------------------------------------------------------------------

GRID = ("--scenario", "grid", "--task", "hvac_fan_max")
"""The last of several values of an option counts."""
LAST = ("--force", "--out", "runs/last")
AS_IT_IS = ()
DRY = ("--dry-run",)
NOT_RUN = None

TREATED: list[tuple[str, tuple[str, ...] | None, str]] = [
    (r"(doctor|eval) .*(FILE\.gguf|--key)", NOT_RUN, "needs a model or a key; tests/models and tests/run try such"),
    (r"eval .*failures/", NOT_RUN, "needs a search; tests/safety/test_trying.py has one"),
    (r"(search|measures)", NOT_RUN, "takes minutes; tests/safety and tests/measures try them"),
    (r"export", NOT_RUN, "needs a recorded drive; tests/exchange has one"),
    (r"eval .*--executor ray", NOT_RUN, "needs a cluster; tests/run/test_on_ray.py has one"),
    (r"eval ", DRY, "takes minutes; `ran` below is an evaluation on the grid"),
    (r"study reroute --scenario (resco|shipped,)", NOT_RUN, "needs networks of others"),
    (r"study (adoption|congestion|days|compare)", NOT_RUN, "takes minutes; tests/studies run them"),
    (r"study reroute", DRY, "takes minutes; tests/studies run studies"),
    (r"run .*(--model '?replay/|--agent (my_agent:|caller --interface functions --see))", LAST, ""),
    (r"run --agent my_agents:", (*GRID, *LAST), "takes ten seconds in its own scenario"),
    (r"run .*--task my_seat_warmer", LAST, ""),
    (r"run", NOT_RUN, "needs what only the reader has, or takes ten seconds in its own scenario; tests/cli run it"),
    (r"tasks validate", ("--gates", "start", "--seeds", "0"), "all gates take minutes; tests/proof tries them"),
    (r"report runs/(hunt|drives|speed)", NOT_RUN, "tests/safety and tests/run/test_drives.py report on such"),
    (r"publish .*(runs/board|NAME|hidden)", NOT_RUN, "needs evaluations of others; `make docs` checks two bundles"),
    (r"(serve|mcp|a2a)", NOT_RUN, "serves until it is stopped; tests/serve and tests/doors ask it"),
    (r"bench", NOT_RUN, "measures for a minute; tests/cli/test_bench.py runs it"),
    (r"scenarios (check|download)", NOT_RUN, "takes minutes or the network; tests/osm has them"),
    (r"scenarios (calibrate|equilibrate)", NOT_RUN, "take minutes; tests/calibration and tests/scenarios try them"),
    (r"scenarios import (pass|city|paris)", NOT_RUN, "needs a map of the reader's; test_examples.py imports one"),
    (r"scenarios import", NOT_RUN, "test_examples.py imports the hamlet"),
    (r"attribute", NOT_RUN, "needs a recorded run or drive; tests/run/test_attribution.py measures such"),
    (r"replay", AS_IT_IS, ""),
    (r"", AS_IT_IS, ""),
]
"""The first pattern that a command begins with says what is added to it, and why."""
ELSEWHERE = {"from inspect_ai": "inspect_ai"}
"""What a block begins with that is run where a package outside the tests' own is installed."""
FOLDERS = r"\b(runs/(mine|first|before|after|jam))\b"
EXCERPTS = {
    "Skill(": "an excerpt of models/skills.py",
    '"""pip install openai-agents': "needs a package of others; test_frameworks.py runs the same file",
    "import minari": "needs Minari, and a table of demonstrations",
    "from android_world": "needs a checkout of AndroidWorld; tests/agents/test_androidworld.py has one",
}


def treatment(line):
    arguments = line.partition(" ")[2]
    return next(entry for entry in TREATED if re.match(entry[0], arguments))


def block(page, kind, first=""):
    """The block of a page that is of that language and begins so."""
    (found,) = (text for language, text in blocks(TOP / page) if language == kind and text.startswith(first))
    return found


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with what the pages tell the reader to save, beside a checkout's docs."""
    folder = tmp_path_factory.mktemp("reader")
    (folder / "my_tasks").mkdir()
    (folder / "my_tasks/fog.toml").write_text(block("docs/tasks.md", "toml"), encoding="utf-8")
    (folder / "my_tasks/seats.toml").write_text(block("docs/tutorial.md", "toml", "[my_seat"), encoding="utf-8")
    agent = block("docs/tutorial.md", "python", "from automotive_cosim import Action")
    (folder / "my_agents.py").write_text(agent, encoding="utf-8")
    (folder / "tasks").mkdir()
    (folder / "tasks" / "own.py").write_text("TASKS = ()\n", encoding="utf-8")
    shutil.copytree(TOP / "docs/examples", folder / "docs/examples")
    shutil.copytree(TOP / "docs/examples/my-agent", folder / "my-agent")
    (folder / "prompts").mkdir()
    (folder / "prompts/careful.md").write_text("Be careful.\n", encoding="utf-8")
    (folder / "my_rules").mkdir()
    (folder / "my_rules/FR-tours.toml").write_text(block("docs/geo.md", "toml"), encoding="utf-8")
    for name in ("my_agent.py", "plan.toml"):
        shutil.copyfile(TOP / "docs/examples/my-agent" / name, folder / name)
    return folder


@pytest.fixture
def reader(cli, place, monkeypatch):
    """The command line in that folder; what ``--tasks-from`` sets ends with the test."""
    monkeypatch.chdir(place)
    monkeypatch.setenv(VARIABLE, "")
    monkeypatch.syspath_prepend(str(place))
    monkeypatch.delitem(sys.modules, "my_agents", raising=False)  # another test's
    return cli


@pytest.fixture
def ran(reader, place):
    """An evaluation under the names that the pages use, and its bundle."""
    if not (place / "runs/mine").exists():
        plan = ("--agents", "asurada,no-op", "--tasks", "hvac_fan_max", "--scenarios", "grid", "--out", "runs/mine")
        assert reader("eval", *plan).code == 0
        for name in ("first", "before", "after"):
            shutil.copytree(place / "runs/mine", place / "runs" / name)
        assert reader("publish", "bundle", "runs/mine", "--out", "mine.bundle").code == 0
        (place / "bundles").mkdir()
        shutil.copyfile(place / "mine.bundle", place / "bundles/mine.bundle")
    return place


LINES = list(dict.fromkeys(line for _, line in commands()))


def named(lines):
    return pytest.mark.parametrize("line", [pytest.param(line, id=line[:70]) for line in lines])


def words_of(line):
    return shlex.split(line.split(" | ")[0].split(" > ")[0], comments=True)[1:]


COUNTED = {
    "--agents t3a,asurada,always-alert --tasks safety --seeds 0-4": "says {} episodes from 65 warm",
    "--agents t3a,asurada --scenarios grid,paris_centre": "has {} episodes: all",
}
"""Plans whose episodes the pages count, with the words."""


@pytest.mark.slow
@named([line for line in LINES if treatment(line)[1] == DRY])
def test_every_plan_can_be_run(line, reader):
    result = reader(*words_of(line), *DRY)
    assert result.code == 0, result.err
    pages = "".join((TOP / f"docs/{name}.md").read_text("utf-8") for name in ("evaluation", "reference/evaluation"))
    for words in (words for plan, words in COUNTED.items() if plan in line):
        (planned,) = re.findall(r"runs +([\d,]+) from", result.out)
        assert words.format(planned) in pages


def test_every_plan_that_is_counted_is_there():
    assert all(any(plan in line for line in LINES if treatment(line)[1] == DRY) for plan in COUNTED)


@pytest.mark.slow
@pytest.mark.usefixtures("sumo", "warm")
@named([line for line in LINES if treatment(line)[1] not in (DRY, NOT_RUN)])
def test_every_command_runs(line, reader, place, request):
    added = treatment(line)[1]
    if (re.search(FOLDERS, line) and added == AS_IT_IS) or "bundle" in line:
        request.getfixturevalue("ran")
        episode = next(Path("runs/mine/traces").glob("*.jsonl.gz")).name.removesuffix(".jsonl.gz")
        line = line.replace(" ID", f" {episode}")
    if line.startswith("automotive-cosim publish bundle"):
        Path("mine.bundle").unlink(missing_ok=True)
    words = words_of(line)
    if "--tasks-from" in words:
        request.getfixturevalue("own_tasks")(place / words[words.index("--tasks-from") + 1])
    result = reader(*words, *added)
    assert result.code == 0, result.err
    assert result.out or result.err


@pytest.mark.slow
@pytest.mark.usefixtures("sumo", "warm")
@pytest.mark.parametrize(
    "page", [page for page in PAGES if "python" in dict(blocks(page))], ids=lambda page: page.stem
)
def test_every_python_block_runs(page, reader, on_path, request):
    names: dict[str, object] = {"__name__": "__main__", "ask": None}
    if page == TOP / "docs/evaluation.md":
        request.getfixturevalue("ran")
    try:
        for language, text in blocks(page):
            missing = [of for start, of in ELSEWHERE.items() if text.startswith(start) and find_spec(of) is None]
            if missing or text.startswith(tuple(EXCERPTS)) or "load_study" in text:
                continue
            if language == "python":
                exec(compile(text, page.name, "exec"), names)
    finally:
        for each in names.values():
            with suppress(Exception):
                each.close()  # environments


def test_every_treatment_is_needed():
    used = {treatment(line)[0] for line in LINES}
    assert {pattern for pattern, _, _ in TREATED} - {"replay"} == used - {"replay"}
    text = "\n".join(text for page in PAGES for _, text in blocks(page))
    assert all(each in text for each in (*EXCERPTS, *ELSEWHERE))


TRUST = (TOP / "docs/reference/trust.md").read_text("utf-8")
PROMISES = re.findall(r"^\| (.+?) \| `(\S+)` \| `(\S+)::(\w+)` \|$", TRUST, re.MULTILINE)


@over(PROMISES)
def test_every_promise_of_the_trust_page_is_kept_somewhere_and_shown_by_a_test(promise, module, file, test):
    assert (TOP / "automotive_cosim" / module).is_file()
    written = ast.parse((TOP / "tests" / file).read_text(encoding="utf-8"))
    assert test in {each.name for each in written.body if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)}
    assert sum(promise == row[0] for row in PROMISES) == 1


def test_every_row_of_the_trust_page_names_a_module_and_a_test():
    told = TRUST.partition("| promise | module | test |\n|---|---|---|\n")[2]
    rows = told.partition("\n\n")[0].splitlines()
    assert len(rows) == len(PROMISES) > 20


def test_pages_count_the_tasks_as_they_are():
    standard, hard = (CATALOGUE.of(suite) for suite in (Suite.STANDARD, Suite.HARD))
    pairs, hard_pairs = (sum(task.second is not None for task in tasks) for tasks in (standard, hard))
    limits = len(CATALOGUE.of(Suite.LIMITS))
    reference = (TOP / "docs/reference/tasks.md").read_text("utf-8")
    assert f"has {limits} pairs about what a car cannot do" in reference
    voice = Counter(task.id.split("_")[1] for task in CATALOGUE.of(Suite.VOICE))
    assert f"has {voice.total()} pairs in which noise in the cabin, or who spoke, decides" in reference
    assert [kind for kind, count in voice.items() if f"`voice_{kind}_*` ({count})" not in reference] == []
    assert f"The suite `people` has {len(CATALOGUE.of(Suite.PEOPLE))} pairs." in reference
    hurried = Counter(task.hurries for task in CATALOGUE.values())
    road, call, words = (hurried[kind] for kind in Hurry)
    live = f"eight seconds ({road} pairs), somebody rings ({call}), or the driver says more on the way ({words})."
    assert live in reference
    clarify = len(CATALOGUE.of(Suite.CLARIFY))
    asking = sum("asking" in task.tags for task in standard)
    assert f"has {clarify} pairs about wishes that leave something open" in reference
    assert f"has {asking} more pairs of this form" in reference
    told = {
        "README.md": f"{len(standard)} tasks in eight modules. {pairs} are pairs",
        "docs/report.md": f"{len(standard)} tasks in eight modules; {pairs} of them are pairs, so there are "
        f"{len(standard) + pairs} halves",
        "docs/reference/comparison.md": f"{len(standard)} tasks, {pairs} of them pairs",
        "docs/reference/tasks.md": f"{len(hard)} tasks, {hard_pairs} of them pairs",
    }
    for page, words in told.items():
        assert words in (TOP / page).read_text(encoding="utf-8")
    assert f"has {len(CATALOGUE.of(Suite.SPEED))} pairs about the limit that holds" in reference
    halves = sum(len(task.halves) for task in CATALOGUE.values())
    assert f"of all {halves:,} halves" in " ".join((TOP / "docs/report.md").read_text("utf-8").split())


def test_pages_count_screens_and_functions_as_they_are():
    assert f"with {len(pages())} screens" in (TOP / "docs/cockpit.md").read_text(encoding="utf-8")
    assert f"by {len(functions())} typed functions" in (TOP / "docs/functions.md").read_text(encoding="utf-8")


def test_the_reference_of_observations_has_every_field_reading_action_and_number():
    from automotive_cosim.contracts import Observation, VehicleState
    from automotive_cosim.drives.changes import WAKES
    from automotive_cosim.envs import flat, flat_drive

    text = (TOP / "docs/reference/observations.md").read_text(encoding="utf-8")
    parts = re.split(r"^##+ ", text, flags=re.MULTILINE)
    seen, car, noticed, tasks, drives = (parts[number] for number in (0, 1, 2, 5, 6))
    fields_of = [[field.name for field in fields(kind)] for kind in (Observation, VehicleState)]
    assert [re.findall(r"^\| `(\w+)`", part, re.MULTILINE) for part in (seen, car)] == fields_of
    named = re.findall(r"`([^`]+)`", noticed.rpartition("does:")[2])
    assert named == [wake.name for wake in WAKES]
    alerts = re.findall(r"(\d+)\s`(\w+)`", drives.partition(" numbers: ")[0])
    acts = [(str(number), str(act.kind)) for number, act in enumerate(flat_drive.ACTIONS) if act.kind]
    assert alerts == acts
    assert re.findall(r"^\| ([^|`]+) \|", drives, re.MULTILINE)[1:] == list(flat_drive.FEATURES)
    assert f"There are {flat_drive.DriveNumbers.size} numbers: the {len(flat_drive.FEATURES)} of" in drives
    signs = re.findall(r"([a-z ]+) \(`(\w+)`\)", " ".join(drives.partition("The signs, ")[2].split()))
    told = [(name, sign.alert.value) for name, sign in flat_drive.SIGNS.items()]
    assert [(name.strip(), alert) for name, alert in signs] == told
    assert f"for each of the {len(told)} signs" in " ".join(drives.split())
    assert f"There are {len(flat_drive.ACTIONS)} actions" in drives
    counts = [flat.GOAL_SLOTS, 3 * len(flat.CONTROLS), len(flat.NUMBERS), 1]
    assert re.findall(r"^\| (\d+) \|", tasks, re.MULTILINE) == list(map(str, counts))
    actions = len(flat.APPS) + len(flat.CONTROLS) + len(flat.ENDS)
    assert f"there are {actions} actions and {sum(counts)} numbers" in tasks
