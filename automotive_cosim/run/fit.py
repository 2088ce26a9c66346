"""Whether a model takes the questions of a run, found out by one question before it."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator

from PIL import Image

from automotive_cosim.agents import AgentSettings, model_of
from automotive_cosim.errors import ModelError
from automotive_cosim.models.base import CHARACTERS_PER_TOKEN, ChatMessage, ChatModel
from automotive_cosim.models.local import Local
from automotive_cosim.run.forecast import asks, longest_question, pictures_of
from automotive_cosim.run.jobs import TrialJob

FILLER = "The car drives on along the avenue, and nothing has changed since. "
ASKED = "Answer with the word OK."


def misfits(jobs: Iterable[TrialJob]) -> Iterator[str]:
    """What each model of some trials does not take of their questions; nothing for those that take them.

    Raises:
        ModelError: a model does not answer at all.
    """
    tried = set()
    for job in jobs:
        setup = job.setup
        if not asks(job.model):
            continue
        longest, size = longest_question(job), setup.conditions.screen if pictures_of(job) else None
        key = setup.agent, job.model, longest, size
        if key in tried:
            continue
        tried.add(key)
        model = model_of(setup.agent, job.model, settings=AgentSettings(setup.conditions))
        if model is not None and (
            found := misfit(model, longest, None if size is None else _blank(size.width, size.height))
        ):
            yield found


def _blank(width_px: int, height_px: int) -> bytes:
    file = io.BytesIO()
    Image.new("RGB", (width_px, height_px), "navy").save(file, "PNG")
    return file.getvalue()


def misfit(model: ChatModel, tokens: int, picture: bytes | None) -> str:
    """What of a run's questions a model does not take, and the option that helps; empty if it takes them.

    A model in this process is not asked, since it knows its context.

    Args:
        model: the model.
        tokens: of the longest question.
        picture: a PNG file as big as a screenshot, if the questions have pictures.

    Raises:
        ModelError: it does not answer at all.
    """
    if isinstance(model, Local):
        has_room = tokens <= model.context_tokens
        return "" if has_room else _too_long(model, tokens, f"its context leaves {model.context_tokens:,}")
    pictures = () if picture is None or not model.sees_pictures else (picture,)
    long = FILLER * (tokens * CHARACTERS_PER_TOKEN // len(FILLER)) + ASKED
    refused = _refusal(model, long, pictures)
    if not refused:
        return ""
    if pictures and not _refusal(model, long, ()):
        return f"{model.name} takes no pictures ({refused}); give --see tree, and an agent that can do without"
    model.chat([ChatMessage("user", ASKED)])
    return _too_long(model, tokens, refused)


def _refusal(model: ChatModel, text: str, pictures: tuple[bytes, ...]) -> str:
    try:
        model.chat([ChatMessage("user", text, pictures)])
    except ModelError as error:
        return str(error).removeprefix(f"{model.name} ")
    return ""


def _too_long(model: ChatModel, tokens: int, why: str) -> str:
    return (
        f"{model.name} takes no question of {tokens:,} tokens, as the longest here may have ({why}); give it a "
        "longer context, a slow one more time (?timeout_s=), or --prompt short"
    )
