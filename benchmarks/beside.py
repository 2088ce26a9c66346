"""What this checkout costs beside another one, each figure measured in turns, in processor time.

    python benchmarks/beside.py ../other                    # every part, with that checkout's own .venv
    python benchmarks/beside.py ../other --parts lean reset --net town.net.xml --rounds 3

Processor time is user and system time of all processes of a part, keeper and simulations included; the machine may
be shared. Of several rounds the least counts; decisions are measured in chunks in turns, of which the least quarter
counts.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

MARK = "XDG_RUNTIME_DIR"
"""Passed on to the keeper and to simulations: by its value, processes are told to be of one part."""
COMPILED = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""Commands find their modules compiled, as anybody's second one does."""
LISTINGS = ("--help", "run --help", "tasks list", "scenarios list", "show drives", "agents list")
CHUNKS = 20
"""Of a round of decisions."""
LAST_S = 840.0
"""No chunk begins later in a drive of fifteen minutes; the next drive is the same again."""
PARTS = ("listings", "lean", "full", "reset", "second", "kept")


def processes(mark: str) -> dict[int, float]:
    """Processor seconds so far of every process with the mark, by its id."""
    found: dict[int, float] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if f"{MARK}={mark}\0".encode() in (entry / "environ").read_bytes() + b"\0":
                    found[int(entry.name)] = time.clock_gettime(((~int(entry.name)) << 3) | 2)
            except OSError:  # it has ended, or is not ours
                continue
    return found


def spent_s(command: list[str], mark: str, cwd: Path, until: Path | None = None) -> float:
    """Processor seconds of a command and all that it starts, to its end, or to the first picture in a folder."""
    before = processes(mark)
    seen: dict[int, float] = {}
    running = subprocess.Popen(
        command, cwd=cwd, env=os.environ | {MARK: mark}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    while running.poll() is None and not (until and any(until.rglob("*.jpg"))):
        seen |= processes(mark)
        time.sleep(0.05)
    if running.poll() is None:  # the picture is there
        seen |= processes(mark)
        running.terminate()
        running.wait()
    elif running.returncode:
        raise SystemExit(f"{' '.join(command)} failed in {cwd}")
    return sum(each_s - before.get(pid, 0.0) for pid, each_s in seen.items())


def chunks(*, is_lean: bool) -> Iterator[tuple[float, float]]:
    """Milliseconds of a simulated second of ``FlatDrive-v0`` in this process and in the simulation's, over waits of
    two seconds, fifteen at a time."""
    import gymnasium as gym

    import automotive_cosim  # noqa: F401, which registers the environments

    env = gym.make("AutomotiveCosim/FlatDrive-v0", families=("grid_june",), minutes=15, lean=is_lean).unwrapped
    env.reset(seed=0)
    while True:
        if env.episode.seconds > LAST_S:
            env.reset(seed=0)
        before_s, there_s = time.process_time(), sum(processes(os.environ[MARK]).values())
        mine_s, clock_s = 0.0, env.episode.seconds
        for _ in range(15):
            begun_s = time.process_time()
            env.step(1)
            mine_s += time.process_time() - begun_s
        own_s = time.process_time() - before_s
        both_s = sum(processes(os.environ[MARK]).values()) - there_s
        seconds = env.episode.seconds - clock_s
        yield 1000 * mine_s / seconds, 1000 * (both_s - own_s) / seconds


def decisions(part: str, checkouts: Sequence[Path], rounds: int) -> list[dict[str, float]]:
    """Figures of the decisions of each checkout; their chunks are measured in turns, so that what else the machine
    does falls on all of them."""
    with contextlib.ExitStack() as open_:
        marks = [open_.enter_context(tempfile.TemporaryDirectory()) for _ in checkouts]
        running = [
            subprocess.Popen(
                [str(each / ".venv/bin/python"), __file__, str(each), "--own", part],
                cwd=each,
                env=os.environ | {MARK: mark},
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            for each, mark in zip(checkouts, marks, strict=True)
        ]
        found: list[list[tuple[float, float]]] = [[] for _ in running]
        for _ in range(CHUNKS * rounds):
            for worker, taken in zip(running, found, strict=True):
                assert worker.stdin is not None
                assert worker.stdout is not None
                worker.stdin.write("\n")
                worker.stdin.flush()
                taken.append(tuple(json.loads(worker.stdout.readline())))
        for worker in running:
            worker.communicate()
    figures = []
    for taken in found:
        python_ms, sumo_ms = (sorted(each)[len(each) // 4] for each in zip(*taken, strict=True))
        figures.append(
            {
                f"{part}: Python, ms a simulated second": python_ms,
                f"{part}: simulation's process, ms a simulated second": sumo_ms,
                f"{part}: decisions of 2 s per second of one core": 500 / (python_ms + sumo_ms),
            }
        )
    return figures


def first_reset(net: str) -> dict[str, float]:
    """Processor seconds of the first reset of a drive on a network, and of the simulation's process in it."""
    import gymnasium as gym

    import automotive_cosim  # noqa: F401

    mark, begun_s = os.environ[MARK], time.process_time()
    env = gym.make("AutomotiveCosim/Drive-v0", scenario=net, channels=("vehicle",))
    env.reset(seed=0)
    own_s = time.process_time() - begun_s
    there_s = sum(each for pid, each in processes(mark).items() if pid != os.getpid())
    begun_s = time.process_time()
    env.reset(seed=1)
    return {
        "first reset of a drive: all, s": own_s + there_s,
        "first reset of a drive: simulation's process, s": there_s,
        "another seed's reset: this process, s": time.process_time() - begun_s,
        "bare SUMO's load and warm-up, s": bare_s(net),
        "memory of the simulation's process, MB": max(
            memory_mb(pid) for pid in processes(mark) if pid != os.getpid()
        ),
    }


def bare_s(net: str) -> float:
    """Processor seconds in which libsumo alone loads the same files with the same traffic, and warms it up."""
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.traffic.options import Setup, command_line, copied, read_configuration, run_options
    from automotive_cosim.traffic.sumo import load_library, start

    scenario, sumo = open_scenario(net), load_library()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        options = run_options(copied(read_configuration(scenario.config), Path(folder)), Setup(scenario))
        begun_s = time.process_time()
        start(sumo, command_line(options))
        for _ in range(round(scenario.sumo.warm_up_s / scenario.sumo.step_length_s)):
            sumo.step()
        return time.process_time() - begun_s


def memory_mb(pid: int) -> float:
    """Resident memory of a process."""
    return int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def listings(program: str, cwd: Path) -> dict[str, float]:
    """Milliseconds of commands that only tell something."""
    found = {}
    for words in LISTINGS:
        command = [program, *words.split()]
        begun = os.times()
        subprocess.run(
            command, cwd=cwd, env=COMPILED, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False
        )
        ended = os.times()
        spent = ended.children_user - begun.children_user + ended.children_system - begun.children_system
        found[f"{words}, ms"] = 1000 * spent
    return found


def second(other: Path, net: str) -> dict[str, float]:
    """A first and a second ``run`` to its first picture, with a keeper."""
    program = str(other / ".venv/bin/automotive-cosim")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "runs")
        took = {}
        subprocess.run([program, "keep"], env=os.environ | {MARK: folder}, check=False, capture_output=True)
        for count in ("first", "second"):
            words = ["run", "--scenario", net or "paris_centre", "--out", str(out / count)]
            took[f"{count} run to its first picture, s"] = spent_s([program, *words], folder, other, out / count)
        subprocess.run([program, "keep", "--minutes", "0"], env=os.environ | {MARK: folder}, check=False)
        return took


def kept(other: Path, family: str) -> dict[str, float]:
    """What a drive of ten minutes takes, what it keeps beside pictures, and how long that takes to read."""
    program = str(other / ".venv/bin/automotive-cosim")
    helps = subprocess.run([program, "run", "--help"], capture_output=True, text=True, check=True).stdout
    drive = ["run", "--drive", family] if "--drive" in helps else ["drive", family]  # as it was until November 2026
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "runs")
        words = [*drive, "--agent", "rule-perfect", "--minutes", "10", "--out", str(out)]
        took_s = spent_s([program, *words], folder, other)
        files = [file for file in out.rglob("*") if file.is_file() and file.suffix != ".jpg"]
        size_mb = sum(file.stat().st_size for file in files) / 1e6
        told_s = {f"{family}, ten minutes, s": took_s, f"{family}, kept beside pictures, MB": size_mb}
        return told_s | own("read", other, str(out))


def reading(folder: Path) -> dict[str, float]:
    """Milliseconds to read the road and the steps of a kept drive, least of ten."""
    from automotive_cosim.run.road import read_record, road_in
    from automotive_cosim.run.trial_folder import read_steps

    road = road_in(folder)
    calls = {"road": lambda: read_record(road), "steps": lambda: read_steps(folder)}
    return {f"to read its {what}, ms": min(taken_ms(call) for _ in range(10)) for what, call in calls.items()}


def taken_ms(call: Callable[[], object]) -> float:
    """Processor time of a call."""
    begun_s = time.process_time()
    call()
    return 1000 * (time.process_time() - begun_s)


def part_of(part: str, other: Path, net: str, family: str) -> dict[str, float]:
    """One part, measured once with one checkout."""
    if part == "second":
        return second(other, net)
    if part == "kept":
        return kept(other, family)
    if part == "listings":
        return listings(str(other / ".venv/bin/automotive-cosim"), other)
    return own(part, other, net)


def own(part: str, other: Path, path: str) -> dict[str, float]:
    """A part that is measured within a process of the other checkout."""
    with tempfile.TemporaryDirectory() as mark:
        told = subprocess.run(
            [str(other / ".venv/bin/python"), str(Path(__file__).absolute()), str(other), "--own", part]
            + (["--net", path] if path else []),
            cwd=other,
            env=os.environ | {MARK: mark},
            stdout=subprocess.PIPE,
            check=True,
        )
    found: dict[str, float] = json.loads(told.stdout.splitlines()[-1])
    return found


def main() -> None:
    """Measures in turns, and prints a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("other", type=Path, help="another checkout")
    parser.add_argument("--parts", nargs="*", default=list(PARTS), choices=PARTS)
    parser.add_argument("--net", default="", help="a network, for reset and second")
    parser.add_argument("--family", default="grid_june", help="of the drive that is kept")
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--own", default="", help=argparse.SUPPRESS)
    given = parser.parse_args()
    net = str(Path(given.net).absolute()) if given.net else ""
    if given.own == "reset":
        print(json.dumps(first_reset(net or "paris_centre")))
        return
    if given.own == "read":
        print(json.dumps(reading(Path(net))))
        return
    if given.own:
        for _, chunk in zip(sys.stdin, chunks(is_lean=given.own == "lean"), strict=False):
            print(json.dumps(chunk), flush=True)
        return
    checkouts = (given.other.absolute(), Path(__file__).absolute().parents[1])
    print("| figure | before | now | ratio |\n|---|---:|---:|---:|")
    for part in given.parts:
        rounds = (
            [decisions(part, checkouts, given.rounds)]
            if part in ("lean", "full")
            else [[part_of(part, each, net, given.family) for each in checkouts] for _ in range(given.rounds)]
        )
        for name in rounds[0][0]:
            best = max if "per second" in name else min
            before, now = (best(both[side][name] for both in rounds) for side in (0, 1))
            print(f"| {name} | {before:,.2f} | {now:,.2f} | {now / before if before else 0.0:.2f} |", flush=True)
    print(f"\nload {os.getloadavg()[0]:.1f}, {given.rounds} rounds in turns")


if __name__ == "__main__":
    main()
