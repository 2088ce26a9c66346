"""What each part of the display takes at its sizes (``size``): status bar, app, companion, dock, keyboard.

| size | the app | beside it |
|---|---|---|
| ``1280x720`` | takes all the room | nothing |
| ``1920x720`` | as large as on 1280x720 | the companion, on the right |
| ``1080x1920`` | its panes one above the other | the companion, above it |

The companion is the map with what plays now (``picture``). Screens with a large map of their own take its
room as well. Status bar and dock have one line each, in portrait two.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, StrEnum

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import FULL, REST, column, row
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.theme import DOCK_HEIGHT, GAP, MARGIN, STATUS_HEIGHT

APP_WIDTH, PANE_HEIGHT, KEYBOARD_HEIGHT = FULL, 544, 304
SIDE_WIDTH, SIDE_MARGIN = 96, 12
"""Width of a dock at a side, and the margin of the screen beside it."""


class Room(Enum):
    """What a screen needs."""

    ONE = "one pane"
    TWO = "two panes"
    WHOLE = "all the room, with no companion"


class DisplayEdge(StrEnum):
    """An edge of the display."""

    ABOVE = "above"
    BELOW = "below"
    LEFT = "left"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Frame:
    """Where each part of a display lies."""

    size: ScreenSize = ScreenSize.STANDARD
    bar: DisplayEdge = DisplayEdge.BELOW
    """Where the dock is, inside the status bar if both are there; in portrait, one at a side is below."""
    status_at: DisplayEdge = DisplayEdge.ABOVE

    @property
    def upright(self) -> bool:
        """Whether the dock's entries stand one above the other."""
        return self.bar in (DisplayEdge.LEFT, DisplayEdge.RIGHT) and self.size is not ScreenSize.PORTRAIT

    @property
    def status(self) -> Rect:
        return _strip(self.size.whole, self.status_at, self.size.bars * STATUS_HEIGHT)[0]

    @property
    def dock(self) -> Rect:
        return self._split[0]

    @property
    def keyboard(self) -> Rect:
        """The on-screen keyboard, while it is shown."""
        return _strip(self.size.whole, self.status_at, self.status.height)[1].bottom_part(KEYBOARD_HEIGHT)

    def content(self, room: Room) -> Rect:
        """The area of a screen."""
        return self._areas(room)[0]

    def beside(self, room: Room) -> Rect | None:
        """The area of the companion; None without one."""
        return self._areas(room)[1]

    @property
    def _split(self) -> tuple[Rect, Rect]:
        """The dock, and what it and the status bar leave."""
        rest = _strip(self.size.whole, self.status_at, self.status.height)[1]
        if self.upright:
            return _strip(rest, self.bar, SIDE_WIDTH)
        bar = self.bar if self.bar is DisplayEdge.ABOVE else DisplayEdge.BELOW
        return _strip(rest, bar, self.size.bars * DOCK_HEIGHT)

    def _areas(self, room: Room) -> tuple[Rect, Rect | None]:
        whole = self._split[1].inset(SIDE_MARGIN if self.upright else MARGIN, 8)
        if room is Room.WHOLE or self.size is ScreenSize.STANDARD:
            return whole, None
        if self.size is ScreenSize.WIDE:
            app, _, companion = row(whole, APP_WIDTH, GAP, REST)
        else:
            companion, _, app = column(whole, REST, GAP, PANE_HEIGHT if room is Room.ONE else 2 * PANE_HEIGHT + GAP)
        return app, companion


def _strip(rect: Rect, at: DisplayEdge, thick: int) -> tuple[Rect, Rect]:
    """A strip along an edge of a box, and the rest."""
    match at:
        case DisplayEdge.ABOVE:
            return rect.top(thick), rect.below(thick)
        case DisplayEdge.BELOW:
            return rect.bottom_part(thick), rect.top(rect.height - thick)
        case DisplayEdge.LEFT:
            return rect.left(thick), rect.right_part(rect.width - thick)
        case DisplayEdge.RIGHT:
            return rect.right_part(thick), rect.left(rect.width - thick)
