"""The one widget tree: drawn, listed for accessibility and hit by fingers.

Widgets are frozen data with absolute boxes; a parent's children lie within it and are drawn after it. ``key`` is
its name in the code (``climate.front_defroster``), from which its resource id is made (``contracts.ids``). A widget
says something (``on_tap``) only by a message.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, ClassVar, Literal, TypeVar

from automotive_cosim.cockpit.camera import CameraScene
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.mapdraw import MapScene
from automotive_cosim.cockpit.photos import Photo
from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.cockpit.state import Message
from automotive_cosim.cockpit.telltales import RoadSign, Telltale
from automotive_cosim.cockpit.theme import HOME_STYLE, Icon, Palette, Style, Type
from automotive_cosim.contracts import Severity
from automotive_cosim.contracts.text import say

if TYPE_CHECKING:
    from dataclasses import dataclass as frozen
else:
    W = TypeVar("W")

    def frozen(**options: bool) -> Callable[[type[W]], type[W]]:
        """Makes a dataclass that only type checkers hold to be frozen: one that is frozen when it runs takes three
        times as long to make, and a step makes a hundred widgets."""
        return dataclass(unsafe_hash=options.pop("frozen"), **options)


NOWHERE = Rect(0, 0, 0, 0)
"""The box of a widget until ``flow.fill`` gives it one."""
Tone = Literal["text", "muted", "accent", "good", "warning"]
"""A colour of the palette."""


@frozen(frozen=True, slots=True, kw_only=True)
class Widget:
    """Common fields of all widgets."""

    rect: Rect = NOWHERE
    key: str = ""
    text: str = ""
    description: str = ""
    """Description for a reader who does not see its icon."""
    on_tap: Message | None = None
    disabled: str = ""
    """Why it cannot be used now; empty if it can."""
    locked: str = ""
    """Why it is locked while driving; empty if it is not."""
    children: tuple[Widget, ...] = ()

    class_name: ClassVar[str] = "View"

    @property
    def usable(self) -> bool:
        """Whether it is neither disabled nor locked."""
        return not (self.disabled or self.locked)

    def walk(self) -> Iterator[Widget]:
        """Itself and all its descendants, in drawing order. One generator for speed: screens are walked often."""
        ahead: list[Widget] = [self]
        while ahead:
            widget = ahead.pop()
            yield widget
            ahead.extend(reversed(widget.children))

    def at(self, x: float, y: float) -> Widget | None:
        """The uppermost widget under a point that reacts to touch."""
        if not self.rect.contains(x, y):
            return None
        for child in reversed(self.children):
            hit = child.at(x, y)
            if hit is not None:
                return hit
        return self if self.listens else None

    @property
    def listens(self) -> bool:
        """Whether a tap does something."""
        return self.on_tap is not None

    @property
    def touched(self) -> Rect:
        """Its bounds in a list of elements."""
        return self.rect


@frozen(frozen=True, slots=True, kw_only=True)
class Screen(Widget):
    """The whole picture."""

    night: bool
    dock: Rect
    """The dock's ground."""
    style: Style = HOME_STYLE

    @property
    def palette(self) -> Palette:
        """The colours of this hour."""
        return self.style.night if self.night else self.style.day


@frozen(frozen=True, slots=True, kw_only=True)
class Card(Widget):
    """A surface that groups other widgets."""

    look: Literal["surface", "raised", "plate", "none"] = "surface"


@frozen(frozen=True, slots=True, kw_only=True)
class Label(Widget):
    """Text."""

    style: Type = Type.BODY
    tone: Tone = "text"
    align: Literal["left", "centre", "right"] = "left"
    lines: int = 1
    plate: bool = False
    """Whether it has a background of its own, as on the map."""
    keeps_end: bool = False
    """Whether it loses its beginning, not its end, where it is too long to be drawn."""

    class_name: ClassVar[str] = "TextView"


@frozen(frozen=True, slots=True, kw_only=True)
class Glyph(Widget):
    """An icon; listed only if it has a description."""

    icon: Icon
    size: int = 28
    tone: Tone = "text"

    class_name: ClassVar[str] = "ImageView"


class Look(Enum):
    """Emphasis of a button."""

    PLAIN = "plain"
    TONAL = "tonal"
    FLOATING = "floating"
    ACCENT = "accent"
    CRITICAL = "critical"


@frozen(frozen=True, slots=True, kw_only=True)
class Button(Widget):
    """Does something when tapped."""

    icon: Icon | None = None
    icon_size: int = 28
    look: Look = Look.TONAL
    style: Type = Type.LABEL
    stacked: bool = False
    """Whether the icon is above the text."""
    on_hold: Message | None = None
    """Message of a long press."""

    class_name: ClassVar[str] = "Button"


@frozen(frozen=True, slots=True, kw_only=True)
class Choice(Widget):
    """One of several, of which one is selected."""

    icon: Icon | None = None
    selected: bool = False
    look: Literal["plain", "boxed", "quiet"] = "plain"
    """Style when not selected: on its group's background, on its own background, or muted."""
    stacked: bool = False
    style: Type = Type.LABEL

    class_name: ClassVar[str] = "RadioButton"


@frozen(frozen=True, slots=True, kw_only=True)
class Tile(Widget):
    """A large switch."""

    icon: Icon
    checked: bool = False
    level: str = ""
    """Text next to the name if on and off do not say enough."""
    levels: str = ""
    """All levels in the order in which taps go round, if there are several."""
    read: str = ""
    """Name and level as a list of elements has them, if there is a level."""

    class_name: ClassVar[str] = "Switch"


@frozen(frozen=True, slots=True, kw_only=True)
class Slider(Widget):
    """Sets a number by the position of the touch."""

    signal: Signal[float]
    value: float
    icon: Icon | None = None

    class_name: ClassVar[str] = "SeekBar"

    @property
    def listens(self) -> bool:
        """True: a slider always does."""
        return True

    @property
    def track(self) -> Rect:
        """The part that represents the range."""
        return Rect(self.rect.x + 20, self.rect.bottom - 26, self.rect.width - 40, 8)

    @property
    def touched(self) -> Rect:
        """As wide as the track, so that a touch at a share of its width sets that share of the range."""
        return Rect(self.track.x, self.rect.y, self.track.width, self.rect.height)

    def message_at(self, x: float) -> Message:
        """The message of a touch at a column."""
        share = min(1.0, max(0.0, (x - self.track.x) / self.track.width))
        low, high, step = self.signal.low, self.signal.high, self.signal.step
        return Set(self.signal, low + round(share * (high - low) / step) * step)

    def message_by(self, steps: int) -> Message:
        """The message of dragging it by a number of steps."""
        value = self.value + steps * self.signal.step
        return Set(self.signal, min(self.signal.high, max(self.signal.low, value)))


@frozen(frozen=True, slots=True, kw_only=True)
class Field(Widget):
    """A text field."""

    hint: str = ""
    icon: Icon = Icon.SEARCH
    focused: bool = False
    on_enter: Message | None = None
    """Message of the enter key; None while nothing matches the typed text."""
    enters: str = say("Take the first result")
    """What the enter key does."""
    lacking: str = say("No matches yet")
    """Why it does nothing, if it has no message."""

    class_name: ClassVar[str] = "EditText"


@frozen(frozen=True, slots=True, kw_only=True)
class Row(Widget):
    """A line of a list."""

    icon: Icon | None = None
    detail: str = ""
    trail: str = ""
    """Text at the right end."""
    raised: bool = False
    """Whether it is on a card, which has the background of other rows."""
    selected: bool = False
    tone: Tone = "accent"
    """Colour of the icon."""

    class_name: ClassVar[str] = "Button"


@frozen(frozen=True, slots=True, kw_only=True)
class Rows(Widget):
    """A list that scrolls by whole rows; its children are the visible rows."""

    first: int = 0
    """Index of the first visible row."""
    shown: int = 0
    total: int = 0

    class_name: ClassVar[str] = "ListView"

    @property
    def last_first(self) -> int:
        """Maximum scroll position."""
        return max(0, self.total - self.shown)


@frozen(frozen=True, slots=True, kw_only=True)
class Bar(Widget):
    """A bar that shows an amount."""

    share: float
    tone: Tone = "accent"


@frozen(frozen=True, slots=True, kw_only=True)
class LimitSign(Widget):
    """The limit sign the camera read last."""

    country: str = ""
    """Whose form it has."""

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class Telltales(Widget):
    """Tell-tales that are lit, line by line; as many as there is room for."""

    lit: tuple[Telltale, ...]

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class SignView(Widget):
    """The road sign that was read last."""

    sign: RoadSign | None
    figure: str = ""
    """The limit as it stands on the sign."""

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class Cover(Widget):
    """The cover of what plays. The list only says that there is one."""

    name: str
    """What it is made from."""

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class CameraView(Widget):
    """What a camera shows. The list only says which camera it is."""

    scene: CameraScene

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class Pill(Widget):
    """A notice in the status bar."""

    icon: Icon
    severity: Severity

    class_name: ClassVar[str] = "TextView"


@frozen(frozen=True, slots=True, kw_only=True)
class Badge(Widget):
    """A mark on the map."""

    icon: Icon
    warns: bool = False
    """Whether it has the colour of warnings."""
    charges: bool = False
    """Whether it is a charging stop, which only the picture shows."""

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class MapView(Widget):
    """The moving map."""

    roads: RoadMap
    scene: MapScene
    on_double_tap: Message | None = None
    pans: bool = False
    """Whether a swipe moves it."""


@frozen(frozen=True, slots=True, kw_only=True)
class Picture(Widget):
    """A photo, whose content no text tells."""

    photo: Photo

    class_name: ClassVar[str] = "ImageView"


@frozen(frozen=True, slots=True, kw_only=True)
class CarView(Widget):
    """The car from above with its lamps and its glass."""

    position: bool
    low: bool
    high: bool
    front_fog: bool
    rear_fog: bool
    hazard: bool
    windshield: int
    """Opacity in tenths."""
    rear_window: int

    class_name: ClassVar[str] = "ImageView"
