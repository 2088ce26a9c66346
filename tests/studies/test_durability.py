"""Killed at any moment, without room, in a folder that cannot be written, twice at once, under a clock that jumps:
each command ends in a line, and goes on to what it would have written undisturbed."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import pytest

from tests.report.test_stopped import write

COUNTS = Path(__file__).parents[2] / "docs/examples/grid_counts.csv"
GRID = ("--scenario", "grid", "--warm-up", "60", "--out", "OUT")
SPACE = """
[factors]
task = ["hvac_fan_max"]
scenario = ["grid"]
latency_s = { least = 0, most = 9, nominal = 0 }

[failure]
"""
OF_A_START = {"wall_seconds", "seconds", "attempts", "failed_attempts"}
"""What rows say of a start and not of what was run."""
FULL = """
mount -t tmpfs -o size=1g none "$ROOM" && cp -a "$GIVEN/." "$ROOM" || exit 99
mount -o remount,ro "$ROOM"; "$@" >1.out 2>1.err; echo $? >1.code
mount -o remount,rw,size=$(($(df -k --output=used "$ROOM" | tail -n 1) + 4))k "$ROOM"
"$@" >2.out 2>2.err; echo $? >2.code
mount -o remount,size=1g "$ROOM"; "$@" >3.out 2>3.err; echo $? >3.code
cp -a "$ROOM/." "$KEPT"
"""
"""Runs a command in a folder that cannot be written, in one with hardly any room, and in one with room."""
CLOCK = """
import random, time
real = time.time
time.time = lambda: real() + random.choice((-86_400.0, 0.0, 86_400.0))
"""


def rows(name: str = "episodes.jsonl") -> Callable[[Path], Any]:
    def read(out: Path) -> Any:
        found = [json.loads(line) for line in (out / name).read_text("utf-8").splitlines()]
        return {
            row.get("id", row.get("number")): {k: v for k, v in row.items() if k not in OF_A_START} for row in found
        }

    return read


def files(pattern: str) -> Callable[[Path], Any]:
    return lambda out: {path.name: path.read_bytes() for path in out.glob(pattern)}


def rows_and_pictures(out: Path) -> Any:
    """Rows, and every screenshot that is kept."""
    return rows()(out), {str(path.relative_to(out)): path.read_bytes() for path in out.rglob("*.jpg")}


@dataclass(frozen=True)
class Command:
    """A command and what of its result does not depend on when and how often it was started."""

    words: tuple[str, ...]
    """``OUT`` is where it writes, ``GIVEN`` an evaluation that has run."""
    result: Callable[[Path], Any]
    kills: int
    """200 of all together."""
    writes_into: str = ""
    """What it is given to write into: ``GIVEN``."""
    name: str = "out"


EVAL = ("eval", "--scenarios", "grid", "--tasks", "hvac_fan_max", "--most", "steps=4", "--out", "OUT")
COMMANDS = {
    "eval": Command((*EVAL, "--agents", "oracle,no-op", "--pictures", "none"), rows(), 24),
    "eval with pictures": Command((*EVAL, "--agents", "oracle", "--pictures", "all"), rows_and_pictures, 20),
    "eval of drives": Command(
        ("eval", "--drives", "grid_june", "--agents", "rule-perfect", "--minutes", "2", "--pictures", "none",
         "--out", "OUT"), rows(), 20,
    ),
    "search": Command(
        ("search", "--space", "space.toml", "--agent", "oracle", "--budget", "3", "--out", "OUT"),
        rows("tried.jsonl"),
        20,
    ),
    "study reroute": Command(
        ("study", "reroute", *GRID, "--seeds", "0", "--departures", "0", "--delay", "0"), rows(), 24
    ),
    "study congestion": Command(
        ("study", "congestion", *GRID, "--seeds", "0,1", "--minutes", "5", "--intervention", "closure edge=c2c3"),
        rows(),
        14,
    ),
    "study days": Command(
        ("study", "days", *GRID, "--seeds", "0", "--shares", "0,1", "--days", "2", "--minutes", "5"), rows(), 12
    ),
    "report": Command(("report", "OUT"), files("tables/*.csv"), 22, writes_into="GIVEN"),
    "publish bundle": Command(("publish", "bundle", "GIVEN", "--out", "OUT"), Path.read_bytes, 32, name="x.bundle"),
    "calibrate": Command(
        ("scenarios", "calibrate", "grid", "--counts", str(COUNTS), "--rounds", "1", "--out", "OUT"),
        files("**/calibrat*"),
        12,
    ),
}  # fmt: skip


class _Disturbed:
    """Starts a command again and again."""

    def __init__(self, command: Command, place: Path, rooms: Path, program: Any) -> None:
        self.command = command
        self.place = place
        self._rooms = rooms
        self._program = program
        self._number = 0

    def fresh(self) -> Path:
        """A place to write to that is empty, or has what the command is given."""
        self._number += 1
        room = self._rooms / f"room{self._number}"
        room.mkdir()
        if self.command.writes_into:
            shutil.copytree(self.place / "given", room / "out")
        return room / self.command.name

    def words(self, out: Path) -> list[str]:
        """The command line."""
        named = {"OUT": str(out), "GIVEN": str(self.place / "given")}
        return [
            sys.executable, "-c", "from automotive_cosim.cli.main import main; main()",
            *(named.get(word, word) for word in self.command.words),
        ]  # fmt: skip

    def start(self, out: Path, **environment: str) -> subprocess.Popen[str]:
        """Starts it; its standard error goes beside the place."""
        with (out.parent / "err").open("a") as err:
            return self._program(
                *self.words(out), cwd=self.place, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=err,
                env=os.environ | environment,
            )  # fmt: skip

    def whole(self, out: Path, **environment: str) -> int:
        """Runs it to its end."""
        return self.start(out, **environment).wait(120)


def is_one_line(err: str) -> bool:
    """Whether the last line says what is wrong, and no traceback stands before it."""
    return "Traceback" not in err and bool(re.match(r"error: ", err.splitlines()[-1]))


def killed(
    disturbed: _Disturbed, expected: tuple[int, Any], last_s: float, kills: int, session: Any, until: Any
) -> None:
    """Kills it at random moments of all that it does, going on each time, and begins anew when it has ended."""
    random, out, done = Random(1), disturbed.fresh(), 0
    while done < kills:
        process = disturbed.start(out)
        with suppress(subprocess.TimeoutExpired):
            code = process.wait(random.uniform(0.2, 1.0) * last_s)
            assert has_ended(disturbed, out, code, expected)
            out = disturbed.fresh()
            continue
        process.send_signal(signal.SIGKILL)
        process.wait()
        until(lambda ended=process.pid: not session(ended))
        done += 1
    assert has_ended(disturbed, out, disturbed.whole(out), expected), (out.parent / "err").read_text()
    assert not left_over(out)


def has_ended(disturbed: _Disturbed, out: Path, code: int, expected: tuple[int, Any]) -> bool:
    """Whether the result is there; a kill may come when the folder has appeared, which is not made again."""
    was_there = code == 2 and f"{out} exists" in (out.parent / "err").read_text().splitlines()[-1]
    return (expected[0] if was_there else code, disturbed.command.result(out)) == expected


def left_over(out: Path) -> list[Path]:
    """Locks and drafts that nobody needs any more."""
    return list(out.parent.rglob(".*"))


def twice(disturbed: _Disturbed, expected: tuple[int, Any]) -> None:
    """Starts it twice at once: one is refused or comes after the other."""
    out = disturbed.fresh()
    both = [disturbed.start(out) for _ in range(2)]
    codes = [process.wait(120) for process in both]
    err = (out.parent / "err").read_text()
    assert expected[0] in codes, err
    assert set(codes) <= {expected[0], 2}, err
    assert "Traceback" not in err
    assert disturbed.command.result(out) == expected[1]
    assert not left_over(out)


def without_room(disturbed: _Disturbed, expected: tuple[int, Any], place: Path) -> None:
    """In a folder that cannot be written, in a full one, and again with room."""
    given = disturbed.fresh().parent
    room, kept, log = place / "full", place / "kept", place / "log"
    for folder in (room, kept, log):
        folder.mkdir()
    words = [word.replace(str(given), str(room)) for word in disturbed.words(given / disturbed.command.name)]
    if "space.toml" in words:
        shutil.copy(disturbed.place / "space.toml", log)
    named = {"ROOM": str(room), "KEPT": str(kept), "GIVEN": str(given)}
    tried = subprocess.run(
        ["unshare", "-rm", "sh", "-c", FULL, "sh", *words], cwd=log, env=os.environ | named, check=False,
        capture_output=True, text=True,
    )  # fmt: skip
    if tried.returncode or not (log / "3.code").is_file():
        pytest.skip(f"no folder of its own may be mounted here: {tried.stderr}")
    codes = [int((log / f"{number}.code").read_text()) for number in "123"]
    errs = [(log / f"{number}.err").read_text() for number in "123"]
    assert codes[0] == 2, errs[0]
    assert is_one_line(errs[0]), errs[0]
    assert "Read-only file system" in errs[0]
    assert codes[1] in (2, 3), errs[1]
    assert is_one_line(errs[1]), errs[1]
    assert "No space left" in errs[1]
    assert not any(re.search(r"/\.\w", each) for each in errs[:2]), "a hidden name says nothing to the user"
    assert (codes[2], disturbed.command.result(kept / disturbed.command.name)) == expected, errs[2]


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory, sumo: None) -> Path:
    """A folder with what the commands are given."""
    place = tmp_path_factory.mktemp("durable")
    (place / "space.toml").write_text(SPACE)
    (place / "clock").mkdir()
    (place / "clock" / "sitecustomize.py").write_text(CLOCK)
    given = [*EVAL[:-1], "given", "--agents", "oracle,no-op"]
    code = "from automotive_cosim.cli.main import main; main()"
    subprocess.run([sys.executable, "-c", code, *given], cwd=place, check=True, capture_output=True)
    return place


@pytest.mark.proof
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", COMMANDS)
def test_a_disturbed_command_goes_on_to_the_same_result(name, place, tmp_path, program, session, until):
    disturbed = _Disturbed(COMMANDS[name], place, tmp_path, program)
    began_s, out = time.monotonic(), disturbed.fresh()
    code = disturbed.whole(out)
    last_s = time.monotonic() - began_s
    expected = code, COMMANDS[name].result(out)
    assert expected[1]
    out = disturbed.fresh()
    assert (disturbed.whole(out, PYTHONPATH=str(place / "clock")), COMMANDS[name].result(out)) == expected
    begun_s = time.monotonic()
    killed(disturbed, expected, last_s, COMMANDS[name].kills, session, until)
    print(f"{name}: {last_s:.1f} s, killed {COMMANDS[name].kills} times in {time.monotonic() - begun_s:.0f} s")
    twice(disturbed, expected)
    without_room(disturbed, expected, tmp_path)


@pytest.mark.slow
def test_a_disturbed_report_goes_on_to_the_same_tables(tmp_path, program, session, until):
    write(tmp_path / "given", range(2))
    disturbed = _Disturbed(COMMANDS["report"], tmp_path, tmp_path, program)
    began_s, out = time.monotonic(), disturbed.fresh()
    expected = disturbed.whole(out), COMMANDS["report"].result(out)
    assert expected[1]
    killed(disturbed, expected, time.monotonic() - began_s, 2, session, until)
    twice(disturbed, expected)
