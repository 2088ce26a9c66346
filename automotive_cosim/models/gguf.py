"""What a model's GGUF file says about itself, read from its beginning, and which files are known to fit.

A file that ends before its last tensor does is refused.

The format: https://github.com/ggml-org/ggml/blob/master/docs/gguf.md.
"""

from __future__ import annotations

import math
import os
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
"""More keys, items of an array or bytes of a text than any model has; and no more tensors than keys."""
BLOCKS = {0: (1, 4), 1: (1, 2), 2: (32, 18), 3: (32, 20), 6: (32, 22), 7: (32, 24), 8: (32, 34), 10: (256, 84),
          11: (256, 110), 12: (256, 144), 13: (256, 176), 14: (256, 210), 30: (1, 2)}  # fmt: skip
"""Values and bytes of a block, by a tensor's type (ggml.h); of others only the beginning is known."""


class _KnownFile(NamedTuple):
    """A file of a model that has been tried here."""

    model: str
    maker: str


KNOWN = {
    "1d9614638d18024d0fbb36575a15f1302a3adf044df10345688ec4f6e1c4ff32": _KnownFile(
        "Qwen2.5-Coder-0.5B-Instruct, Q4_K_M", "Qwen, Alibaba Cloud"
    ),
    "cc324af070c2ecbfd324a30884d2f951a7ff756aba85cb811a6ec436933bb046": _KnownFile(
        "Qwen2.5-Coder-1.5B-Instruct, Q4_K_M", "Qwen, Alibaba Cloud"
    ),
    "b179c9523d0e6a0f98a330c7562b682750a6f8c8c15e5bc70ea373728110db53": _KnownFile(
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

    Raises UserError: there is no such file, or it is not a whole GGUF file."""
    try:
        with open_file(path) as file:
            if file.read(4) != MAGIC:
                raise UserError(
                    f"{path} is no GGUF file, by its first four bytes; give a file of llama.cpp's format"
                )
            version, tensors, count = struct.unpack("<IQQ", _read(file, 20))
            if version not in (2, 3) or max(count, tensors) > MOST_KEYS:
                raise UserError(f"{path} is GGUF version {version} with {count} keys; versions 2 and 3 are read")
            told = dict(_pair(file) for _ in range(count))
            ends = [_tensor_end(file) for _ in range(tensors)]
            align = int(told.get("general.alignment", 32))
            whole, size = -(-file.tell() // align) * align + max(ends, default=0), os.fstat(file.fileno()).st_size
            if ends and size < whole:
                raise ValueError(f"it has {size} bytes of {whole}")
    except OSError as error:
        raise UserError(f"cannot read {path}: {error.strerror or error}") from error
    except (struct.error, ValueError, TypeError, ArithmeticError, KeyError, MemoryError) as error:
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


def _tensor_end(file: IO[bytes]) -> int:
    """Where a tensor's data ends, in bytes from where the first begins."""
    _text(file)
    (dimensions,) = struct.unpack("<I", _read(file, 4))
    *sizes, kind, begin = struct.unpack(f"<{dimensions}QIQ", _read(file, 8 * dimensions + 12))
    values, size = BLOCKS.get(kind, (2**63, 1))
    return int(begin + max(1, math.prod(sizes) // values * size))


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
