"""Gymnasium spaces of observations and actions, and conversions to and from the typed ones.

Observation (``Dict``; a withheld channel has no key):

| key | space | meaning |
|---|---|---|
| ``goal`` | uint8 (512,) | what the driver said, UTF-8, zero-padded |
| ``said`` | uint8 (1024,) | what the driver has said since, one remark per line, the latest that fit |
| ``time_s`` | float64 () | simulated seconds since the hand-over |
| ``feedback`` | ``code`` Discrete, ``text`` uint8 (1024,) | result of the last action |
| ``screenshot`` | uint8 (height, width, 3) | RGB |
| ``camera`` | uint8 (360, 640, 3) | RGB: the view through the windshield, if asked for |
| ``elements`` | ``count``, ``bbox``, ``kind``, ``flags``, ``text``, ``description``, ``resource_id`` | 128 |
| ``vehicle`` | one float32 or Discrete per field of ``VehicleState``, ``*_valid`` if it can be absent; ``aboard`` \
uint8 (512,) | |
| ``gps`` | ``available``, ``fix``, ``lon_lat``, ``accuracy_m``, ``age_s``, ``heading_deg`` | |
| ``connectivity`` | ``online``, ``kind``, ``signal`` | |
| ``context`` | uint8 (8192,) | the geo-context as text |
| ``sound`` | ``count``, ``length``, ``samples`` int16 (480000,) | with ``hear="audio"``: what was said, the \
latest half a minute of it at 16 kHz, zero-padded |

Action (``Dict``): see ``action_space``; every sample is well formed.
"""

from __future__ import annotations

import io
import wave
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import fields
from functools import cache, lru_cache
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from automotive_cosim.cockpit.actions import FIELDS, SECONDS_LIMIT, TEXT_LIMIT, check
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.contracts import (
    UNCALLED,
    Action,
    ActionType,
    AlertKind,
    BoundingBox,
    Connectivity,
    Direction,
    Element,
    Feedback,
    FeedbackCode,
    GoalStatus,
    GpsFix,
    Observation,
    Reason,
    Severity,
    VehicleState,
)
from automotive_cosim.errors import ActionError
from automotive_cosim.formats.words import shown
from automotive_cosim.interface.observe import Channel
from automotive_cosim.view.lens import HEIGHT as VIEW_HEIGHT
from automotive_cosim.view.lens import WIDTH as VIEW_WIDTH

T = TypeVar("T")

GOAL_BYTES, SAID_BYTES, FEEDBACK_BYTES, CONTEXT_BYTES, ABOARD_BYTES = 512, 1024, 1024, 8192, 512
NOTICED_BYTES = 2048
SOUND_SAMPLES, MOST_SOUNDS = 480_000, 1000
"""Half a minute, which is what recognisers take at once; and as far as utterances are counted."""
MAX_ELEMENTS, ELEMENT_TEXT_BYTES, RESOURCE_ID_BYTES = 128, 128, 64
KINDS = ("View", "TextView", "Button", "Switch", "SeekBar", "EditText", "ImageView", "ListView", "RadioButton")
FLAGS = tuple(field.name for field in fields(Element) if field.name.startswith("is_"))
GEARS = ("P", "R", "N", "D")
NETWORKS = ("none", "4g", "5g")
RESTRICTION_BITS = 9
SPEED_STEP_KMH = 5
APPS = tuple(apps())

BOUNDS: Mapping[str, tuple[float, float]] = {
    "speed_kmh": (0, 400),
    "ambient_temperature_c": (-60, 70),
    "cabin_temperature_c": (-60, 90),
    "cabin_humidity_pct": (0, 100),
    "rain_intensity_pct": (0, 100),
    "driver_temperature_set_c": (-50, 60),
    "fan_speed_pct": (0, 100),
    "energy_level_pct": (0, 100),
    "range_km": (0, 5000),
    "speed_limit_sign_kmh": (0, 400),
    "leader_gap_m": (0, 10_000),
    "leader_time_to_collision_s": (0, 10_000),
}
"""Bounds of the numeric fields of ``VehicleState``; values beyond are clipped."""
OPTIONAL = ("speed_limit_sign_kmh", "leader_gap_m", "leader_time_to_collision_s", "noticed")


class _AnyText(spaces.Text):
    """A ``Text`` space that takes any string up to its length; the parent knows only its character set."""

    def contains(self, x: Any) -> bool:
        """Whether ``x`` is a string that is not too long."""
        return isinstance(x, str) and len(x) <= self.max_length


def observation_space(
    channels: frozenset[Channel], width: int, height: int, *, with_sound: bool = False
) -> spaces.Dict:
    """The observation space of an agent with these channels; see the module's table."""
    heard: dict[str, spaces.Space[Any]] = {
        "sound": spaces.Dict(
            {
                "count": spaces.Discrete(MOST_SOUNDS + 1),
                "length": spaces.Discrete(SOUND_SAMPLES + 1),
                "samples": spaces.Box(-32768, 32767, (SOUND_SAMPLES,), np.int16),
            }
        )
    }
    known: dict[Channel, spaces.Space[Any]] = {
        Channel.SCREENSHOT: _bytes_space(height, width, 3),
        Channel.ELEMENTS: _elements_space(),
        Channel.VEHICLE: _vehicle_space(),
        Channel.GPS: _gps_space(),
        Channel.CONNECTIVITY: spaces.Dict(
            {
                "online": spaces.Discrete(2),
                "kind": spaces.Discrete(len(NETWORKS)),
                "signal": spaces.Discrete(5),
            }
        ),
        Channel.CONTEXT: _bytes_space(CONTEXT_BYTES),
        Channel.CAMERA: _bytes_space(VIEW_HEIGHT, VIEW_WIDTH, 3),
    }
    return spaces.Dict(
        {
            "goal": _bytes_space(GOAL_BYTES),
            "said": _bytes_space(SAID_BYTES),
            "time_s": spaces.Box(0, 1e6, (), np.float64),
            "feedback": spaces.Dict(
                {"code": spaces.Discrete(len(FeedbackCode)), "text": _bytes_space(FEEDBACK_BYTES)}
            ),
        }
        | {str(channel): space for channel, space in known.items() if channel in channels}
        | (heard if with_sound else {})
    )


def action_space(width: int, height: int) -> spaces.Dict:
    """The action space. ``target`` says whether ``index`` or ``x``, ``y`` is used; an action type ignores fields
    that it does not take, so every sample is well formed."""
    return spaces.Dict(
        {
            "action_type": spaces.Discrete(len(UNCALLED)),
            "target": spaces.Discrete(2),
            "index": spaces.Discrete(MAX_ELEMENTS),
            "x": spaces.Discrete(width),
            "y": spaces.Discrete(height),
            "direction": spaces.Discrete(len(Direction)),
            "text": _AnyText(TEXT_LIMIT, min_length=0),
            "clear_text": spaces.Discrete(2),
            "app": spaces.Discrete(len(APPS)),
            "seconds": spaces.Discrete(SECONDS_LIMIT, start=1),
            "goal_status": spaces.Discrete(len(GoalStatus)),
            "reason": spaces.Discrete(len(Reason)),
            "alert_kind": spaces.Discrete(len(AlertKind)),
            "severity": spaces.Discrete(len(Severity)),
            "speed": spaces.Discrete(41),
            "on": spaces.Discrete(2),
        }
    )


def decode_action(value: Mapping[str, Any]) -> Action:
    """An action of the space as a typed one. ``speed`` counts in steps of 5 km/h, 0 for none in an alert.

    Raises ActionError: it is not one of the space."""
    try:
        return check(_decoded(value))
    except KeyError as error:
        raise ActionError(f"the action lacks {error}; it has {', '.join(action_space(1, 1))}") from error
    except (TypeError, ValueError, OverflowError) as error:
        raise ActionError(f"the action is not one of the action space: {error}") from error


def _decoded(value: Mapping[str, Any]) -> Action:
    kind = _member(ActionType, value, "action_type")
    takes = FIELDS[kind]
    speed_kmh = float(int(value["speed"]) * SPEED_STEP_KMH)
    by_index = int(value["target"]) == 0
    index, x, y = int(value["index"]), int(value["x"]), int(value["y"])
    offered = {
        "index": index if by_index else None,
        "text": str(value["text"]),
        "clear_text": bool(value["clear_text"]),
        "direction": _member(Direction, value, "direction"),
        "distance_px": None,
        "app_name": _member(APPS, value, "app"),
        "seconds": int(value["seconds"]),
        "goal_status": _member(GoalStatus, value, "goal_status"),
        "reason": _member(Reason, value, "reason"),
        "kind": _member(AlertKind, value, "alert_kind"),
        "severity": _member(Severity, value, "severity"),
        "speed_kmh": (speed_kmh or None) if kind is ActionType.SHOW_ALERT else speed_kmh,
        "on": bool(value["on"]),
        "destination": str(value["text"]),
    }
    target = ({"index": index} if by_index else {"x": x, "y": y}) if takes.target else {}
    taken = {name: offered[name] for name in takes.required + takes.optional}
    return Action(kind, **(target | taken))  # type: ignore[arg-type]


def _member(of: Iterable[T], value: Mapping[str, Any], name: str) -> T:
    members, index = tuple(of), int(value[name])
    if not 0 <= index < len(members):
        raise ActionError(f"the action's {name} is {shown(index)}; it goes from 0 to {len(members) - 1}")
    return members[index]


def encode(observation: Observation, channels: frozenset[Channel]) -> dict[str, Any]:
    """A typed observation as a sample of ``observation_space(channels, ...)``; fresh arrays each call.

    Texts are cut to their space's bytes, the element list to its first 128 entries, numbers to ``BOUNDS``.
    """
    encoded: dict[str, Any] = {
        "goal": _bytes(observation.goal, GOAL_BYTES),
        "said": _bytes(_latest(observation.said), SAID_BYTES),
        "time_s": np.array(observation.time_s, np.float64),
        "feedback": {
            "code": tuple(FeedbackCode).index(observation.feedback.code),
            "text": _bytes(observation.feedback.text, FEEDBACK_BYTES),
        },
    }
    if Channel.SCREENSHOT in channels and observation.screenshot is not None:
        encoded["screenshot"] = observation.screenshot.copy()
    if Channel.CAMERA in channels and observation.camera is not None:
        encoded["camera"] = observation.camera.copy()
    if Channel.ELEMENTS in channels:
        encoded["elements"] = _encode_elements(observation.elements or ())
    if Channel.VEHICLE in channels and observation.vehicle is not None:
        encoded["vehicle"] = _encode_vehicle(observation.vehicle)
    if Channel.GPS in channels:
        encoded["gps"] = _encode_gps(observation.gps)
    if Channel.CONNECTIVITY in channels and observation.connectivity is not None:
        link = observation.connectivity
        encoded["connectivity"] = {
            "online": int(link.online),
            "kind": NETWORKS.index(link.kind),
            "signal": link.signal_bars,
        }
    if Channel.CONTEXT in channels:
        encoded["context"] = _bytes(observation.context or "", CONTEXT_BYTES)
    if observation.sounds:
        encoded["sound"] = _encode_sounds(observation.sounds)
    return encoded


def decode(encoded: Mapping[str, Any]) -> Observation:
    """The typed observation behind a sample of the space, as far as the space contains it."""
    feedback = encoded["feedback"]
    return Observation(
        goal=_text(encoded["goal"]),
        said=tuple(_text(encoded["said"]).splitlines()),
        time_s=float(encoded["time_s"]),
        feedback=Feedback(tuple(FeedbackCode)[int(feedback["code"])], _text(feedback["text"])),
        elements=_decode_elements(encoded["elements"]) if "elements" in encoded else None,
        screenshot=encoded.get("screenshot"),
        camera=encoded.get("camera"),
        vehicle=_decode_vehicle(encoded["vehicle"]) if "vehicle" in encoded else None,
        connectivity=_decode_connectivity(encoded["connectivity"]) if "connectivity" in encoded else None,
        gps=_decode_gps(encoded["gps"]) if "gps" in encoded else None,
        context=_text(encoded["context"]) if "context" in encoded else None,
    )


# --- elements ---------------------------------------------------------------------------------------------


def _elements_space() -> spaces.Dict:
    many = MAX_ELEMENTS
    return spaces.Dict(
        {
            "count": spaces.Discrete(many + 1),
            "bbox": spaces.Box(-32768, 32767, (many, 4), np.int16),
            "kind": _bytes_space(many),
            "flags": spaces.MultiBinary((many, len(FLAGS))),
            "text": _bytes_space(many, ELEMENT_TEXT_BYTES),
            "description": _bytes_space(many, ELEMENT_TEXT_BYTES),
            "resource_id": _bytes_space(many, RESOURCE_ID_BYTES),
        }
    )


_TEXTS = {"text": ELEMENT_TEXT_BYTES, "description": ELEMENT_TEXT_BYTES, "resource_id": RESOURCE_ID_BYTES}


def _encode_elements(elements: Sequence[Element]) -> dict[str, Any]:
    count = min(len(elements), MAX_ELEMENTS)
    encoded: dict[str, Any] = {
        "count": count,
        "bbox": np.zeros((MAX_ELEMENTS, 4), np.int16),
        "kind": np.zeros(MAX_ELEMENTS, np.uint8),
        "flags": np.zeros((MAX_ELEMENTS, len(FLAGS)), np.int8),
        **{name: np.zeros((MAX_ELEMENTS, size), np.uint8) for name, size in _TEXTS.items()},
    }
    columns = zip(*map(_row, elements[:count]), strict=True)
    for name, column in zip(("bbox", "kind", "flags", *_TEXTS), columns, strict=bool(count)):
        array = encoded[name]
        array[:count] = np.frombuffer(b"".join(column), array.dtype).reshape(count, *array.shape[1:])
    return encoded


@lru_cache(maxsize=4096)
def _row(element: Element) -> tuple[bytes, ...]:
    """Of one element, in the order of the encoded fields; most of a screen is the same from step to step."""
    box = element.bbox_pixels
    words = (element.text, element.content_description, element.resource_id)
    return (
        np.array((box.x_min, box.y_min, box.x_max, box.y_max), np.int16).tobytes(),
        bytes((KINDS.index(element.class_name) if element.class_name in KINDS else 0,)),
        bytes(getattr(element, flag) for flag in FLAGS),
        *(_bytes(text, size).tobytes() for text, size in zip(words, _TEXTS.values(), strict=True)),
    )


def _decode_elements(encoded: Mapping[str, Any]) -> tuple[Element, ...]:
    return tuple(
        Element(
            text=_text(encoded["text"][row]),
            content_description=_text(encoded["description"][row]),
            class_name=KINDS[int(encoded["kind"][row])],
            bbox_pixels=BoundingBox(*(int(edge) for edge in encoded["bbox"][row])),
            resource_id=_text(encoded["resource_id"][row]),
            package_name="",
            **{flag: bool(encoded["flags"][row][column]) for column, flag in enumerate(FLAGS)},  # type: ignore[arg-type]
        )
        for row in range(int(encoded["count"]))
    )


# --- vehicle, GPS, connectivity ---------------------------------------------------------------------------


def _vehicle_space() -> spaces.Dict:
    known: dict[str, spaces.Space[Any]] = {
        "gear": spaces.Discrete(len(GEARS)),
        "restrictions": spaces.MultiBinary(RESTRICTION_BITS),
        "aboard": _bytes_space(ABOARD_BYTES),
        "noticed": _bytes_space(NOTICED_BYTES),
    }
    for field in fields(VehicleState):
        if field.name in BOUNDS:
            known[field.name] = spaces.Box(*BOUNDS[field.name], (), np.float32)
        elif field.name not in known:
            known[field.name] = spaces.Discrete(2)
    return spaces.Dict(known | {f"{name}_valid": spaces.Discrete(2) for name in OPTIONAL})


def _encode_vehicle(vehicle: VehicleState) -> dict[str, Any]:
    encoded: dict[str, Any] = {}
    for field in fields(VehicleState):
        value = getattr(vehicle, field.name)
        if field.name in OPTIONAL:
            encoded[f"{field.name}_valid"] = int(value is not None)
        if field.name in BOUNDS:
            low, high = BOUNDS[field.name]
            encoded[field.name] = np.array(min(high, max(low, value or 0.0)), np.float32)
        elif field.name == "gear":
            encoded["gear"] = GEARS.index(value)
        elif field.name == "restrictions":
            encoded["restrictions"] = np.array([value >> bit & 1 for bit in range(RESTRICTION_BITS)], np.int8)
        elif field.name == "aboard":
            encoded["aboard"] = _bytes(value, ABOARD_BYTES)
        elif field.name == "noticed":
            encoded["noticed"] = _bytes(value or "", NOTICED_BYTES)
        else:
            encoded[field.name] = int(value)
    return encoded


def _decode_vehicle(encoded: Mapping[str, Any]) -> VehicleState:
    values: dict[str, Any] = {}
    for field in fields(VehicleState):
        value = encoded[field.name]
        if field.name in OPTIONAL and not encoded[f"{field.name}_valid"]:
            values[field.name] = None
        elif field.name in BOUNDS:
            values[field.name] = float(value)
        elif field.name == "gear":
            values["gear"] = GEARS[int(value)]
        elif field.name == "restrictions":
            values["restrictions"] = sum(int(on) << bit for bit, on in enumerate(value))
        elif field.name == "aboard":
            values["aboard"] = _text(value)
        elif field.name == "noticed":
            values["noticed"] = _text(value)
        else:
            values[field.name] = bool(value)
    return VehicleState(**values)


def _gps_space() -> spaces.Dict:
    return spaces.Dict(
        {
            "available": spaces.Discrete(2),
            "fix": spaces.Discrete(2),
            "lon_lat": spaces.Box(np.array([-180.0, -90.0]), np.array([180.0, 90.0]), (2,), np.float64),
            "accuracy_m": spaces.Box(0, 1e5, (), np.float32),
            "age_s": spaces.Box(0, 1e6, (), np.float32),
            "heading_deg": spaces.Box(0, 360, (), np.float32),
        }
    )


def _encode_gps(gps: GpsFix | None) -> dict[str, Any]:
    fix = gps or GpsFix(False, 0.0, 0.0, 0.0, 0.0, 0.0)
    return {
        "available": int(gps is not None),
        "fix": int(fix.has_fix),
        "lon_lat": np.array([fix.lon_deg, fix.lat_deg], np.float64),
        "accuracy_m": np.array(min(fix.accuracy_m, 1e5), np.float32),
        "age_s": np.array(min(fix.age_s, 1e6), np.float32),
        "heading_deg": np.array(fix.heading_deg % 360, np.float32),
    }


def _decode_gps(encoded: Mapping[str, Any]) -> GpsFix | None:
    if not encoded["available"]:
        return None
    return GpsFix(
        bool(encoded["fix"]),
        float(encoded["lon_lat"][0]),
        float(encoded["lon_lat"][1]),
        float(encoded["accuracy_m"]),
        float(encoded["age_s"]),
        float(encoded["heading_deg"]),
    )


def _decode_connectivity(encoded: Mapping[str, Any]) -> Connectivity:
    return Connectivity(bool(encoded["online"]), NETWORKS[int(encoded["kind"])], int(encoded["signal"]))


# --- sound ------------------------------------------------------------------------------------------------


def _encode_sounds(sounds: tuple[bytes, ...]) -> dict[str, Any]:
    """The latest that fit, in order; of a longer one alone its beginning."""
    kept, length = list[npt.NDArray[np.int16]](), 0
    for sound in reversed(sounds):
        samples = _samples(sound)
        if kept and length + len(samples) > SOUND_SAMPLES:
            break
        kept.insert(0, samples[:SOUND_SAMPLES])
        length += len(kept[0])
    whole = np.zeros(SOUND_SAMPLES, np.int16)
    whole[:length] = np.concatenate(kept)
    return {"count": min(len(sounds), MOST_SOUNDS), "length": length, "samples": whole}


@lru_cache(maxsize=64)
def _samples(wav: bytes) -> npt.NDArray[np.int16]:
    with wave.open(io.BytesIO(wav)) as file:
        return np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(np.int16)


# --- texts ------------------------------------------------------------------------------------------------


def _bytes_space(*shape: int) -> spaces.Box:
    """A box of bytes. Those of one shape share their bounds: a screenshot's take four times its own size."""
    return copy(_first_bytes(shape))


@cache
def _first_bytes(shape: tuple[int, ...]) -> spaces.Box:
    """Nobody samples from this one, so copies have random generators of their own."""
    return spaces.Box(0, 255, shape, np.uint8)


def _latest(said: tuple[str, ...]) -> str:
    """The remarks on a line each, without the first ones if not all of them fit."""
    while len("\n".join(said).encode()) > SAID_BYTES:
        said = said[1:]
    return "\n".join(said)


def _bytes(text: str, size: int) -> npt.NDArray[np.uint8]:
    """UTF-8, cut between characters, zero-padded."""
    raw = text.encode()[:size].decode(errors="ignore").encode()
    padded = np.zeros(size, np.uint8)
    padded[: len(raw)] = np.frombuffer(raw, np.uint8)
    return padded


def _text(padded: npt.NDArray[np.uint8]) -> str:
    return padded.tobytes().rstrip(b"\0").decode()
