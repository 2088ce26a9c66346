"""``replay``: the answers of a recorded episode, for an exact re-run without the model."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import ModelError, UserError
from automotive_cosim.formats.files import parse_json
from automotive_cosim.models.base import ChatMessage, ModelReply, digest


class Replay:
    """Gives the recorded answers in order, each to the question that it answered."""

    name = "replay"

    def __init__(self, answers: Sequence[tuple[str, ModelReply]], sees_pictures: bool) -> None:
        """Takes the answers to play.

        Args:
            answers: the digest of each question with its answer.
            sees_pictures: whether the questions had pictures.
        """
        self._left = deque(answers)
        self._count = len(answers)
        self.sees_pictures = sees_pictures

    @classmethod
    def read(cls, folder: Path) -> Replay:
        """The answers recorded in an episode's folder.

        Raises:
            UserError: there is no readable record, or it has no answers of a model.
        """
        path = folder / "steps.jsonl"
        try:
            stages = list(_stages(path))
            answers = [(stage["asked"], ModelReply(**stage["reply"])) for stage in stages if stage["reply"]]
            sees_pictures = any(stage["pictures"] for stage in stages)
        except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
            raise UserError(
                f"cannot read a model's answers in {path}: {error}; give an episode's folder"
            ) from error
        if not answers:
            raise UserError(f"{path} has no answers of a model; record an episode of an agent that uses a model")
        return cls(answers, sees_pictures)

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """The next recorded answer.

        Raises:
            ModelError: there is none left, or it answered another question.
        """
        number = self._count - len(self._left) + 1
        if not self._left:
            raise ModelError(f"the recording has {self._count} answers, but question {number} was asked")
        asked, reply = self._left.popleft()
        if asked != digest(messages):
            raise ModelError(
                f"question {number} differs from the recorded one; replay with the same task, half, scenario, "
                f"seed, agent, switches and versions"
            )
        return reply


def _stages(path: Path) -> Iterator[Json]:
    with path.open(encoding="utf-8") as lines:
        for line in lines:
            yield from parse_json(line)["stages"]
