"""The simulation's own process: ``python -m automotive_cosim.traffic.process``, started by ``fork``.

It has one thread and contains only SUMO. It loads and warms up once; every ``fork`` makes an independent child with
a connection of its own, which can be forked again. A process ends when its connection closes, so none outlives the
program that uses it; one that hangs is ended by its alarm.
"""

from __future__ import annotations

import faulthandler
import fcntl
import gc
import os
import pickle
import signal
import socket
import stat
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy.random  # noqa: F401, which numpy loads at its first use: in each copy, where it takes 3 MB

from automotive_cosim.contracts import Answer, RoadNetwork, RoadRequest, RoadShapes, RouteOption
from automotive_cosim.errors import CosimError, TrafficError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.writing import copy
from automotive_cosim.formats.xml import without_collection
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.channel import LOADING_LIMIT_S, ClosedError, MessageChannel
from automotive_cosim.traffic.confinement import confine
from automotive_cosim.traffic.convoy import Convoy
from automotive_cosim.traffic.network import KnownNetwork
from automotive_cosim.traffic.options import OUTPUTS, Setup
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import load_library
from automotive_cosim.traffic.wire import Packed, pack_advance, pack_snapshot, pack_state
from automotive_cosim.traffic.world import World

BEAT_S = 1.0
"""Wall time between two signs of life during a long call."""

UNREAD_BEAT_S = 5.0
"""The same during a call that is begun and read later: in minutes a full socket would hold it up."""

WAITING_FACTOR = 20
"""Wall time that a step may take, in multiples of the processor time that it may use."""

DESCRIPTORS = Path("/proc/self/fd")


class Server:
    """Answers the messages of one connection."""

    def __init__(self, channel: MessageChannel, hang_limit_s: float) -> None:
        """Takes over the connection.

        Args:
            channel: to the program that uses the simulation.
            hang_limit_s: processor time after which an unfinished step ends the process."""
        self._channel = channel
        self._hang_limit_s = hang_limit_s
        self._loaded: Running | None = None
        self._last_beat_s = 0.0
        self._beat_s = BEAT_S

    def run(self) -> None:
        """Serves until the connection closes."""
        try:
            while True:
                name, arguments = self._channel.receive()
                self._set_alarm()
                answer = self._answer(name, arguments)
                self._stop_alarm()
                self._channel.send(answer)  # in a forked child this is its own connection already
        except ClosedError:
            if self._loaded is not None and self._loaded.world.writes:
                self._loaded.world.close()  # which completes the outputs

    @property
    def _running(self) -> Running:
        assert self._loaded is not None
        return self._loaded

    @property
    def _convoy(self) -> Convoy:
        return self._running.convoy

    def _answer(self, name: str, arguments: tuple[Any, ...]) -> tuple[str, Any]:
        try:
            return "done", getattr(self, f"do_{name}")(*arguments)
        except ClosedError:
            raise
        except CosimError as error:
            return "error", (type(error), str(error))
        except Exception as error:  # whatever the error is, the other side has to learn about it
            traceback.print_exc()
            place = traceback.extract_tb(error.__traceback__)[-1]
            text = f"{type(error).__name__}: {error} ({Path(place.filename).name}, line {place.lineno})"
            return "error", (TrafficError, text)

    # --- the calls ----------------------------------------------------------------------------------------

    def do_load(self, setup: Setup, scratch: Path, known: KnownNetwork | None) -> RoadNetwork | None:
        """Loads and warms up; returns the network, which is not read once more if it is known, unless it is the
        known one.

        From here on this process and its copies can write only to the scratch folder, which the other side removes
        when this is done, and beside SUMO's outputs, if the kernel can see to that."""
        self._set_alarm(LOADING_LIMIT_S)
        load_library()  # which writes where Python keeps its compiled modules
        confine([scratch] if setup.outputs is None else [scratch, setup.outputs.parent])
        os.chdir(scratch)  # which is gone afterwards: nothing can be made under a relative name
        with without_collection():
            world = World(setup, scratch, known)
        self._loaded = Running(world, self._beat)
        self._set_alarm()
        world.warm_up(self._progress)
        world.prepare_copies()
        gc.collect()
        gc.freeze()  # collecting garbage would copy every page that the children share
        return None if world.is_known else world.network.map

    def do_move(self, scenario: Scenario) -> RoadNetwork:
        """Moves the warm traffic to where that scenario has it; returns the network there."""
        self._running.world.move(scenario)
        gc.freeze()  # as after loading
        return self._running.world.network.map

    def do_fork(self, outputs: Path | None) -> int:
        """Makes a child that serves the next connection; both answer with their process id."""
        connection = self._channel.receive_socket()
        child = os.fork()
        if not child:
            self._channel.close()
            self._channel = MessageChannel(connection)
            self._set_alarm()
            reopen_files()
            if outputs is not None:
                copy_outputs(outputs)
        else:
            connection.close()
        return child or os.getpid()

    def do_depart(self, plan: EgoPlan) -> Packed:
        """Puts the ego on the road; returns its first state."""
        return pack_state(self._convoy.depart(plan, self._running.after_step).state)

    def do_send(self, car: str, plan: EgoPlan) -> None:
        """Sends another car on its way, which enters in an advance."""
        self._convoy.send(car, plan)

    def do_equip(self, car: str, plan: EgoPlan) -> Packed:
        """Puts a cockpit into a vehicle that drives anyway; returns its state."""
        return pack_state(self._convoy.equip(car, plan).state)

    def do_forget(self, car: str) -> None:
        """Uses a cockpit no longer."""
        self._convoy.forget(car)

    def do_advance(
        self, duration_s: float, cars: tuple[str, ...], away: tuple[str, ...]
    ) -> tuple[dict[str, Packed], bytes, dict[str, Packed], float]:
        """Lets the traffic run; returns what passed for each of those cars and, pickled, of those who are told
        elsewhere, the state of each that entered, and the simulation time."""
        passed, entered = self._convoy.advance(duration_s, (*cars, *away), self._running.after_step)
        packed = {
            car: pack_advance((now.packed for now in instants), events)
            for car, (instants, events) in passed.items()
        }
        told, elsewhere = ({car: packed[car] for car in each} for each in (cars, away))
        first = {car: pack_state(self._convoy.drive(car).state) for car in entered}
        return told, pickle.dumps(elsewhere, pickle.HIGHEST_PROTOCOL), first, self._running.sumo.time()

    def do_request(self, request: RoadRequest, car: str) -> Answer:
        """Makes a request to the driver or the car."""
        return self._convoy.drive(car).request(request)

    def do_alternatives(self, age_s: float, car: str) -> tuple[RouteOption, ...]:
        """Finds alternative routes by news of that age."""
        return self._convoy.drive(car).alternatives(age_s)

    def do_look(self, car: str) -> Packed:
        """Looks at everything around a car."""
        return pack_snapshot(self._convoy.drive(car).look())

    def do_shapes(self, car: str) -> RoadShapes:
        """Reads the lanes and junctions."""
        return self._convoy.drive(car).shapes()

    # --- calls of who extends it ----------------------------------------------------------------------------

    def do_find(self, folders: list[str]) -> None:
        """Looks for the modules of such calls where whoever uses it from now on does."""
        sys.path[:] = folders

    def do_call(self, call: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
        """Calls a function with what runs here."""
        return call(self._running, *arguments, **named)

    def do_run(
        self, call: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]
    ) -> tuple[Packed | None, Any]:
        """The same with one that takes long and drives on; returns the ego's last state, if there is one, too."""
        self._beat_s = UNREAD_BEAT_S
        answer = self.do_call(call, arguments, named)
        drive = self._running.drive
        return None if drive is None else pack_state(drive.state), answer

    # --- signs of life ------------------------------------------------------------------------------------

    def _beat(self) -> None:
        now_s = time.monotonic()
        if now_s - self._last_beat_s >= self._beat_s:
            self._last_beat_s = now_s
            self._set_alarm()
            done = self._running.done
            self._channel.send(("beat", None) if done is None else ("progress", done))

    def _progress(self, done_s: float, total_s: float) -> None:
        self._set_alarm()
        self._channel.send(("progress", (done_s, total_s)))

    def _set_alarm(self, limit_s: float | None = None) -> None:
        """The kernel ends the process after the limit, even if nobody is left to notice that it hangs.

        One that waits for good uses no processor time, so the wall clock ends it, much later."""
        limit_s = limit_s or self._hang_limit_s
        signal.setitimer(signal.ITIMER_PROF, limit_s)
        signal.setitimer(signal.ITIMER_REAL, WAITING_FACTOR * limit_s)

    def _stop_alarm(self) -> None:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)


def reopen_files() -> None:
    """Gives this process its own position in every file it was forked with.

    SUMO reads its demand in pieces; with a shared position, the first reader would take the others' traffic."""
    for entry in list(DESCRIPTORS.iterdir()):
        descriptor = int(entry.name)
        try:
            is_file = stat.S_ISREG(os.fstat(descriptor).st_mode)
        except OSError:  # the listing's own
            continue
        if is_file and fcntl.fcntl(descriptor, fcntl.F_GETFL) & os.O_ACCMODE == os.O_RDONLY:
            own = os.open(f"{DESCRIPTORS}/{descriptor}", os.O_RDONLY)
            os.lseek(own, os.lseek(descriptor, 0, os.SEEK_CUR), os.SEEK_SET)
            os.dup2(own, descriptor, inheritable=False)
            os.close(own)


def copy_outputs(folder: Path) -> None:
    """Gives this process its own copies, in ``folder``, of the files that it was forked with to write to.

    What SUMO has not written yet is also in this process's memory, and goes into the copy."""
    for entry in list(DESCRIPTORS.iterdir()):
        descriptor = int(entry.name)
        try:
            name = entry.readlink()
        except OSError:  # the listing's own
            continue
        if name.name in OUTPUTS and name.parent.parent == folder.parent:
            copy(name, folder / name.name, name.stat().st_size)
            own = os.open(folder / name.name, os.O_WRONLY | os.O_APPEND)
            os.dup2(own, descriptor, inheritable=False)
            os.close(own)


def main() -> None:
    """Serves the connection whose descriptor is the first argument."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    faulthandler.enable()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # no need to wait for children
    Server(MessageChannel(socket.socket(fileno=int(sys.argv[1]))), float(sys.argv[2])).run()
    os._exit(0)  # without tearing down the simulation


if __name__ == "__main__":
    main()
