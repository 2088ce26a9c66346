"""Messages that change only what is shown: another screen, a part of it, and what is typed into its fields."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.restrictions import STRING_LIMIT
from automotive_cosim.cockpit.state import UNCHANGED, Command, Message, State
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say

BACKSPACE = "\b"
"""The letter that deletes one."""
FOLDED = say("The keyboard is hidden")


@dataclass(frozen=True, slots=True)
class Show(Message):
    """Go to a screen, optionally to one item on it."""

    screen: str
    item: str = ""

    def perform(self, state: State) -> Feedback:
        """The screen; the previous one can be returned to."""
        screen, item = self.screen, self.item
        if screen == state.screen and item in ("", state.picked.get(screen)):
            return Feedback(FeedbackCode.NO_EFFECT, say("{screen} is already shown", screen=screen))
        state.past = (*state.past[-8:], (state.screen, state.picked.get(state.screen, "")))
        if item and item != state.picked.get(screen):
            state.picked = {**state.picked, screen: item}
            state.rewind(f"{screen}.")
        state.enter(screen)
        return Feedback(FeedbackCode.OK, say("{screen} is shown", screen=item or screen))


@dataclass(frozen=True, slots=True)
class Back(Message):
    """Return to the previous screen."""

    def perform(self, state: State) -> Feedback:
        """The previous screen; with text in a field, first the screen without it."""
        if state.focus or state.typed:
            state.focus, state.typed = "", {}
            return Feedback(FeedbackCode.OK, say("the search is closed"))
        if not state.past:
            return Feedback(FeedbackCode.NO_EFFECT, say("there is no screen to go back to"))
        *past, (last, item) = state.past
        state.past = tuple(past)
        state.picked = {**state.picked, last: item} if item else state.picked
        state.enter(last)
        return Feedback(FeedbackCode.OK, say("{screen} is shown", screen=last))


@dataclass(frozen=True, slots=True)
class Pick(Message):
    """Show another part of a screen: select one of its choices."""

    key: str
    value: str
    rewinds: str = ""
    """Prefix of the lists whose content changes with it."""

    def perform(self, state: State) -> Feedback:
        """The part, with its lists at their start."""
        state.keyboard = False
        if state.picked.get(self.key) == self.value:
            return UNCHANGED
        if self.rewinds:
            state.rewind(self.rewinds)
        state.picked = {**state.picked, self.key: self.value}
        return Feedback(FeedbackCode.OK, say("It is shown"))


@dataclass(frozen=True, slots=True)
class Dismiss(Message):
    """Take the newest notice off the status bar, or with ``all`` every notice out of the list."""

    all: bool = False

    def perform(self, state: State) -> Feedback:
        if self.all:
            state.notices = ()
            return Feedback(FeedbackCode.OK, say("The notifications are cleared"))
        *rest, newest = state.notices
        state.notices = (*rest, replace(newest, seen=True))
        return Feedback(FeedbackCode.OK, say("The notification is dismissed"))


@dataclass(frozen=True, slots=True)
class Focus(Message):
    """Focus a text field and open the keyboard, or the microphone; empty closes the keyboard."""

    field: str
    spoken: bool = False

    def perform(self, state: State) -> Feedback:
        if (state.listening if self.spoken else state.is_typing) and state.focus == self.field:
            return UNCHANGED
        state.focus, state.keyboard, state.listening = self.field, bool(self.field) > self.spoken, self.spoken
        return Feedback(FeedbackCode.OK, say("The field takes text") if self.field else FOLDED)


@dataclass(frozen=True, slots=True)
class Key(Message):
    """Enter letters into a text field by a key; a backspace deletes one."""

    field: str
    letters: str

    def perform(self, state: State) -> Feedback:
        text = state.typed.get(self.field, "")
        longer = text[:-1] if self.letters == BACKSPACE else text + self.letters
        if longer == text:
            return Feedback(FeedbackCode.NO_EFFECT, say("there is nothing to delete"))
        write(state, self.field, longer)
        return Feedback(FeedbackCode.OK, say("the field reads {text}", text=repr(state.typed[self.field])))


@dataclass(frozen=True, slots=True)
class Enter(Message):
    """Press enter in a text field."""

    then: Message | None
    """The message to send; None while nothing matches the typed text."""

    @property
    def command(self) -> Command | None:
        return None if self.then is None else self.then.command

    def perform(self, state: State) -> Feedback:
        Focus("").perform(state)
        folded = Feedback(FeedbackCode.OK, FOLDED)
        if self.then is None:
            return folded
        done = self.then.perform(state)
        return folded if done.code is FeedbackCode.NO_EFFECT else done


def write(state: State, field: str, text: str) -> None:
    """Puts text into a field; lists return to their start."""
    printable = "".join(letter for letter in text if letter.isprintable())
    state.typed = {**state.typed, field: printable[:STRING_LIMIT]}
    state.scrolled = {}
