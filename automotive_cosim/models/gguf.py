"""What a model's GGUF file says about itself, read from its beginning, and which files are known to fit.

The format: https://github.com/ggml-org/ggml/blob/master/docs/gguf.md.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, NamedTuple

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import open_file

MAGIC = b"GGUF"
SCALARS = {0: "B", 1: "b", 2: "H", 3: "h", 4: "I", 5: "i", 6: "f", 7: "?", 10: "Q", 11: "q", 12: "d"}
TEXT, ARRAY = 8, 9
MOST_KEYS, MOST_ITEMS, MOST_TEXT = 10_000, 10_000_000, 2**20
"""More keys, items of an array or bytes of a text than any model has."""


class KnownFile(NamedTuple):
    """A file of a model that has been tried here."""

    model: str
    maker: str


KNOWN = {
    "1d9614638d18024d0fbb36575a15f1302a3adf044df10345688ec4f6e1c4ff32": KnownFile(
        "Qwen2.5-Coder-0.5B-Instruct, Q4_K_M", "Qwen, Alibaba Cloud"
    ),
    "cc324af070c2ecbfd324a30884d2f951a7ff756aba85cb811a6ec436933bb046": KnownFile(
        "Qwen2.5-Coder-1.5B-Instruct, Q4_K_M", "Qwen, Alibaba Cloud"
    ),
    "b179c9523d0e6a0f98a330c7562b682750a6f8c8c15e5bc70ea373728110db53": KnownFile(
        "SmolLM2-135M-Instruct, Q4_1", "Hugging Face"
    ),
}
"""By the SHA-256 of the file."""


@dataclass(frozen=True, slots=True)
class ModelFile:
    """A model's file, as it describes itself."""

    name: str
    context: int
    """Longest question and answer together that it was trained on, in tokens; 0 if it does not say."""
    has_template: bool
    """Whether it has a template of conversations, without which it is no model to be instructed."""
    has_tools: bool
    """Whether this template has a place for functions."""


def read_model_file(path: Path) -> ModelFile:
    """Reads the beginning of the file, without loading the model.

    Raises:
        UserError: there is no such file, or it is not a whole GGUF file.
    """
    try:
        with open_file(path) as file:
            if file.read(4) != MAGIC:
                raise UserError(
                    f"{path} is no GGUF file, by its first four bytes; give a file of llama.cpp's format"
                )
            version, _, count = struct.unpack("<IQQ", _read(file, 20))
            if version not in (2, 3) or count > MOST_KEYS:
                raise UserError(f"{path} is GGUF version {version} with {count} keys; versions 2 and 3 are read")
            told = dict(_pair(file) for _ in range(count))
    except OSError as error:
        raise UserError(f"cannot read {path}: {error.strerror or error}") from error
    except (struct.error, ValueError, KeyError, MemoryError) as error:
        raise UserError(f"{path} is not a whole GGUF file ({error}); fetch it again") from error
    template = str(told.get("tokenizer.chat_template", ""))
    context = told.get(f"{told.get('general.architecture')}.context_length", 0)
    return ModelFile(
        str(told.get("general.name", path.stem)),
        context if isinstance(context, int) else 0,
        bool(template),
        "tools" in template,
    )


def _pair(file: IO[bytes]) -> tuple[str, Any]:
    name = _text(file)
    return name, _value(file, *struct.unpack("<I", _read(file, 4)))


def _read(file: IO[bytes], size: int) -> bytes:
    if len(data := file.read(size)) < size:
        raise ValueError("it ends early")
    return data


def _text(file: IO[bytes]) -> str:
    (length,) = struct.unpack("<Q", _read(file, 8))
    if length > MOST_TEXT:
        raise ValueError(f"a text of {length} bytes")
    return _read(file, length).decode(errors="replace")


def _value(file: IO[bytes], kind: int) -> Any:
    """A value; None for an array, which is passed over."""
    if kind == TEXT:
        return _text(file)
    if kind != ARRAY:
        form = f"<{SCALARS[kind]}"
        return struct.unpack(form, _read(file, struct.calcsize(form)))[0]
    of, count = struct.unpack("<IQ", _read(file, 12))
    if count > MOST_ITEMS or of == ARRAY:
        raise ValueError(f"an array of {count} items")
    if of != TEXT:
        file.seek(count * struct.calcsize(f"<{SCALARS[of]}"), 1)
        return None
    for _ in range(count):
        _text(file)
    return None
