"""One person on the phone: how to reach them, and the messages to and fro."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.phone.commands import Dial, Read, SendReply
from automotive_cosim.cockpit.apps.phone.handset import beside_handset
from automotive_cosim.cockpit.apps.phone.state import TEMPLATES, Directory, Phone
from automotive_cosim.cockpit.cards import heading, note, rows
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import Block, grid, line, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.messages import Back, Show
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import Message, State
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

    def act(key: str, text: str, icon: Icon, on_tap: Message, look: Look = Look.TONAL) -> Button:
        return Button(
            key=f"contact.{key}", text=text, icon=icon, icon_size=36, look=look, stacked=True, on_tap=on_tap
        )

    kept = Put(
        state.of(Phone).with_favourite(who, not favourite),
        say("{who} is no longer a favourite", who=who) if favourite else say("{who} is now a favourite", who=who),
    )
    star = Icon.STAR if favourite else Icon.STAR_OUTLINE
    back = Button(key="contact.back", description=say("Back"), icon=Icon.BACK, on_tap=Back())
    reached = Label(
        key="contact.number",
        text="" if number == who else number,
        description=say("Number"),
        tone="muted",
        align="centre",
    )
    head = stack(
        24,
        (120, Glyph(icon=Icon.ACCOUNT, size=112, tone="accent")),
        8,
        (48, Label(key="contact.name", text=who, style=Type.HEADLINE, align="centre")),
        6,
        (36, reached),
        REST,
    )
    acts = grid(
        3,
        GAP,
        act("call", say("Call"), Icon.PHONE, Dial(who), Look.ACCENT),
        act("message", say("Message"), Icon.MESSAGE, Show("thread", who)),
        act("favourite", say("Remove favourite") if favourite else say("Add favourite"), star, kept),
    )
    over = Block((back, head), lambda box: (box.left(64).top(64), box))
    return beside_handset(state, stack((264, over), GAP, (108, acts), REST))


def thread(state: State) -> tuple[Widget, ...]:
    """Somebody's messages, and replies that one tap sends. While driving, messages are read out instead."""
    who = state.picked.get("thread") or state.of(Directory).threads[0].who
    phone = state.of(Phone)
    known = state.of(Directory).thread(who, phone)
    hidden = state.locked(Restriction.NO_TEXT_MESSAGE)
    opened = who in phone.read or not (known and known.unread)
    unseen = state.locked(Restriction.NO_VOICE_TRANSCRIPTION)
    sent = [((each.own and unseen) or each.text, say("You")) for each in phone.sent if each.to == who]
    said = [(text, who) for text in known.lines] if known else []
    lines = [*(said if opened and not hidden else []), *sent]
    photo = known.photo if known and opened and not hidden else None
    back = Button(key="thread.back", description=say("Back"), icon=Icon.BACK, on_tap=Back())
    figure = Button(key="thread.figure", text=say("Write…"), icon=Icon.MESSAGE, on_tap=Show("figure", who))
    read = Button(
        key="thread.read",
        text=say("Read out") if hidden else say("Open"),
        icon=Icon.VOICE if hidden else Icon.EYE,
        on_tap=Read(who),
        disabled="" if said and not opened else say("There is nothing new to read"),
    )

    def answer(index: int, text: str) -> Row:
        return Row(key=f"thread.answer.{index}", text=text, icon=Icon.REPLY, on_tap=SendReply(who, text))

    def spoken(index: int, each: tuple[str, str]) -> Row:
        text, by = each
        icon = Icon.REPLY if by == "You" else Icon.MESSAGE
        return Row(key=f"thread.line.{index}", text=by, detail=text, icon=icon)

    nothing = hidden if hidden and said else say("Not opened yet") if said else say("No messages yet")
    talk = rows("thread.lines", say("Messages"), state, lines, spoken, height=88)
    picture = Picture(key=PHOTO, description=say("Photo"), photo=photo) if photo else None
    answers = stack(
        heading(say("Reply")), 8, rows("thread.answers", say("Replies"), state, TEMPLATES, answer, height=56)
    )
    bar = line((64, back), 16, Label(key="thread.who", text=who, style=Type.TITLE), 12, (216, figure))

    def divide(box: Rect) -> tuple[Rect, ...]:
        """The bar, the button, the replies, the messages and the photo, as they are read."""
        left, _, right = row(box, 500, GAP, REST)
        head, _, middle, _, foot = column(left, 64, 12, REST, 12, 64)
        if photo is None:
            return head, foot, right, middle
        above, _, seen = column(middle, REST, 12, PHOTO_HIGH)
        return head, foot, right, above, seen.middle(PHOTO_WIDE, PHOTO_HIGH)

    spoken_so_far = talk if lines else note("thread.hidden", nothing)
    return beside_handset(state, Block((bar, read, answers, spoken_so_far, picture), divide))
