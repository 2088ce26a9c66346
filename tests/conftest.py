"""Which tests may start SUMO; builders of observations for those that may not, warm simulations for those that may.

A test starts SUMO if it is marked ``sumo`` or asks, itself or through a fixture, for the fixture ``sumo``, which
marks it. Any other test that loads libsumo or runs one of SUMO's programs fails.
"""

import gc
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from multiprocessing import forkserver
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from zlib import crc32

import pytest
import typer.main
from hypothesis import HealthCheck, settings

from automotive_cosim.cli.main import main
from automotive_cosim.contracts import (
    BoundingBox,
    Connectivity,
    Element,
    Feedback,
    FeedbackCode,
    GpsFix,
    Observation,
    VehicleState,
)
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.tasking.own_files import VARIABLE
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from tests import farm, preloaded
from tests.farm import NO_LIBSUMO

PROXIES = [f"{kind}_proxy" for kind in ("http", "https", "all")]
for _name in (
    "COLUMNS", "LINES", "FORCE_COLOR", "NO_COLOR", "PY_COLORS", "GITHUB_ACTIONS", "AUTOMOTIVE_COSIM_DEBUG",
    *PROXIES, *map(str.upper, PROXIES),
):  # fmt: skip
    os.environ.pop(_name, None)  # what is printed, and who answers at 127.0.0.1, must not depend on the machine
os.environ["XDG_RUNTIME_DIR"] = "/proc"  # nor on warm traffic that is kept here: nobody has a folder there

# How long an example takes says how busy the machine is.
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")

# Building all commands is nine tenths of running one.
typer.main.get_command = cache(typer.main.get_command)

OTHERS = "AUTOMOTIVE_COSIM_TEST_DATA"
ABOUT_PROCESSES = {"test_faults", "test_confinement", "test_file_check"}
"""Modules whose simulations start as programs start them."""
_forbidden = False


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--prove",
        metavar="I/N",
        nargs="?",
        const="1/1",
        help="run the tests marked `proof` instead, the I-th of N parts",
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    for item in items:
        for name in {"sumo", "proof"}.intersection(getattr(item, "fixturenames", ())):
            item.add_marker(name)
    part, parts = map(int, (config.option.prove or "0/1").split("/"))
    if not 0 <= part <= parts:
        raise pytest.UsageError(
            f"--prove is {config.option.prove}; give a part from 1 to {parts}, such as 1/{parts}"
        )

    def is_wanted(item: pytest.Item) -> bool:
        is_proof = item.get_closest_marker("proof") is not None
        return is_proof and crc32(item.nodeid.encode()) % parts == part - 1 if part else not is_proof

    config.hook.pytest_deselected(items=[item for item in items if not is_wanted(item)])
    items[:] = [item for item in items if is_wanted(item)]
    items.sort(key=lambda item: item.get_closest_marker("long") is None)  # else a worker waits for one at the end


def pytest_sessionstart(session: pytest.Session) -> None:
    if session.config.getoption("numprocesses", None) and preloaded.POSSIBLE:
        session.config.add_cleanup(farm.Farm().close)


def pytest_collection_finish() -> None:
    gc.collect()
    gc.freeze()  # six thousand tests live to the end: no later collection looks at them again


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    if item.get_closest_marker("sumo"):
        with pytest.MonkeyPatch.context() as patch:
            if preloaded.POSSIBLE and item.path.stem not in ABOUT_PROCESSES:
                _ready()
                farm.use(patch.setattr)
            return (yield)
    with _without_sumo():
        return (yield)


@cache
def _ready() -> None:
    """Starts what simulations and the workers of evaluations are forked from."""
    preloaded.Preloaded()
    forkserver.set_forkserver_preload(["tests.readied"])
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(Path(__file__).parents[1]), prepend=os.pathsep)
        forkserver.ensure_running()


@contextmanager
def _without_sumo() -> Iterator[None]:
    global _forbidden
    path = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (NO_LIBSUMO, path)))
    sys.path.insert(0, NO_LIBSUMO)  # which multiprocessing hands on
    _forbidden = True
    try:
        yield
    finally:
        _forbidden = False
        sys.path.remove(NO_LIBSUMO)
        if path is None:
            del os.environ["PYTHONPATH"]
        else:
            os.environ["PYTHONPATH"] = path


def _refuse_sumo(event: str, arguments: tuple[Any, ...]) -> None:
    if not _forbidden:
        return
    if event == "subprocess.Popen":
        program, words = Path(str(arguments[0])), list(map(str, arguments[1]))
        starts = program.parts[-3:-1] == ("sumo", "bin") or "automotive_cosim.traffic.process" in words
    else:
        starts = event == "import" and arguments[0] == "libsumo"
    if starts:
        pytest.fail("this test starts SUMO: mark it `sumo`, or let what starts SUMO ask for the fixture `sumo`")


sys.addaudithook(_refuse_sumo)


@pytest.fixture(scope="session")
def sumo() -> None:
    """Asked for by every fixture that starts SUMO, or returns what does."""


@pytest.fixture(scope="session")
def proof() -> None:
    """Asked for by every fixture that serves proofs, whose tests it marks."""


PARIS = "Place: Paris, France\nSpeed limit here: 50 km/h (posted on Avenue Foch)"


def _vehicle(**changes: object) -> VehicleState:
    values: dict[str, object] = dict(
        speed_kmh=80.2,
        gear="D",
        restrictions=511,
        ambient_temperature_c=4.0,
        cabin_temperature_c=20.0,
        cabin_humidity_pct=60.0,
        rain_intensity_pct=0.0,
        driver_temperature_set_c=21.0,
        fan_speed_pct=30.0,
        is_low_beam_on=False,
        is_high_beam_on=False,
        is_front_fog_on=False,
        is_rear_fog_on=False,
        is_hazard_on=False,
        energy_level_pct=70.0,
        range_km=250.0,
        speed_limit_sign_kmh=None,
        leader_gap_m=None,
        leader_time_to_collision_s=None,
        aboard="driver: adult, 75 kg, awake, belted",
    )
    return VehicleState(**(values | changes))  # type: ignore[arg-type]


def _button(resource_id: str, text: str = "Button") -> Element:
    box = BoundingBox(0, 0, 100, 60)
    return Element(text, "", "Button", box, resource_id, "automotive", is_clickable=True)


def _observation(goal: str, context: str | None = PARIS, **changes: object) -> Observation:
    values: dict[str, object] = dict(
        goal=goal,
        time_s=0.0,
        feedback=Feedback(FeedbackCode.NONE, ""),
        elements=(_button(shown_id("safety.kind.speed"), "Speed"), _button(shown_id("safety.warn"), "Warn driver")),
        vehicle=_vehicle(),
        connectivity=Connectivity(True, "5g", 4),
        gps=GpsFix(True, 2.29, 48.87, 3.0, 0.0, 90.0),
        context=context,
    )
    return Observation(**(values | changes))  # type: ignore[arg-type]


@pytest.fixture(scope="session")
def vehicle() -> Callable[..., VehicleState]:
    return _vehicle


@pytest.fixture(scope="session")
def button() -> Callable[..., Element]:
    return _button


@pytest.fixture(scope="session")
def observation() -> Callable[..., Observation]:
    return _observation


@pytest.fixture(scope="session")
def simulations(sumo: None) -> Iterator[Simulations]:
    """Shared by all tests of a worker."""
    shared = Simulations(count_limit=16)
    yield shared
    shared.close()


@pytest.fixture(scope="session")
def data_of_others() -> Callable[[str], Path]:
    """A file of the networks, maps and counts that some tests try beside what the repository holds."""

    def find(name: str) -> Path:
        folder = os.environ.get(OTHERS)
        if not folder:
            pytest.skip(f"{OTHERS} is not set: the folder with the networks, maps and counts of others")
        if not (found := Path(folder) / name).exists():
            pytest.skip(f"{found} is not there")
        return found

    return find


@pytest.fixture
def program() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Starts programs, each in a session of its own, that Ctrl-C reaches however the tests were started.

    Children of ``nohup``, of a shell's ``&`` and of some CI services inherit that SIGINT is ignored; these inherit
    ``sigint`` instead. None outlives its test, even one that a timeout ended."""
    started: list[subprocess.Popen[str]] = []

    def start(*words: object, sigint: Any = signal.default_int_handler, **named: Any) -> subprocess.Popen[str]:
        inherited = signal.signal(signal.SIGINT, sigint)
        try:
            started.append(subprocess.Popen(list(map(str, words)), text=True, start_new_session=True, **named))
        finally:
            signal.signal(signal.SIGINT, inherited)
        return started[-1]

    yield start
    for process in started:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        with process:  # closes its pipes and waits
            pass


@pytest.fixture(scope="session")
def until() -> Callable[[Callable[[], object]], None]:
    """Waits until something is so, for a minute and a half."""

    def wait(true: Callable[[], object]) -> None:
        end_s = time.monotonic() + 90.0
        while not true():
            assert time.monotonic() < end_s, "did not come about"
            time.sleep(0.05)

    return wait


@pytest.fixture(scope="session")
def session() -> Callable[[int], list[str]]:
    """The processes that live in a session, by its leader."""

    def found(leader: int) -> list[str]:
        living = []
        for stat in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if fields[3] == str(leader) and fields[0] != "Z":
                living.append(stat.parent.name)
        return living

    return found


@pytest.fixture(scope="session")
def fork_server() -> Iterator[ForkServer]:
    """Starts the agents' processes of all tests of a worker."""
    with closing(ForkServer()) as shared:
        yield shared


@dataclass
class Ran:
    code: int
    out: str
    err: str


@pytest.fixture
def cli(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path, fork_server: ForkServer
) -> Iterator[Callable[..., Ran]]:
    """Runs ``automotive-cosim`` in an empty folder."""
    lent = SimpleNamespace(start=fork_server.start, end=fork_server.end, close=lambda: None)
    monkeypatch.setattr("automotive_cosim.run.outside.ForkServer", lambda: lent)
    monkeypatch.setattr("automotive_cosim.cli.main.watched", lambda work: work())
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("AUTOMOTIVE_COSIM_DEBUG", raising=False)
    terminated = signal.getsignal(signal.SIGTERM)

    def run(*arguments: object) -> Ran:
        monkeypatch.setattr(sys, "argv", ["automotive-cosim", *map(str, arguments)])
        capfd.readouterr()
        with pytest.raises(SystemExit) as ended:
            main()
        printed = capfd.readouterr()
        return Ran(int(ended.value.code or 0), printed.out, printed.err)

    yield run
    signal.signal(signal.SIGTERM, terminated)


@pytest.fixture
def own_tasks(monkeypatch: pytest.MonkeyPatch) -> Callable[[Path], None]:
    """Adds a folder of tasks to the catalogue of this process; workers add that which ``--tasks-from`` names."""
    shipped = dict(CATALOGUE._tasks)
    monkeypatch.setenv(VARIABLE, "")

    def add(folder: Path) -> None:
        monkeypatch.setattr(CATALOGUE, "_tasks", {**shipped})
        CATALOGUE.add_folder(folder)

    return add


@pytest.fixture
def warm(simulations: Simulations, monkeypatch: pytest.MonkeyPatch) -> None:
    """``automotive-cosim run`` takes the warm simulations that all tests share, instead of its own, and its film,
    which takes most of the time, is an empty file."""
    import_module("automotive_cosim.envs.pool")  # has simulations of its own, whichever test imports it first

    def unfilmed(film: Any, *_: object) -> None:
        if film._path.parent.is_dir():
            film._path.touch()

    monkeypatch.setattr("automotive_cosim.report.film.Film.finished", unfilmed)

    class Lent:
        held = staticmethod(simulations.held)

        def close(self) -> None:
            """They stay warm."""

    monkeypatch.setattr("automotive_cosim.traffic.fork.Simulations", Lent)
