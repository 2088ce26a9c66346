"""Memos: the recorder, and one memo with its removal."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import back, content, gone, heading, note, picked_at, rows, title
from automotive_cosim.cockpit.commands import Put, Remove, SimpleCommand
from automotive_cosim.cockpit.flow import card, fill, grid, panels, stack
from automotive_cosim.cockpit.functions import CallMade, named, offered, unknown
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import minutes
from automotive_cosim.cockpit.widgets import Button, Glyph, Label, Look, Row, Widget
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class Memos(AppData):
    """The memos, and the one that is being recorded."""

    kept: tuple[str, ...] = ()
    recording_since_s: float | None = None

    def commands(self) -> dict[str, Any]:
        """The memos, and whether one is being recorded."""
        return {"apps.memos": list(self.kept), "apps.recording": self.recording_since_s is not None}


def _record(state: State) -> Feedback:
    """Begin or end a spoken memo."""
    memos = state.of(Memos)
    if memos.recording_since_s is None:
        state.keep(replace(memos, recording_since_s=state.time_s))
        return Feedback(FeedbackCode.OK, say("the memo is being recorded"))
    seconds = int(state.time_s - memos.recording_since_s)
    memo = say(
        "Memo {number}, {time}, {length}",
        number=len(memos.kept) + 1,
        time=state.clock,
        length=f"{seconds // 60}:{seconds % 60:02d}",
    )
    state.keep(Memos((*memos.kept, memo)))
    return Feedback(FeedbackCode.OK, say("{memo} is kept", memo=memo))


RECORD = SimpleCommand(_record, ("apps.memos", "apps.recording"))


def memo(state: State) -> tuple[Widget, ...]:
    """Records spoken notes."""
    since, memos = state.of(Memos).recording_since_s, state.of(Memos).kept
    time = Label(
        key="memo.time",
        text=minutes(state.time_s - since) if since is not None else say("Ready"),
        description=say("Recording") if since is not None else say("Memo"),
        style=Type.HEADLINE,
        align="centre",
    )
    record = Button(
        key="memo.record",
        text=say("Record") if since is None else say("Stop"),
        icon=Icon.RECORD if since is None else Icon.STOP,
        icon_size=34,
        style=Type.TITLE,
        look=Look.ACCENT if since is None else Look.CRITICAL,
        on_tap=RECORD,
    )
    recorder = card(
        title(Icon.MEMO, say("Memo")),
        50,
        (128, Glyph(icon=Icon.MICROPHONE, size=112, tone="warning" if since is not None else "muted")),
        22,
        (52, time),
        REST,
        (88, record),
        padding=(28, 20),
    )

    def entry(index: int, text: str) -> Row:
        return Row(key=f"memo.{index}", text=text, trail=say("Details"), icon=Icon.MEMO, on_tap=Show("note", text))

    every = rows("memo.all", say("Memos"), state, memos, entry, height=60)
    listed = every if memos else note("memo.empty", say("No memos yet"))
    return fill(content(state), panels(recorder, stack((32, heading(say("Memos"))), 12, (REST, listed))))


def memo_note(state: State) -> tuple[Widget, ...]:
    """The memo that was tapped; it is deleted here, so that nobody deletes by looking."""
    memos = state.of(Memos).kept
    index = picked_at(state, "note", memos)
    if index is None:
        return gone(state, "note", say("This memo is no longer there"))
    text = memos[index]
    rest = replace(state.of(Memos), kept=(*memos[:index], *memos[index + 1 :]))
    delete = Button(
        key="note.delete",
        text=say("Delete"),
        icon=Icon.DELETE,
        on_tap=Remove(rest, say("{memo} is deleted", memo=text)),
    )
    whole = card(
        title(Icon.MEMO, say("Memo")),
        24,
        (160, Label(key="note.text", text=text, style=Type.HEADLINE, lines=3)),
        REST,
        (72, grid(3, 16, back("note"), None, delete)),
        padding=(28, 20),
    )
    return fill(content(state), whole)


@offered
def record_memo(state: State) -> CallMade:
    """Begin to record a spoken memo, or end the one that is being recorded."""
    return RECORD


@offered
def delete_memo(state: State, memo: Annotated[str, "The memo, as the screen memo tells it."]) -> CallMade:
    """Delete a memo."""
    memos = state.of(Memos)
    found = named(memo, memos.kept)
    if found is None:
        return unknown("memo", memo, memos.kept)
    at = memos.kept.index(found)
    return Put(replace(memos, kept=(*memos.kept[:at], *memos.kept[at + 1 :])), "")


APP = App(
    name="memo",
    title=say("Memos"),
    icon=Icon.MEMO,
    order=14,
    where=Where.STORE,
    about=say("Spoken notes"),
    functions=(record_memo, delete_memo),
    pages={"memo": AppPage(memo), "note": AppPage(memo_note, Room.ONE)},
    aliases={"memos": ""},
    starts=lambda state, rng: (Memos(),),
)
