"""An agent's observations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from automotive_cosim.contracts.place import Connectivity, GpsFix

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


@dataclass(frozen=True, slots=True)
class BoundingBox:
    """A box in pixels with exclusive maxima, like AndroidWorld's ``bbox_pixels``."""

    x_min: int
    y_min: int
    x_max: int
    y_max: int


@dataclass(frozen=True, slots=True)
class Element:
    """One entry of the accessibility tree, like AndroidWorld's ``UIElement``. Its index is its position."""

    text: str
    content_description: str
    class_name: str
    bbox_pixels: BoundingBox
    resource_id: str
    package_name: str
    hint_text: str = ""
    is_checked: bool = False
    is_checkable: bool = False
    is_clickable: bool = False
    is_editable: bool = False
    is_enabled: bool = True
    is_focused: bool = False
    is_focusable: bool = False
    is_long_clickable: bool = False
    is_scrollable: bool = False
    is_selected: bool = False
    is_visible: bool = True


@dataclass(frozen=True, slots=True)
class VehicleState:
    """Readings of the car's own sensors and switches. A field that the car does not have is None."""

    speed_kmh: float
    gear: str
    """``"P"``, ``"R"``, ``"N"`` or ``"D"``."""
    restrictions: int
    """Android ``CarUxRestrictions`` bits; 0 while parked."""
    ambient_temperature_c: float
    cabin_temperature_c: float
    cabin_humidity_pct: float
    rain_intensity_pct: float
    driver_temperature_set_c: float
    fan_speed_pct: float
    is_low_beam_on: bool
    is_high_beam_on: bool
    is_front_fog_on: bool
    is_rear_fog_on: bool
    is_hazard_on: bool
    energy_level_pct: float
    range_km: float
    speed_limit_sign_kmh: float | None
    """Limit read by the sign camera; None without a camera or a sign."""
    leader_gap_m: float | None
    leader_time_to_collision_s: float | None
    aboard: str
    """Who sits where: ``driver: adult, 75 kg, awake, belted; rear left: pet, 24 kg, asleep, not belted``."""
    noticed: str | None = None
    """On a drive, what the car reads around, ahead and aboard, one ``name: words`` a line."""


class FeedbackCode(StrEnum):
    """Results of an action, in the order of the observation space."""

    NONE = "none"
    """Nothing has been done yet."""
    OK = "ok"
    NO_EFFECT = "no_effect"
    """Well formed and possible, but nothing changed (e.g. a tap that hit no widget)."""
    NO_SUCH_ELEMENT = "no_such_element"
    DISABLED = "disabled"
    RESTRICTED = "restricted"
    """Locked while driving."""
    REFUSED = "refused"
    """The car or the driver could not do it; the text says why."""
    MALFORMED = "malformed"
    READ_OUT = "read_out"
    """Done, and everybody in the car hears the text."""


@dataclass(frozen=True, slots=True)
class Feedback:
    """The result of the last action, as a code and in words."""

    code: FeedbackCode
    text: str


@dataclass(frozen=True, slots=True)
class Observation:
    """Everything an agent gets. A channel that it is not given is None."""

    goal: str
    time_s: float
    """Seconds since the hand-over."""
    feedback: Feedback
    said: tuple[str, ...] = ()
    """What the driver has said since the hand-over, in order: answers to questions, and remarks of his own."""
    on_watch: bool = False
    """Whether the goal is a drive's standing order, which holds until the drive is over."""
    elements: Sequence[Element] | None = None
    screenshot: npt.NDArray[np.uint8] | None = None
    """(height, width, 3), RGB."""
    camera: npt.NDArray[np.uint8] | None = None
    """The view through the windshield, or behind the car in reverse: (360, 640, 3), RGB."""
    vehicle: VehicleState | None = None
    connectivity: Connectivity | None = None
    gps: GpsFix | None = None
    context: str | None = None
    """The geo-context as text: facts and rules that apply here, never a judgement."""
    policy: str | None = None
    """The house rules, one a line; None if the agent is not told any."""
    sounds: tuple[bytes, ...] = ()
    """The wish and what was said since, each as a WAV file; empty where words come as text."""
