"""What all workers of an evaluation share: turns at each model, and one budget in tokens and dollars.

There is one meter: on a single machine in the batch's own process, which the workers ask over a socket; on a
cluster in an actor. A worker's model asks it before and after each question.
"""

from __future__ import annotations

import secrets
import socket
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import AuthenticationError, connection
from multiprocessing.connection import Connection, Listener
from typing import Any, Protocol

from automotive_cosim.errors import BudgetSpentError, InfrastructureError
from automotive_cosim.models import ChatMessage, ChatModel, ModelReply
from automotive_cosim.models.turns import LocalTurns
from automotive_cosim.run.settings import Budget

KEY_BYTES = 32
CLOSE_S = 5.0
"""Longest wall time to end the service of a meter."""


@dataclass(frozen=True, slots=True)
class Spent:
    """What an evaluation has spent on its models."""

    tokens: int = 0
    usd: float = 0.0

    def share_of(self, budget: Budget) -> float:
        """The share of a budget that is spent, 0 to 1; of both limits, the greater one."""
        shares = (
            self.tokens / budget.tokens if budget.tokens else 0.0,
            self.usd / budget.usd if budget.usd else 0.0,
        )
        return min(1.0, max(shares))

    def left_of(self, budget: Budget) -> str:
        """What is left of a budget, as ``38,000 of 50,000 tokens left``; empty without a limit."""
        told = []
        if budget.tokens is not None:
            told.append(f"{max(0, budget.tokens - self.tokens):,} of {budget.tokens:,} tokens")
        if budget.usd is not None:
            told.append(f"${max(0.0, budget.usd - self.usd):,.2f} of ${budget.usd:,.2f}")
        return f"{' and '.join(told)} left" if told else ""


class MeterHandle(Protocol):
    """The meter, wherever it is; it can be sent to a worker."""

    def wait_s(self, model: str, per_minute: float) -> float: ...

    def spend(self, tokens: int, usd: float) -> None:
        """Notes what an answer has cost."""
        ...

    def spent(self) -> Spent:
        """What has been spent in total."""
        ...

    def refusal(self) -> str:
        """Why no more questions may be asked; empty while they may."""
        ...


class Meter(LocalTurns):
    """The meter itself; any thread may use it."""

    def __init__(self, budget: Budget, before: Spent) -> None:
        """Starts from what has already been spent.

        Args:
            budget: what may be spent in total.
            before: by earlier starts of the same evaluation."""
        super().__init__()
        self._budget = budget
        self._tokens, self._usd = before.tokens, before.usd

    def spend(self, tokens: int, usd: float) -> None:
        with self._lock:
            self._tokens += tokens
            self._usd += usd

    def spent(self) -> Spent:
        with self._lock:
            return Spent(self._tokens, self._usd)

    def refusal(self) -> str:
        budget, spent = self._budget, self.spent()
        if budget.tokens is not None and spent.tokens >= budget.tokens:
            return f"the evaluation's budget is spent: {spent.tokens:,} of {budget.tokens:,} tokens"
        if budget.usd is not None and spent.usd >= budget.usd:
            return f"the evaluation's budget is spent: {spent.usd:.2f} of {budget.usd:.2f} dollars"
        return ""


class Metered:
    """A model that asks the meter before each question, and tells it what the answer has cost."""

    def __init__(self, model: ChatModel, meter: MeterHandle) -> None:
        """Takes the model, which takes its turns from the same meter."""
        self._model, self._meter = model, meter

    @property
    def name(self) -> str:
        return self._model.name

    @property
    def sees_pictures(self) -> bool:
        """Whether the model sees pictures."""
        return self._model.sees_pictures

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """The model's answer.

        Raises:
            BudgetSpentError: nothing is left; the episode is rerun with a larger budget.
            ModelError: as the model."""
        if refusal := self._meter.refusal():
            raise BudgetSpentError(refusal)
        reply = self._model.chat(messages)
        self._meter.spend(reply.tokens_in + reply.tokens_out, reply.cost_usd)
        return reply


# --- on one machine ---------------------------------------------------------------------------------------------


@contextmanager
def served(meter: Meter) -> Iterator[MeterHandle]:
    """Serves a meter to the processes of this machine."""
    key, is_over = secrets.token_bytes(KEY_BYTES), threading.Event()
    with Listener(authkey=key) as listener:
        accepts = threading.Thread(target=_accept, args=(listener, meter, is_over), name="meter", daemon=True)
        accepts.start()
        try:
            yield MeterClient(listener.address, key)
        finally:
            is_over.set()
            _knock(listener.address)
            accepts.join(CLOSE_S)


def _knock(address: Any) -> None:
    """Wakes the thread that waits for a client; if that fails, the thread ends with the process."""
    if hasattr(socket, "AF_UNIX"):
        with suppress(OSError), socket.socket(socket.AF_UNIX) as visitor:
            visitor.settimeout(CLOSE_S)
            visitor.connect(address)


def _accept(listener: Listener, meter: Meter, is_over: threading.Event) -> None:
    while not is_over.is_set():
        with suppress(AuthenticationError, EOFError, OSError):
            client = listener.accept()
            threading.Thread(target=_answer, args=(client, meter), daemon=True).start()


def _answer(client: Connection, meter: Meter) -> None:
    with client, suppress(EOFError, OSError):
        while True:
            name, given = client.recv()
            client.send(getattr(meter, name)(*given))


class MeterClient:
    """A worker's connection to the meter of its batch, made when it is first used."""

    def __init__(self, address: Any, key: bytes) -> None:
        """Takes the address of the meter, and its key."""
        self._address, self._key = address, key
        self._made: Connection | None = None
        self._lock = threading.Lock()

    def __reduce__(self) -> tuple[type[MeterClient], tuple[Any, bytes]]:
        return MeterClient, (self._address, self._key)

    def wait_s(self, model: str, per_minute: float) -> float:
        return float(self._asked("wait_s", model, per_minute))

    def spend(self, tokens: int, usd: float) -> None:
        self._asked("spend", tokens, usd)

    def spent(self) -> Spent:
        found: Spent = self._asked("spent")
        return found

    def refusal(self) -> str:
        return str(self._asked("refusal"))

    def _asked(self, name: str, *given: Any) -> Any:
        with self._lock:
            try:
                if self._made is None:
                    self._made = connection.Client(self._address, authkey=self._key)
                self._made.send((name, given))
                return self._made.recv()
            except (EOFError, OSError) as error:
                raise InfrastructureError(
                    "the process that meters the budget has ended; rerun the command to resume"
                ) from error
