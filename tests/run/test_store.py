import json
import subprocess
import sys

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.run.job_row import JobRow
from automotive_cosim.run.store import (
    opened,
    own_code,
    read_manifest,
    read_rows,
    read_trace,
    trace_file,
    write_trace,
)

PLAN = {"agents": ["oracle"]}


@pytest.mark.slow
def test_a_line_cut_short_costs_that_line_alone(tmp_path):
    with opened(tmp_path / "e", PLAN, JobRow) as store:
        store.append(JobRow(id="a"))
        store.append(JobRow(id="b"))
    path = tmp_path / "e" / "episodes.jsonl"
    whole = path.read_bytes()
    first = whole.index(b"\n") + 1
    for cut in {*range(0, len(whole), 20), 1, first - 1, first, first + 1, len(whole) - 1}:
        path.write_bytes(whole[:cut])
        left = whole[: cut + 1].count(b"\n")  # a line that lacks but its end is whole
        assert len(read_rows(tmp_path / "e", JobRow)) == left
        with opened(tmp_path / "e", PLAN, JobRow) as store:
            assert len(store.rows) == left
            store.append(JobRow(id="c"))
        assert set(read_rows(tmp_path / "e", JobRow)) == {*"ab"[:left], "c"}


def test_the_newest_line_of_an_episode_holds(tmp_path):
    with opened(tmp_path / "e", PLAN, JobRow) as store:
        store.append(JobRow(id="a", error="gone"))
        store.append(JobRow(id="a"))
    assert read_rows(tmp_path / "e", JobRow) == {"a": JobRow(id="a")}


def test_results_are_not_resumed_with_other_code_of_the_agent(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    plan = {"agents": ["oracle", "mine:Careful", "a2a:http://127.0.0.1:9", "none_such:Agent"]}
    for code in ("class Careful: pass\n", "class Careful:\n    pass\n"):
        (tmp_path / "mine.py").write_text(code, encoding="utf-8")
        with opened(tmp_path / f"e{len(code)}", plan, JobRow):
            pass
        assert list(read_manifest(tmp_path / f"e{len(code)}")["starts"][0]["own_code"]) == ["mine:Careful"]
    other = opened(tmp_path / "e20", plan, JobRow)
    with pytest.raises(UserError, match="code of mine:Careful has changed"), other:
        pass


def test_results_are_not_resumed_after_a_file_of_ones_own_scenario_has_changed(tmp_path):
    config, net = tmp_path / "mine.sumocfg", tmp_path / "mine.net.xml"
    net.write_text("<net/>")
    config.write_text('<configuration><input><net-file value="mine.net.xml"/></input></configuration>')
    plans = {"study": {"scenario": str(config)}, "eval": {"agents": ["oracle"], "scenarios": ["grid", str(config)]}}
    for name, plan in plans.items():
        for _ in range(2):
            with opened(tmp_path / name, plan, JobRow):
                pass
        assert [*read_manifest(tmp_path / name)["starts"][0]["own_scenarios"]] == [str(config)], "not the shipped"
    net.write_text("<net><location/></net>")
    for name, plan in plans.items():
        other = opened(tmp_path / name, plan, JobRow)
        with pytest.raises(UserError, match=r"mine\.net\.xml of .*mine\.sumocfg has changed.*Give --out"), other:
            pass
        manifest = read_manifest(tmp_path / name)
        del manifest["starts"][0]["own_scenarios"]
        (tmp_path / name / "manifest.json").write_text(json.dumps(manifest))
        with opened(tmp_path / name, plan, JobRow):
            pass  # as an earlier version wrote it


def test_a_package_counts_with_all_its_modules(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").mkdir()
    for name in ("__init__", "agent", "words"):
        (tmp_path / "mine" / f"{name}.py").touch()
    before = own_code(["mine.agent:Careful"])
    (tmp_path / "mine/words.py").write_text("SEAT = 'Seat heat'\n", encoding="utf-8")
    assert own_code(["mine.agent:Careful"]) != before != {}


def test_a_broken_line_in_the_middle_is_named(tmp_path):
    with opened(tmp_path / "e", PLAN, JobRow) as store:
        store.append(JobRow(id="a"))
    path = tmp_path / "e" / "episodes.jsonl"
    path.write_text("{]\n" + path.read_text())
    with pytest.raises(UserError, match="line 1"):
        read_rows(tmp_path / "e", JobRow)


@pytest.mark.slow
def test_two_evaluations_in_one_folder_are_refused(program, tmp_path):
    script = (
        "import sys, pathlib; from automotive_cosim.run.job_row import JobRow\n"
        "from automotive_cosim.run.store import opened\n"
        f"with opened(pathlib.Path(sys.argv[1]), {PLAN!r}, JobRow): print('in', flush=True); sys.stdin.read()"
    )
    other = program(sys.executable, "-c", script, tmp_path / "e", stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert other.stdout is not None
    assert other.stdout.readline() == "in\n"
    with pytest.raises(UserError, match="another program is writing to"), opened(tmp_path / "e", PLAN, JobRow):
        pass
    other.kill()
    other.wait()
    with opened(tmp_path / "e", PLAN, JobRow):
        pass


def test_another_plan_version_or_format_is_refused_and_nothing_lost(tmp_path):
    folder = tmp_path / "e"
    with opened(folder, PLAN, JobRow) as store:
        store.append(JobRow(id="a"))
    with (
        pytest.raises(UserError, match=r"a different plan: agents was \['oracle'\] and is \['t3a'\]"),
        opened(folder, {"agents": ["t3a"]}, JobRow),
    ):
        pass
    path = folder / "manifest.json"
    manifest = read_manifest(folder)
    manifest["starts"][0]["versions"]["libsumo"] = "0.0.1"
    path.write_text(json.dumps(manifest))
    with pytest.raises(UserError, match="started with a different version: libsumo"), opened(folder, PLAN, JobRow):
        pass
    path.write_text(json.dumps(manifest | {"format": 0}))
    with pytest.raises(UserError, match="format 0"), opened(folder, PLAN, JobRow):
        pass
    assert set(read_rows(folder, JobRow)) == {"a"}


def test_each_start_stands_in_the_manifest(tmp_path):
    for _ in range(2):
        with opened(tmp_path / "e", PLAN, JobRow):
            pass
    starts = read_manifest(tmp_path / "e")["starts"]
    assert len(starts) == 2
    assert starts[0]["versions"]["libsumo"]


def test_folders_that_cannot_be_are_told(tmp_path):
    (tmp_path / "file").touch()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "mine.txt").touch()
    for folder in (tmp_path / "file", tmp_path / "other", tmp_path / "file" / "below"):
        with pytest.raises(UserError) as caught, opened(folder, PLAN, JobRow):
            pass
        assert "\n" not in str(caught.value)
    with pytest.raises(UserError, match="not an evaluation"):
        read_manifest(tmp_path)


def test_a_full_disk_keeps_what_was_written(tmp_path, monkeypatch):
    def full(descriptor):
        raise OSError(28, "No space left on device")

    with opened(tmp_path / "e", PLAN, JobRow) as store:
        store.append(JobRow(id="a"))
        monkeypatch.setattr("os.fsync", full)
        with pytest.raises(UserError, match="No space left"):
            store.append(JobRow(id="b"))
    assert set(read_rows(tmp_path / "e", JobRow)) == {"a"}


def test_a_trace_comes_back_and_has_one_form(tmp_path):
    (tmp_path / "traces").mkdir()
    lines = [{"step": 0, "text": "Über"}, {"result": {}}]
    write_trace(tmp_path, "a", lines)
    first = trace_file(tmp_path, "a").read_bytes()
    write_trace(tmp_path, "a", lines)
    assert trace_file(tmp_path, "a").read_bytes() == first
    assert read_trace(tmp_path, "a") == lines
    trace_file(tmp_path, "a").write_bytes(first[:-9])
    for name in ("a", "b"):
        with pytest.raises(UserError):
            read_trace(tmp_path, name)
