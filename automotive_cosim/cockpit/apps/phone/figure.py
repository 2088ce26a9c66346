"""A message with a figure, put together by taps: a sentence, a number, send; or in own words, typed or dictated."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import timedelta

from automotive_cosim.cockpit.apps.phone.commands import SendReply
from automotive_cosim.cockpit.apps.phone.handset import beside_handset
from automotive_cosim.cockpit.apps.phone.state import OWN, Directory, FigureDraft, Phone, in_own_words
from automotive_cosim.cockpit.cards import choices, heading, search
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import BlockItem, framed, grid, line, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Back, Focus
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import HMI, LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Label, Look, Widget
from automotive_cosim.contracts.text import Quantity, Text, say

DAY_MIN = 24 * 60
FIELD = "figure.own"
"""Key of the field for own words."""


@dataclass(frozen=True, slots=True)
class Sentence:
    """What can be said with a figure."""

    text: Callable[[str], Text]
    """The message with its figure."""
    label: str
    start: float
    """The value from which plus and minus begin, as long as none is set."""
    fine: float
    """Change per tap of plus or minus."""
    coarse: float
    most: float

    def said(self, value: float | None) -> Text:
        """The whole message, with the value in its sentence, or a gap for it."""
        if value is None:
            return self.text("…")
        if self.label == "Arrival":
            return self.text(f"{int(value) // 60:02d}:{int(value) % 60:02d}")
        return self.text(Quantity(f"{value:.1f}" if self.fine < 1 else f"{value:.0f}"))


SENTENCES: Mapping[str, Sentence] = {
    "arrive": Sentence(
        lambda figure: say("I'll be there at {time}", time=figure), say("Arrival"), 12 * 60, 5, 60, DAY_MIN - 1
    ),
    "late": Sentence(
        lambda figure: say("I'll be {minutes} minutes late", minutes=figure), say("Delay"), 0, 5, 30, 600
    ),
    "driven": Sentence(
        lambda figure: say("I have driven {distance} km", distance=figure), say("Distance"), 0, 1, 10, 990
    ),
    "used": Sentence(
        lambda figure: say("I used {energy} kWh per 100 km", energy=figure), say("Usage"), 15.0, 0.1, 1, 99
    ),
    "level": Sentence(
        lambda figure: say("The battery has {share} %", share=figure), say("Battery"), 50, 1, 10, 100
    ),
    "pressure": Sentence(
        lambda figure: say("The tyre has {pressure} psi", pressure=figure), say("Tyre"), 30, 1, 10, 60
    ),
    "paid": Sentence(lambda figure: say("I paid {price}", price=figure), say("Price"), 0, 0.1, 1, 200),
}
"""By key; the distance is in kilometres whatever the display's unit."""


def figure(state: State) -> tuple[Widget, ...]:
    """The sentence, its figure or own words, and the button that sends it."""
    who = state.picked.get("figure") or state.of(Directory).contacts[0].name
    draft = state.of(Phone).draft or _begun("arrive", state)
    back = Button(key="figure.back", description=say("Back"), icon=Icon.BACK, on_tap=Back())
    kinds = {key: each.label for key, each in SENTENCES.items()} | {OWN: say("Own words")}
    said = choices(
        "figure.say",
        (
            (key, label, None, key == draft.sentence, _put(_begun(key, state), state))
            for key, label in kinds.items()
        ),
    )
    page = stack(
        (64, line((64, back), 16, Label(key="figure.who", text=who, style=Type.TITLE))),
        GAP,
        heading(say("Message")),
        8,
        (56, said),
        16,
        *(_own(who, state) if draft.sentence == OWN else _with_figure(who, draft, state)),
        REST,
    )
    return beside_handset(state, page)


def _with_figure(who: str, draft: FigureDraft, state: State) -> Iterator[BlockItem]:
    sentence = SENTENCES[draft.sentence]

    def moved(by: float) -> Put:
        now = sentence.start if draft.value is None else draft.value
        value = round(min(sentence.most, max(0.0, now + by)), 1)
        return _put(replace(draft, value=value), state)

    words = sentence.said(draft.value)
    steps = (("less", -sentence.coarse), ("down", -sentence.fine), ("up", sentence.fine), ("more", sentence.coarse))
    sizes = (Button(key=f"figure.{key}", text=_signed(by, sentence), on_tap=moved(by)) for key, by in steps)
    told = Label(key="figure.words", text=words, description=say("Message"), style=Type.TITLE)
    lacking = say("Set the figure first") if draft.value is None else ""
    yield from ((64, framed(told, (20, 8))), 12, (72, grid(4, 12, *sizes)))
    yield from (16, (72, _send(SendReply(who, words), lacking)))


def _own(who: str, state: State) -> Iterator[BlockItem]:
    """Typing is locked while driving; dictating is not, but what was dictated is then not shown."""
    typed, hidden = state.typed.get(FIELD, ""), state.locked(Restriction.NO_VOICE_TRANSCRIPTION)
    listens = state.listening and state.focus == FIELD
    words = in_own_words(typed, state.signals[HMI.LANGUAGE])
    lacking = "" if words else say("Write or dictate the message first")
    send = SendReply(who, words, own=True)
    hint = hidden if hidden and typed else say("In your own words, if no reply fits")
    field = replace(
        search(FIELD, say("Message"), hint, state, send if words else None),
        text="" if hidden else typed,
        icon=Icon.MESSAGE,
        enters=say("Send"),
        lacking=lacking,
    )
    if listens:
        field = replace(field, on_tap=Focus(FIELD, spoken=True), locked="")
    dictate = Button(
        key="figure.dictate",
        text=say("Speak now") if listens else say("Dictate"),
        icon=Icon.MICROPHONE,
        on_tap=Focus(FIELD, spoken=True),
        disabled="" if state.signals[LINK.VOICE_ASSISTANT] else say("The microphone is off"),
    )
    yield from ((56, field), 20, (72, dictate), 16, (72, _send(send, lacking)))


def _send(message: SendReply, lacking: str) -> Button:
    return Button(
        key="figure.send", text=say("Send"), icon=Icon.REPLY, look=Look.ACCENT, on_tap=message, disabled=lacking
    )


def _put(draft: FigureDraft, state: State) -> Put:
    words = say("Own words") if draft.sentence == OWN else SENTENCES[draft.sentence].said(draft.value)
    return Put(replace(state.of(Phone), draft=draft), words)


def _begun(key: str, state: State) -> FigureDraft:
    """A sentence without its figure; an arrival has that of the route, never a time past."""
    if key != "arrive" or state.outside is None:
        return FigureDraft(key)
    then = state.outside.local_time + timedelta(seconds=state.outside.driving.ahead.eta_s)
    minute, step = 60 * then.hour + then.minute + then.second / 60, SENTENCES[key].fine
    return FigureDraft(key, math.ceil(minute / step) * step % DAY_MIN)


def _signed(by: float, sentence: Sentence) -> str:
    if sentence.label == "Arrival":
        return f"{by / 60:+.0f} h" if abs(by) >= 60 else f"{by:+.0f} min"
    return Quantity(f"{by:+g}")
