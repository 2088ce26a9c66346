"""What a bundle costs to check is bounded by its size and its plan, and what is too dear is refused in one line."""

import gzip
import json
import lzma
import os
import random
import time
import zipfile
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds, limited
from automotive_cosim.formats.files import (
    file_sha256,
    open_file,
    parse_json,
    read_json,
    read_json_lines,
    read_unpacked,
)
from automotive_cosim.formats.limited import LimitedProcesses
from automotive_cosim.publish import archive
from automotive_cosim.publish.bundle import write_bundle
from automotive_cosim.publish.contents import NAME, read_contents
from automotive_cosim.publish.episodes import ROWS, check_trial
from automotive_cosim.publish.verify import verify
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.moments import judged_file
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import read_rows, trace_file


def lists(most_values: int) -> bytes:
    """More empty lists than so many values; Python keeps them in thirty times as much."""
    return b"[" + b"[]," * (most_values // 2 + 1) + b"0]"


def renewed(folder: Path, out: Path) -> Path:
    """A bundle of changed files with hashes that fit."""
    hashes = {name: file_sha256(folder / name) for name in archive.members(folder) if name != NAME}
    (folder / NAME).write_text(replace(read_contents(folder), files=hashes).text())
    archive.pack(folder, out)
    return out


def judged(folder: Path) -> EpisodeRow:
    return next(row for row in read_rows(folder, EpisodeRow).values() if row.success is not None)


def takes(megabytes: int) -> int:
    return len(bytearray(megabytes << 20))


def spins(seconds: float) -> None:
    end_s = time.process_time() + seconds
    while time.process_time() < end_s:
        pass


def ends() -> None:
    os._exit(9)


def refuses() -> None:
    raise UserError("not this")


def test_a_call_that_takes_too_much_memory_is_refused_and_the_next_one_is_answered(tmp_path):
    (tmp_path / "b").write_bytes(b"small")
    with LimitedProcesses(tmp_path / "b") as processes:
        with pytest.raises(UserError, match="more memory or processor time than a file of its size"):
            processes.call(takes, 2 * bounds.BUNDLE.free_bytes >> 20)
        assert processes.call(takes, 100) == 100 << 20
        assert list(processes.map(takes, [1, 2, 3])) == [1 << 20, 2 << 20, 3 << 20]
        with pytest.raises(UserError, match="not this"):
            processes.call(refuses)
        with pytest.raises(UserError, match="b is incomplete or malformed"):
            processes.call(int, "x")


@pytest.mark.slow
def test_a_larger_file_may_take_more(tmp_path, monkeypatch):
    monkeypatch.setattr(limited, "BUNDLE", replace(bounds.BUNDLE, free_bytes=2**28))
    with (tmp_path / "b").open("wb") as file:
        file.truncate(2 * 2**28 // bounds.BUNDLE.times)
    with LimitedProcesses(tmp_path / "b") as processes:
        assert processes.call(takes, 5 * 2**28 >> 22)


@pytest.mark.slow
@pytest.mark.parametrize(("what", "given"), [(spins, (100.0,)), (ends, ())])
def test_a_call_that_takes_too_long_or_ends_its_process_is_refused(tmp_path, monkeypatch, what, given):
    monkeypatch.setattr(limited, "BUNDLE", replace(bounds.BUNDLE, free_s=0))
    (tmp_path / "b").write_bytes(b"small")
    with LimitedProcesses(tmp_path / "b") as processes, pytest.raises(UserError, match="processor time"):
        processes.call(what, *given)


def test_json_of_too_many_values_is_refused_before_it_is_parsed(tmp_path, monkeypatch):
    with pytest.raises(ValueError, match="too many values"):
        parse_json(lists(bounds.VALUES))
    most = 40_000
    for text in (lists(most).decode(), lists(most).replace(b"[]", b"{}")):
        with pytest.raises(ValueError, match="too many values"):
            parse_json(text, most)
    path = tmp_path / "x.json.xz"
    path.write_bytes(lzma.compress(lists(most), preset=0))
    with pytest.raises(ValueError, match="too many values"):
        read_json(path, most)
    monkeypatch.setattr(bounds, "VALUES", most)
    line = b"[" + b"[]," * (most // 8) + b"0]\n"
    path.write_bytes(gzip.compress(line * 3, 1))
    assert len(read_json_lines(path)) == 3
    path.write_bytes(gzip.compress(line * 5, 1))
    with pytest.raises(ValueError, match="too many values"):
        read_json_lines(path)


@pytest.mark.parametrize("file", [judged_file, trace_file])
def test_a_file_that_unpacks_to_more_than_its_plan_allows_is_named(unpacked, tmp_path, file):
    path = file(unpacked, judged(unpacked).id)
    padded = b'{"pad": "' + b"x" * (25 << 20) + b'"}\n'
    path.write_bytes(lzma.compress(padded, preset=0) if path.suffix == ".xz" else gzip.compress(padded, 1))
    (problem,) = verify(renewed(unpacked, tmp_path / "b.bundle")).problems
    assert str(problem).startswith(f"traces/{path.name}: unpacks to over ")


@pytest.mark.parametrize("file", [judged_file, trace_file])
def test_so_is_that_of_a_drive(tmp_path, file):
    job = DriveSetup("grid_january", agent="no-op")
    path = file(tmp_path, job.id)
    path.parent.mkdir()
    padded = b"x" * (70 << 20)
    path.write_bytes(lzma.compress(padded, preset=0) if path.suffix == ".xz" else gzip.compress(padded, 1))
    (problem,) = check_trial(tmp_path, job, job.planned())
    assert str(problem).startswith(f"traces/{path.name}: unpacks to over ")


@pytest.mark.slow
def test_references_that_grow_twofold_a_line_cost_a_bounded_time(unpacked, tmp_path, monkeypatch):
    """Each entry of the pool holds the one before twice: small to keep, and endless to look through."""
    monkeypatch.setattr(limited, "BUNDLE", replace(bounds.BUNDLE, free_s=1))
    path = judged_file(unpacked, judged(unpacked).id)
    whole = read_json(path)
    at = len(whole["pool"])
    whole["pool"] += [["t", 0], *(["t", ["#", at + n], ["#", at + n]] for n in range(60))]
    whole["pool"] += [["f", ["#", at + 60]]]  # to be hashed
    path.write_bytes(lzma.compress(json.dumps(whole).encode(), preset=0))
    try:
        assert verify(renewed(unpacked, tmp_path / "b.bundle")).problems
    except UserError as refused:
        assert "made to do that" in str(refused)


def test_an_archive_that_holds_more_than_its_size_is_refused(packed, tmp_path):
    path = tmp_path / "b.bundle"
    path.write_bytes(read_unpacked(packed))
    with zipfile.ZipFile(path, "a") as zipped:
        whole = zipped.getinfo("manifest.json")
        first = zipped.getinfo(next(name for name in zipped.namelist() if name.endswith(".gz")))
        for number in range(30):  # one body, many names
            again = zipfile.ZipInfo(f"traces/a{number}.jsonl.gz")
            again.header_offset, again.CRC = first.header_offset, first.CRC
            again.file_size = again.compress_size = 10 * first.file_size
            zipped.filelist.append(again)
            zipped.NameToInfo[again.filename] = again
        zipped.comment = b"x" * (whole.file_size % 7)
        zipped._didModify = True
    with pytest.raises(UserError, match=r"is not a bundle|holds more than its size"):
        verify(path)


@pytest.mark.parametrize(("size", "fits"), [(2**12, False), (2**18, True)])
def test_a_bundle_may_unpack_to_hundreds_of_times_its_size(tmp_path, size, fits):
    path, piece = tmp_path / "b.bundle", random.Random(0).randbytes(size)
    path.write_bytes(lzma.compress(piece * (2**27 // size), preset=0))
    assert 2**27 / path.stat().st_size > 150
    with archive.content(path) as file, nullcontext() if fits else pytest.raises(OSError, match="unpacks to over"):
        while file.read(2**20):
            pass


def test_an_episode_that_stands_twice_is_found_in_a_bundle_and_in_a_folder(folder, unpacked, tmp_path):
    lines = (unpacked / ROWS).read_text().splitlines(keepends=True)
    (unpacked / ROWS).write_text("".join(sorted([*lines, lines[0]], key=lambda line: json.loads(line)["id"])))
    found = verify(renewed(unpacked, tmp_path / "b.bundle")).problems
    assert any("again, which was judged before" in str(problem) for problem in found)
    rows = [json.loads(line) for line in (folder / ROWS).read_text().splitlines()]
    failed = next(row for row in rows if row["success"] is None)
    with (folder / ROWS).open("a") as file:  # an error may have been run again
        file.write(json.dumps(failed) + "\n")
    assert not verify(folder).problems
    with (folder / ROWS).open("a") as file:
        file.write(json.dumps(next(row for row in rows if row["success"] is not None)) + "\n")
    assert any("again, which was judged before" in str(problem) for problem in verify(folder).problems)


def test_what_is_not_a_regular_file_is_refused_unopened(folder, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero"), tmp_path):
        with pytest.raises(OSError, match=r"not a regular file|directory"):
            open_file(path)
    for path in (tmp_path / "pipe", Path("/dev/zero")):
        with pytest.raises(UserError, match="is not a regular file"):
            verify(path)
    (folder / "manifest.json").unlink()
    os.mkfifo(folder / "manifest.json")
    with pytest.raises(UserError, match="is not a regular file"):
        verify(folder)


def test_a_link_is_not_published(folder, tmp_path):
    path = trace_file(folder, judged(folder).id)
    path.rename(tmp_path / "elsewhere.gz")
    path.symlink_to(tmp_path / "elsewhere.gz")
    with pytest.raises(UserError, match="is a link"):
        write_bundle(folder, tmp_path / "b.bundle")
    assert not (tmp_path / "b.bundle").exists()
