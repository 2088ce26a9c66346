"""How loud the cabin is, from what the car does, and who understands whom in it.

Levels in dB(A) at the driver's head, to first order; sources add up by their energy, and lg is the logarithm to 10:

| source | level |
|---|---|
| at rest | 40 |
| tyres and wind, all shut | 66 + 30 lg(v / 100 km/h), 3 more on a wet road |
| openings | 87 + 34 lg(v / 100 km/h) + 10 lg(n / 5), where n of four windows and the sunroof are open |
| rain | 45 + 17 lg(rate / 1 mm/h) |
| blower | 65 + 50 lg(share of full speed) |
| media | 80 + 40 lg(share of full volume) |
| a call | 65, whoever is on the phone |
| siren | 102 - 20 lg(distance / 30 m), 23 less with all shut, and less of that with openings |
| voices | while others aboard speak, each as loud as the driver's a metre away; the radio's are media |

Sources, in that order: a parked electric car (an assumption); the middle of what Auto Bild measured at 100 km/h
(2010 to 2012: 58 to 78 dB(A)), with the slope of rolling noise in CNOSSOS-EU (Directive (EU) 2015/996), and
what a wet road adds to tyres (Sandberg and Ejsmont 2002, 1 to 5 dB); cars with an open roof (Mikulec et al.
2011, J. Laryngol. Otol. 125: 85.3 dB at 88.5 km/h, 89.9 at 120.7), an opening counting as a fifth of it (an
assumption); rain by the logarithm of its rate, as measured under roofs in natural rain (Applied Acoustics,
2016), with 45 dB(A) and 17 as assumptions; the fan law of 50 lg (ASHRAE Handbook, HVAC Applications), from 65
dB(A) at full blower (an assumption of the size in Mavuri et al. 2008, SAE World Congress); volume as an audio
taper, and voices on a phone as loud as a raised voice (assumptions); sirens (Flesch et al. 1986, NIOSHTIC
00177994: 99 to 105 dB(A) at 100 feet), and the side of an ambulance as the insulation of a car (Oliveira et al.
2013, Building Acoustics 20: 23 dB(A)); people's voices by their effort, 60 dB(A) a metre away, and more in noise
(ISO 9921:2003).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from automotive_cosim.cockpit.signals import CABIN, CALL, HVAC, MEDIA, VOICE
from automotive_cosim.contracts.plain import KMH_PER_MPS
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.dialogue import spoken_s
from automotive_cosim.voice.table import came_from

REST_DB = 40.0
OPENINGS = (
    CABIN.DRIVER_WINDOW,
    CABIN.PASSENGER_WINDOW,
    CABIN.REAR_LEFT_WINDOW,
    CABIN.REAR_RIGHT_WINDOW,
    CABIN.SUNROOF,
)
WET_MM_H = 0.1
NORMAL_DB = 60.0
"""Normal vocal effort, a metre in front of the mouth (ISO 9921:2003)."""
LOUDEST_DB = 78.0
"""Very loud, in the same table."""
LOMBARD, LOMBARD_DB = 0.3, 40.0
"""People raise their voices by three tenths of the noise above this (van Heusden et al. 1979, Applied Acoustics
12)."""
CLOSE_DB = 6.0
"""The microphone is half a metre away."""
LOUDSPEAKER_DB = 66.0
"""The car's voice at half its volume, at the driver's ear: a raised voice (ISO 9921:2003). It rises with the noise
as people's voices do, as cars with speed-dependent volume have it."""
UNDERSTOOD = 0.45
"""Speech intelligibility index below which communication is poor (ANSI S3.5-1997)."""


def sources(moment: Moment, voices: int = 0) -> Iterator[tuple[str, float]]:
    """What is heard in the cabin, and each level in dB(A).

    Args:
        voices: how many people speak besides the driver."""
    siren = moment.driving.around.emergency_behind
    kmh, rain_mm_h = moment.driving.speed_mps * KMH_PER_MPS, moment.weather.precipitation
    found = dict(levels(moment.signals, kmh, rain_mm_h, None if siren is None else siren.gap_m))
    yield from found.items()
    if voices:
        yield "voices", _voice_db(summed_db(found.items())) + 10 * math.log10(voices)


def levels(
    signals: Mapping[str, Any], kmh: float, rain_mm_h: float = 0.0, siren_m: float | None = None
) -> Iterator[tuple[str, float]]:
    """As ``sources``, by the values of signals, and by what is outside."""
    opened = sum(signals[each.path] for each in OPENINGS) / 100
    yield "at rest", REST_DB
    if kmh > 1:
        yield "tyres and wind", 66 + 30 * math.log10(kmh / 100) + (3 if rain_mm_h >= WET_MM_H else 0)
    if kmh > 1 and opened:
        yield "openings", 87 + 34 * math.log10(kmh / 100) + _share_db(opened)
    if rain_mm_h >= WET_MM_H:
        yield "rain", 45 + 17 * math.log10(rain_mm_h)
    if fan := signals[HVAC.FAN_SPEED.path]:
        yield "blower", 65 + 50 * math.log10(fan / 100)
    volume = signals[MEDIA.VOLUME.path]
    if volume and signals[MEDIA.ACTION.path] == "PLAY" and not signals[MEDIA.MUTED.path]:
        yield "media", 80 + 40 * math.log10(volume / 100)
    if signals[CALL.PARTNER.path]:
        yield "a call", 65.0
    if siren_m is not None:
        through = 10 * math.log10(10**-2.3 + opened / len(OPENINGS))
        yield "siren", 102 - 20 * math.log10(max(siren_m, 3.0) / 30) + min(0.0, through)


def level_db(moment: Moment, voices: int = 0) -> float:
    """How loud the cabin is, dB(A), while so many people speak besides the driver."""
    return summed_db(sources(moment, voices))


def voices(said: Iterable[tuple[float, Iterable[str]]], now_s: float) -> int:
    """How many people besides the driver speak now.

    Args:
        said: seconds, and what was said from then on."""
    texts = ((at_s, text, came_from(text)) for at_s, every in said for text in every)
    others = ((at_s, spoken_s(text[len(seat) :])) for at_s, text, seat in texts if seat.endswith("seat: "))
    return sum(at_s <= now_s < at_s + lasts_s for at_s, lasts_s in others)


def summed_db(found: Iterable[tuple[str, float]]) -> float:
    """Sources together, by their energy, dB(A)."""
    return 10 * math.log10(sum(10 ** (level / 10) for _, level in found))


def driver_snr_db(noise_db: float) -> float:
    """The driver's voice above the noise, at the microphone."""
    return _voice_db(noise_db) + CLOSE_DB - noise_db


def is_understood(moment: Moment, noise_db: float) -> bool:
    """Whether the driver understands the car's voice, by the speech intelligibility index of ANSI S3.5-1997 in a
    single band, in which every decibel from -15 to 15 counts a thirtieth."""
    volume = moment.signals[VOICE.GUIDANCE_VOLUME.path]
    if not volume:
        return False
    snr_db = LOUDSPEAKER_DB + 40 * math.log10(volume / 50) + _raised_db(noise_db) - noise_db
    return min(1.0, max(0.0, (snr_db + 15) / 30)) >= UNDERSTOOD


def _voice_db(noise_db: float) -> float:
    return min(NORMAL_DB + _raised_db(noise_db), LOUDEST_DB)


def _raised_db(noise_db: float) -> float:
    return LOMBARD * max(0.0, noise_db - LOMBARD_DB)


def _share_db(opened: float) -> float:
    return 10 * math.log10(opened / len(OPENINGS))
