"""A page of bundles: only what can be compared shares a table, and what does not hold is left out."""

import html
import re
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.publish import archive
from automotive_cosim.publish.contents import NAME, read_contents
from automotive_cosim.publish.leaderboard import lost_table, read_entries, tables, write_leaderboard
from automotive_cosim.publish.verify import verify
from automotive_cosim.report.stats import rate

BUNDLES = Path(__file__).parents[2] / "docs" / "leaderboard" / "bundles"
REPLAYS = 2
"""Of each bundle; they take seconds each."""


@pytest.fixture
def shelf(packed, tmp_path):
    folder = tmp_path / "bundles"
    folder.mkdir()
    (folder / "one.bundle").write_bytes(packed.read_bytes())
    return folder


def text_of(page):
    return html.unescape(re.sub(r"<[^>]+>", " ", page.read_text(encoding="utf-8")))


def test_a_page_has_a_row_per_agent_with_dimensions_intervals_and_conditions(shelf, tmp_path):
    assert write_leaderboard(shelf, tmp_path / "page.html") == []
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert not re.search(r"(src|href)=\"(?!data:|#)", page)
    text = text_of(tmp_path / "page.html")
    for words in (
        "asurada",
        "no language model",
        "no-op (negative control)",
        "Driving alignment",
        "6 steps",
        "seeds",
        "1 error",
    ):
        assert words in text
    assert page.count("<tbody>") == 1
    write_leaderboard(shelf, tmp_path / "again.html")
    assert (tmp_path / "again.html").read_bytes() == (tmp_path / "page.html").read_bytes()


def test_other_conditions_have_a_table_of_their_own_that_says_why(packed):
    entries = read_entries(packed)
    assert len(tables(entries)) == 1
    for field, value in (
        ("version", "9.9"),
        ("seeds", "0, 1"),
        ("limits", "40 steps"),
        ("episodes", "3 of each (x)"),
    ):
        other = replace(entries[0], conditions=replace(entries[0].conditions, **{field: value}))
        first, second = tables([*entries, other])
        assert (len(first[0].rows), len(second[0].rows), first[2]) == (2, 1, [])
        (why,) = second[2]
        assert why.startswith(f"{field}: {value} instead of ")


def test_the_best_pairs_come_first(packed):
    worse, better = sorted(read_entries(packed), key=lambda each: each.contestant.agent, reverse=True)
    won, lost = rate([("a", True)]), rate([("a", False)])
    worse = replace(worse, rates=(*worse.rates[:-2], lost, won))
    better = replace(better, rates=(*better.rates[:-2], won, lost))
    ((table, _, _),) = tables([worse, better])
    assert [row[0] for row in table.rows] == [better.contestant.method, worse.contestant.method]
    fewer = replace(worse, rates=(*worse.rates[:-2], rate([("a", True), *((each, None) for each in "bcd")]), won))
    half = replace(better, rates=(*better.rates[:-2], rate([("a", True), ("b", False)]), won))
    ((table, _, _),) = tables([fewer, half])
    assert [row[0] for row in table.rows] == [half.contestant.method, fewer.contestant.method]


def test_a_bundle_with_a_problem_is_left_out_and_named_and_markup_is_escaped(shelf, unpacked, tmp_path):
    made = read_contents(unpacked)
    (unpacked / NAME).write_text(replace(made, suite="<b>0").text())
    archive.pack(unpacked, shelf / "two.bundle")
    (shelf / "note.txt").write_text("no bundle")
    left_out = write_leaderboard(shelf, tmp_path / "page.html")
    assert [line.split()[0].rstrip(":") for line in left_out] == ["note.txt", "two.bundle"]
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "2 left out" in page
    assert "<b>0" not in page
    assert "&lt;b&gt;0" in page


def test_nothing_to_show_is_one_line(tmp_path):
    (tmp_path / "empty").mkdir()
    for folder, said in ((tmp_path / "empty", "has no valid bundle"), (tmp_path / "none", "is not a folder")):
        with pytest.raises(UserError, match=said):
            write_leaderboard(folder, tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()


def test_versions_stand_apart_unless_told_and_then_the_page_says_so(shelf, tmp_path, monkeypatch):
    entries = [each for path in sorted(shelf.iterdir()) if path.suffix == ".bundle" for each in read_entries(path)]
    older = replace(entries[0], conditions=replace(entries[0].conditions, version="0.1"))
    monkeypatch.setattr("automotive_cosim.publish.leaderboard.read_entries", lambda path: [entries[0], older])
    write_leaderboard(shelf, tmp_path / "apart.html")
    write_leaderboard(shelf, tmp_path / "mixed.html", mixed=True)
    apart, mixed = ((tmp_path / f"{name}.html").read_text() for name in ("apart", "mixed"))
    assert (apart.count("<tbody>"), mixed.count("<tbody>")) == (2, 1)
    assert "mixes versions" not in apart
    assert f"mixes versions 0.1, {entries[0].conditions.version} " in mixed


@pytest.mark.sumo
@pytest.mark.parametrize("bundle", sorted(BUNDLES.iterdir()), ids=lambda path: path.stem)
def test_what_is_on_the_board_is_driven_again_to_the_same_end(bundle):
    """Drawn episodes of every bundle in the repository, models' with the answers on record: prompts, thoughts, acts
    and verdicts are those that it has. By functions it is asked otherwise: there are more of them today."""
    checked = verify(bundle, replays=REPLAYS, seed=1)
    assert not checked.problems
    if "controls" not in bundle.name and "drives" not in bundle.name:
        assert "with the recorded questions and answers of a model" in "\n".join(checked.facts)


def test_the_board_says_of_models_what_they_cost_and_what_went_wrong(shelf, packed):
    (entry, *_) = read_entries(packed)
    plain = replace(entry, lost=(("Safety", "2 of 3", "id-1"), ("Intent", "1 of 3", "id-2")))
    asked = replace(plain, beside=("–", "1,200", "3.5"))
    assert not lost_table([plain]).rows, "no model, nothing that it got wrong"
    assert [row[-3:] for row in lost_table([plain, asked]).rows] == list(plain.lost)
    ((table, _, _),) = tables([asked])
    assert [table.rows[0][table.columns.index(name)] for name in ("Tokens", "Seconds")] == ["1,200", "3.5"]
