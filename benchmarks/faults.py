"""What an evaluation survives: kills, stops, a full disk, a clock set back; and whether resets leave anything.

    python benchmarks/faults.py [--parts tasks,drives,faults,ray,resets] [--kills 200] [--resets 1000] [--seed 0]

Runs small evaluations with two workers, of tasks on the grid (an agent with a process of its own, and one without)
and of drives, and kills one of their processes after a random time: the command itself, a worker, the one that
holds the warm traffic, an episode's own traffic, the one that agents are forked from, or an agent; or stops one for
a second. When the command has ended, it is run again until nothing is missing. Then the rows must be those of an
undisturbed run, but for times; only where an agent's own process was killed, the episode may be that agent's
failure, as it would be if it had ended itself.

With Ray (extra ``ray``), one of two nodes on this machine is killed and replaced. Every part takes a tenth of the
kills, tasks take all.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any

from automotive_cosim.agents.leftovers import children, tree
from automotive_cosim.contracts import Json
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.row import steady
from automotive_cosim.run.store import read_rows

COMMAND = (sys.executable, "-c", "from automotive_cosim_main import main; main()", "eval")
TASKS = (
    "--agents",
    "t3a,oracle",
    "--tasks",
    "hvac_fan_max",
    "--scenarios",
    "grid",
    "--seeds",
    "0-2",
    "--retries",
    "0",
)
DRIVES = ("--drives", "grid_january", "--agents", "t3a", "--seeds", "0,1", "--retries", "0")
STOPPED = "stopped for a second"
KINDS = ("command", "worker", "warm traffic", "episode's traffic", "fork server", "agent", STOPPED)
AGENTS_OWN = frozenset(("fork server", "agent"))
"""Processes whose end is the agent's failure: it could have ended them itself."""
LONGEST_S = 3600.0
"""Wall time of one start of the command, on a busy machine too."""
MOST_STARTS = 20
MARK = "FAULTS_OF"
"""Environment variable of what is started here, so that it is found again."""


def main() -> None:
    """Runs everything that is asked for and prints what came of it as JSON, a line for each part."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--parts", default="tasks,drives,faults,ray,resets")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--resets", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    rng, tenth = random.Random(given.seed), max(1, given.kills // 10)
    with tempfile.TemporaryDirectory(prefix="faults-") as name:
        folder = Path(name)
        parts: dict[str, Callable[[], dict[str, Any]]] = {
            "tasks": lambda: killed(folder / "tasks", TASKS, EpisodeRow, given.kills, rng),
            "drives": lambda: killed(folder / "drives", DRIVES, DriveTrialRow, tenth, rng),
            "faults": lambda: disturbed(folder / "faults"),
            "ray": lambda: on_ray(folder / "ray", tenth, rng),
            "resets": lambda: resets(given.resets),
        }
        for part in given.parts.split(","):
            began_s = time.monotonic()
            told = {"part": part} | parts[part]()
            print(json.dumps(told | {"minutes": round((time.monotonic() - began_s) / 60, 1)}), flush=True)


# --- kills --------------------------------------------------------------------------------------------------------


def killed(folder: Path, words: Sequence[str], kind: type[Any], kills: int, rng: random.Random) -> dict[str, Any]:
    """Kills processes of one evaluation after another until there were so many kills."""
    done: Counter[str] = Counter()
    undisturbed, took_s = rows(folder / "undisturbed", words, kind)
    evaluations = differing = own_failures = starts = 0
    while done.total() < kills:
        out = folder / f"e{evaluations}"
        evaluations += 1
        mine: Counter[str] = Counter()
        for number in range(MOST_STARTS):
            starts += 1
            left = kills - done.total() - mine.total()
            to_do = min(rng.randint(1, 8), left) if number < MOST_STARTS // 2 else 0
            with started((*words, "--workers", "2", "--out", str(out))) as process:
                # A command takes long to start on a busy machine, and most kills would only hit that.
                at_work = to_do > 0 and rng.random() < 0.9
                while at_work and process.poll() is None and not has_workers(process.pid):
                    time.sleep(0.5)
                for _ in range(to_do):
                    with suppress(subprocess.TimeoutExpired):
                        process.wait(rng.uniform(0.5, max(2.0, took_s / 6)))
                        break
                    if hit := hurt(process.pid, rng):
                        mine[hit] += 1
                code = process.wait(LONGEST_S)
            if code == 0:
                break
        done += mine
        found = {name: steady(row) for name, row in read_rows(out, kind).items()}
        other = [name for name in undisturbed if found.get(name) != undisturbed[name]]
        own = [name for name in other if mine.keys() & AGENTS_OWN and found.get(name, {}).get("agent_error")]
        own_failures += len(own)
        differing += len(other) - len(own)
        for name in sorted({*other} - {*own}):
            print(f"{name} after {dict(mine)}: {changed(undisturbed[name], found.get(name, {}))}", file=sys.stderr)
        shutil.rmtree(out)
        print(f"{done.total()} of {kills} kills, {starts} starts, {differing} rows differ", file=sys.stderr)
    return {
        "kills": dict(sorted(done.items())),
        "evaluations": evaluations,
        "starts": starts,
        "rows": evaluations * len(undisturbed),
        "rows that differ": differing,
        "failures of an agent that was killed": own_failures,
        "processes left": len(left_over()),
    }


def changed(row: Json, other: Json) -> str:
    """The fields in which a row differs, each with both values."""
    names = sorted(name for name in {*row, *other} if row.get(name) != other.get(name))
    return "; ".join(f"{name}: {row.get(name)!r:.300} -> {other.get(name)!r:.300}" for name in names)


def has_workers(command: int) -> bool:
    """Whether anything but the command itself could be killed."""
    return any(kind_of(pid, command) in KINDS[1:] for pid in tree(command))


def hurt(command: int, rng: random.Random) -> str:
    """Kills a process of a running command, or stops it for a second; which, or nothing if there was none."""
    there = {pid: kind_of(pid, command) for pid in tree(command)}
    kinds = [kind for kind in KINDS if kind in there.values() or (kind == STOPPED and there)]
    if not kinds:
        return ""
    kind = rng.choice(kinds)
    with suppress(ProcessLookupError):
        pid = rng.choice([pid for pid, is_a in there.items() if kind in (is_a, STOPPED)])
        if kind == STOPPED:
            os.kill(pid, signal.SIGSTOP)
            time.sleep(1)
            os.kill(pid, signal.SIGCONT)
        else:
            os.kill(pid, signal.SIGKILL)
        return kind
    return ""


def kind_of(pid: int, command: int) -> str:
    """What a process of an evaluation is, by its command line and its parent's."""
    line, above = words_of(pid), words_of(parent_of(pid))
    if pid == command:
        return "command"
    if "automotive_cosim.traffic.process" in line:
        return "episode's traffic" if "automotive_cosim.traffic.process" in above else "warm traffic"
    if "automotive_cosim.agents.process" in line:
        return "agent" if "automotive_cosim.agents.process" in above else "fork server"
    return "worker" if "forkserver" in line and "forkserver" in above else "other"


def words_of(pid: int) -> str:
    """The command line of a process; empty if it has ended."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_text(errors="replace")
    except OSError:
        return ""


def parent_of(pid: int) -> int:
    """The parent of a process; 0 if it has ended."""
    try:
        return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def left_over() -> list[int]:
    """Processes that a command has started and that still run half a minute after its end."""
    mine, found = f"{MARK}={os.getpid()}".encode(), list[int]()
    for _ in range(30):
        found = []
        for path in Path("/proc").glob("[0-9]*"):
            with suppress(OSError):
                if mine in (path / "environ").read_bytes().split(b"\0"):
                    found.append(int(path.name))
        if not found:
            break
        time.sleep(1)
    return found


@contextmanager
def started(words: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[str]]:
    """A start of the command, which ends with the block."""
    options["env"] = options.get("env", os.environ) | {MARK: str(os.getpid())}
    process = subprocess.Popen(
        [*COMMAND, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **options
    )
    try:
        yield process
    finally:
        if process.poll() is None:
            for pid in tree(process.pid):
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        if process.stderr is not None:
            process.stderr.close()
        process.wait()


def rows(folder: Path, words: Sequence[str], kind: type[Any]) -> tuple[dict[str, Any], float]:
    """The rows of an undisturbed run without what may differ, and its wall seconds."""
    began_s = time.monotonic()
    with started((*words, "--workers", "2", "--out", str(folder))) as process:
        assert process.wait(LONGEST_S) == 0, "the undisturbed run has failed"
    return {name: steady(row) for name, row in read_rows(folder, kind).items()}, time.monotonic() - began_s


# --- other faults -------------------------------------------------------------------------------------------------


def disturbed(folder: Path) -> dict[str, Any]:
    """Runs an evaluation under each fault, then again without it; how the disturbed start has ended, and whether
    the rows are the undisturbed ones."""
    expected, _ = rows(folder / "undisturbed", TASKS, EpisodeRow)
    told: dict[str, Any] = {}

    def limited(what: int, most: int) -> Callable[[], None]:
        return lambda: resource.setrlimit(what, (most, most))

    clock = folder / "clock"
    clock.mkdir()
    (clock / "sitecustomize.py").write_text(CLOCK)
    path = os.pathsep.join((str(clock), *filter(None, [os.environ.get("PYTHONPATH")])))
    for name, options in (
        ("full disk", {"preexec_fn": limited(resource.RLIMIT_FSIZE, 60_000)}),
        ("little memory", {"preexec_fn": limited(resource.RLIMIT_AS, 320 * 2**20)}),
        ("clock set back", {"env": os.environ | {"PYTHONPATH": path}}),
    ):
        out = folder / name.replace(" ", "_")
        with started((*TASKS, "--workers", "2", "--out", str(out)), **options) as process:
            said = ended(process)
        told[name] = f"{said} {again(out, expected)}"
        print(name, told[name], file=sys.stderr)
    with started((*TASKS, "--out", "/proc/nowhere")) as process:
        told["read-only folder"] = ended(process)
    out = folder / "two"
    words = (*TASKS, "--workers", "2", "--out", str(out))
    with started(words) as first:
        while not (out / "lock").exists():
            time.sleep(0.05)
        with started(words) as second:
            said = ended(second)
        assert first.wait(LONGEST_S) == 0
    told["two into one folder"] = said + " " + again(out, expected)
    return told


CLOCK = """
import time
_now, _began = time.time, time.monotonic()
time.time = lambda: _now() - (86400 if time.monotonic() - _began > 3 else 0)
"""
"""Sets the clock of every process back by a day three seconds after its start."""


def ended(process: subprocess.Popen[str]) -> str:
    """How a start of the command has ended, in words."""
    _, errors = process.communicate(timeout=LONGEST_S)
    lines = [line for line in errors.splitlines() if line.startswith(("error:", "Traceback"))]
    return f"exit code {process.returncode}{': ' + lines[-1][:120] if lines else ''};"


def again(out: Path, expected: dict[str, Any]) -> str:
    """Runs the command again without a fault; whether the rows are as expected."""
    for _ in range(2):
        with started((*TASKS, "--workers", "2", "--out", str(out))) as process:
            if process.wait(LONGEST_S) == 0:
                break
    found = {name: steady(row) for name, row in read_rows(out, EpisodeRow).items()}
    return "rows equal" if found == expected else "ROWS DIFFER"


# --- Ray ----------------------------------------------------------------------------------------------------------


def on_ray(folder: Path, kills: int, rng: random.Random) -> dict[str, Any]:
    """Kills one of two nodes during an evaluation, and gives it another."""
    from ray.cluster_utils import Cluster

    expected, took_s = rows(folder / "undisturbed", TASKS, EpisodeRow)
    node: dict[str, Any] = {"num_cpus": 1, "object_store_memory": 80 * 1024**2}
    cluster = Cluster(initialize_head=True, head_node_args=node | {"include_dashboard": False})
    differing = starts = 0
    with closing(_Closes(cluster)):
        for number in range(kills):
            second = cluster.add_node(**node)
            out = folder / f"e{number}"
            words = (*TASKS, "--executor", "ray", "--ray-address", str(cluster.address), "--out", str(out))
            with started(words) as process:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(rng.uniform(5.0, 5.0 + took_s))
                cluster.remove_node(second, allow_graceful=False)
                starts += 1
                code = process.wait(LONGEST_S)
            while code and starts < MOST_STARTS * kills:
                with started(words) as process:
                    code = process.wait(LONGEST_S)
                starts += 1
            found = {name: steady(row) for name, row in read_rows(out, EpisodeRow).items()}
            differing += sum(found.get(name) != row for name, row in expected.items())
    return {"kills": kills, "starts": starts, "rows": kills * len(expected), "rows that differ": differing}


class _Closes:
    def __init__(self, cluster: Any) -> None:
        self.close = cluster.shutdown


# --- resets -------------------------------------------------------------------------------------------------------


def resets(count: int) -> dict[str, Any]:
    """Resets one environment again and again; what there was of files, processes and memory on the way."""
    from automotive_cosim.envs.cockpit import CockpitEnv

    seen: dict[int, dict[str, float]] = {}
    with closing(CockpitEnv("hvac_fan_max", scenario="grid")) as env:
        for number in range(1, count + 1):
            env.reset(seed=number % 5)
            if number in (1, count // 10, count // 2, count):
                mine = tree(os.getpid())
                seen[number] = {
                    "files": sum(len(list(Path(f"/proc/{pid}/fd").iterdir())) for pid in mine),
                    "processes": len(mine),
                    "zombies": sum(not words_of(pid) for pid in children()),
                    "megabytes of this process": round(resident_mb(os.getpid())),
                    "temporary files": len(list(Path(tempfile.gettempdir()).iterdir())),
                }
    return {"after": seen}


def resident_mb(pid: int) -> float:
    """Resident memory of a process."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * resource.getpagesize() / 2**20


if __name__ == "__main__":
    main()
