"""What goes wrong is named, and leaves nothing behind."""

from __future__ import annotations

import os
import signal
import socket
import stat
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from threading import Timer

import pytest

from automotive_cosim.contracts import SlowDown
from automotive_cosim.errors import ScenarioError, SetupError, TrafficError
from automotive_cosim.scenarios import Scenario, load
from automotive_cosim.traffic import keeper, remote, sumo
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.channel import MessageChannel
from automotive_cosim.traffic.driven import DrivenProcess
from automotive_cosim.traffic.fork import Forked
from tests.traffic.calls import run_on, seen, watch
from tests.traffic.in_process import InProcess

pytestmark = pytest.mark.sumo

Variant = Callable[[Callable[[Path], None]], Scenario]


@pytest.fixture(scope="module")
def forked(grid: Scenario) -> Iterator[Forked]:
    """Started as programs start it, whatever other modules share."""
    with closing(Forked(grid, seed=1)) as simulation:
        yield simulation


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def gone(pids: list[int], within_s: float = 10.0) -> bool:
    end_s = time.monotonic() + within_s
    while any(map(is_running, pids)) and time.monotonic() < end_s:
        time.sleep(0.02)
    return not any(map(is_running, pids))


def children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def open_files(pid: int) -> int:
    return sum(1 for _ in Path(f"/proc/{pid}/fd").iterdir())


# --- processes --------------------------------------------------------------------------------------------


def test_a_killed_drive_is_named_and_the_next_departs(forked: Forked, hurried: EgoPlan) -> None:
    traffic = forked.depart(hurried)
    expected = traffic.branch()
    os.kill(traffic.pid, signal.SIGKILL)
    with pytest.raises(TrafficError, match=f"process {traffic.pid}.* died"):
        traffic.advance(5.0)
    with pytest.raises(TrafficError, match="died"):
        traffic.branch()
    traffic.close()
    following = forked.depart(hurried)
    assert following.advance(5.0) == expected.advance(5.0)
    following.close()
    expected.close()


def test_a_warm_process_that_died_between_drives_costs_a_reload(grid: Scenario, hurried: EgoPlan) -> None:
    short = replace(grid, sumo=replace(grid.sumo, warm_up_s=10.0))
    with closing(Forked(short, seed=1)) as simulation:
        with closing(simulation.depart(hurried)) as traffic:
            expected = traffic.advance(5.0)
        for _ in range(2):
            os.kill(simulation._source._warm.pid, signal.SIGKILL)
            assert gone([simulation._source._warm.pid])
            assert simulation.memory_bytes == 0
            with closing(simulation.depart(hurried)) as traffic:
                assert traffic.advance(5.0) == expected


def test_a_warm_process_that_dies_as_it_is_copied_costs_a_reload(grid: Scenario, hurried: EgoPlan) -> None:
    short = replace(grid, sumo=replace(grid.sumo, warm_up_s=10.0))
    with closing(Forked(short, seed=1)) as simulation:
        with closing(simulation.depart(hurried)) as traffic:
            expected = traffic.advance(5.0)
        warm = simulation._source._warm
        os.kill(warm.pid, signal.SIGSTOP)  # alive as far as anyone can see, until it is asked
        Timer(0.3, os.kill, (warm.pid, signal.SIGKILL)).start()
        with closing(simulation.depart(hurried)) as traffic:
            assert traffic.advance(5.0) == expected
        assert simulation._source._warm is not warm


def test_what_was_asked_of_a_warm_process_is_asked_of_the_next(grid: Scenario, hurried: EgoPlan) -> None:
    short = replace(grid, sumo=replace(grid.sumo, warm_up_s=10.0))
    with closing(Forked(short, seed=1)) as simulation:
        simulation.call(watch)
        assert simulation.call(run_on, steps=20) == 20
        with closing(simulation.depart(hurried)) as traffic:
            expected = traffic.state, traffic.call(seen)
        os.kill(simulation._source._warm.pid, signal.SIGKILL)
        assert gone([simulation._source._warm.pid])
        with closing(simulation.depart(hurried)) as traffic:
            assert (traffic.state, traffic.call(seen)) == expected
            traffic.begin(run_on, steps=200)
            assert traffic.ended() == expected[1] + 200


def test_a_hung_drive_is_ended_in_time(grid: Scenario, hurried: EgoPlan) -> None:
    simulation = Forked(grid, seed=1, timeout_s=1.0)
    traffic = simulation.depart(hurried)
    os.kill(traffic.pid, signal.SIGSTOP)
    with pytest.raises(TrafficError, match="hung"):
        traffic.advance(5.0)
    assert gone([traffic.pid])
    traffic.close()
    simulation.depart(hurried).close()
    simulation.close()


def test_a_drive_that_waits_for_a_processor_is_waited_for(grid: Scenario, hurried: EgoPlan) -> None:
    with closing(Forked(grid, seed=1, timeout_s=1.0)) as simulation, closing(simulation.depart(hurried)) as traffic:
        expected = traffic.branch()
        os.kill(traffic.pid, signal.SIGSTOP)
        Timer(1.3, os.kill, (traffic.pid, signal.SIGCONT)).start()
        assert traffic.advance(5.0) == expected.advance(5.0)
        expected.close()


def test_a_silent_process_may_use_so_much_processor_time(monkeypatch: pytest.MonkeyPatch) -> None:
    told = iter([100.0, 107.0, 119.9, 120.0])
    monkeypatch.setattr(remote, "processor_s", lambda pid: next(told))
    silence = remote._Silence(1, 20.0)
    assert [silence.may_last() for _ in range(4)] == [True, True, True, False]


@pytest.mark.parametrize("told", [[None], [100.0, 100.0]])
def test_a_silent_process_that_does_not_work_hangs(
    monkeypatch: pytest.MonkeyPatch, told: list[float | None]
) -> None:
    readings = iter(told)
    monkeypatch.setattr(remote, "processor_s", lambda pid: next(readings))
    silence = remote._Silence(1, 20.0)
    assert [silence.may_last() for _ in told][-1] is False


def test_a_crash_says_what_it_was(forked: Forked, hurried: EgoPlan) -> None:
    traffic = forked.depart(hurried)
    os.kill(traffic.pid, signal.SIGSEGV)
    with pytest.raises(TrafficError, match="Segmentation fault"):
        traffic.advance(5.0)
    traffic.close()


def test_a_lost_warm_process_is_started_again(grid: Scenario, hurried: EgoPlan) -> None:
    simulation = Forked(grid, seed=1)
    traffic = simulation.depart(hurried)
    (warm,) = (pid for pid in children(os.getpid()) if traffic.pid in children(pid))
    os.kill(warm, signal.SIGKILL)
    assert traffic.advance(1.0).states, "drives do not need it any more"
    again = simulation.depart(hurried)
    again.advance(1.0)
    assert again.state == traffic.state
    for drive in (traffic, again):
        drive.close()
    simulation.close()


def test_thirty_drives_leave_nothing_behind(grid: Scenario, hurried: EgoPlan) -> None:
    simulation = Forked(grid, seed=1)
    traffic = simulation.depart(hurried)
    (warm,) = (pid for pid in children(os.getpid()) if traffic.pid in children(pid))
    traffic.close()
    assert gone(children(warm))
    files = [open_files(os.getpid()), open_files(warm)]
    pids = []
    for number in range(30):
        traffic = simulation.depart(hurried)
        branch = traffic.branch()
        pids += [traffic.pid, branch.pid]
        branch.advance(1.0)
        for drive in (traffic, branch) if number % 2 else (branch, traffic):
            drive.close()
    assert gone(pids)
    assert [open_files(os.getpid()), open_files(warm)] == files
    simulation.close()
    simulation.close()
    assert gone([warm])
    with pytest.raises(TrafficError, match="closed"):
        simulation.depart(hurried)


SCRIPT = """
import sys
from automotive_cosim.scenarios import load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.channel import MessageChannel
from automotive_cosim.traffic.driven import DrivenProcess
from automotive_cosim.traffic.fork import Forked
grid = load("grid")
simulation = Forked(grid)
traffic = simulation.depart(EgoPlan(grid.trip("round"), "calm"))
branch = traffic.branch()
print(simulation._source._warm.pid, traffic.pid, branch.pid, flush=True)
try:
    while traffic.advance(3600.0).states:
        traffic.close()
        traffic = simulation.depart(EgoPlan(grid.trip("round"), "calm"))
except KeyboardInterrupt:
    traffic.close(); branch.close(); simulation.close()
    print("kept", flush=True)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_no_process_outlives_the_program(
    program: Callable[..., subprocess.Popen[str]], how: signal.Signals
) -> None:
    """Ctrl-C goes to the whole process group; a killed program can tell nobody."""
    process = program(sys.executable, "-c", SCRIPT, stdout=subprocess.PIPE)
    assert process.stdout is not None
    pids = [int(pid) for pid in process.stdout.readline().split()]
    assert len(pids) == 3
    time.sleep(0.3)
    if how is signal.SIGINT:
        os.killpg(process.pid, how)
        assert process.communicate(timeout=60)[0] == "kept\n"
    else:
        process.kill()
        process.wait()
    assert gone(pids)


def test_where_nothing_can_be_forked_it_says_what_to_use(grid: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(SetupError, match="on Windows use WSL, on macOS a container"):
        Forked(grid)


def libraries(pid: int) -> set[str]:
    return {line.split()[-1] for line in Path(f"/proc/{pid}/maps").read_text().splitlines() if ".so" in line}


def test_a_copy_finds_all_loaded(grid: Scenario, hurried: EgoPlan) -> None:
    """What a copy loads takes its time in every reset, and memory that it shares with none."""
    before = children(os.getpid())
    with closing(Forked(grid, seed=1)) as simulation:
        (warm,) = set(children(os.getpid())) - set(before)
        with closing(simulation.depart(hurried)) as traffic:
            traffic.advance(5.0)
            (copy,) = children(warm)
            assert libraries(copy) <= libraries(warm)


def test_a_process_holds_one_simulation_of_its_own(grid: Scenario, hurried: EgoPlan) -> None:
    simulation = InProcess(grid, seed=1)
    with pytest.raises(TrafficError, match=r"fork\.Forked"):
        InProcess(grid, seed=1)
    traffic = simulation.depart(hurried)
    simulation.depart(hurried)
    with pytest.raises(TrafficError, match="another one departed"):
        traffic.advance(1.0)
    simulation.close()
    simulation.close()
    with pytest.raises(TrafficError, match="closed"):
        simulation.depart(hurried)
    InProcess(grid, seed=1).close()


# --- set-up -----------------------------------------------------------------------------------------------


def test_a_wrong_or_missing_sumo_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    library = type(sys)("libsumo")
    library.__version__ = "1.19.0"  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "libsumo", library)
    with pytest.raises(SetupError, match=r"libsumo 1\.19\.0 is installed, 1\.28\.x is needed"):
        sumo.load_library()
    monkeypatch.setitem(sys.modules, "libsumo", None)
    with pytest.raises(SetupError, match="libsumo"):
        sumo.load_library()


def test_a_function_that_sumo_lost_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    import libsumo

    monkeypatch.delattr(libsumo._libsumo, "vehicle_getSpeed")
    with pytest.raises(SetupError, match=r"libsumo 1\.28\.\d has no function _libsumo\.vehicle_getSpeed; rein"):
        sumo.load_library()


def test_missing_system_libraries_are_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """And what the library prints when it is imported is not shown."""
    library = (
        "print('Warning! pyarrow is installed')\nraise ImportError('libGL.so.1: cannot open shared object file')"
    )
    (tmp_path / "libsumo.py").write_text(library)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "libsumo", raising=False)
    with pytest.raises(SetupError, match=r"libGL\.so\.1.*apt-get install libgl1 libx11-6"):
        sumo.load_library()
    assert capfd.readouterr() == ("", "")


def test_the_callers_environment_stays(grid: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SUMO_HOME", "/somewhere/else")
    monkeypatch.delenv("PROJ_DATA", raising=False)
    simulation = InProcess(grid, seed=1)
    assert os.environ["SUMO_HOME"] == "/somewhere/else"
    assert "PROJ_DATA" not in os.environ
    simulation.close()


def test_the_package_does_not_load_sumo_by_itself() -> None:
    code = "import sys, automotive_cosim.traffic.fork; print({'libsumo', 'traci'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_a_shipped_scenario_is_found_from_any_folder(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, forked: Forked, hurried: EgoPlan
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SUMO_HOME", str(tmp_path / "another_sumo"))
    monkeypatch.setenv("PROJ_DATA", str(tmp_path / "another_proj"))
    elsewhere = Forked(load("grid"), seed=1)
    drives = [simulation.depart(hurried) for simulation in (forked, elsewhere)]
    assert drives[0].advance(10.0) == drives[1].advance(10.0)
    for drive in drives:
        drive.close()
    elsewhere.close()
    assert not list(tmp_path.iterdir())


def test_a_crash_while_loading_names_the_scenario(variant: Variant, capfd: pytest.CaptureFixture[str]) -> None:
    """SUMO trusts its networks: a junction with a lane too few can bring it down."""

    def take_a_connection(folder: Path) -> None:
        path = folder / "grid.net.xml"
        lines = path.read_text().splitlines(keepends=True)
        path.write_text("".join(line for line in lines if 'from="c4ce" to="cec4"' not in line))

    scenario = variant(take_a_connection)
    with pytest.raises(TrafficError, match=rf"SIGSEGV.*{scenario.config.name}"):
        Forked(scenario)
    assert capfd.readouterr() == ("", "")


# --- the keeper -------------------------------------------------------------------------------------------


@pytest.fixture
def own_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where the keeper of this test listens, which ends with it."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    yield keeper._home()
    with suppress(SetupError):
        keeper.keep(0)
    while keeper._CHILDREN:
        keeper._CHILDREN.pop().wait(10)


def test_later_commands_fork_from_what_a_keeper_has_warmed_and_drive_alike(
    own_home: Path, forked: Forked, variant: Variant, hurried: EgoPlan
) -> None:
    keeper.keep(5)
    scenario = variant(lambda folder: None)
    assert stat.S_IMODE(own_home.stat().st_mode) == 0o700
    told: list[float] = []
    pids, warmed = [], []
    with closing(forked.depart(hurried)) as here:
        expected = here.advance(60.0)
    for _ in range(2):
        with closing(Forked(scenario, 1, lambda done_s, total_s: told.append(done_s))) as copy:
            with closing(copy.depart(hurried)) as there:
                assert there.advance(60.0) == expected
            assert copy._source._warm is not None
            pids.append(copy._source._warm.pid)
        warmed.append(len(told))
    assert warmed[0] == warmed[1] > 0  # the second had nothing to warm up
    assert [line.split(":")[0] for line in keeper.keep(5)] == ["variant, seed 1"]
    net = scenario.folder / "grid.net.xml"
    net.write_text(net.read_text(encoding="utf-8") + "<!-- changed -->\n", encoding="utf-8")
    with closing(Forked(scenario, 1)):
        assert len(keeper.keep(5)) == 2
    scenario.config.write_text("<configuration/>", encoding="utf-8")
    with pytest.raises(ScenarioError):
        Forked(scenario, 1)
    keeper.keep(0)
    assert gone(pids)
    end_s = time.monotonic() + 10
    while list(own_home.iterdir()) and time.monotonic() < end_s:
        time.sleep(0.05)
    assert not list(own_home.iterdir())


def test_a_drive_that_departs_alike_begins_where_one_was_handed_over_and_asks_what_it_likes(
    own_home: Path, forked: Forked, grid: Scenario, hurried: EgoPlan
) -> None:
    def driven(simulation: Forked, asked_after: int) -> tuple[list[object], bool]:
        with closing(simulation.depart(hurried)) as drive:
            passed: list[object] = [drive.state]
            for second in range(12):
                if second == asked_after:
                    passed.append(drive.request(SlowDown(20.0)))
                passed += drive.advance(1.0), drive.look(), drive.alternatives()
                if second == 7:
                    drive.handed_over()
            with closing(drive.branch()) as twin:
                passed.append(twin.advance(5.0))
            process = drive._process
            return passed, isinstance(process, DrivenProcess) and not process.answers()

    keeper.keep(5)
    for count, asked_after in enumerate((99, 99, 8, 3, 10)):
        with closing(Forked(grid, 1)) as copy:
            passed, was_known = driven(copy, asked_after)
        assert passed == driven(forked, asked_after)[0]
        assert was_known == (count > 0)


def test_what_a_keeper_was_told_of_files_is_not_read_again(own_home: Path, tmp_path: Path) -> None:
    file, read, later = tmp_path / "net.xml", list[str](), list[str]()

    def once(kind: str = "text") -> str:
        def text() -> str:
            if later:
                file.write_text(later.pop(), encoding="utf-8")
            read.append(kind + file.read_text(encoding="utf-8"))
            return read[-1].removeprefix("text")

        return keeper.read_once(kind, [file], text)

    for is_kept in (False, True):
        if is_kept:
            keeper.keep(5)
        read.clear()
        for content in ("one", "other", "one"):
            file.write_text(content, encoding="utf-8")
            assert [once(), once()] == [content, content]
        seen = ["one", "other"] if is_kept else ["one", "one", "other", "other", "one", "one"]
        assert read == [f"text{each}" for each in seen]
        assert once("other kind ") == "other kind one"
    file.write_text("one, again", encoding="utf-8")
    later.append("changed meanwhile")
    assert once() == "changed meanwhile"
    file.write_text("one, again", encoding="utf-8")
    assert once() == "one, again"


@pytest.mark.parametrize("kind", ["open", "link", "file"])
def test_no_keeper_is_used_in_a_folder_that_others_can_enter_or_made(own_home: Path, kind: str) -> None:
    if kind == "open":
        own_home.mkdir(mode=0o755)
    elif kind == "link":
        own_home.symlink_to(own_home.parent)
    else:
        own_home.touch()
    with pytest.raises(SetupError, match="is not a folder of your own"):
        keeper.keep(5)


READ: list[bool] = []


def note() -> None:
    READ.append(True)


class _Told:
    """Notes whether anybody has read it."""

    def __reduce__(self) -> tuple[object, ...]:
        return note, ()


@pytest.mark.parametrize("own", [True, False])
def test_a_keeper_reads_nothing_of_another_user(monkeypatch: pytest.MonkeyPatch, own: bool) -> None:
    READ.clear()
    ours, theirs = socket.socketpair()
    if not own:
        user = os.getuid() + 1
        monkeypatch.setattr(keeper.os, "getuid", lambda: user)
    with ours:
        MessageChannel(ours).send(("keep", _Told()))
        keeper._Keeper(1)._answer(theirs)
    assert bool(READ) is own


def test_a_keeper_is_needed_for_its_minutes_after_the_last_use(monkeypatch: pytest.MonkeyPatch) -> None:
    one, now_s = keeper._Keeper(5), time.monotonic()
    for later_s, needed in ((290, True), (310, False)):
        monkeypatch.setattr(keeper.time, "monotonic", lambda later_s=later_s: now_s + later_s)
        assert one._is_needed() is needed


def test_nobody_s_copy_fails_because_the_keeper_needs_room_and_what_cannot_be_warmed_up_is_not_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one, made = keeper._Keeper(5), list[str]()
    one._most_bytes = 0.0

    def copy(name: str) -> None:
        ours, theirs = socket.socketpair()
        with ours, theirs:
            one._copy(name, MessageChannel(ours))  # type: ignore[arg-type]

    class _Warm:
        pid, memory_bytes, is_broken = 1, 1, False

        def __init__(self, name: str) -> None:
            self.name = name

        def fork(self, outputs: None) -> _Warm:
            if self.name == "one":
                copy("other")  # which needs the room
            assert not self.is_broken
            made.append(self.name)
            return self

        def hand_over(self, channel: MessageChannel) -> None: ...

        def close(self) -> None:
            self.is_broken = True

    def start(name: str, *_: object) -> tuple[_Warm, None]:
        if name == "broken":
            raise TrafficError(name)
        return _Warm(name), None

    monkeypatch.setattr(keeper.RemoteProcess, "start", start)
    monkeypatch.setattr(keeper, "_wanted", lambda setup: setup)
    copy("one")
    assert made == ["other", "one"]
    with pytest.raises(TrafficError):
        copy("broken")
    assert len(one._kept) == 1
