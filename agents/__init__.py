"""Agents: the contestants (T3A, M3A, ASURADA), the references (oracle, human) and the negative controls."""

from __future__ import annotations

if __name__ != "automotive_cosim.agents":
    raise ImportError(f"import this package as automotive_cosim.agents, not as {__name__}")

from automotive_cosim.lazy import lazily

__getattr__, __dir__ = lazily(__name__, __file__)
