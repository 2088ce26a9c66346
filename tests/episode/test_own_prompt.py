"""A file with instructions of one's own: named by its SHA-256, and refused in one line."""

import hashlib
import pickle

import pytest

from automotive_cosim.contracts.given import PromptLength
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.own_prompt import MOST_CHARACTERS, instructions, resolved
from automotive_cosim.errors import UserError
from automotive_cosim.run.plan import make_plan, read_plan


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_it_is_named_by_its_digest_and_read_again(here):
    (here / "mine.md").write_text("Be brief.\n")
    name = resolved("mine.md")
    assert name == f"mine.md@{hashlib.sha256(b'Be brief.' + bytes([10])).hexdigest()}"
    prompt = Conditions.named({"prompt": name}).prompt
    assert pickle.loads(pickle.dumps(prompt)) == prompt
    assert (prompt.length, instructions(prompt)) == (PromptLength.STANDARD, "Be brief.")
    (here / "mine.md").write_text("Be long.\n")
    with pytest.raises(UserError, match="has changed since"):
        instructions(prompt)


def test_prompts_of_the_package_have_no_file():
    assert [resolved(each) for each in PromptLength] == list(PromptLength)
    assert {(each.file, each.length, instructions(each)) for each in PromptLength} == {
        ("", each, "") for each in PromptLength
    }


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "no such file"),
        (b" \n", "is empty"),
        (b"a" * (MOST_CHARACTERS + 1), "more than 16,000 characters"),
        (b"\xff\xfe", "UTF-8"),
    ],
)
def test_a_file_that_cannot_be_used_is_refused(here, content, said):
    if content is not None:
        (here / "mine.txt").write_bytes(content)
    with pytest.raises(UserError, match=said) as error:
        resolved("mine.txt")
    assert "\n" not in str(error.value)


def test_two_prompts_are_two_rows_of_a_plan(here):
    for name in "ab":
        (here / f"{name}.md").write_text(name)
    (here / "plan.toml").write_text(
        'agents = ["t3a"]\ntasks = ["hvac_fan_max"]\nprompt = ["a.md", "b.md", "short"]\n'
    )
    plan = make_plan(read_plan(here / "plan.toml"))
    assert len({job.id for job in plan.jobs()}) == 3
    assert make_plan(plan.as_json()) == plan
    with pytest.raises(UserError, match="prompt"):
        make_plan({"agents": ["t3a"], "prompt": ["mine"]})
