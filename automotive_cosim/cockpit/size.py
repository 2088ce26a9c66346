"""The sizes that the display comes in, and what each part of it takes: status bar, app, companion, dock, keyboard.

| size | the app | beside it |
|---|---|---|
| ``1280x720`` | takes all the room | nothing |
| ``1920x720`` | as large as on 1280x720 | the companion, on the right |
| ``1080x1920`` | its panes one above the other | the companion, above it |

The companion is the map with what plays now (``picture``). Screens with a large map of their own take its
room as well. Status bar and dock have one line each, in portrait two.
"""

from __future__ import annotations

from enum import Enum, StrEnum

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.theme import DOCK_HEIGHT, GAP, MARGIN, STATUS_HEIGHT

APP_WIDTH, PANE_HEIGHT, KEYBOARD_HEIGHT = 1232, 544, 304


class Room(Enum):
    """What a screen needs."""

    ONE = "one pane"
    TWO = "two panes"
    WHOLE = "all the room, with no companion"


class ScreenSize(StrEnum):
    """A display's size in logical pixels, width before height."""

    STANDARD = "1280x720"
    """The usual one."""
    WIDE = "1920x720"
    """Wide, with map and music beside each app."""
    PORTRAIT = "1080x1920"
    """Portrait, with map and music above each app."""

    @property
    def width(self) -> int:
        """Width in logical pixels."""
        return int(self.partition("x")[0])

    @property
    def height(self) -> int:
        """Height in logical pixels."""
        return int(self.partition("x")[2])

    @property
    def whole(self) -> Rect:
        return Rect(0, 0, self.width, self.height)

    @property
    def bars(self) -> int:
        """Lines of the status bar, and of the dock."""
        return 2 if self is ScreenSize.PORTRAIT else 1

    @property
    def status(self) -> Rect:
        return self.whole.top(self.bars * STATUS_HEIGHT)

    @property
    def dock(self) -> Rect:
        return self.whole.bottom_part(self.bars * DOCK_HEIGHT)

    @property
    def keyboard(self) -> Rect:
        """The on-screen keyboard, while it is shown."""
        return self.whole.bottom_part(KEYBOARD_HEIGHT)

    def content(self, room: Room) -> Rect:
        """The area of a screen."""
        return self._areas(room)[0]

    def beside(self, room: Room) -> Rect | None:
        """The area of the companion; None without one."""
        return self._areas(room)[1]

    def _areas(self, room: Room) -> tuple[Rect, Rect | None]:
        _, whole, _ = column(self.whole.inset(MARGIN, 0), self.status.height + 8, REST, self.dock.height + 8)
        if room is Room.WHOLE or self is ScreenSize.STANDARD:
            return whole, None
        if self is ScreenSize.WIDE:
            app, _, companion = row(whole, APP_WIDTH, GAP, REST)
        else:
            companion, _, app = column(whole, REST, GAP, PANE_HEIGHT if room is Room.ONE else 2 * PANE_HEIGHT + GAP)
        return app, companion
