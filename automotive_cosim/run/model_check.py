"""Whether a model takes the questions of a run, found out by one before it; by two, if it is to call functions."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace

from PIL import Image

from automotive_cosim.agents import AgentSettings, Caller, model_of
from automotive_cosim.agents.caller import heard
from automotive_cosim.errors import ActionError, ModelError
from automotive_cosim.models.base import CHARACTERS_PER_TOKEN, ChatMessage, ChatModel, ModelReply, ToolCall
from automotive_cosim.models.gguf import read_model_file
from automotive_cosim.models.local import Local
from automotive_cosim.run.forecast import asks, longest_question, pictures_of
from automotive_cosim.run.trial import TrialSetup

FILLER = "The car drives on along the avenue, and nothing has changed since. "
ASKED = "Answer with the word OK."
CALLED = "Call the function `wait` once."
WAIT = ToolCall("call00000", "wait", {"seconds": 1})


def misfits(jobs: Iterable[TrialSetup]) -> Iterator[str]:
    """What each model of some trials does not take of their questions; nothing for those that take them.

    Raises:
        ModelError: a model does not answer at all.
        UserError: the file of one in this process is none, or not whole."""
    tried = set()
    for job in jobs:
        if not asks(job.asked_model):
            continue
        longest, size = longest_question(job), job.conditions.screen if pictures_of(job) else None
        key = job.agent, job.asked_model, longest, size
        if key in tried:
            continue
        tried.add(key)
        model = model_of(job.agent, job.asked_model, settings=AgentSettings(job.conditions))
        picture = None if size is None else _blank(size.width, size.height)
        if model is not None and (found := misfit(model, longest, picture, calls=job.agent == Caller.name)):
            yield found


def _blank(width_px: int, height_px: int) -> bytes:
    file = io.BytesIO()
    Image.new("RGB", (width_px, height_px), "navy").save(file, "PNG")
    return file.getvalue()


def misfit(model: ChatModel, tokens: int, picture: bytes | None, *, calls: bool = False) -> str:
    """What of a run's questions a model does not take, and the option that helps; empty if it takes them.

    A model in this process is not asked, since it knows its context; its file is looked at.

    Args:
        picture: a PNG file as big as a screenshot, if the questions have pictures.
        calls: whether the questions after the first have calls with their results.

    Raises:
        ModelError: it does not answer at all.
        UserError: its file is none, or not whole."""
    if isinstance(model, Local):
        read_model_file(model.file)
        has_room = tokens <= model.context_tokens
        return "" if has_room else _too_long(model, tokens, f"its context leaves {model.context_tokens:,}")
    pictures = () if picture is None or not model.sees_pictures else (picture,)
    room = FILLER * (tokens * CHARACTERS_PER_TOKEN // len(FILLER))
    system = [ChatMessage("system", "You operate a car.")] if calls else []
    reply, refused = _tried(model, [*system, ChatMessage("user", room + (CALLED if calls else ASKED), pictures)])
    if reply is not None and calls:
        asked = ChatMessage("assistant", "", calls=(WAIT,))
        with suppress(ActionError):
            asked = called if (called := heard(reply, {})).calls else asked
        results = [ChatMessage("tool", "ok", call_id=call.id) for call in asked.calls]
        results[-1] = replace(results[-1], text=f"ok\n\n{room}{ASKED}")
        _, refused = _tried(model, [*system, ChatMessage("user", CALLED, pictures), asked, *results])
        if refused:
            return (
                f"{model.name} takes no question with the result of a call ({refused}); serve it by something that "
                "speaks chat completions with tools, or give an agent that answers in words (t3a, m3a, asurada)"
            )
    if not refused:
        return ""
    if pictures and not _tried(model, [ChatMessage("user", room + ASKED)])[1]:
        return f"{model.name} takes no pictures ({refused}); give --see tree, and an agent that can do without"
    model.chat([ChatMessage("user", ASKED)])
    return _too_long(model, tokens, refused)


def _tried(model: ChatModel, messages: Sequence[ChatMessage]) -> tuple[ModelReply | None, str]:
    """The answer, or why there is none."""
    try:
        return model.chat(messages), ""
    except ModelError as error:
        return None, str(error).removeprefix(f"{model.name} ")


def _too_long(model: ChatModel, tokens: int, why: str) -> str:
    return (
        f"{model.name} takes no question of {tokens:,} tokens, as the longest here may have ({why}); give it a "
        "longer context, a slow one more time (?timeout_s=), or --prompt short"
    )
