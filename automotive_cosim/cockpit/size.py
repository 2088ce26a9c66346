"""The sizes that the display comes in; what each part takes of them stands in ``room``."""

from __future__ import annotations

from enum import StrEnum

from automotive_cosim.cockpit.geometry import Rect


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
        return int(self.partition("x")[0])

    @property
    def height(self) -> int:
        return int(self.partition("x")[2])

    @property
    def whole(self) -> Rect:
        return Rect(0, 0, self.width, self.height)

    @property
    def bars(self) -> int:
        """Lines of the status bar, and of the dock."""
        return 2 if self is ScreenSize.PORTRAIT else 1
