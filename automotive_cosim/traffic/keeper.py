"""Warm traffic that outlives the command: one process per user keeps what was used last, and later commands fork
from it instead of loading and warming up again. It also keeps where drives in it were handed over last.

``automotive-cosim keep`` starts it. It listens in a folder that nobody else can enter, answers no other user, and
ends by itself. Its name goes by this program's code and versions, and what it keeps by the content of the
scenario's files, so what differs in anything is never used. A command that finds none warms up as ever.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
import pickle
import socket
import stat
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import CosimError, SetupError, TrafficError, UserError
from automotive_cosim.formats.files import file_sha256
from automotive_cosim.formats.writing import locked, make_folder, remove
from automotive_cosim.formats.xml import without_collection
from automotive_cosim.traffic.base import EgoPlan, WarmUpProgress
from automotive_cosim.traffic.channel import ClosedError, MessageChannel
from automotive_cosim.traffic.driven import Departure, DrivenProcess
from automotive_cosim.traffic.options import Setup, read_configuration
from automotive_cosim.traffic.remote import TIMEOUT_S, RemoteProcess, environment

MEMORY_SHARE = 0.25
"""Of the machine's memory, what it keeps takes no more, unless one alone does."""
PASSED_ON = ("HOME", "LANG", "LC_ALL", "LD_LIBRARY_PATH", "PATH", "TMPDIR", "TZ", "XDG_RUNTIME_DIR")
"""Variables that it gets: no key of a provider should stay in a process that outlives the command."""
STARTS_S = 30.0
LOOK_S = 2.0
_PEER = struct.Struct("3i")

_Files: TypeAlias = tuple[tuple[str, str], ...]
"""Files with their SHA-256."""
_Wanted: TypeAlias = tuple[Setup, _Files]
"""The traffic, and its files."""
MOST_DRIVES = 8
"""In the same traffic; a copy has written to some 20 MB of its memory when it is handed over."""
MOST_READ = 64
"""Scenarios without their networks: a few kilobytes each."""
T = TypeVar("T")


@dataclass(slots=True)
class _Kept:
    """Warm traffic; made by whoever holds the lock first. It ends with the last reference to it, so that nobody's
    copy fails because it is kept no longer; copies live on."""

    lock: threading.Lock = field(default_factory=threading.Lock)
    setup: Setup | None = None
    """With which it was warmed up."""
    process: RemoteProcess | None = None
    network: bytes = b""
    """Pickled once for all."""
    drives: OrderedDict[Departure, tuple[RemoteProcess, bytes]] = field(default_factory=OrderedDict)
    """Where each was handed over, and the answers on its way, pickled."""
    used_s: float = field(default_factory=time.monotonic)

    @property
    def memory_bytes(self) -> int:
        """Memory of all that."""
        own = sum(each.own_bytes + len(answers) for each, answers in self.drives.values())
        return own if self.process is None else own + self.process.memory_bytes

    def line(self) -> str:
        """In words, for who asks what is kept."""
        if self.setup is None or self.process is None:
            return "being warmed up"
        what = f"{self.setup.scenario.config.parent.name}, seed {self.setup.seed}"
        used_min = (time.monotonic() - self.used_s) / 60
        return f"{what}: {self.memory_bytes / 1e6:.0f} MB, used {used_min:.0f} min ago"


class _Keeper:
    """The process itself."""

    def __init__(self, minutes: float) -> None:
        self._minutes = minutes
        self._kept: OrderedDict[_Wanted, _Kept] = OrderedDict()
        self._read: OrderedDict[tuple[str, _Files], object] = OrderedDict()
        """What was read from files, by their content."""
        self._lock = threading.Lock()
        self._used_s = time.monotonic()
        self._most_bytes = MEMORY_SHARE * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")

    def serve(self, listening: socket.socket) -> None:
        """Answers until nothing has been used for its time, or it is told to end."""
        listening.settimeout(LOOK_S)
        while self._is_needed():
            with suppress(TimeoutError):
                connection, _ = listening.accept()
                threading.Thread(target=self._answer, args=(connection,), daemon=True).start()

    def _is_needed(self) -> bool:
        with self._lock:
            old_s = time.monotonic() - 60 * self._minutes
            for wanted, kept in list(self._kept.items()):
                if kept.used_s < old_s and not kept.lock.locked():
                    del self._kept[wanted]
            return bool(self._kept) or self._used_s > old_s

    def _answer(self, connection: socket.socket) -> None:
        with connection, suppress(ClosedError, OSError):
            if not _is_own(connection):
                return
            channel = MessageChannel(connection)
            what, given = channel.receive()
            self._used_s = time.monotonic()
            if what == "keep":
                self._minutes = given
                with self._lock:
                    channel.send([each.line() for each in self._kept.values()])
                return
            if what == "read":
                found = self._read.get(given)
                channel.send(found)
                if found is None:
                    self._read[given] = channel.receive()
                if len(self._read) > MOST_READ:
                    self._read.popitem(last=False)
                return
            if what == "driven":
                self._take(given, channel)
                return
            if what == "drive":
                self._give(given, channel)
                return
            try:
                self._copy(given, channel)
            except CosimError as error:  # as from a simulation's process
                channel.send(("error", (type(error), str(error))))

    def _copy(self, setup: Setup, channel: MessageChannel) -> None:
        """Sends a copy of the traffic, and with what setup it was warmed up."""
        wanted = _wanted(setup)
        with self._lock:
            kept = self._kept.setdefault(wanted, _Kept())
            self._kept.move_to_end(wanted)
        is_new = is_whole = False
        try:
            with kept.lock:
                kept.used_s = time.monotonic()
                if kept.process is None or kept.process.is_broken:

                    def progress(done_s: float, total_s: float) -> None:
                        with suppress(ClosedError):  # who comes later gets it
                            channel.send(("progress", (done_s, total_s)))

                    is_new, kept.setup = True, setup
                    kept.process, network = RemoteProcess.start(setup, progress, TIMEOUT_S)
                    kept.network = pickle.dumps(network, pickle.HIGHEST_PROTOCOL)
                copy = kept.process.fork(None)
                kept.used_s = self._used_s = time.monotonic()
                found = kept.setup, kept.network, copy.pid, kept.process.pid
            is_whole = not is_new or _wanted(setup) == wanted  # or somebody has changed its files meanwhile
        finally:
            with self._lock:
                if not is_whole:
                    self._kept.pop(wanted, None)
                self._make_room()
        channel.send(("done", found))
        copy.hand_over(channel)

    def _take(self, departure: Departure, channel: MessageChannel) -> None:
        """Keeps a drive where it is handed over."""
        answers, pid = channel.receive()
        process = RemoteProcess.taken(channel, pid, TIMEOUT_S)
        with self._lock:
            drives = self._drives(departure)
            drives[departure] = process, answers
            if len(drives) > MOST_DRIVES:
                drives.popitem(last=False)
            self._make_room()

    def _give(self, departure: Departure, channel: MessageChannel) -> None:
        """Sends the answers of a drive up to its hand-over and a copy from there; None if it is not kept."""
        with self._lock:
            process, answers = self._drives(departure).get(departure, (None, b""))
            copy = None
            with suppress(TrafficError):
                copy = process and process.fork(None)
        channel.send(copy and (answers, copy.pid))
        if copy:
            copy.hand_over(channel)

    def _drives(self, departure: Departure) -> OrderedDict[Departure, tuple[RemoteProcess, bytes]]:
        """Those in the traffic of a departure; of traffic that is kept no longer, they are not kept either."""
        in_it = (each.drives for each in self._kept.values() if each.process and each.process.pid == departure[0])
        return next(in_it, OrderedDict())

    def _make_room(self) -> None:
        while len(self._kept) > 1 and sum(each.memory_bytes for each in self._kept.values()) > self._most_bytes:
            self._kept.popitem(last=False)


def started(setup: Setup, progress: WarmUpProgress | None, timeout_s: float) -> tuple[RemoteProcess, RoadNetwork]:
    """What ``RemoteProcess.start`` does, by a copy from the keeper if there is one; raises like it."""
    if setup.outputs is None and setup.flow_s is None and setup.scenario.config.is_absolute():
        with suppress(ClosedError, OSError, SetupError, TrafficError):  # there is none of one's own, or it fails
            return _copied(setup, progress, timeout_s)
    return RemoteProcess.start(setup, progress, timeout_s)


def departing(
    warm: RemoteProcess, setup: Setup, plan: EgoPlan, copied: Callable[[], RemoteProcess]
) -> RemoteProcess:
    """A copy of warm traffic in which a drive departs; where that is kept, one that has driven to its hand-over."""
    if not warm.kept_as:
        return copied()
    departure = warm.kept_as, setup, plan
    with suppress(ClosedError, OSError, SetupError, TrafficError), _connected() as connection:
        channel = MessageChannel(connection)
        channel.send(("drive", departure))
        if found := channel.receive():
            answers, pid = found
            process = RemoteProcess.taken(channel, pid, TIMEOUT_S)
            process.call("find", sys.path)
            return DrivenProcess(process, departure, copied, pickle.loads(answers))
    return DrivenProcess(copied(), departure, copied)


def handed_over(drive: RemoteProcess) -> None:
    """Has a drive kept where it is now, if its traffic is, for later commands in which one departs alike."""
    if isinstance(drive, DrivenProcess) and (answers := drive.answers()):
        with suppress(ClosedError, OSError, SetupError), _connected() as connection:
            channel, copy = MessageChannel(connection), drive.fork(None)
            channel.send(("driven", drive.departure))
            channel.send((pickle.dumps(answers, pickle.HIGHEST_PROTOCOL), copy.pid))
            copy.hand_over(channel)


def read_once(kind: str, files: Iterable[Path], read: Callable[[], T]) -> T:
    """What is read from some files and nothing else: the keeper, if there is one, says what it was the last time.

    Args:
        kind: of what is read, by a name of its own.
        files: all that is read.
        read: reads them; small, and the same for the same content.
    """
    with suppress(ClosedError, OSError, SetupError), _connected() as connection:
        channel = MessageChannel(connection)
        seen = _digests(files)
        channel.send(("read", (kind, seen)))
        found: T | None = channel.receive()
        if found is None:
            found = read()
            if _digests(files) == seen:  # or somebody has changed them meanwhile
                channel.send(found)
                with suppress(ClosedError):  # once it has that
                    channel.receive()
        return found
    return read()


def keep(minutes: float) -> list[str]:
    """Has what is used from now on kept until it was not used for some minutes; 0 ends everything.

    Returns:
        What is kept so far, a line each.

    Raises:
        SetupError: the folder of its socket is open to others, or it does not start.
    """
    began_s = time.monotonic()
    while True:
        with suppress(OSError, ClosedError), _connected() as connection:
            channel = MessageChannel(connection)
            channel.send(("keep", minutes))
            kept: list[str] = channel.receive()
            return kept
        if not minutes:
            return []
        if time.monotonic() > began_s + STARTS_S:
            raise SetupError("the process that keeps warm traffic does not start; commands run without it")
        _start(minutes)


def _copied(setup: Setup, progress: WarmUpProgress | None, timeout_s: float) -> tuple[RemoteProcess, RoadNetwork]:
    with _connected() as connection:
        channel = MessageChannel(connection)
        channel.send(("copy", setup))
        outcome, value = channel.receive()
        while outcome == "progress":
            if progress is not None:
                progress(*value)
            outcome, value = channel.receive()
        if outcome == "error":
            kind, text = value
            raise kind.__new__(kind, text)  # the text is whole already
        theirs, pickled, pid, kept_as = value
        process = RemoteProcess.taken(channel, pid, timeout_s)
        process.kept_as = kept_as
    process.call("find", sys.path)
    if theirs != setup:
        return process, process.call("move", setup.scenario)
    with without_collection():
        return process, pickle.loads(pickled)


def _wanted(setup: Setup) -> _Wanted:
    configuration = read_configuration(setup.scenario.config)
    files = {configuration.path, configuration.net, *chain.from_iterable(configuration.files.values())}
    return setup.traffic, _digests(files)


def _digests(files: Iterable[Path]) -> _Files:
    return tuple((str(path), file_sha256(path)) for path in sorted(files))


def _home() -> Path:
    given = Path(os.environ.get("XDG_RUNTIME_DIR", ""))
    home = given if given.is_absolute() and given.is_dir() else Path(tempfile.gettempdir())
    return home / f"automotive_cosim-{os.getuid()}"


def _address(program: str) -> Path:
    """The socket of a program, in a folder that is one's own and closed to others.

    Raises:
        FileNotFoundError: there is no such folder.
        SetupError: somebody else made it, or can enter it.
    """
    home = _home()
    about = home.lstat()
    if not stat.S_ISDIR(about.st_mode) or about.st_uid != os.getuid() or about.st_mode & 0o077:
        raise SetupError(f"{home} is not a folder of your own that is closed to others; remove it, or chmod 700")
    return home / program


@cache
def _program() -> str:
    """A digest of code and versions: processes exchange objects only if it is the same."""
    package = Path(__file__).parents[1]
    seen: list[Any] = [sys.version, sys.prefix, os.environ.get("PYTHONPATH"), str(package)]
    seen += [importlib.metadata.version("libsumo")]
    for each in sorted(package.rglob("*.py")):
        seen += str(each), (about := each.stat()).st_size, about.st_mtime_ns
    return hashlib.sha256(repr(seen).encode()).hexdigest()[:16]


def _is_own(connection: socket.socket) -> bool:
    """Whether the other side runs as this user."""
    peer = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _PEER.size)
    return bool(_PEER.unpack(peer)[1] == os.getuid())


def _connected() -> socket.socket:
    """A connection to the keeper.

    Raises:
        OSError: there is none.
        SetupError: see ``_address``.
    """
    address = _address(_program())
    connection = socket.socket(socket.AF_UNIX)
    try:
        _at(address, connection.connect)
        if not _is_own(connection):
            raise SetupError(f"{address} is not answered by you; remove it")
    except BaseException:
        connection.close()
        raise
    return connection


def _at(address: Path, use: Callable[[str], None]) -> None:
    """Connects or binds a socket, whose own path may be too long for one (107 bytes): by its folder, opened."""
    home = os.open(address.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        use(f"/proc/self/fd/{home}/{address.name}")
    finally:
        os.close(home)


_CHILDREN: list[subprocess.Popen[bytes]] = []
"""Those that were started, which outlive this process and are not waited for."""


def _start(minutes: float) -> None:
    """Starts a keeper, and waits until it listens or has ended, as a second one does.

    Raises:
        SetupError: it does not start.
    """
    with tempfile.TemporaryFile() as ready:
        popen = subprocess.Popen(
            [sys.executable, "-P", "-m", "automotive_cosim.traffic.keeper", _program(), str(minutes)],
            env=environment({name: os.environ[name] for name in PASSED_ON if name in os.environ}),
            cwd="/",
            stdin=subprocess.DEVNULL,
            stdout=ready,
            stderr=ready,
            start_new_session=True,
        )
        _CHILDREN.append(popen)
        while popen.poll() is None and not os.fstat(ready.fileno()).st_size:
            time.sleep(0.02)
        if popen.poll():
            ready.seek(0)
            why = ready.read().decode("utf-8", "replace").strip().splitlines() or [f"exit code {popen.poll()}"]
            raise SetupError(f"no traffic can be kept in {_home()}: {why[-1]}; commands run without it")


def main() -> None:
    """Keeps for a program, the first argument, and for the minutes that are the second."""
    os.umask(0o077)
    try:
        make_folder(_home())
        address = _address(sys.argv[1])
        with suppress(UserError), locked(address.with_suffix(".lock"), "warm traffic"):
            remove(address)
            with socket.socket(socket.AF_UNIX) as listening:
                _at(address, listening.bind)
                listening.listen()
                print("listening", flush=True)
                _Keeper(float(sys.argv[2])).serve(listening)
            remove(address)
    except OSError as error:
        sys.exit(error.strerror or str(error))


if __name__ == "__main__":
    main()
