"""Models by their names; to know the names, none is imported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from automotive_cosim.errors import UnknownNameError

if TYPE_CHECKING:
    from automotive_cosim.models.apis import ProviderApi
    from automotive_cosim.models.base import ChatModel
    from automotive_cosim.models.turns import Turns

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
    from automotive_cosim.models.local import Local, is_local
    from automotive_cosim.models.remote import make_remote
    from automotive_cosim.models.replay import Replay
    from automotive_cosim.models.rules import Rules

    provider, slash, rest = name.partition("/")
    if name == "rules":
        return Rules()
    if is_local(name):
        return Local(name, api)
    if not slash or not provider or not rest:
        raise UnknownNameError("model", name, MODELS)
    return Replay.named(rest, api) if provider == "replay" else make_remote(name, api, turns)
