"""What the agents with a model share: questions within a budget, and the record of the stages."""

from __future__ import annotations

from collections.abc import Sequence

from automotive_cosim.agents.base import Stage, StageName
from automotive_cosim.agents.settings import AgentSettings
from automotive_cosim.contracts import Json, Observation
from automotive_cosim.errors import OutOfBudgetError
from automotive_cosim.models.base import ChatMessage, ChatModel, ModelReply, digest


class Asking:
    """Asks a model and notes what came of it, for one episode at a time."""

    def __init__(self, chat_model: ChatModel, settings: AgentSettings) -> None:
        self.chat_model = chat_model
        self._settings = settings
        self.stages: list[Stage] = []
        """The stages of the present turn."""
        self.reset()

    def reset(self) -> None:
        self.stages.clear()
        self._tokens = 0
        self._seconds = 0.0

    def ask(self, text: str, pictures: Sequence[bytes], form: Json | None = None) -> tuple[ModelReply, str]:
        """The answer, and the question's digest.

        Args:
            form: JSON Schema of the answer, for a model that is held to it.

        Raises:
            OutOfBudgetError: the episode's tokens or seconds are spent.
            ModelError: the model does not answer."""
        return self.converse([ChatMessage("user", text, tuple(pictures), form=form)])

    def converse(self, messages: Sequence[ChatMessage]) -> tuple[ModelReply, str]:
        """The answer to the last of several messages, and the digest of them all; raises like ``ask``."""
        settings = self._settings
        if self._tokens >= settings.most_tokens or self._seconds >= settings.most_seconds:
            raise OutOfBudgetError(
                f"the episode's budget is spent: {self._tokens} of {settings.most_tokens} tokens, "
                f"{self._seconds:.0f} of {settings.most_seconds:g} s"
            )
        reply = self.chat_model.chat(messages)
        self._tokens += reply.tokens_in + reply.tokens_out
        self._seconds += reply.seconds
        return reply, digest(messages)

    def note(
        self,
        name: StageName,
        seen: Observation,
        text: str,
        reply: ModelReply | None = None,
        asked: str = "",
        pictures: int = 0,
    ) -> None:
        """Adds a stage to the record."""
        self.stages.append(Stage(name, text, seen.time_s, reply, asked, pictures))
