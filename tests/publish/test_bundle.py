"""A bundle has everything that a check needs, and nothing that is nobody's business."""

import json
import lzma
import zipfile
from importlib.resources import files
from pathlib import Path

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_unpacked
from automotive_cosim.publish import archive
from automotive_cosim.publish.bundle import cleaned, write_bundle
from automotive_cosim.publish.contents import read_contents
from automotive_cosim.publish.verify import verify
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import opened, read_rows, read_trace, write_trace
from tests.models.test_remote import LONG_KEY, SPELLINGS


def plain_text(bundle):
    """Everything in it."""
    with lzma.open(bundle) as packed, zipfile.ZipFile(packed) as opened_:
        for name in opened_.namelist():
            yield name, opened_.read(name).decode()


def test_the_same_folder_gives_the_same_bytes(ran, packed, tmp_path):
    made = write_bundle(ran, tmp_path / "again.bundle")
    assert (tmp_path / "again.bundle").read_bytes() == packed.read_bytes()
    with archive.unpacked(packed) as folder:
        assert read_contents(folder) == made
    assert (made.counts.planned, made.counts.judged, made.counts.errors, made.counts.not_run) == (6, 5, 1, 0)


def test_the_schema_takes_what_a_bundle_says(packed):
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((files("automotive_cosim.schemas") / "bundle.schema.json").read_text())
    told = json.loads(dict(plain_text(packed))["bundle.json"])
    jsonschema.Draft7Validator(schema).validate(told)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft7Validator(schema).validate(told | {"format": 2})


def test_nothing_in_it_tells_of_the_machine(ran, packed, tmp_path):
    texts = dict(plain_text(packed))
    assert "agent.py: gone" in texts["episodes.jsonl"]
    for name, text in texts.items():
        for word in ("anna", "/home/", str(Path.home()) + "/", str(tmp_path), str(ran), str(Path.cwd())):
            assert word not in text, (name, word)


def test_paths_are_cleaned_and_other_slashes_stay():
    rest = "(/srv/z): 50 km/h, http://127.0.0.1:8/v1, a/b, 1 / 2"
    told = cleaned(f"cannot read '/home/anna/my lab/x.toml' or C:\\Users\\anna\\y.py {rest}")
    assert "/home/anna" not in told
    assert "Users" not in told
    assert "/srv" not in told
    assert told.endswith("(z): 50 km/h, http://127.0.0.1:8/v1, a/b, 1 / 2")


@pytest.mark.parametrize(
    ("name", "value", "spell"),
    [("LAB_API_KEY", LONG_KEY, spell) for spell in SPELLINGS] + [("hf_token", "hf_0123456789abc", str.title)],
)
def test_a_key_in_a_trace_is_refused_by_the_name_of_its_variable(folder, tmp_path, monkeypatch, name, value, spell):
    monkeypatch.setenv(name, value)
    write_bundle(folder, tmp_path / "fine.bundle")
    episode = next(row.id for row in read_rows(folder, EpisodeRow).values() if row.success is not None)
    lines = read_trace(folder, episode)
    lines[0]["thought"] = f"my key is {spell(value)}"
    write_trace(folder, episode, lines)
    with pytest.raises(UserError, match=name) as refused:
        write_bundle(folder, tmp_path / "b.bundle")
    assert value not in str(refused.value)
    assert not (tmp_path / "b.bundle").exists()


def test_what_an_agents_side_says_loses_its_folders_and_other_places_are_refused(folder, tmp_path):
    row = next(row for row in read_rows(folder, EpisodeRow).values() if row.success is not None)
    lines = read_trace(folder, row.id)
    lines[0]["thought"] = "as in /home/anna/notes, at 50 km/h"
    lines[-1]["result"]["notes"] = ["/Users/anna/x.toml has no date"]
    write_trace(folder, row.id, lines)
    write_bundle(folder, tmp_path / "b.bundle")
    assert "anna" not in "".join(text for _, text in plain_text(tmp_path / "b.bundle"))
    with archive.unpacked(tmp_path / "b.bundle") as files_:
        assert read_trace(files_, row.id)[0]["thought"] == "as in notes, at 50 km/h"
    assert verify(tmp_path / "b.bundle").problems == ()
    lines[0]["elements"][0]["text"] = "/home/anna/notes"
    write_trace(folder, row.id, lines)
    with pytest.raises(UserError, match="home folder"):
        write_bundle(folder, tmp_path / "c.bundle")


def test_a_plan_with_an_absolute_path_and_an_empty_folder_are_refused(tmp_path):
    plan = make_plan({"agents": ["oracle"], "tasks": ["hvac_fan_max"], "scenarios": ["/srv/my/town"]})
    with opened(tmp_path / "e", plan.as_json(), EpisodeRow) as store:
        with pytest.raises(UserError, match="no episodes yet"):
            write_bundle(tmp_path / "e", tmp_path / "b.bundle")
        store.append(plan.jobs()[0].planned())
    with pytest.raises(UserError, match="absolute path"):
        write_bundle(tmp_path / "e", tmp_path / "b.bundle")


def test_a_stopped_evaluation_can_be_bundled_and_says_so(folder, tmp_path):
    path = folder / "episodes.jsonl"
    path.write_text("".join(path.read_text().splitlines(keepends=True)[:2]))
    made = write_bundle(folder, tmp_path / "b.bundle")
    assert (made.counts.judged, made.counts.not_run) == (2, 4)
    found = verify(tmp_path / "b.bundle")
    assert not found.problems
    assert "2 of 6 planned episodes judged, 4 not run" in found.facts


@pytest.mark.parametrize("member", ["../x", "/x", "traces/../../x", "lock", "traces/a/b.jsonl.gz", "bundle.json/"])
def test_what_does_not_belong_in_a_bundle_is_refused(packed, tmp_path, member):
    path = tmp_path / "b.bundle"
    path.write_bytes(read_unpacked(packed))
    with zipfile.ZipFile(path, "a") as opened_:
        opened_.writestr(member, "x")
    with pytest.raises(UserError, match="does not belong"):
        verify(path)


def test_damaged_and_compressed_archives_are_refused_or_found(packed, tmp_path):
    path = tmp_path / "b.bundle"
    with pytest.raises(UserError, match=r"b\.bundle is not a bundle: No such file or directory; "):
        verify(path)
    for data in (b"", b"nothing", packed.read_bytes()[:5000]):
        path.write_bytes(data)
        with pytest.raises(UserError, match="is not a bundle"):
            verify(path)
    with (
        lzma.open(packed) as whole,
        zipfile.ZipFile(whole) as old,
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as new,
    ):
        for name in old.namelist():
            new.writestr(name, old.read(name))
    with pytest.raises(UserError, match="a compressed file"):
        verify(path)
    with zipfile.ZipFile(path, "w") as new:
        new.writestr("manifest.json", "{}")
    with pytest.raises(UserError, match=r"no bundle\.json"):
        verify(path)
    path.write_bytes(b"before" + read_unpacked(packed))
    (problem,) = verify(path).problems
    assert "to the byte" in problem.why
