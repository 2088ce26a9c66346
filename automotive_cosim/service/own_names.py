"""Under which names a server on this machine may be asked. A foreign name that resolves to it would get around the
rule of browsers that a page may read only from where it came (DNS rebinding)."""

from __future__ import annotations

import ipaddress
import socket

ANY = frozenset(("0.0.0.0", "::"))
"""Addresses that listen everywhere."""


def own_names(host: str) -> frozenset[str]:
    """The names of a server that listens on an address."""
    loopback = {"127.0.0.1", "localhost", "::1"}
    if host in loopback:
        return frozenset(loopback)
    return frozenset({host.lower(), socket.gethostname().lower(), *(loopback if host in ANY else ())})


def is_own(asked: str, names: frozenset[str], port: int) -> bool:
    """Whether a request names the server.

    Args:
        asked: the request's ``Host``.
        names: the server's ``own_names``; one that listens everywhere may be asked by any address."""
    name, _, told_port = asked.rpartition(":")
    if not told_port.isdigit() or int(told_port) != port:
        return False
    name = name.strip("[]").lower()
    return name in names or (not names.isdisjoint(ANY) and _is_address(name))


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
