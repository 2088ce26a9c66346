"""docs/geo.md and its reference say what is so: their examples are run."""

import re
from collections import Counter
from collections.abc import Callable
from datetime import datetime
from importlib.resources import files
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.main import made
from automotive_cosim.contracts import DrivingState, GpsFix
from automotive_cosim.errors import UserError
from automotive_cosim.geo.basics import basics_of, rows
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.rulefacts import CONDITIONS
from automotive_cosim.geo.rulefile import read_jurisdiction
from automotive_cosim.geo.rules import ANSWERS, TOPICS, UNITS, USERS, Status

DOCS = Path(__file__).parents[2] / "docs"
DOC = "".join((DOCS / page).read_text(encoding="utf-8") for page in ("geo.md", "reference/geo.md"))
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", DOC, re.DOTALL)
APP = made("show", "context")


def _block(kind: str, number: int = 0) -> str:
    return [text for found, text in BLOCKS if found == kind][number]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my_rules").mkdir()
    (tmp_path / "my_rules" / "FR-tours.toml").write_text(_block("toml"), encoding="utf-8")
    return tmp_path


def test_the_example_shows_in_the_command(folder: Path) -> None:
    arguments = _block("console").removeprefix("$ automotive-cosim show context ").split()
    result = CliRunner().invoke(APP, ["show", "context", *arguments], catch_exceptions=False)
    assert set(_block("text").splitlines()) <= set(result.stdout.splitlines())


def test_the_example_shows_through_geo(folder: Path, drive: Callable[..., DrivingState]) -> None:
    geo = Geo(folders=[folder / "my_rules"])
    fix = GpsFix(True, 0.69, 47.39, 3.0, 0.0, 90.0)
    time = datetime(2026, 1, 20, 10, tzinfo=ZoneInfo("Europe/Paris"))
    text = geo.locate(drive(road_class="residential", speed_mps=0.0), fix, None, time).text()
    assert set(_block("text").splitlines()) <= set(text.splitlines())


def test_the_refusal_is_the_one_shown(folder: Path) -> None:
    path = folder / "my_rules" / "FR-tours.toml"
    path.write_text(_block("toml").replace('topic = "limit"', 'topic = "limt"'), encoding="utf-8")
    arguments = _block("console").removeprefix("$ automotive-cosim show context ").split()
    with pytest.raises(UserError) as error:
        CliRunner().invoke(APP, ["show", "context", *arguments], catch_exceptions=False)
    assert f"error: {error.value}\n" == _block("text", 1)


def test_the_rules_of_each_status_are_counted() -> None:
    paths = Path(str(files("automotive_cosim.geo.data"))).glob("*.toml")
    counts = Counter(str(rule.status) for path in paths for rule in read_jurisdiction(path).rules)
    told = re.findall(r"^\| `(\w+)` \| [^|]* \| (\d+) \|$", DOC, re.MULTILINE)
    assert {status: int(count) for status, count in told} == counts
    verified, whole = counts["verified"], sum(counts.values())
    for page, words in (
        ("README.md", f"{verified} of {whole}"),
        ("docs/reference/evaluation.md", f"Of our {whole} legal rules {verified} are verified"),
    ):
        assert words in (Path(__file__).parents[2] / page).read_text(encoding="utf-8"), page


def test_the_basics_of_each_status_are_counted() -> None:
    counts = Counter(str(rule.status) for row in map(basics_of, rows()) if row for rule in row.country.rules)
    (told,) = re.findall(
        r"^`geo/data/basics.csv` .* (\d+) are secondary, (\d+) knowledge, (\d+) uncertain", DOC, re.M
    )
    assert tuple(map(int, told)) == tuple(counts[status] for status in ("secondary", "knowledge", "uncertain"))


@pytest.mark.parametrize("line", re.findall(r"^    automotive-cosim show context (.*)$", DOC, re.MULTILINE))
def test_the_commands_run(line: str) -> None:
    assert CliRunner().invoke(APP, ["show", "context", *line.split()], catch_exceptions=False).exit_code == 0


def test_the_line_of_law_is_one(locate: Callable[..., GeoContext]) -> None:
    (line,) = re.findall(r"^    (Rear fog lamp: .*)$", DOC, re.MULTILINE)
    assert line in [each.text for each in locate(52.52, 13.4).lines]


def test_every_word_of_the_language_is_explained() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| ([^|]*) \|", DOC, re.MULTILINE))
    assert set(TOPICS) <= set(rows)
    assert {word: condition.expects for word, condition in CONDITIONS.items()}.items() <= rows.items()
    assert {topic: label for topic, label in TOPICS.items() if topic not in CONDITIONS}.items() <= rows.items()
    assert {str(status) for status in Status} <= set(rows)
    for word in (*ANSWERS, *UNITS, *(USERS - {"car"})):
        assert f"`{word}`" in DOC
