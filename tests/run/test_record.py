import json
import os

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.record import check_folder, default_folder
from automotive_cosim.run.rerun import rerun
from automotive_cosim.run.trial_folder import read_steps, read_trial


def test_an_empty_or_missing_folder_will_do(tmp_path):
    check_folder(tmp_path, force=False)
    check_folder(tmp_path / "a" / "b", force=False)
    assert not list(tmp_path.iterdir()), "checking makes nothing"


def test_force_replaces_the_record_and_leaves_the_rest(run, tmp_path):
    first = run("no-op")
    (first.folder / "notes.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(UserError, match="--force"):
        check_folder(first.folder, force=False)
    check_folder(first.folder, force=True)
    second = run("oracle")
    pictures = {path.name for path in (second.folder / "screenshots").iterdir()}
    assert {name for name in pictures if name.startswith("step")} == {
        f"step_{line['picture']:03d}.jpg" for line in read_steps(second.folder)
    }
    assert len(read_steps(second.folder)) == second.result.steps + 1 < first.result.steps + 1
    assert (second.folder / "notes.txt").read_text(encoding="utf-8") == "mine"


def test_default_folders_never_collide(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = set()
    for _ in range(12):
        folder = default_folder(EpisodeSetup(half="second"))
        assert "-road_speed_80_in_50-second-asurada-seed0" in folder.name
        assert folder not in made
        folder.mkdir(parents=True)
        made.add(folder)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_refused(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(UserError, match="cannot write"):
        check_folder(tmp_path / "out", force=False)
    tmp_path.chmod(0o700)


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    path = tmp_path / "a.json"
    path.write_text("old", encoding="utf-8")
    with pytest.raises(UnicodeEncodeError):
        write_whole(path, "new \ud800")
    assert path.read_text(encoding="utf-8") == "old"
    write_whole(path, "new")
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.json"]


def test_a_run_is_repeated_from_its_folder(run):
    folder = run("oracle").folder
    compared = rerun(folder)
    assert compared
    assert not [step for step in compared if step.differs]
    told = read_trial(folder)
    (folder / "trial.json").write_text(json.dumps({"manifest": told["manifest"]}))
    assert rerun(folder) == compared, "as a kill leaves it"
    (folder / "trial.json").write_text(json.dumps({"result": told["result"]}))
    with pytest.raises(UserError, match="does not say what was run"):
        rerun(folder)
