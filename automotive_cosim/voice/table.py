"""What the recogniser heard of what drivers say, at each ratio of words to noise: a table in the package.

    python -m automotive_cosim.proof.heard --seeds 3

renews it, with the extra ``voice``. Words that are not in it are said and recognised when they are needed, if the
extra is installed.
"""

from __future__ import annotations

import json
import lzma
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from pathlib import Path

import numpy as np

from automotive_cosim.errors import InfrastructureError, SetupError, UserError, install_hint
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.tasking.dialogue import AS_SEEN, LOOK_FIRST
from automotive_cosim.voice import engines

TABLE = Path(__file__).with_name("heard.json.xz")
LEVELS_DB = (None, 5.0, 0.0, -5.0, -10.0)
"""Ratios of the A-weighted levels of words and noise at which the words were recognised; None is without noise."""
CLEAN_DB = 10.0
"""The ratio that counts as without noise, when the nearest level is taken."""
NOTHING, SPOKEN = "[inaudible]", "[spoken]"
"""What an agent reads where nothing was recognised, and where it gets the sound."""
MOST_WORDS = 40
"""Of a piece that is said in one go: at 150 words a minute half of the half minute that the recogniser takes."""
_FROM = re.compile(r"From the ([a-z ]+ seat|loudspeakers): ")
"""Where a voice comes from that is not the driver's, which no recogniser has to tell."""
_SENTENCE = re.compile(r"(?<=[.!?]) +")


@lru_cache(maxsize=256)
def sounding(text: str, snr_db: float) -> bytes:
    """An English text as it sounds at a ratio of words to noise, as a WAV file.

    Raises:
        SetupError: the extra is missing.
        InfrastructureError: the voice could not say it."""
    every = list(pieces(text))
    try:
        sounds = engines.said(every)
    except SetupError:
        raise
    except UserError as error:
        raise InfrastructureError(str(error)) from None
    said = (engines.in_cabin(sound, snr_db, piece) for piece, sound in zip(every, sounds, strict=True))
    return engines.as_wav(np.concatenate(list(said)))


def heard(text: str, snr_db: float) -> str:
    """What is heard of an English text, at a ratio of words to noise.

    Raises InfrastructureError: the table does not have it, and the extra is missing or damaged."""
    return came_from(text) + " ".join(_heard(piece, _column(snr_db)) or NOTHING for piece in pieces(text))


def pieces(text: str) -> Iterator[str]:
    """The parts of a text that are said and recognised by themselves, in order."""
    text = _FROM.sub("", text, count=1)
    added = next((each for each in (LOOK_FIRST, AS_SEEN) if text.endswith(each)), "")
    rest = text.removesuffix(added).strip()
    piece: list[str] = []
    for sentence in _SENTENCE.split(rest) if rest else ():
        if piece and len(" ".join([*piece, sentence]).split()) > MOST_WORDS:
            yield " ".join(piece)
            piece = []
        piece.append(sentence)
    if piece:
        yield " ".join(piece)
    if added:
        yield added


def lacking(texts: Iterable[str]) -> list[str]:
    """The pieces of English texts that cannot be heard here: the table lacks them, and the extra is missing."""
    known = _shipped()
    every = dict.fromkeys(piece for text in texts for piece in pieces(text) if piece not in known)
    return [] if engines.is_installed() else list(every)


def check(texts: Iterable[str]) -> None:
    """Refuses English texts that cannot all be heard here.

    Raises InfrastructureError: the table does not have one, and the extra is missing."""
    if missing := lacking(texts):
        raise _unheard(missing[0])


def recognise(texts: Sequence[str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Says the texts and recognises each at every level. Raises SetupError: the extra is missing."""
    for text, sound in zip(texts, engines.said(texts), strict=True):
        yield text, tuple(engines.recognised(engines.in_cabin(sound, level, text)) for level in LEVELS_DB)


def word_errors(said: str, made_out: str) -> tuple[int, int]:
    """Words that are missing, wrong or too many (Levenshtein), and the number of words that were said."""
    one, other = (re.findall(r"\w+", text.casefold()) for text in (said, made_out))
    row = list(range(len(other) + 1))
    for count, word in enumerate(one, start=1):
        last, row = row, [count]
        for at, found in enumerate(other, start=1):
            row.append(min(last[at] + 1, row[at - 1] + 1, last[at - 1] + (word != found)))
    return row[-1], len(one)


def read(path: Path = TABLE) -> Mapping[str, tuple[str, ...]]:
    """A table, by text; empty if there is none. Raises UserError: it is none, or was made for other levels."""
    if not path.is_file():
        return {}
    try:
        whole = read_json(path)
        if whole["levels_db"] != list(LEVELS_DB):
            raise UserError(f"{path.name} was made for {whole['levels_db']} dB; make it anew for {LEVELS_DB}")
        return {text: tuple(row) for text, row in whole["heard"].items()}
    except (OSError, KeyError, TypeError, AttributeError, ValueError) as error:
        raise UserError(f"{path.name} is no table of what was heard ({error}); make it anew") from None


def write(table: Mapping[str, tuple[str, ...]], path: Path = TABLE) -> None:
    """Writes a table, with what it was made with."""
    whole = {"made_with": dict(engines.made_with()), "levels_db": LEVELS_DB, "heard": dict(sorted(table.items()))}
    write_whole(path, lzma.compress(json.dumps(whole, ensure_ascii=False, indent=0).encode(), preset=9))


_shipped = cache(read)


def came_from(text: str) -> str:
    """Where a voice comes from that is not the driver's; empty if it is."""
    found = _FROM.match(text)
    return found[0] if found else ""


@lru_cache(maxsize=4096)
def _heard(piece: str, column: int) -> str:
    known = _shipped().get(piece)
    if known is not None:
        return known[column]
    try:
        (sound,) = engines.said([piece])
        return engines.recognised(engines.in_cabin(sound, LEVELS_DB[column], piece))
    except SetupError:
        raise _unheard(piece) from None
    except UserError as error:  # of the engines: the trial is to be run again
        raise InfrastructureError(str(error)) from None


def _unheard(piece: str) -> InfrastructureError:
    return InfrastructureError(
        f"the table of what was heard does not have {piece!r}; {install_hint('voice')} says it when it is "
        "needed, or give another seed, or --hear text"
    )


def _column(snr_db: float) -> int:
    """The level that is nearest."""
    levels = [CLEAN_DB if level is None else level for level in LEVELS_DB]
    return min(range(len(levels)), key=lambda i: abs(levels[i] - snr_db))
