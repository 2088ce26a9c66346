"""Messages between the harness and an agent's process, over a pair of sockets.

The harness sends pickled objects. What comes back is JSON and nothing else: to unpickle what a foreign program
wrote is to run that program. Half surrogate pairs in it, which no file can hold, are replaced here.
"""

from __future__ import annotations

import json
import pickle
import re
import socket
import struct
import time
from math import inf
from typing import Any, NoReturn

from automotive_cosim.contracts import Json

LONGEST_BYTES = 16 * 1024**2
"""Longest JSON; a question with two screenshots has about a megabyte."""
MOST_VALUES = 1_000_000
"""More values than that are refused before they are made; a question lists some thousand elements."""
_SURROGATE = re.compile(rb"\\u[dD][89a-fA-F]")
_LENGTH = struct.Struct("!Q")


def packed(message: object) -> bytes:
    """An object of the harness as ``Wire.send`` takes it."""
    return pickle.dumps(message, pickle.HIGHEST_PROTOCOL)


class GoneError(Exception):
    """The other side has closed its end, or died."""


class Wire:
    """One end of a connection."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection

    def send_object(self, message: object, within_s: float | None = None) -> None:
        """Sends an object, from the harness.

        Raises:
            GoneError: the other side is gone.
            TimeoutError: it did not take the whole message in time."""
        self.send(packed(message), within_s)

    def send(self, message: bytes, within_s: float | None = None) -> None:
        """Sends a message that has been packed before, so that only sending takes time.

        Raises:
            GoneError: the other side is gone.
            TimeoutError: it did not take the whole message in time."""
        self._socket.settimeout(within_s)
        try:
            self._socket.sendall(_LENGTH.pack(len(message)) + message)
        except TimeoutError:
            raise
        except OSError as error:
            raise GoneError from error

    def send_json(self, message: Json) -> None:
        """Sends a JSON object, to the harness. Raises GoneError: the other side is gone."""
        self.send(json.dumps(message).encode())

    def receive_object(self) -> Any:
        """Waits for an object of the harness. Raises GoneError: the other side is gone."""
        return pickle.loads(self._receive(None))

    def receive_json(self, within_s: float) -> Json:
        """Waits for a JSON object of an agent's process.

        Raises:
            GoneError: the other side is gone.
            TimeoutError: the message was not complete in time.
            ValueError: it is too long, nested too deeply, or not a JSON object."""
        return _json(bytes(self._receive(time.monotonic() + within_s, LONGEST_BYTES)))

    def send_socket(self, connection: socket.socket) -> None:
        """Sends a socket. Raises GoneError: the other side is gone."""
        try:
            socket.send_fds(self._socket, [b"s"], [connection.fileno()])
        except OSError as error:
            raise GoneError from error

    def receive_socket(self) -> socket.socket:
        """Receives a socket. Raises GoneError: the other side is gone."""
        _, descriptors, _, _ = socket.recv_fds(self._socket, 1, 1)
        if not descriptors:
            raise GoneError
        return socket.socket(fileno=descriptors[0])

    def close(self) -> None:
        """Closes this end; may be called again."""
        self._socket.close()

    def _receive(self, end_s: float | None, longest: float = inf) -> bytearray:
        (length,) = _LENGTH.unpack(self._read(_LENGTH.size, end_s))
        if length > longest:
            raise ValueError(f"{length} bytes, and {longest} are allowed")
        return self._read(length, end_s)

    def _read(self, length: int, end_s: float | None) -> bytearray:
        """Reads exactly that many bytes until then; a trickle gets no more time than silence."""
        data = bytearray(length)
        view, got = memoryview(data), 0
        while got < length:
            left_s = None if end_s is None else end_s - time.monotonic()
            if left_s is not None and left_s <= 0:
                raise TimeoutError
            self._socket.settimeout(left_s)
            try:
                count = self._socket.recv_into(view[got:])
            except TimeoutError:
                raise
            except OSError as error:
                raise GoneError from error
            if not count:
                raise GoneError
            got += count
        return data


def _json(data: bytes) -> Json:
    """
    Raises ValueError: it is no JSON object that could be stored and read again."""
    if sum(map(data.count, (b"[", b"{", b","))) > MOST_VALUES:
        raise ValueError(f"it may have over {MOST_VALUES:,} values")
    try:
        message = json.loads(data.decode("utf-8", "replace"), parse_constant=_refused)
        if _SURROGATE.search(data):
            whole = json.dumps(message, ensure_ascii=False).encode("utf-8", "replace")
            message = json.loads(whole, parse_constant=_refused)
    except RecursionError as error:
        raise ValueError("nested too deeply") from error
    if not isinstance(message, dict):
        raise ValueError(f"{type(message).__name__} in the place of a JSON object")
    return message


def _refused(name: str) -> NoReturn:
    raise ValueError(f"{name} is not JSON")
