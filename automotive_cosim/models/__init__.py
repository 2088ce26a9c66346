"""Models for the agents: one chat protocol, several back ends.

``rules``               a deterministic stand-in that reads the prompt by keywords; runs anywhere
``replay/FOLDER``       the answers recorded in an episode's folder, for an exact re-run
``replay/NAME``         those of a shipped conversation (``automotive_cosim/replay``)
``local``               a small model in this process, from an installed package; see ``local``
``local/FILE.gguf``     a model in this process, from a file
``openai/NAME``         OpenAI, or the server that ``OPENAI_BASE_URL`` names
``PROVIDER/NAME``       any OpenAI-compatible endpoint: ``PROVIDER_API_KEY`` and ``PROVIDER_BASE_URL``

The last four take settings, as in ``openai/NAME?seed=3&timeout_s=30``; see ``remote.Settings`` and
``local.LocalSettings``.
"""

from __future__ import annotations

from automotive_cosim.errors import UnknownNameError
from automotive_cosim.models.apis import ProviderApi
from automotive_cosim.models.base import ChatMessage, ChatModel, ModelReply
from automotive_cosim.models.local import Local, is_local
from automotive_cosim.models.replay import Replay
from automotive_cosim.models.rules import Rules
from automotive_cosim.models.turns import Turns

__all__ = ["MODELS", "ChatMessage", "ChatModel", "ModelReply", "Replay", "Rules", "make_model"]

MODELS = ("rules", "replay/FOLDER", "replay/NAME", "local", "local/FILE.gguf", "openai/NAME", "PROVIDER/NAME")
"""The forms of a model's name."""


def make_model(name: str, api: ProviderApi | None = None, turns: Turns | None = None) -> ChatModel:
    """A model by name.

    Args:
        api: the protocol of its endpoint, if it has one; by default chat completions.
        turns: where a model with a limit of questions a minute takes its turns; by default its own.

    Raises:
        UnknownNameError: the name has none of the forms above.
        UserError: the recording cannot be read, or a setting is wrong.
        SetupError: ``httpx2``, the key or the address is missing.
    """
    provider, slash, rest = name.partition("/")
    if name == "rules":
        return Rules()
    if is_local(name):
        return Local(name, api)
    if not slash or not provider or not rest:
        raise UnknownNameError("model", name, MODELS)
    if provider == "replay":
        return Replay.named(rest, api)
    from automotive_cosim.models.remote import make_remote

    return make_remote(name, api, turns)
