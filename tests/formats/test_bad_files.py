"""Whatever stands in a file that a user wrote: it is read, or every problem gets a line of file, line and field."""

import json
import re
import shutil
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from automotive_cosim import scenarios, schemas
from automotive_cosim.cockpit.actions import parse, to_json
from automotive_cosim.contracts import ActionType
from automotive_cosim.episode.specification import EpisodeSpec
from automotive_cosim.errors import UserError
from automotive_cosim.formats.checked import MOST_PROBLEMS, as_json
from automotive_cosim.geo.rulefile import read_jurisdiction
from automotive_cosim.run.episode import EpisodeSetup, read_setup
from automotive_cosim.run.plan import make_plan, read_plan

jsonschema = pytest.importorskip("jsonschema")

TOML = ("scenario", "plan", "rules")
PLAN = """
agents = ["asurada"]
tasks = ["safety"]
seeds = [0, 1]
geo = ["full", "none"]
repeats = 2
held_out = false

[limits]
steps = 5
sim_s = 60.0
"""
RULES = """
[jurisdiction]
code = "XX-town"
within = "XX"
kind = "city"
name = "Town"
status = "knowledge"
polygon = [[0, 0], [1, 0], [1, 1]]

[[rules]]
id = "XX-town.limit"
topic = "limit"
text = "in town"
value = 30
unit = "km/h"
when = { built_up = true, hours = ["08:00", "20:00"], since = 2020-01-01 }
law = "Act 1"
as_of = 2026-01-01
status = "verified"

[[rules]]
id = "XX-town.horn"
topic = "horn"
text = "in danger only"
law = "Act 2"
as_of = 2026-01-01
status = "verified"
cases = [{ value = "forbidden", when = { weekdays = [7] } }, { value = "allowed" }]
"""
INCIDENTS = """
[[incidents]]
kind = "school_zone"
edges = ["c1c2"]
limit_kmh = 30.0
opens = 08:00:00
closes = 09:30:00

[[incidents]]
kind = "jam"
trip = "avenue"
edges = ["c1c2"]
length_m = 50.0
"""


@dataclass(frozen=True)
class Format:
    """A format of TOML files."""

    name: str
    text: str
    """A good file."""
    path: Path
    """Where a file is written."""
    read: Callable[[Path], object]

    def written(self, text: str) -> Path:
        self.path.write_text(text, encoding="utf-8")
        return self.path

    def schema_takes(self, text: str) -> bool:
        return _takes(self.name, json.loads(as_json(tomllib.loads(text))))


def _takes(name: str, value: object) -> bool:
    return jsonschema.Draft7Validator(json.loads(schemas.text(name))).is_valid(value)


@pytest.fixture(scope="module")
def formats(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Format]:
    folder = tmp_path_factory.mktemp("formats")
    grid = folder / "grid"
    shutil.copytree(scenarios.load("grid").folder, grid)
    scenario = (grid / "scenario.toml").read_text(encoding="utf-8") + INCIDENTS
    all_of_them = (
        Format("scenario", scenario, grid / "scenario.toml", lambda path: scenarios.load(path.parent)),
        Format("plan", PLAN, folder / "plan.toml", lambda path: make_plan(read_plan(path))),
        Format("rules", RULES, folder / "XX-town.toml", read_jurisdiction),
    )
    return {one.name: one for one in all_of_them}


def _read_episode(values: dict[str, object]) -> EpisodeSpec:
    return read_setup(values, "the episode")


GOOD_EPISODE = json.loads(json.dumps(asdict(EpisodeSetup())))
GOOD_ACTION = {"action_type": "swipe", "index": 3, "direction": "left", "distance_px": 120}


def _refused(one: Format, path: Path) -> list[str]:
    with pytest.raises(UserError) as caught:
        one.read(path)
    problems = str(caught.value).splitlines()
    assert problems == [str(problem) for problem in caught.value.args]
    for problem in problems:
        assert str(path) in problem or "the plan" in problem
        assert len(problem) < 1000
    return problems


@pytest.mark.parametrize("name", TOML)
def test_a_good_file_is_read_and_its_schema_takes_it(formats: dict[str, Format], name: str) -> None:
    one = formats[name]
    assert one.read(one.written(one.text)) is not None
    assert one.schema_takes(one.text)
    assert one.read(one.written("\ufeff" + one.text.replace("\n", "\r\n"))) is not None


BROKEN = {
    "binary": b"\xff\xfe\x00\x01",
    "no TOML": b"a = = 1",
    "unfinished": b"a = [",
    "a key twice": b"a = 1\na = 2",
    "no date": b"a = 2026-99-99",
    "a huge number": b"a = " + b"9" * 5000,
    "a huge hexadecimal number": b"a = 0x" + b"f" * 5000,
    "deep lists": b"a = " + b"[" * 100_000,
    "closed deep lists": b"a = " + b"[" * 300 + b"]" * 300,
    "deep tables": b"a = " + b"{a = " * 100_000,
    "deep keys": b"a" + b".a" * 50_000 + b" = 1",
    "deep headers": b"[" + b"'a'." * 50_000 + b"a]",
    "thousands of mistakes": b"[[rules]]\n[[incidents]]\n[[seeds]]\n" * 20_000,
    "too large": b"# " + b"x" * 2**23,
}


@pytest.mark.parametrize("name", TOML)
@pytest.mark.parametrize("content", BROKEN.values(), ids=BROKEN)
def test_a_broken_file_is_refused(formats: dict[str, Format], name: str, content: bytes) -> None:
    one = formats[name]
    one.path.write_bytes(content)
    assert len(_refused(one, one.path)) <= MOST_PROBLEMS + 1


@pytest.mark.parametrize("name", TOML)
def test_an_empty_file_lacks_what_must_be_there(formats: dict[str, Format], name: str) -> None:
    (problem,) = _refused(formats[name], formats[name].written(""))
    assert "lacks" in problem or "has no agent" in problem


@pytest.mark.parametrize("path", ["nowhere.toml", ".", "/dev/zero"])
@pytest.mark.parametrize("name", ["plan", "rules"])
def test_a_path_without_a_file_is_refused(formats: dict[str, Format], name: str, path: str, tmp_path: Path) -> None:
    if path == "/dev/zero" and not Path(path).exists():
        pytest.skip("needs a device that never ends")
    _refused(formats[name], tmp_path / path)


WRONG = [
    # format, what stands there, what in its place, how the line begins or None, its words, seen by a schema
    ("scenario", 'name = "grid"', "name = 3", "name = 3", "name is 3; it must be a text", True),
    ("scenario", 'country = "FR"', 'contry = "FR"', "contry", "did you mean 'country'", True),
    ("scenario", 'country = "FR"', "", None, "lacks 'country'; give a text", True),
    ("scenario", "[sumo]", "[sumoo]", "[sumoo]", "no field named 'sumoo'", True),
    ("scenario", "start = ", 'start = "2026-13-01"\n# ', "start", "month must be in 1..12", False),
    ("scenario", "start = ", 'start = "soon"\n# ', "start", "of the form 2026-03-10T08:30:00", True),
    ("scenario", "start = ", "start = 2026-03-10T08:30:00Z\n# ", "start", "of the form 2026-03-10T08:30:00", True),
    (
        "scenario",
        "start = ",
        "start = 9999-12-31T23:59:59\n# ",
        "start",
        "the year must be from 1970 to 2199",
        False,
    ),
    ("scenario", "visibility = ", "visibility = 1e300\n# ", "visibility", "visibility is beyond 1e+10", False),
    ("scenario", '"Europe/Paris"', '"Europe"', "time_zone", "no such time zone", False),
    ("scenario", '"Europe/Paris"', '"../../etc/passwd"', "time_zone", "of the form Europe/Paris", True),
    ("scenario", "warm_up_s = 60.0", "warm_up_s = inf", "warm_up_s", "warm_up_s is inf", True),
    ("scenario", "warm_up_s = 60.0", "warm_up_s = true", "warm_up_s", "warm_up_s is true", True),
    ("scenario", "warm_up_s = 60.0", "warm_up_s = 86401", "warm_up_s", "a number from 0 to 86400", True),
    ("scenario", "warm_up_s = 60.0", "warmup_s = 60.0", "warmup_s", "did you mean 'warm_up_s'", True),
    ("scenario", '"grid.sumocfg"', '"gird.sumocfg"', "config", "has no such file", False),
    ("scenario", '"grid.sumocfg"', '"\\u0000"', "config", "has no such file", False),
    ("scenario", 'from_edge = "cwc0"', 'from_edge = ""', "from_edge", "from_edge is empty", True),
    ("scenario", 'from_edge = "cwc0"\n', "", "[[ego.trips]]", "'avenue' lacks 'from_edge'", True),
    ("scenario", "[ego]", '[ego]\nvia = ["x"]', "via", "no field named 'via'", True),
    ("scenario", "at_s = 0.0", "at_s = 5.0", "at_s", "the first entry's is 0", False),
    ("scenario", "weather_code = 2", "weather_code = 2.0", "weather_code", "it must be a whole number", False),
    ("scenario", "cloud_cover = 40.0", "cloud_cover = 101", "cloud_cover", "a number from 0 to 100", True),
    ("scenario", "cloud_cover = 40.0\n", "", "[[weather]]", "lacks 'cloud_cover'", True),
    ("scenario", 'maxspeed = ["50"]', "maxspeed = [50]", "maxspeed", "maxspeed[0] is 50", True),
    ("scenario", 'kind = "jam"', 'kind = "jamm"', 'kind = "jamm"', "did you mean 'jam'", True),
    ("scenario", 'kind = "jam"', "kind = [3]", "kind = [3]", "kind is [3]; it must be 'breakdown'", True),
    ("scenario", 'kind = "jam"\n', "", None, "lacks 'kind'; give 'breakdown' or", True),
    ("scenario", "length_m = 50.0", "length_m = 0", "length_m", "of kind 'jam': length_m is 0; it must be", True),
    ("scenario", "length_m = 50.0", "lenght_m = 50.0", "lenght_m", "did you mean 'length_m'", True),
    ("scenario", 'trip = "avenue"', 'trip = "avenu"', 'trip = "avenu"', "did you mean 'avenue'", False),
    ("scenario", "length_m = 50.0", "length_m = 50.0\nto_s = -5", None, "is not before to_s", False),
    ("scenario", "closes = 09:30:00", "closes = 07:30:00", None, "is not before closes", False),
    ("scenario", "closes = 09:30:00", "closes = 2026-01-01", "closes", "of the form 08:00:00", True),
    ("scenario", "opens = 08:00:00", 'opens = "25:00:00"', "opens", "hour must be in 0..23", False),
    ("plan", "agents = ", "agent = ", "agent", "did you mean 'agents'", True),
    ("plan", "agents = ", 'agents = "x" # ', "agents", "agents is 'x'; it must be a list of texts", True),
    ("plan", "seeds = [0, 1]", "seeds = [0, -1]", "seeds", "seeds[1] is -1", True),
    ("plan", "seeds = [0, 1]", "seeds = [0, true]", "seeds", "seeds[1] is true", True),
    ("plan", "seeds = [0, 1]", "seeds = []", "seeds", "seeds is empty", True),
    ("plan", "seeds = [0, 1]", "seeds = [\n  0,\n  0.5,\n]", "seeds", "seeds[1] is 0.5", True),
    ("plan", '"none"', '"non"', "geo", "no geo control named 'non': did you mean 'none'", True),
    ("plan", "repeats = 2", "repeats = 0", "repeats", "a whole number from 1 to 1000", True),
    ("plan", "repeats = 2", 'repeats = "2"', "repeats", "repeats is '2'", True),
    ("plan", "repeats = 2", "repeats = 1.5", "repeats", "whole number", True),
    ("plan", "held_out = false", "everywhere = 1", "everywhere", "true or false", True),
    ("plan", "held_out = false", "held_out = 0", "held_out", "true or false", True),
    ("plan", "steps = 5", "steps = 5.5", "steps", "[limits]: steps is 5.5", True),
    ("plan", "steps = 5", "step = 5", "step", "did you mean 'steps'", True),
    ("plan", "sim_s = 60.0", "sim_s = nan", "sim_s", "sim_s is nan; it must be a number above 0", False),
    ("plan", "sim_s = 60.0", "sim_s = 1e300", "sim_s", "sim_s is beyond 1e+10", False),
    ("plan", "[limits]", "[[limits]]", "[[limits]]", "it must be a table", True),
    ("rules", 'code = "XX-town"', 'code = "XX"', None, "no field named 'within'", True),
    ("rules", 'within = "XX"', 'within = "YY"', None, "does not begin with within = 'YY'", False),
    ("rules", 'kind = "city"', 'kind = "town"', "kind", "no kind named 'town'; choose from: city, region", True),
    ("rules", "[1, 0]", "[1, 91]", "polygon", "polygon[1][1] is 91; it must be a latitude", True),
    ("rules", "[1, 0]", "[1, 0, 0]", "polygon", "polygon[1] is [1, 0, 0]; it must be a pair", True),
    ("rules", "[1, 0], ", "[1, 0], [0, 1], ", "polygon", "the polygon's edges cross", False),
    ("rules", "value = 30", "value = -1", "value", "value is -1", True),
    ("rules", "value = 30\n", "", None, "either value (with when) or cases", True),
    ("rules", "value = 30", "value = 30\ncases = [{ value = 3 }]", None, "either value (with when) or cases", True),
    ("rules", "as_of = 2026-01-01", "as_of = 20260101", "as_of", "a date such as 2026-03-31", True),
    ("rules", "built_up = true", "buildup = true", "when", "did you mean 'built_up'", True),
    ("rules", "since = 2020-01-01", 'since = "now"', "when", "when.since is 'now'; it must be a date", False),
    ("rules", '"20:00"]', '"20:00", "21:00"]', "when", 'it must be ["HH:MM", "HH:MM"]', True),
    ("rules", "weekdays = [7]", "weekdays = [8]", "cases", "weekdays[0] is 8; it must be a whole number", True),
    ("rules", "weekdays = [7]", "weekdays = 7", "cases", "cases[0].when.weekdays is 7", True),
    ("rules", 'value = "allowed"', 'value = "alowed"', "cases", "no value named 'alowed': did you mean", True),
    ("rules", 'id = "XX-town.horn"', 'id = "XX-town.limit"', "id", "occurs twice", False),
    ("rules", 'topic = "horn"\n', "", "[[rules]]", "lacks 'topic'; give one of 'limit'", True),
]


@pytest.mark.parametrize(("name", "old", "new", "line", "words", "seen"), WRONG)
def test_a_wrong_entry_is_refused(
    formats: dict[str, Format], name: str, old: str, new: str, line: str | None, words: str, seen: bool
) -> None:
    one = formats[name]
    assert old in one.text
    text = one.text.replace(old, new, 1)
    problems = _refused(one, one.written(text))
    assert any(words in problem for problem in problems), problems
    if line is not None:
        (told,) = (problem for problem in problems if words in problem)
        number = re.search(r" line (\d+)", told)
        assert number is not None
        assert text.splitlines()[int(number[1]) - 1].lstrip().startswith(line)
    assert one.schema_takes(text) is not seen


@pytest.mark.parametrize("name", TOML)
def test_an_unknown_field_is_refused_in_every_table(formats: dict[str, Format], name: str) -> None:
    one = formats[name]
    for header in ["", *re.findall(r"^\[.*\]$", one.text, re.MULTILINE)]:
        text = one.text.replace(header, f"{header}\nno_such_field = 1\n", 1)
        (problem,) = _refused(one, one.written(text))
        assert "no field named 'no_such_field'" in problem
        number = re.search(r" line (\d+)", problem)
        assert number is not None
        assert text.splitlines()[int(number[1]) - 1].startswith("no_such_field")
        assert not one.schema_takes(text)


_words = st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), max_size=6)
_values = st.recursive(
    st.booleans()
    | st.integers(-(2**70), 2**70)
    | st.floats()
    | _words
    | st.dates().map(str)
    | st.sampled_from(["full", "limit", "jam", "none", "c1c2"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_words, inner, max_size=3),
    max_leaves=6,
)


def _places(value: object, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    for step, inner in value.items() if isinstance(value, dict) else enumerate(value):
        yield (*path, step)
        if isinstance(inner, dict | list):
            yield from _places(inner, (*path, step))


def _put(value: object, path: tuple[str | int, ...], new: object) -> object:
    if not path:
        return new
    step, *rest = path
    items = dict(value.items() if isinstance(value, dict) else enumerate(value))
    items[step] = _put(items[step], tuple(rest), new)
    return items if isinstance(value, dict) else list(items.values())


@pytest.mark.parametrize("name", TOML)
@settings(max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), new=_values)
@pytest.mark.slow
def test_any_value_anywhere_is_read_or_refused_and_what_is_read_passes_the_schema(
    formats: dict[str, Format], name: str, data: st.DataObject, new: object
) -> None:
    one = formats[name]
    good = tomllib.loads(one.text)
    path = data.draw(st.sampled_from(list(_places(good))))
    text = "\n".join(f"{_inline(key)} = {_inline(value)}" for key, value in _put(good, path, new).items())
    assert tomllib.loads(text)
    try:
        one.read(one.written(text))
    except UserError as error:
        assert all(str(one.path) in problem for problem in str(error).splitlines()) or "the plan" in str(error)
    else:
        assert one.schema_takes(text)


def _inline(value: object) -> str:
    match value:
        case str() | bool() | int():
            return json.dumps(value, ensure_ascii=False)
        case float():
            return {"Infinity": "inf", "-Infinity": "-inf", "NaN": "nan"}.get(json.dumps(value), repr(value))
        case list():
            return f"[{', '.join(map(_inline, value))}]"
        case dict():
            return f"{{{', '.join(f'{_inline(str(key))} = {_inline(entry)}' for key, entry in value.items())}}}"
    return str(value)


# --- JSON ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "words", "seen"),
    [
        ({"seed": -1}, "seed is -1; it must be a whole number of at least 0", True),
        ({"seed": "3"}, "seed is '3'", True),
        ({"gps": 1}, "gps is 1; it must be true or false", True),
        ({"max_steps": 0}, "max_steps is 0", True),
        ({"max_steps": 2.5}, "max_steps is 2.5", True),
        ({"max_sim_s": float("nan")}, "max_sim_s is nan", False),
        ({"action_cost_s": float("inf")}, "action_cost_s is inf", False),
        ({"conditions": {"geo": "ful"}}, "no geo control named 'ful': did you mean 'full'", True),
        ({"origin": (9.0,)}, "origin is (9.0,)", True),
        ({"origin": (181.0, 0.0)}, "origin[0] is 181.0; it must be a longitude", True),
        ({"scenario": 3}, "scenario is 3; it must be a text", True),
        ({"without": "gps"}, "without is 'gps'; it must be a list of texts", True),
    ],
)
def test_a_wrong_episode_is_refused(change: dict[str, object], words: str, seen: bool) -> None:
    assert _takes("episode", GOOD_EPISODE)
    with pytest.raises(UserError) as caught:
        _read_episode(GOOD_EPISODE | change)
    (problem,) = caught.value.args
    assert problem.startswith("the episode: ")
    assert words in problem
    assert _takes("episode", json.loads(json.dumps(GOOD_EPISODE | change))) is not seen


def test_an_unknown_field_of_an_episode_is_refused_by_the_schema() -> None:
    assert not _takes("episode", GOOD_EPISODE | {"sede": 1})


_fields = st.sampled_from(
    ["index", "x", "y", "text", "direction", "distance_px", "app_name", "goal_status", "reason", "clear_text",
     "seconds", "kind", "severity", "speed_kmh", "on", "destination", "colour"]
)  # fmt: skip
_entries = (
    st.booleans()
    | st.integers(-2, 9000)
    | st.floats(allow_nan=False)
    | st.sampled_from(["left", "complete", "law", "speed", "warning", "", "x" * 121])
)


@pytest.mark.slow
@settings(max_examples=250)
@given(kind=st.sampled_from(ActionType), given_fields=st.dictionaries(_fields, _entries, max_size=4))
def test_the_schema_of_an_action_takes_what_the_program_takes(
    kind: ActionType, given_fields: dict[str, object]
) -> None:
    value = {"action_type": str(kind), **given_fields}
    try:
        action = parse(value)
    except UserError:
        assert not _takes("action", value)
    else:
        assert _takes("action", to_json(action))  # what is converted has the form of the schema then


def test_every_member_of_the_actions_schema_can_be_met() -> None:
    schema = json.loads(schemas.text("action"))
    assert [member["title"] for member in schema["oneOf"]] == list(ActionType)
    assert _takes("action", GOOD_ACTION)
    assert not _takes("action", {"action_type": "clik", "index": 1})
    assert not _takes("action", [])
