"""``replay``: the answers of a recorded episode, for an exact re-run without the model.

A record is an episode's folder, or a conversation that ships with the package (``replay/``).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.errors import ModelError, UnknownNameError, UserError
from automotive_cosim.formats.files import opened, parse_json
from automotive_cosim.formats.layout import steps_in
from automotive_cosim.models.apis import Chat, ProviderApi
from automotive_cosim.models.base import ChatMessage, ModelReply, digest

SUFFIX = ".json"
SAME = "the same task, half, scenario, seed, agent, switches and versions"


class Replay:
    """Gives the recorded answers in order, each to the question that it answered."""

    name = "replay"

    def __init__(
        self,
        answers: Sequence[tuple[str, ModelReply]],
        sees_pictures: bool,
        digest_of: Callable[[Sequence[ChatMessage]], str] = digest,
        again: str = SAME,
    ) -> None:
        """Takes the answers to play.

        Args:
            answers: the digest of each question with its answer.
            digest_of: makes the digest of a question.
        """
        self._left = deque(answers)
        self._count = len(answers)
        self._digest_of = digest_of
        self._again = again
        self.sees_pictures = sees_pictures

    @classmethod
    def named(cls, name: str, api: ProviderApi | None = None) -> Replay:
        """The answers of an episode's folder or, if there is no such folder, of a shipped conversation.

        Args:
            name: the folder or the conversation.
            api: the protocol of the model's endpoint, if it has one; by default chat completions.

        Raises UserError: there is no such record, it cannot be read, or it has no answers of a model."""
        path = Path(name)
        if path.exists() or len(path.parts) > 1:
            return cls.read(path)
        if name not in shipped():
            raise UnknownNameError("folder or recording", name, shipped())
        return cls.shipped(name, api)

    @classmethod
    def read(cls, folder: Path) -> Replay:
        """The answers recorded in an episode's folder.

        Raises UserError: there is no readable record, or it has no answers of a model."""
        path = steps_in(folder)
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

    @classmethod
    def shipped(cls, name: str, api: ProviderApi | None = None) -> Replay:
        """The answers of a shipped conversation.

        Pictures may differ by a pixel from one machine to another, so only the text of a question is compared.
        """
        told = conversation(name)
        answers = [(answer["asked"], (api or Chat()).read(answer["body"])) for answer in told["answers"]]
        given = " ".join(f"--{option} {value}" for option, value in told["episode"].items())
        return cls(answers, told["sees_pictures"], text_digest, f"{given} --agent {told['agent']}")

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """The next recorded answer. Raises ModelError: there is none left, or it answered another question."""
        number = self._count - len(self._left) + 1
        if not self._left:
            raise ModelError(f"the recording has {self._count} answers, but question {number} was asked")
        asked, reply = self._left.popleft()
        if asked != self._digest_of(messages):
            raise ModelError(f"question {number} differs from the recorded one; replay with {self._again}")
        return reply


def shipped() -> tuple[str, ...]:
    """Names of the shipped conversations."""
    found = (entry.name for entry in files("automotive_cosim.replay").iterdir())
    return tuple(sorted(name.removesuffix(SUFFIX) for name in found if name.endswith(SUFFIX)))


def conversation(name: str) -> Json:
    """A shipped conversation as it is stored."""
    text = (files("automotive_cosim.replay") / f"{name}{SUFFIX}").read_text(encoding="utf-8")
    told: Json = parse_json(text)
    return told


def text_digest(messages: Sequence[ChatMessage]) -> str:
    """SHA-256 of a conversation without its pictures, as a hexadecimal string."""
    return digest([replace(message, pictures=()) for message in messages])


def _stages(path: Path) -> Iterator[Json]:
    with opened(path) as lines:
        for line in lines:
            yield from parse_json(line)["stages"]
