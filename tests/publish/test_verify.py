"""Whatever single field of a bundle is changed is found; what only its hashes show is on a list that says so."""

import gzip
import json
import lzma
import random
import shutil
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import file_sha256, read_json, read_unpacked
from automotive_cosim.interface.trace import Step
from automotive_cosim.publish import archive, episodes
from automotive_cosim.publish.contents import NAME, read_contents
from automotive_cosim.publish.episodes import BY_REPLAY, ON_TRUST, check_trial
from automotive_cosim.publish.problems import ROWS
from automotive_cosim.publish.replays import replay
from automotive_cosim.publish.verify import PLAN_ON_TRUST, STARTS_ON_TRUST, _read, hash_problems, verify
from automotive_cosim.run.job_row import from_line
from automotive_cosim.run.moments import Judged, read_judged
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.regrade import judged_again
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.store import opened, read_evaluation, read_rows, read_trace, write_trace
from automotive_cosim.run.worker import run_job
from automotive_cosim.tasking.binding import bound
from automotive_cosim.tasking.dialogue import PARDON, TALKED_OVER, understood
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasks import CATALOGUE

from .conftest import TASKS

OTHERS = {
    "half": "second", "dimension": "explicit_control", "module": "media", "basis": "wish", "geo": "none",
    "end": "out_of_time", "scenario": "paris_centre", "agent": "t3a", "country": "FR",
}  # fmt: skip
"""Legal values, which are harder to find than others."""


def leaves(value: Any, steps: tuple = ()) -> Iterator[tuple]:
    """The path to every value that is not a table or list, or is an empty one."""
    if isinstance(value, dict | list) and value:
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(inner, (*steps, key))
    else:
        yield steps


def kinds(value: Any) -> list[tuple]:
    """One path of each kind: entries of one list are alike, but the first and the last, and signals of one part of
    the car."""
    found: dict[tuple, tuple] = {}
    for steps in leaves(value):
        found[tuple("*" if isinstance(step, int) else ".".join(step.split(".")[:3]) for step in steps)] = steps
    return list(found.values())


def changed(value: Any, steps: tuple) -> Any:
    """A copy with another value there."""
    copy = deepcopy(value)
    inner = copy
    for step in steps[:-1]:
        inner = inner[step]
    old = inner[steps[-1]]
    match old:
        case bool():
            new: Any = not old
        case int() | float():
            new = old + 1
        case str():
            new = OTHERS[steps[-1]] if steps[-1] in OTHERS and old != OTHERS[steps[-1]] else old + "0"
        case None:
            new = 1.0
        case _:
            new = ["x"] if isinstance(old, list) else {"x": 1}
    inner[steps[-1]] = new
    return copy


def documents(path: Path) -> tuple[list[Any], Any]:
    """The JSON documents in a file, and what writes them into it."""
    if path.suffix == ".xz":
        return [read_json(path)], lambda made: path.write_bytes(
            lzma.compress(json.dumps(made[0]).encode(), preset=0)
        )
    if path.suffix == ".gz":
        lines = read_unpacked(path).decode().splitlines()
        return list(map(json.loads, lines)), lambda made: write_trace(
            path.parents[1], path.name.removesuffix(".jsonl.gz"), made
        )
    if path.suffix == ".jsonl":
        return list(map(json.loads, path.read_text().splitlines())), lambda made: path.write_text(
            "".join(json.dumps(each, ensure_ascii=False) + "\n" for each in made)
        )
    return [json.loads(path.read_text())], lambda made: path.write_text(json.dumps(made[0]))


def judged(folder: Path, agent: str = "asurada") -> EpisodeRow:
    rows = read_rows(folder, EpisodeRow).values()
    return next(row for row in rows if row.agent == agent and row.pair and row.half == "first")


def job_of(folder: Path, row: EpisodeRow):
    return next(job for job in make_plan(read_evaluation(folder)["plan"]).jobs() if job.id == row.id)


@pytest.mark.slow
def test_every_field_of_every_file_is_covered_by_its_hash(unpacked):
    contents = read_contents(unpacked)
    assert not hash_problems(unpacked, contents)
    assert set(contents.files) == set(archive.members(unpacked)) - {NAME}
    count, row = 0, judged(unpacked)
    for name in [name for name in contents.files if name.startswith("traces/") and row.id not in name]:
        (unpacked / name).unlink()  # alike
        del contents.files[name]
    (unpacked / NAME).write_text(contents.text())
    for name in contents.files:
        path = unpacked / name
        whole, (values, write) = path.read_bytes(), documents(path)
        for steps in kinds(values):
            if steps[-1] == "*":
                continue
            write(changed(values, steps))
            assert [problem.file for problem in hash_problems(unpacked, contents)] == [name], steps
            count += 1
        path.write_bytes(whole)
    assert count > 200


def test_a_bundle_and_its_folder_are_found_in_order_by_several_workers_too(ran, packed):
    for path in (ran, packed):
        for workers in (1, 2):
            found = verify(path, workers=workers)
            assert found.problems == ()
            assert "5 of 6 planned episodes judged, 1 error" in found.facts
            assert "5 verdicts recomputed" in found.facts


def problems_of_row(folder, job, values):
    try:
        row = from_line(EpisodeRow, json.dumps(values).encode())
    except ValueError:
        return ["refused"]
    return check_trial(folder, job, row)


@pytest.mark.slow
@pytest.mark.parametrize("agent", ["asurada", "no-op"])
def test_every_field_of_a_row_is_found_by_trace_plan_and_verdict_whatever_the_hashes_say(ran, agent, monkeypatch):
    for name in ("read_judged", "read_trace"):
        monkeypatch.setattr(episodes, name, cache(getattr(episodes, name)))
    row = judged(ran, agent)
    job = job_of(ran, row)
    line = next(text for text in (ran / ROWS).read_text().splitlines() if json.loads(text)["id"] == row.id)
    values = json.loads(line)
    assert not problems_of_row(ran, job, values)
    missed = set()
    for steps in leaves(values):
        assert isinstance(problems_of_row(ran, job, lacking(values, steps)), list | tuple)
        if steps != ("id",) and not problems_of_row(ran, job, changed(values, steps)):
            missed.add(f"{ROWS} {steps[0]}")
    assert missed <= BY_REPLAY | ON_TRUST
    assert f"{ROWS} wall_seconds" in missed


@pytest.mark.slow
def test_every_field_of_a_trace_is_found_or_on_the_list(folder):
    row = judged(folder)
    job, lines = job_of(folder, row), read_trace(folder, row.id)
    missed = set()
    for steps in kinds(lines):
        write_trace(folder, row.id, changed(lines, steps))
        found = check_trial(folder, job, row)
        assert all(row.id in str(problem) for problem in found)
        if not found:
            missed.add(f"result {steps[2]}" if steps[1] == "result" else f"step {steps[1]}")
    assert missed <= BY_REPLAY | ON_TRUST
    write_trace(folder, row.id, lines)
    assert not check_trial(folder, job, row)


def renewed(folder: Path, out: Path) -> Path:
    """A bundle of changed files with hashes that fit."""
    made = read_contents(folder)
    hashes = {name: file_sha256(folder / name) for name in archive.members(folder) if name != NAME}
    (folder / NAME).write_text(replace(made, files=hashes).text())
    archive.pack(folder, out)
    return out


def lacking(value: Any, steps: tuple) -> Any:
    """A copy without what is there."""
    copy = deepcopy(value)
    inner = copy
    for step in steps[:-1]:
        inner = inner[step]
    del inner[steps[-1]]
    return copy


def is_found(path: Path) -> bool:
    """Whether ``verify`` has a problem with a bundle; in this process, and only as far as the first."""
    try:
        with archive.unpacked(path) as folder:
            read = _read(folder, path)
            return bool(read.problems) or any(
                check_trial(folder, read.jobs[name], row) for name, row in read.rows.items()
            )
    except (UserError, *MALFORMED):
        return True


MALFORMED = (LookupError, TypeError, ValueError, AttributeError, RecursionError)
"""What ``LimitedProcesses`` makes a refusal of."""
ALIKE = ("versions", "files")
"""Tables whose entries are."""


def different(value: Any) -> list[tuple]:
    """The path to every value; of tables whose entries are alike, to the first and the last."""
    found = list(leaves(value))
    several = {steps[:-1] for steps in found if steps[-2:-1] and steps[-2] in ALIKE}
    spare = {each for table in several for each in [steps for steps in found if steps[:-1] == table][1:-1]}
    return [steps for steps in found if steps not in spare]


@pytest.mark.slow
def test_every_field_of_the_manifest_and_the_contents_is_found_or_on_the_list(unpacked, tmp_path):
    missed = set()
    for name in ("manifest.json", NAME):
        whole = (unpacked / name).read_bytes()
        values = json.loads(whole)
        for steps, change in ((steps, change) for steps in different(values) for change in (changed, lacking)):
            other = json.dumps(change(values, steps), indent=1, sort_keys=name == NAME)
            (unpacked / name).write_text(other + ("\n" if name == NAME else ""))
            try:
                if name != NAME:
                    renewed(unpacked, tmp_path / "b.bundle")
                else:
                    archive.pack(unpacked, tmp_path / "b.bundle")
                if not is_found(tmp_path / "b.bundle"):
                    missed.add((name, steps[0], next(step for step in steps[1:] if isinstance(step, str))))
            finally:
                (unpacked / name).write_bytes(whole)
    assert not is_found(renewed(unpacked, tmp_path / "b.bundle"))
    on_trust = {("manifest.json", "plan", field) for field in PLAN_ON_TRUST}
    on_trust |= {("manifest.json", "starts", field) for field in STARTS_ON_TRUST}
    assert missed <= on_trust


def test_files_and_lines_too_many_or_too_few_are_found(unpacked, tmp_path):
    lines = (unpacked / ROWS).read_text().splitlines(keepends=True)
    for other in (
        lines[:-1],
        [*lines, lines[0]],
        lines[::-1],
        [lines[0].replace('"seed": 0', '"seed": 0, "x": 1'), *lines[1:]],
    ):
        (unpacked / ROWS).write_text("".join(other))
        assert is_found(renewed(unpacked, tmp_path / "b.bundle"))
    (unpacked / ROWS).write_text("".join(lines))
    assert not is_found(renewed(unpacked, tmp_path / "b.bundle"))
    traces = sorted((unpacked / "traces").iterdir())
    shutil.copy(traces[0], traces[0].with_name("another.jsonl.gz"))
    assert is_found(renewed(unpacked, tmp_path / "b.bundle"))
    (unpacked / "traces" / "another.jsonl.gz").unlink()
    for path in traces:
        whole = path.read_bytes()
        path.unlink()
        assert is_found(renewed(unpacked, tmp_path / "b.bundle"))
        path.write_bytes(whole)


@pytest.mark.slow
def test_cut_and_damaged_files_are_found_or_refused_whatever_the_hashes_say(unpacked, tmp_path):
    rng = random.Random(0)
    row = judged(unpacked)
    files = [f"traces/{row.id}.jsonl.gz", f"traces/{row.id}.judged.json.xz", "manifest.json", ROWS, NAME]
    for name in files:
        pack = {".gz": gzip.compress, ".xz": lzma.compress}.get(Path(name).suffix, bytes)
        whole = pack((unpacked / name).read_bytes())  # as bundles were before they were packed as a whole
        deep = b"[" * 100_000
        flipped = [bytearray(whole) for _ in range(3)]
        for data in flipped:
            data[rng.randrange(len(data) // 2)] ^= 1 << rng.randrange(7)
        for data in (b"", whole[: len(whole) // 2], pack(deep), *flipped):
            (unpacked / name).write_bytes(data)
            if name == NAME:
                archive.pack(unpacked, tmp_path / "b.bundle")
            else:
                renewed(unpacked, tmp_path / "b.bundle")
            assert is_found(tmp_path / "b.bundle") or is_on_trust(name, bytes(data), whole)
        (unpacked / name).write_bytes(whole)
    assert not is_found(renewed(unpacked, tmp_path / "b.bundle"))


def is_on_trust(name: str, data: bytes, whole: bytes) -> bool:
    """Whether a change hit nothing but what cannot be known."""
    if name == ROWS:
        one, other = ([json.loads(line) for line in text.splitlines()] for text in (data, whole))
        fields = {f"{ROWS} {key}" for a, b in zip(one, other, strict=True) for key in b if a.get(key) != b[key]}
        return fields <= BY_REPLAY | ON_TRUST
    if name == "manifest.json":
        plans = [json.loads(text)["plan"] for text in (data, whole)]
        return all(plans[0].get(key) == plans[1][key] or key in PLAN_ON_TRUST for key in plans[1])
    if name.endswith(".gz"):
        return gzip.decompress(data) == gzip.decompress(whole)
    return name.endswith(".xz")  # the baseline run and the states between steps: a replay finds them


def test_a_verdict_that_was_turned_everywhere_is_found_and_named(unpacked, tmp_path):
    row = judged(unpacked, "no-op")
    (unpacked / ROWS).write_text(
        (unpacked / ROWS).read_text().replace('"success": false, "reward": 0.0', '"success": true, "reward": 1.0')
    )
    *steps, last = read_trace(unpacked, row.id)
    result = last["result"] | {"success": True, "reward": 1.0}
    write_trace(unpacked, row.id, [*steps, {"result": result}])
    told = list(map(str, verify(renewed(unpacked, tmp_path / "b.bundle")).problems))
    assert any(f"{ROWS}, {row.id} success: is true, but false by" in problem for problem in told)


def test_what_a_trial_has_only_under_some_conditions_is_checked_and_replayed_too(
    tmp_path, simulations, fork_server
):
    under = {"make": ["drawn"], "hear": ["cabin"], "attention": ["on"]}
    plan = make_plan({"agents": ["oracle"], "tasks": TASKS[:1], "scenarios": ["grid"], **under})
    job = next(job for job in plan.jobs() if job.half == "first")
    with opened(tmp_path / "e", plan.as_json(), EpisodeRow, planned=1) as store:
        store.append(row := run_job(job, tmp_path / "e", Pictures.NONE, simulations, fork_server))
    lines = read_trace(tmp_path / "e", row.id)
    assert row.success
    assert {"awareness", "heard", "cabin_db"} <= lines[0].keys()
    assert not check_trial(tmp_path / "e", job, row)
    assert not replay(tmp_path / "e", job, row, simulations).problems
    for name in ("awareness", "cabin_db", "heard"):
        write_trace(tmp_path / "e", row.id, changed(lines, (0, name) if name != "heard" else (0, name, 0)))
        found = [*check_trial(tmp_path / "e", job, row), *replay(tmp_path / "e", job, row, simulations).problems]
        assert any(f"step 0 {name}" in problem.field for problem in found), name


def test_a_replay_finds_what_nothing_else_can(ran, simulations):
    row = judged(ran)
    job = job_of(ran, row)
    assert replay(ran, job, row, simulations) == ((), True)
    assert row.speed_compliance is not None
    forged = replace(row, speed_compliance=row.speed_compliance - 0.5)
    assert not check_trial(ran, job, forged)
    (problem,) = replay(ran, job, forged, simulations).problems
    assert problem.field == f"{row.id} speed_compliance"


def test_an_answer_that_the_driver_did_not_understand_is_none(ran):
    row = judged(ran)
    hand_over, action = read_judged(ran, row.id, Judged).trace[0], Action(ActionType.ANSWER, text="At 20 degrees.")
    for words, said, told in (("", (), ("At 20 degrees.",)), ("", (PARDON,), ()), (TALKED_OVER, ("No!",), ())):
        step = Step(1, hand_over, (), action, Feedback(FeedbackCode.OK, words), said=said)
        assert understood(step) == tuple(episodes._answers(step.as_json())) == told


@pytest.mark.slow
def test_a_replay_finds_every_field_that_is_left_to_it(folder, simulations):
    row = judged(folder)
    job, lines = job_of(folder, row), read_trace(folder, row.id)
    left = {
        steps
        for steps in kinds(lines)
        if {f"step {steps[1]}", f"result {steps[-1] if len(steps) < 3 else steps[2]}"} & BY_REPLAY
    }
    assert len(left) >= 6
    for steps in left:
        if "reply" in steps and steps[-1] != "text":
            continue  # what a model's answer cost, and why it ended, nobody can know but who asked
        write_trace(folder, row.id, changed(lines, steps))
        with suppress(UserError):  # which a check tells as a problem
            again = replay(folder, job, row, simulations)
            assert again.problems or not again.has_asked, steps


@pytest.mark.sumo
def test_the_commands_tell_by_their_exit_code(packed, tmp_path):
    from typer.testing import CliRunner

    from automotive_cosim.cli.main import app

    fine = CliRunner().invoke(app, ["publish", "verify", str(packed), "--replay", "1"])
    assert fine.exit_code == 0, fine.output
    assert "1 drive replayed" in fine.output
    assert "this check cannot tell" in fine.output
    (tmp_path / "key").write_text("k" * 16)
    of_none = CliRunner().invoke(app, ["publish", "verify", str(packed), "--key", str(tmp_path / "key")])
    assert "drawn from no key" in str(of_none.exception)
    data = bytearray(read_unpacked(packed))
    data[data.index(b"wall_seconds") + 16] ^= 1
    (tmp_path / "b.bundle").write_bytes(data)
    bad = CliRunner().invoke(app, ["publish", "verify", str(tmp_path / "b.bundle"), "--replay", "0"])
    assert bad.exit_code == 1 or isinstance(bad.exception, UserError)


def test_elsewhere_a_verdict_rests_on_the_sign_that_stands_there(ran):
    row = next(row for row in read_rows(ran, EpisodeRow).values() if row.success is not None)
    instance = draw(CATALOGUE["road_speed_80_in_50"], "first", 0)
    half, given = instance.half, instance.parameters
    stored = replace(read_judged(ran, row.id, Judged), allowed_writes=half.allowed_writes, parameters=given)
    elsewhere = replace(row, task=instance.task.id, half="first")
    assert judged_again(elsewhere, stored).rule == bound(half, stored.trace[0].context) != half.rule
    assert judged_again(replace(elsewhere, scenario=half.start.scenario), stored).rule == half.rule
