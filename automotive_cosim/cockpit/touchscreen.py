"""The display under a finger: what a touch does, how text is entered, and what is shown."""

from difflib import get_close_matches
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit import accessibility
from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.map.commands import Pan
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.display import Display
from automotive_cosim.cockpit.make import HOME, Make
from automotive_cosim.cockpit.messages import Back, Key, Show, write
from automotive_cosim.cockpit.picture import picture
from automotive_cosim.cockpit.registry import apps, by_any_name, docked, pages
from automotive_cosim.cockpit.restrictions import REASONS, Restriction
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.tree import opens
from automotive_cosim.cockpit.widgets import Button, Field, MapView, Rows, Screen, Slider, Widget
from automotive_cosim.contracts import Direction, Element, Feedback, FeedbackCode
from automotive_cosim.contracts.text import say, say_in
from automotive_cosim.errors import UnknownNameError

W = TypeVar("W", bound=Widget)

DIRECTIONS = {
    Direction.UP: say_in("towards", "up"),
    Direction.DOWN: say_in("towards", "down"),
    Direction.LEFT: say_in("towards", "left"),
    Direction.RIGHT: say_in("towards", "right"),
}
OPPOSITE = {
    Direction.UP: Direction.DOWN,
    Direction.DOWN: Direction.UP,
    Direction.LEFT: Direction.RIGHT,
    Direction.RIGHT: Direction.LEFT,
}
"""The scroll direction of a swipe."""
PAN_SHARE = 0.4
"""Share of the map's width and height moved by one swipe."""


class Touchscreen:
    """The display of a cockpit. A touch answers with a ``Feedback``; a wrong one changes nothing."""

    _state: State
    _display: Display
    _tree: Screen | None

    def resize(self, size: ScreenSize, make: Make | None = None) -> None:
        """Takes a display of this size, and of a make if one is given, unless it has that already."""
        if size is not self._state.size:
            self._state.size, self._tree = size, None
            self._display = Display(1.0)
        if make is not None and make is not self._state.make:
            self._state.make, self._tree = make, None

    # --- fingers ------------------------------------------------------------------------------------------

    def tap(self, x: int, y: int) -> Feedback:
        """A short touch at a pixel of the screenshot."""
        logical = self._logical(x, y)
        widget = self._screen.at(*logical)
        if widget is None:
            return Feedback(FeedbackCode.NO_EFFECT, say("nothing at ({x}, {y}) reacts to a tap", x=x, y=y))
        if not widget.usable:
            return self._unusable(widget)
        if isinstance(widget, Slider):
            return self._perform(widget.message_at(logical[0]))
        assert widget.on_tap is not None
        return self._perform(widget.on_tap)

    def double_tap(self, x: int, y: int) -> Feedback:
        """A double tap: zooms into the map; elsewhere, it is two taps."""
        widget = self._screen.at(*self._logical(x, y)) or self._under(x, y, MapView)
        if isinstance(widget, MapView) and widget.on_double_tap is not None:
            return self._perform(widget.on_double_tap)
        first = self.tap(x, y)
        return self.tap(x, y) if first.code is FeedbackCode.OK else first

    def long_press(self, x: int, y: int) -> Feedback:
        """A long press: minus and plus, wherever they are, go several steps at once; nothing else reacts to it."""
        widget = self._screen.at(*self._logical(x, y))
        if widget is not None and not widget.usable:
            return self._unusable(widget)
        if isinstance(widget, Button) and widget.on_hold is not None:
            return self._perform(widget.on_hold)
        return Feedback(FeedbackCode.NO_EFFECT, say("nothing at ({x}, {y}) reacts to a long press", x=x, y=y))

    def swipe(self, x: int, y: int, direction: Direction, distance_px: int | None = None) -> Feedback:
        """Drags the widget under the finger: a slider, a list or the map.

        Args:
            x: where the finger touches, in pixels of the screenshot.
            y: where the finger touches, in pixels of the screenshot.
            distance_px: its length. A slider takes the value where the finger lifts, a list moves by the rows
                passed, the map moves along. Without it: a tenth of the range, a page, over a third of the map."""
        far = None if distance_px is None else distance_px / self._scale
        slider = self._under(x, y, Slider)
        if slider is not None and direction in (Direction.LEFT, Direction.RIGHT):
            if not slider.usable:
                return self._unusable(slider)
            way = 1 if direction is Direction.RIGHT else -1
            if far is not None:
                return self._perform(slider.message_at(x / self._scale + way * far))
            tenth = max(1, round((slider.signal.high - slider.signal.low) / slider.signal.step / 10))
            return self._perform(slider.message_by(way * tenth))
        rows = self._under(x, y, Rows)
        if rows is not None:
            return self._scroll(rows, OPPOSITE[direction], far)
        view = self._under(x, y, MapView)
        if view is not None and view.pans:
            return self._pan(view, OPPOSITE[direction], far)
        return Feedback(
            FeedbackCode.NO_EFFECT,
            say("nothing at ({x}, {y}) moves {direction}", x=x, y=y, direction=DIRECTIONS[direction]),
        )

    def scroll(self, key: str, direction: Direction) -> Feedback:
        """Scrolls a list by a page; ``down`` reveals what is below.

        Args:
            key: of the list or of something in it; empty for the first list on the screen."""
        lists = [widget for widget in self._screen.walk() if isinstance(widget, Rows)]
        if key:
            if all(widget.key != key for widget in self._screen.walk()):
                return Feedback(FeedbackCode.NO_SUCH_ELEMENT, say("{name} is not on the screen", name=key))
            view = next((w for w in self._screen.walk() if w.key == key and isinstance(w, MapView)), None)
            if view is not None and view.pans:
                return self._pan(view, direction)
            lists = [rows for rows in lists if any(widget.key == key for widget in rows.walk())]
        if not lists:
            return Feedback(FeedbackCode.NO_EFFECT, say("there is nothing to scroll here"))
        return self._scroll(lists[0], direction)

    def type_text(self, text: str, clear: bool = False) -> Feedback:
        """Enters text into the focused field at once and closes the keyboard; one that listens is spoken to."""
        field = next((widget for widget in self._screen.walk() if isinstance(widget, Field)), None)
        if field is None or not field.focused:
            return self._nowhere_to_type(field)
        if field.locked:
            return self._unusable(field)
        kept = "" if clear else field.text
        write(self._state, field.key, kept + text)
        self._state.keyboard = self._state.listening = False
        self._tree = None
        return Feedback(FeedbackCode.OK, say("the field reads {text}", text=repr(self._state.typed[field.key])))

    def key_enter(self) -> Feedback:
        """Presses enter in the focused field, which usually selects the first result."""
        if Restriction.NO_KEYBOARD in self._state.restrictions:
            return Feedback(FeedbackCode.RESTRICTED, REASONS[Restriction.NO_KEYBOARD])
        field = next((widget for widget in self._screen.walk() if isinstance(widget, Field)), None)
        if field is None or not field.focused:
            return self._nowhere_to_type(field)
        if field.on_enter is None:
            return Feedback(FeedbackCode.REFUSED, field.lacking)
        self._state.focus = ""
        return self._perform(field.on_enter)

    def _nowhere_to_type(self, field: Field | None) -> Feedback:
        """Why nothing can be typed, and what to do where something can."""
        if field is not None:
            why = say("no text field has the focus; tap one first")
        elif any(isinstance(widget.on_tap, Key) for widget in self._screen.walk()):
            why = say("there is no text field here; press the keys on the screen one by one")
        else:
            why = say("there is no text field here")
        return Feedback(FeedbackCode.NO_SUCH_ELEMENT, why)

    def home(self) -> Feedback:
        return self.open_app("home")

    def back(self) -> Feedback:
        return self._perform(Back())

    def open_app(self, name: str) -> Feedback:
        wanted, make = " ".join(name.casefold().split()), self._state.make
        if make is not HOME:
            known = opens(make)
            if wanted in known:
                return self._perform(Show(known[wanted]))
            missing, offered = repr(name[:40]), ", ".join(dict.fromkeys(known.values()))
            words = say("no app is named {name}; choose from {apps}", name=missing, apps=offered)
            return Feedback(FeedbackCode.NO_SUCH_ELEMENT, words)
        if wanted not in by_any_name():
            page_of = docked().get(wanted)
            if page_of is not None:
                return Feedback(
                    FeedbackCode.NO_SUCH_ELEMENT,
                    say("{name} is not an app; it is a page of {app}", name=wanted, app=page_of),
                )
            close = get_close_matches(wanted, apps(), n=1)
            missing = repr(name[:40])
            return Feedback(
                FeedbackCode.NO_SUCH_ELEMENT,
                say("no app is named {name}: did you mean {other}?", name=missing, other=repr(close[0]))
                if close
                else say("no app is named {name}; choose from {apps}", name=missing, apps=", ".join(apps())),
            )
        app, part = by_any_name()[wanted]
        if apps()[app].where is Where.STORE and app not in self._state.of(Installed).apps:
            return Feedback(FeedbackCode.REFUSED, say("{app} is not installed; the store has it", app=app))
        return self._perform(Show(app, part))

    def visit(self, screen: str) -> Feedback:
        """Shows any screen by its name directly, for pictures and studies.

        Raises UnknownNameError: no such screen."""
        known = {*pages(), *self._state.make.screens}
        if screen not in known:
            raise UnknownNameError("screen", screen, known)
        return self._perform(Show(screen))

    # --- what is shown ------------------------------------------------------------------------------------

    @property
    def screen(self) -> str:
        """Name of the present screen."""
        return self._state.screen

    @property
    def size(self) -> ScreenSize:
        return self._state.size

    @property
    def tree(self) -> Screen:
        """The widgets on the display."""
        return self._screen

    def elements(self) -> tuple[Element, ...]:
        return self._display.elements(self._screen)

    def drawn(self) -> tuple[Element, ...]:
        """The same list with only the texts that the picture shows, for a reference that works by pixels."""
        return accessibility.drawn(self._screen, self._scale)

    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The display, (height, width, 3), RGB, read-only; the same array as long as nothing changes."""
        return self._display.screenshot(self._screen)

    def touched(self, x: int, y: int) -> Widget | None:
        """The widget that a tap at a pixel of the screenshot would reach."""
        return self._screen.at(*self._logical(x, y))

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _screen(self) -> Screen:
        if self._tree is None:
            self._tree = picture(self._state)
        return self._tree

    @property
    def _scale(self) -> float:
        return self._display.scale

    def _logical(self, x: int, y: int) -> tuple[float, float]:
        return x / self._scale, y / self._scale

    def _perform(self, message: Message) -> Feedback:
        self._tree = None
        return self._state.perform(message)

    def _unusable(self, widget: Widget) -> Feedback:
        if widget.locked:
            return Feedback(FeedbackCode.RESTRICTED, widget.locked)
        return Feedback(FeedbackCode.DISABLED, widget.disabled)

    def _scroll(self, rows: Rows, direction: Direction, far: float | None = None) -> Feedback:
        """Scrolls by a page, or by the rows in a number of logical pixels."""
        by = max(1, rows.shown - 1 if far is None else round(far * rows.shown / rows.rect.height))
        step = by * {Direction.DOWN: 1, Direction.UP: -1}.get(direction, 0)
        first = min(rows.last_first, max(0, rows.first + step))
        if first == rows.first:
            return Feedback(
                FeedbackCode.NO_EFFECT,
                say(
                    "{list} cannot move further {direction}", list=rows.description, direction=DIRECTIONS[direction]
                ),
            )
        self._state.scrolled = {**self._state.scrolled, rows.key: first}
        self._tree = None
        return Feedback(
            FeedbackCode.OK,
            say(
                "{list} shows rows {first} to {last} of {total}",
                list=rows.description,
                first=first + 1,
                last=first + rows.shown,
                total=rows.total,
            ),
        )

    def _pan(self, view: MapView, direction: Direction, far: float | None = None) -> Feedback:
        """Pans by a number of logical pixels, or by over a third of the visible map."""
        across = {Direction.RIGHT: 1, Direction.LEFT: -1}.get(direction, 0)
        down = {Direction.DOWN: 1, Direction.UP: -1}.get(direction, 0)
        wide, high = (PAN_SHARE * view.rect.width, PAN_SHARE * view.rect.height) if far is None else (far, far)
        return self._perform(Pan(across * wide, down * high))

    def _under(self, x: int, y: int, kind: type[W]) -> W | None:
        """The uppermost widget of a kind under a pixel."""
        logical = self._logical(x, y)
        found = [w for w in self._screen.walk() if isinstance(w, kind) and w.rect.contains(*logical)]
        return found[-1] if found else None
