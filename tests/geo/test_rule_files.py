"""Rule files: all that is shipped is well formed; a wrong one is refused with file, entry and reason."""

import tomllib
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path

import pytest

from automotive_cosim.contracts import DrivingState, GpsFix, Weather
from automotive_cosim.errors import UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.geo.basics import basics_of, rows
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.place import Atlas
from automotive_cosim.geo.rulefacts import CONDITIONS, RuleFacts, When, all_hold
from automotive_cosim.geo.rulefile import CaseEntry, read_jurisdiction
from automotive_cosim.geo.rules import TOPICS
from tests.laws import over

SHIPPED = sorted(Path(str(files("automotive_cosim.geo.data"))).glob("*.toml"))

HEAD = """
[jurisdiction]
code = "XX"
name = "Nowhere"
status = "knowledge"
driving_side = "left"
speed_unit = "mph"
temperature_unit = "C"
emergency = ["1"]
"""
TOWN = """
[jurisdiction]
code = "ZZ-town"
within = "ZZ"
kind = "city"
name = "Town"
status = "knowledge"
polygon = [[0, 0], [1, 0], [1, 1]]
"""
RULE = """
[[rules]]
id = "XX.limit"
topic = "limit"
text = "everywhere"
value = 30
unit = "mph"
law = "Act 1"
as_of = 2026-01-01
status = "verified"
"""


def _write(folder: Path, text: str, name: str = "XX.toml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def _conditions(table: dict[str, object]) -> When:
    return checked(CaseEntry, {"value": "allowed", "when": table}, lambda steps: ("", str(steps))).when or ()


@over(SHIPPED)
def test_a_shipped_file_reads(path: Path) -> None:
    entry = read_jurisdiction(path)
    assert entry.code == path.stem
    assert entry.rules or entry.kind == "city"
    assert list(tomllib.loads(path.read_text(encoding="utf-8"))) in (["jurisdiction", "rules"], ["jurisdiction"])


def test_at_least_22_countries_and_no_id_twice() -> None:
    countries = [path.stem for path in SHIPPED if len(path.stem) == 2]
    assert len(countries) >= 22
    ids = [rule.id for path in SHIPPED for rule in read_jurisdiction(path).rules]
    assert len(ids) == len(set(ids))


def test_a_well_formed_file_reads(tmp_path: Path) -> None:
    entry = read_jurisdiction(_write(tmp_path, HEAD + RULE))
    assert (entry.code, entry.driving_side, len(entry.rules)) == ("XX", "left", 1)


@pytest.mark.parametrize(
    ("wrong", "right", "line", "reason"),
    [
        ('topic = "limit"', 'topic = "limt"', 13, "no topic named 'limt': did you mean 'limit'"),
        ('id = "XX.limit"', 'id = "YY.limit"', 12, "id is 'YY.limit'; it must begin with 'XX.'"),
        ("value = 30", "value = 0", 11, "a limit is above 0"),
        ("value = 30", "value = nan", 15, "value is nan; it must be a number"),
        ("value = 30", "value = [30]", 15, "value is [30]; it must be a number"),
        ("value = 30", "cases = []", 15, "cases is empty; it must be a list of tables"),
        ("value = 30", "cases = [30]", 15, "cases[0] is 30; it must be a table"),
        ("value = 30", "cases = [{ value = -1 }]", 15, "cases[0].value is -1"),
        ('unit = "mph"', "unit = 3", 16, "unit is 3; it must be one of"),
        ('unit = "mph"\n', "", 11, "a number requires a unit"),
        ('unit = "mph"', 'unit = "mph"\nwhen = 3', 17, "when is 3; it must be a table"),
        ('unit = "mph"', 'unit = "mph"\nwhen = { visibility_below_m = inf }', 17, "must be a number of metres"),
        (
            'unit = "mph"',
            'unit = "mph"\nwhen = { inside = [[0, 0], [1, 1], [200, 0]] }',
            17,
            "it must be a longitude",
        ),
        ('unit = "mph"', 'unit = "mph"\ncaps = "no"', 17, "caps is 'no'; it must be true"),
        ('unit = "mph"', 'unit = "mph"\nbinds = "everyone"', 17, "no road user named 'everyone'"),
        ('text = "everywhere"', 'text = ""', 14, "text is empty: it must be one line of text"),
        ('text = "everywhere"', 'text = "a\\nb"', 14, "it must be one line of text"),
        ("as_of = 2026-01-01", "as_of = 2026-01-01T10:00:00", 18, "it must be a date such as 2026-03-31"),
        ("value = 30", 'value = "fast"', 15, "value is 'fast'; it must be a number"),
        ("value = 30", 'value = "allowed"', 11, "a limit is a number or 'none'"),
        ('unit = "mph"', 'unit = "mp/h"', 16, "did you mean 'mph'"),
        (
            'unit = "mph"',
            'unit = "mph"\nwhen = { built_up = 1 }',
            17,
            "when.built_up is 1; it must be true or false",
        ),
        ('unit = "mph"', 'unit = "mph"\nwhen = { weather = ["frogs"] }', 17, "no weather named 'frogs'"),
        (
            'unit = "mph"',
            'unit = "mph"\nwhen = { weather = [] }',
            17,
            "when.weather is empty; it must be a list of",
        ),
        ('unit = "mph"', 'unit = "mph"\nwhen = { season = ["13-01", "03-31"] }', 17, "month must be in 1..12"),
        ('unit = "mph"', 'unit = "mph"\nwhen = { hours = ["8", "20:00"] }', 17, "it must be of the form 08:00"),
        ('unit = "mph"', 'unit = "mph"\nwhen = { inside = [[0, 0], [1, 1]] }', 17, "a list of [lon, lat] corners"),
        ('unit = "mph"', 'unit = "mph"\ncolour = "red"', 17, "no field named 'colour'"),
        ('status = "verified"', 'status = "sure"', 19, "no status named 'sure'"),
        ("as_of = 2026-01-01", 'as_of = "2026"', 18, "as_of is '2026'; it must be a date"),
        ('law = "Act 1"\n', "", 11, "lacks 'law'; give a text"),
        ("value = 30\n", "cases = [{ value = 30 }, { value = 20 }]\n", 11, "each limit needs a separate rule"),
    ],
)
def test_a_wrong_rule_is_refused_with_file_line_and_reason(
    tmp_path: Path, wrong: str, right: str, line: int, reason: str
) -> None:
    assert wrong in RULE
    path = _write(tmp_path, HEAD + RULE.replace(wrong, right))
    with pytest.raises(UserError) as error:
        read_jurisdiction(path)
    assert f"{path} line {line} [[rules" in str(error.value)
    assert reason in str(error.value)
    assert "\n" not in str(error.value)


def test_every_problem_of_a_file_is_told_on_a_line_of_its_own(tmp_path: Path) -> None:
    text = HEAD.replace('"left"', "1") + RULE.replace('"limit"', '"limt"').replace("30", "-30") + "colour = 3\n"
    path = _write(tmp_path, text)
    with pytest.raises(UserError) as error:
        read_jurisdiction(path)
    assert [line.split()[2] for line in str(error.value).splitlines()] == ["6", "13", "15", "20"]


def test_a_file_is_read_again_once_it_has_changed_and_not_before(tmp_path: Path) -> None:
    path = _write(tmp_path, HEAD + RULE)
    first = read_jurisdiction(path)
    assert read_jurisdiction(path) is first
    _write(tmp_path, HEAD.replace("Nowhere", "Elsewhere") + RULE)
    assert read_jurisdiction(path).name == "Elsewhere"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[jurisdiction]\ncode XX\n", "at line 2"),
        (HEAD.replace('"left"', '"middle"'), "no driving_side named 'middle'"),
        (HEAD + '[rules]\nid = "XX.limit"\n', "it must be a list of [[rules]] entries"),
        (TOWN.replace("[1, 0], ", ""), "polygon"),
        (TOWN.replace("[1, 0], ", "[181, 0], "), "polygon[1][0] is 181; it must be a longitude from -180"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, reason: str) -> None:
    with pytest.raises(UserError) as error:
        read_jurisdiction(_write(tmp_path, text))
    assert reason in str(error.value)


def test_a_users_city_joins_the_shipped_country(
    tmp_path: Path, drive: Callable[..., DrivingState], weather: Callable[..., Weather]
) -> None:
    _write(
        tmp_path,
        """
[jurisdiction]
code = "FR-tours"
within = "FR"
kind = "city"
name = "Tours"
status = "knowledge"
polygon = [[0.6, 47.3], [0.8, 47.3], [0.8, 47.5], [0.6, 47.5]]

[[rules]]
id = "FR-tours.limit"
topic = "limit"
text = "in town"
value = 30
unit = "km/h"
when = { built_up = true }
law = "order"
as_of = 2026-01-01
status = "secondary"
""",
        "FR-tours.toml",
    )
    geo = Geo([tmp_path])
    state, fix = drive(road_class="residential"), GpsFix(True, 0.7, 47.4, 3.0, 0.0, 0.0)
    found = geo.locate(state, fix, weather(), datetime(2026, 10, 5, 12, tzinfo=UTC))
    assert found.place.city == "Tours"
    assert [(limit.rule.id, limit.value) for limit in found.default_limits] == [("FR-tours.limit", 30)]
    assert "Default limit: 30 km/h in town (FR order, secondary 2026-01-01)" in found.text()


def test_a_users_country_stands_before_the_shipped_one(tmp_path: Path) -> None:
    shipped = next(path for path in SHIPPED if path.stem == "FR").read_text(encoding="utf-8")
    _write(tmp_path, shipped.replace('name = "France"', 'name = "Mine"'), "FR.toml")
    assert Atlas([tmp_path]).place(1.8, 48.2).country_name == "Mine"
    assert Atlas().place(1.8, 48.2).country_name == "France"


def test_a_users_folder_must_exist_and_hold_whole_countries(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="is not a folder"):
        Atlas([tmp_path / "none"])
    _write(tmp_path, HEAD, "YY.toml")
    with pytest.raises(UserError, match="not the name of the file"):
        Atlas([tmp_path]).country("YY")
    _write(tmp_path, TOWN, "ZZ-town.toml")
    with pytest.raises(UserError, match=r"no ZZ\.toml"):
        Atlas([tmp_path]).country("ZZ")


def test_every_condition_and_topic_is_used_by_a_shipped_rule() -> None:
    rules = [rule for path in SHIPPED for rule in read_jurisdiction(path).rules]
    rules += [rule for code in rows() if (row := basics_of(code)) for rule in row.country.rules]
    assert {rule.topic for rule in rules} == set(TOPICS)
    used = {test.word for rule in rules for case in rule.cases for test in case.when}
    assert used == set(CONDITIONS)


def test_conditions_are_three_valued(facts: Callable[..., RuleFacts]) -> None:
    tests = _conditions({"built_up": True, "weather": ["rain"]})
    rain = {"phenomena": frozenset({"rain"})}
    assert all_hold(tests, facts(built_up=True, **rain)) is True
    assert all_hold(tests, facts(built_up=None, **rain)) is None
    assert all_hold(tests, facts(built_up=None, phenomena=frozenset())) is False
    assert all_hold((), facts()) is True


@pytest.mark.parametrize(
    ("when", "holds", "fails"),
    [
        ({"season": ["11-01", "03-31"]}, {"month": 12, "day": 24}, {"month": 4, "day": 1}),
        ({"season": ["04-15", "10-01"]}, {"month": 4, "day": 15}, {"month": 10, "day": 2}),
        ({"hours": ["22:00", "06:00"]}, {"hour": 23}, {"hour": 6}),
        ({"hours": ["08:00", "20:00"]}, {"hour": 8}, {"hour": 20}),
        ({"weekdays": [1, 2, 3, 4, 5]}, {"day": 5}, {"day": 4}),
    ],
)
def test_times_wrap_and_ends_belong_where_the_words_say(
    facts: Callable[..., RuleFacts], when: dict[str, object], holds: dict[str, int], fails: dict[str, int]
) -> None:
    (test,) = _conditions(when)
    now = facts().local_time
    assert test.holds(replace(facts(), local_time=now.replace(**holds))) is True  # type: ignore[arg-type]
    assert test.holds(replace(facts(), local_time=now.replace(**fails))) is False  # type: ignore[arg-type]
