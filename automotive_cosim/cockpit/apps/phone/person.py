"""One person on the phone: how to reach them, and the messages to and fro."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.phone.commands import Dial, Read, SendReply
from automotive_cosim.cockpit.apps.phone.handset import handset, handset_and_page
from automotive_cosim.cockpit.apps.phone.state import TEMPLATES, Directory, Phone
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.messages import Back, Show
from automotive_cosim.cockpit.parts import heading, note, rows
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Glyph, Label, Look, Picture, Row, Widget
from automotive_cosim.contracts.text import say

PHOTO = "thread.photo"
"""Id of the photo that came with a message."""
PHOTO_WIDE, PHOTO_HIGH = 460, 288
"""As wide for its height as photos are; above it, one line of the thread has room."""


def contact(state: State) -> tuple[Widget, ...]:
    """The screen of one contact."""
    who = state.picked.get("contact") or state.of(Directory).contacts[0].name
    number = state.of(Directory).number(who)
    favourite = who in state.of(Phone).favourites
    _, page = handset_and_page(state)
    head, _, acts = column(page, 264, GAP, 108)
    _, picture, _, name, _, line = column(head, 24, 120, 8, 48, 6, 36)
    buttons = acts.columns(3, GAP)
    return (
        handset(state),
        Button(
            rect=head.left(64).top(64), key="contact.back", description=say("Back"), icon=Icon.BACK, on_tap=Back()
        ),
        Glyph(rect=picture, icon=Icon.ACCOUNT, size=112, tone="accent"),
        Label(
            rect=name,
            key="contact.name",
            text=who,
            style=Type.HEADLINE,
            align="centre",
        ),
        Label(
            rect=line,
            key="contact.number",
            text="" if number == who else number,
            description=say("Number"),
            tone="muted",
            align="centre",
        ),
        Button(
            rect=buttons[0],
            key="contact.call",
            text=say("Call"),
            icon=Icon.PHONE,
            icon_size=36,
            look=Look.ACCENT,
            stacked=True,
            on_tap=Dial(who),
        ),
        Button(
            rect=buttons[1],
            key="contact.message",
            text=say("Message"),
            icon=Icon.MESSAGE,
            icon_size=36,
            stacked=True,
            on_tap=Show("thread", who),
        ),
        Button(
            rect=buttons[2],
            key="contact.favourite",
            text=say("Remove favourite") if favourite else say("Add favourite"),
            icon=Icon.STAR if favourite else Icon.STAR_OUTLINE,
            icon_size=36,
            stacked=True,
            on_tap=Put(
                state.of(Phone).with_favourite(who, not favourite),
                say("{who} is no longer a favourite", who=who)
                if favourite
                else say("{who} is now a favourite", who=who),
            ),
        ),
    )


def thread(state: State) -> tuple[Widget, ...]:
    """Somebody's messages, and replies that one tap sends. While driving, messages are read out instead."""
    who = state.picked.get("thread") or state.of(Directory).threads[0].who
    known = state.of(Directory).thread(who, state.of(Phone))
    hidden = state.locked(Restriction.NO_TEXT_MESSAGE)
    opened = who in state.of(Phone).read or not (known and known.unread)
    sent = [(sent.text, say("You")) for sent in state.of(Phone).sent if sent.to == who]
    said = [(text, who) for text in known.lines] if known else []
    lines = [*(said if opened and not hidden else []), *sent]
    photo = known.photo if known and opened and not hidden else None
    _, page = handset_and_page(state)
    left, _, right = row(page, 500, GAP, REST)
    bar, _, talk, _, read = column(left, 64, 12, REST, 12, 64)
    talk, _, seen = column(talk, REST, 12, PHOTO_HIGH) if photo else (talk, talk, talk)
    back, _, name, _, figure = row(bar, 64, 16, REST, 12, 216)
    return (
        handset(state),
        Button(rect=back, key="thread.back", description=say("Back"), icon=Icon.BACK, on_tap=Back()),
        Label(rect=name, key="thread.who", text=who, style=Type.TITLE),
        Button(
            rect=figure,
            key="thread.figure",
            text=say("Send time, price…"),
            icon=Icon.MESSAGE,
            on_tap=Show("figure", who),
        ),
        Button(
            rect=read,
            key="thread.read",
            text=say("Read out") if hidden else say("Open"),
            icon=Icon.VOICE if hidden else Icon.EYE,
            on_tap=Read(who),
            disabled="" if said and not opened else say("There is nothing new to read"),
        ),
        heading(right.top(28), say("Reply")),
        rows(
            right.below(36),
            "thread.answers",
            say("Replies"),
            state,
            len(TEMPLATES),
            lambda index, cell: Row(
                rect=cell,
                key=f"thread.answer.{index}",
                text=TEMPLATES[index],
                icon=Icon.REPLY,
                on_tap=SendReply(who, TEMPLATES[index]),
            ),
            height=56,
        ),
        *(
            (
                rows(
                    talk,
                    "thread.lines",
                    say("Messages"),
                    state,
                    len(lines),
                    lambda index, cell: Row(
                        rect=cell,
                        key=f"thread.line.{index}",
                        text=lines[index][1],
                        detail=lines[index][0],
                        icon=Icon.REPLY if lines[index][1] == "You" else Icon.MESSAGE,
                    ),
                    height=88,
                ),
            )
            if lines
            else (
                note(
                    talk,
                    "thread.hidden",
                    hidden if hidden and said else say("Not opened yet") if said else say("No messages yet"),
                ),
            )
        ),
        *(
            (Picture(rect=seen.middle(PHOTO_WIDE, PHOTO_HIGH), key=PHOTO, description=say("Photo"), photo=photo),)
            if photo
            else ()
        ),
    )
