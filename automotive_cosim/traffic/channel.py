"""Messages between this process and a simulation's process: pickled objects over a pair of sockets."""

from __future__ import annotations

import math
import pickle
import socket
import struct
from collections.abc import Callable
from contextlib import nullcontext, suppress
from typing import Any

from automotive_cosim.formats.xml import without_collection

LOADING_LIMIT_S = 300.0
"""Processor time that the simulation may take to load a network without a sign of life, or wall time where the
system does not tell it. A city of 50,000 edges takes 36 s."""

LARGE_BYTES = 1_000_000
"""A larger message is a network, with hundreds of thousands of objects that stay."""

_LENGTH = struct.Struct("!Q")


class ClosedError(Exception):
    """The other side has closed its end, or died."""


class MessageChannel:
    """One end of a connection. Both ends run this package, started by the same user."""

    def __init__(self, connection: socket.socket) -> None:
        """Takes ownership of the socket."""
        self._socket = connection
        self._timeout_s: float | None = math.nan
        """The socket's, once it is set: to set it again takes a call of the system."""

    def fileno(self) -> int:
        """File descriptor of the socket."""
        return self._socket.fileno()

    def send(self, message: object) -> None:
        """Sends an object.

        Raises:
            ClosedError: the other end is closed.
        """
        self.send_pickled(pickle.dumps(message, pickle.HIGHEST_PROTOCOL))

    def send_pickled(self, data: bytes) -> None:
        """Sends an object that is already pickled."""
        try:
            self._socket.sendall(_LENGTH.pack(len(data)) + data)
        except OSError as error:
            raise ClosedError from error

    def receive(self, timeout_s: float | None = None, waits_on: Callable[[], bool] = lambda: False) -> Any:
        """Waits for an object.

        Args:
            timeout_s: longest silence; None waits forever.
            waits_on: asked after each such silence, whether to wait once more.

        Raises:
            ClosedError: the other side is gone, or this one is closed, as at the end of the program.
            TimeoutError: nothing came in time.
        """
        if timeout_s != self._timeout_s:
            try:
                self._socket.settimeout(timeout_s)
            except OSError as error:
                raise ClosedError from error
            self._timeout_s = timeout_s
        (length,) = _LENGTH.unpack(self._read(_LENGTH.size, waits_on))
        with without_collection() if length > LARGE_BYTES else nullcontext():
            return pickle.loads(self._read(length, waits_on))

    def send_socket(self, connection: socket.socket | MessageChannel) -> None:
        """Sends a socket, or that of a channel, to the process on the other side."""
        try:
            socket.send_fds(self._socket, [b"s"], [connection.fileno()])
        except OSError as error:
            raise ClosedError from error

    def receive_socket(self) -> socket.socket:
        _, descriptors, _, _ = socket.recv_fds(self._socket, 1, 1)
        if not descriptors:
            raise ClosedError
        return socket.socket(fileno=descriptors[0])

    def hang_up(self) -> None:
        """Tells the other side that no more messages come; what it sends can still be received."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_WR)

    def close(self) -> None:
        """Closes this end; may be called again."""
        self._socket.close()

    def _read(self, length: int, waits_on: Callable[[], bool]) -> bytearray:
        data = bytearray(length)
        view, got = memoryview(data), 0
        while got < length:
            try:
                count = self._socket.recv_into(view[got:])
            except TimeoutError:
                if not waits_on():
                    raise
                continue
            except OSError as error:
                raise ClosedError from error
            if not count:
                raise ClosedError
            got += count
        return data
