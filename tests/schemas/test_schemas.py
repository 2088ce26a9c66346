"""The shipped schemas are those of the types, and take what is shipped and what the docs show."""

import json
import re
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

from automotive_cosim import schemas
from automotive_cosim.errors import UserError
from automotive_cosim.formats.checked import as_json
from automotive_cosim.run.plan import read_plan
from automotive_cosim.schemas import make
from tests.laws import over

jsonschema = pytest.importorskip("jsonschema")

ROOT = Path(str(files("automotive_cosim")))
DOCS = Path(__file__).parents[2] / "docs"


def _check(name: str, value: object) -> None:
    jsonschema.Draft7Validator(json.loads(schemas.text(name))).validate(json.loads(as_json(value)))


def test_there_is_one_for_every_format() -> None:
    assert schemas.names() == tuple(sorted(make.FORMATS))
    assert all(schemas.about(name) for name in schemas.names())


@pytest.mark.parametrize("name", make.FORMATS)
def test_a_shipped_schema_is_the_one_of_the_types(name: str) -> None:
    """Renew them with ``python -m automotive_cosim.schemas.make``."""
    assert schemas.text(name) == make.made(name)


@pytest.mark.parametrize("name", make.FORMATS)
def test_a_schema_is_one_of_draft_7(name: str) -> None:
    schema = json.loads(schemas.text(name))
    jsonschema.Draft7Validator.check_schema(schema)
    assert "prefixItems" not in json.dumps(schema)


@pytest.mark.parametrize("name", ["scenario", "plan", "rules"])
def test_every_field_of_a_file_is_described(name: str) -> None:
    def bare(schema: dict[str, object], path: str) -> list[str]:
        fields = schema.get("properties", {})
        assert isinstance(fields, dict)
        return [
            f"{path}.{field}"
            for field, entry in fields.items()
            if not {"description", "title", "enum", "const"} & entry.keys()
        ]

    whole = json.loads(schemas.text(name))
    missing = bare(whole, name)
    for title, definition in whole.get("$defs", {}).items():
        missing += bare(definition, title)
    assert not missing


@pytest.mark.parametrize(
    "path", sorted(ROOT.glob("sumo_scenarios/*/scenario.toml")), ids=lambda path: path.parent.name
)
def test_a_shipped_scenario_passes(path: Path) -> None:
    _check("scenario", tomllib.loads(path.read_text(encoding="utf-8")))


@over(sorted(ROOT.glob("geo/data/*.toml")))
def test_a_shipped_rule_file_passes(path: Path) -> None:
    _check("rules", tomllib.loads(path.read_text(encoding="utf-8")))


def test_the_plans_and_rules_in_the_docs_pass() -> None:
    if not DOCS.is_dir():
        pytest.skip("not run from a checkout")
    seen = set()
    for path in set(DOCS.glob("*.md")):
        for text in re.findall(r"```toml\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL):
            table = tomllib.loads(text)
            name = "plan" if "agents" in table else "rules" if "jurisdiction" in table else ""
            if name:
                _check(name, table)
                seen.add(name)
    assert seen == {"plan", "rules"}


def test_the_refusal_in_the_docs_is_what_one_gets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not DOCS.is_dir():
        pytest.skip("not run from a checkout")
    page = (DOCS / "reference/formats.md").read_text(encoding="utf-8")
    (plan,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    Path("plan.toml").write_text(plan, encoding="utf-8")
    with pytest.raises(UserError) as refused:
        read_plan(Path("plan.toml"))
    assert "".join(f"error: {problem}\n" for problem in refused.value.args) in page


def test_the_docs_name_every_schema() -> None:
    if not DOCS.is_dir():
        pytest.skip("not run from a checkout")
    page = (DOCS / "reference/formats.md").read_text(encoding="utf-8")
    assert tuple(sorted(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE))) == schemas.names()
