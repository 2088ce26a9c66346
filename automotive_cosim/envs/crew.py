"""Who drives the cars of a fleet: this process, and a copy of it that has half of them, so both use a core.

road:   one process of SUMO's, which both ask in turns, and which this one lets run
step:   this one's cars begin, then the copy's: requests reach the road in the order of the cars
tick:   the road runs; what passed goes to the copy; both let their cars sense, judge and observe at once
"""

from __future__ import annotations

import gc
import os
import pickle
import signal
import socket
import traceback
import weakref
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from functools import partial
from math import inf
from typing import Any, NoReturn

from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.envs.base import Stepped
from automotive_cosim.envs.drive import DrivesEnv
from automotive_cosim.episode.fleet import Fleet
from automotive_cosim.errors import CosimError, TrafficError
from automotive_cosim.traffic.channel import ClosedError, MessageChannel
from automotive_cosim.traffic.fork import RemoteRoad, RemoteTraffic
from automotive_cosim.traffic.wire import Packed, pack_state


class Crews:
    """The cars of a fleet, and what each is doing: those that a copy of this process has, and the others."""

    def __init__(self, envs: Mapping[str, DrivesEnv[Any, Any]], away: Collection[str], road: RemoteRoad) -> None:
        """Begins with nobody doing anything.

        Args:
            envs: those of all cars by name.
            away: who is in the copy; none makes none.
            road: the traffic of all.
        """
        self._near, self._away, self._road = _Crew(envs, road), away, road
        self._far = _CrewElsewhere(self._near) if away else None
        self.busy: set[str] = set()
        """The cars that are doing something."""

    def enter(
        self, car: str, spec: DriveSpec, script: DriveScript, traffic: RemoteTraffic
    ) -> tuple[Any, dict[str, Any]]:
        """A car has entered the traffic; what its agent sees first, and its info."""
        if self._far is not None and car in self._away:
            return self._far.enter(car, spec, script, traffic)
        return self._near.enter(car, spec, script, traffic)

    def run(self, actions: Mapping[str, Any]) -> dict[str, Stepped[Any]]:
        """Lets cars act, and the road run until one has done what it was doing; the results of those that have.

        Raises:
            TrafficError: the traffic simulation failed, or the copy has ended.
        """
        near, far = self._near, self._far
        self.busy |= actions.keys()
        near.act({car: action for car, action in actions.items() if car not in self._away})
        if far is None:
            done = near.run()
        else:
            far.act({car: action for car, action in actions.items() if car in self._away})
            while not (done := near.done() | far.done()) and (until_s := min(near.wakes_s, far.wakes_s)) < inf:
                self._road.reach(until_s)
                far.start(until_s)
                near.go(until_s)
                far.finish()
        self.busy -= done.keys()
        return done

    def close(self) -> None:
        """Ends the copy; may be called again."""
        if self._far is not None:
            self._far.close()


class _Crew(Fleet[Stepped[Any]]):
    """The cars of one process."""

    def __init__(self, envs: Mapping[str, DrivesEnv[Any, Any]], road: RemoteRoad) -> None:
        super().__init__(road.step_s)
        self._envs, self.road = envs, road

    def enter(
        self, car: str, spec: DriveSpec, script: DriveScript, traffic: RemoteTraffic
    ) -> tuple[Any, dict[str, Any]]:
        return self._envs[car].depart(spec, script, traffic)

    def act(self, actions: Mapping[str, Any]) -> None:
        """Lets cars act; what they do at this instant is done at once."""
        for car, action in actions.items():
            self.begin(car, self._envs[car].stepping(action), partial(self._now_s, car))

    def _now_s(self, car: str) -> float:
        return self._envs[car].episode.world.moment.time_s


class _CrewElsewhere:
    """Those of a copy of this process, which ends with this object."""

    def __init__(self, crew: _Crew) -> None:
        ours, theirs = socket.socketpair()
        self._road, self._told = crew.road, len(crew.road.asked)
        self._road.take_turns()
        pid = os.fork()
        if not pid:
            ours.close()
            _serve(crew, MessageChannel(theirs))
        theirs.close()
        self._channel = MessageChannel(ours)
        self.close = weakref.finalize(self, _end, self._channel, pid, os.getpid())
        """Ends the copy; may be called again."""
        self.wakes_s = crew.wakes_s
        self._done: dict[str, Stepped[Any]] = {}

    def enter(
        self, car: str, spec: DriveSpec, script: DriveScript, traffic: RemoteTraffic
    ) -> tuple[Any, dict[str, Any]]:
        self._road.away.add(traffic.car)
        self._send("enter", car, spec, script, traffic.car, pack_state(traffic.state))
        entered: tuple[Any, dict[str, Any]] = self.finish()
        return entered

    def act(self, actions: Mapping[str, Any]) -> None:
        """See ``_Crew.act``."""
        self._send("act", actions)
        self.finish()

    def start(self, until_s: float) -> None:
        """Starts what ``Fleet.go`` does; call ``finish`` next."""
        passed, self._road.passed_away = self._road.passed_away, []
        self._send("go", until_s, passed)

    def finish(self) -> Any:
        """Waits for the copy."""
        try:
            answer, self.wakes_s, done, asked = self._channel.receive()
        except ClosedError:
            raise TrafficError("the process with half of the fleet's cockpits ended; reset the fleet") from None
        if isinstance(answer, Exception):
            raise answer
        self._road.asked += asked
        self._told += len(asked)
        self._done |= done
        return answer

    def done(self) -> dict[str, Stepped[Any]]:
        """See ``Fleet.done``."""
        done, self._done = self._done, {}
        return done

    def _send(self, name: str, *arguments: object) -> None:
        new, self._told = self._road.asked[self._told :], len(self._road.asked)
        with suppress(ClosedError):  # which ``finish`` finds, too
            self._channel.send((name, arguments, new, self._road.time_s))


def _serve(crew: _Crew, channel: MessageChannel) -> NoReturn:
    """What the copy does until the other end of its channel is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.freeze()  # collecting garbage would copy every page that both share
    road = crew.road
    road.away = {"the first's", "and others"}  # there are others as long as it lives

    def enter(
        car: str, spec: DriveSpec, script: DriveScript, name: str, state: Packed
    ) -> tuple[Any, dict[str, Any]]:
        return crew.enter(car, spec, script, road.take(name, state))

    def go(until_s: float, passed: Sequence[bytes]) -> None:
        for each in passed:
            road.tell(pickle.loads(each))
        crew.go(until_s)

    calls: Mapping[str, Callable[..., Any]] = {"enter": enter, "act": crew.act, "go": go}
    try:
        while True:
            name, arguments, asked, road.time_s = channel.receive()
            road.asked += asked
            told = len(road.asked)
            try:
                answer = calls[name](*arguments)
            except Exception as error:  # whatever the error is, the other side has to learn about it
                traceback.print_exc()
                known = isinstance(error, CosimError)
                answer = error if known else TrafficError(f"{type(error).__name__}: {error}")
            channel.send((answer, crew.wakes_s, crew.done(), road.asked[told:]))
    finally:
        os._exit(0)  # without ending what belongs to the process that it is a copy of


def _end(channel: MessageChannel, pid: int, owner: int) -> None:
    channel.close()
    if os.getpid() == owner:  # no copy of that process has a child to wait for
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
