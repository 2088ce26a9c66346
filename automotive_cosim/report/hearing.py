"""What was said in the cabin of a recorded trial, what reached the agent, and how loud it was."""

from __future__ import annotations

import io
import wave
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.errors import InfrastructureError, SetupError, UserError, install_hint
from automotive_cosim.formats.files import read_bytes
from automotive_cosim.formats.layout import SOUNDS, sound
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.report.plot import BOTTOM, LEFT, RIGHT, TOP
from automotive_cosim.voice.cabin import driver_snr_db
from automotive_cosim.voice.engines import RATE_HZ, from_wav, is_installed
from automotive_cosim.voice.table import sounding

QUIETEST_DB, LOUDEST_DB, LINE_DB = 30, 110, 20
"""Ends and grid of the axis: beyond a parked car and a siren beside open windows."""
MOST_LETTERS = 2000
"""Of words that are said; nobody says more at once, and a record may be anybody's."""


def utterances(step: Json, goal: str) -> list[Json]:
    """What was said by the end of a step: the words, what reached the agent, and the noise in dB(A); none where
    words are text."""
    said = step.get("said", []) if step["step"] else [goal]
    heard, noise_db = step.get("heard", ()), step.get("cabin_db")
    return [
        {"said": words, "heard": reached, "noise_db": noise_db} for words, reached in zip(said, heard, strict=False)
    ]


def can_sound(folder: Path, step: int, number: int) -> bool:
    """Whether ``sounded`` has it, or can make it with the extra ``voice``."""
    return sound(folder, step, number).is_file() or is_installed()


def sounded(folder: Path, step: int, number: int, uttered: Json) -> bytes:
    """Words as the microphone had them, in the noise of that instant, as a WAV file; the one of the record, if it
    has one.

    Raises:
        SetupError: there is none, and the extra ``voice`` is missing.
        UserError: that file is no WAV file.
        InfrastructureError: the voice could not say it."""
    path = sound(folder, step, number)
    if not path.is_file():
        return sounding(uttered["said"][:MOST_LETTERS], driver_snr_db(uttered["noise_db"]))
    data = read_bytes(path)
    from_wav(data, path.name)
    return data


def with_sounds(folder: Path, steps: Sequence[Json], goal: str) -> tuple[list[Json], str]:
    """All utterances with ``at_s`` and ``wav``, whose files are written beside the record; and why some are
    silent, if any is."""
    told, why = [], ""
    for step in steps:
        for number, uttered in enumerate(utterances(step, goal)):
            wav = b""
            try:
                wav = sounded(folder, step["step"], number, uttered)
                if not (path := sound(folder, step["step"], number)).is_file():
                    write_whole(make_folder(folder, SOUNDS) / path.name, wav)
            except SetupError:
                why = f"After `{install_hint('voice')}`, the pages of `serve` and of further runs play it."
            except (UserError, InfrastructureError) as error:
                why = f"No sound: {error}."
            told.append(uttered | {"at_s": step["at_s"], "wav": small(wav) if wav else b""})
    return told, why


def small(wav: bytes) -> bytes:
    """A WAV file with 8 bits instead of 16, for a page: its grains are 50 dB below the loudest."""
    samples, made = from_wav(wav, "the sound"), io.BytesIO()
    with wave.open(made, "wb") as file:
        file.setparams((1, 1, RATE_HZ, 0, "NONE", ""))
        file.writeframes((np.clip(samples, -1, 1) * 127 + 128).astype(np.uint8).tobytes())
    return made.getvalue()


def level_plot(levels: Sequence[tuple[float, float]], said: Sequence[Json], width: int, height: int) -> Json:
    """The cabin's level at each step, as what an SVG template needs, in pixels of its view box.

    Args:
        levels: seconds since the hand-over, and dB(A).
        said: utterances, which get a mark each."""
    left, right, top, bottom = LEFT, width - RIGHT, TOP, height - BOTTOM
    end_s = max(1.0, levels[-1][0])

    def x(at_s: float) -> float:
        return round(left + at_s / end_s * (right - left), 1)

    def y(level_db: float) -> float:
        return round(bottom - (level_db - QUIETEST_DB) / (LOUDEST_DB - QUIETEST_DB) * (bottom - top), 1)

    points = [*levels, (end_s, levels[-1][1])]
    return {
        **{"width": width, "height": height, "left": left, "right": right, "top": top, "bottom": bottom},
        "end_s": end_s,
        "lines": [(level, y(level)) for level in range(QUIETEST_DB, LOUDEST_DB + 1, LINE_DB)],
        "marks": sorted({x(each["at_s"]) for each in said}),
        "curve": "M" + "L".join(f"{x(at_s):g} {y(level):g}" for at_s, level in points),
    }
