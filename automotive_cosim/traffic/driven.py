"""A drive's process of which it may be known what it answers on its way, because one that departed alike has been
asked the same."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from automotive_cosim.traffic.base import EgoPlan, WarmUpProgress
from automotive_cosim.traffic.options import Setup
from automotive_cosim.traffic.remote import RemoteProcess

MOST_ANSWERS = 2_000
"""Of a way that is remembered: one of 15 minutes, with everything around it seen each second."""

Departure: TypeAlias = tuple[int, Setup, EgoPlan]
"""``RemoteProcess.kept_as`` of the warm traffic, and what determines a drive in it."""
Answered: TypeAlias = Sequence[tuple[tuple[str, tuple[object, ...]], Any]]
"""Calls from departure on, with their answers."""


class DrivenProcess(RemoteProcess):
    """Answered what was asked on the same way before; whatever else is asked, a process that is as far does.

    What a simulation answers follows from what it was asked since it was copied, so the answers are those that it
    would give.
    """

    def __init__(
        self,
        process: RemoteProcess,
        departure: Departure,
        copied: Callable[[], RemoteProcess],
        known: Answered = (),
    ) -> None:
        """Takes over a process.

        Args:
            process: a copy of the warm traffic, or one that has driven what is known.
            departure: what determines the drive.
            copied: makes a copy of the warm traffic.
            known: the answers.
        """
        self._take(process)
        self.departure = departure
        self._copied = copied
        self._known = [*known]
        self._at = 0
        self._is_new = not known
        """Whether its answers may be remembered."""
        self._asked: tuple[str, tuple[object, ...]] = "", ()

    def send(self, name: str, *arguments: object, **more: Any) -> None:
        self._asked = name, arguments
        if self._at < len(self._known):
            if self._known[self._at][0] == self._asked:
                return
            self.turn_off()
        self._is_new = self._is_new and name not in ("call", "run") and self._at < MOST_ANSWERS
        super().send(name, *arguments, **more)

    def receive(self, progress: WarmUpProgress | None = None, timeout_s: float | None = None) -> Any:
        if self._at == len(self._known):
            is_new, self._is_new = self._is_new, False  # as after an error
            answer = super().receive(progress, timeout_s)
            self._is_new = is_new
            if not is_new or self._asked[0] == "fork":
                return answer
            self._known.append((self._asked, answer))
        self._at += 1
        return self._known[self._at - 1][1]

    def answers(self) -> Answered:
        """All so far; empty if they are known to somebody, or more than can be."""
        return self._known if self._is_new else ()

    def turn_off(self) -> None:
        """Goes its own way from here on, in a process that is as far as it is."""
        if self._at == len(self._known):
            return
        self._end()
        self._take(self._copied())
        for (name, arguments), _ in self._known[: self._at]:
            super().send(name, *arguments)
            super().receive()
        del self._known[self._at :]

    def _take(self, process: RemoteProcess) -> None:
        super().__init__(*process.given_up())
