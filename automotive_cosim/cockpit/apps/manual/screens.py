"""The owner's handbook, to search in and to watch."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.manual.state import FILM_S, TOPICS, ManualFilm
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.parts import content, minutes, note, rows, search
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Glyph, Label, Row, Widget
from automotive_cosim.contracts.text import say


def _film(rect: Rect, topic: int, icon: Icon, state: State) -> tuple[Widget, ...]:
    """The topic's video: its picture, its progress while it plays, and the button."""
    film, button = state.of(ManualFilm), rect.bottom_part(64).left(320)
    if film.topic != topic:
        start = Put(ManualFilm(topic, state.time_s), say("The video plays"))
        return (
            Button(
                rect=button,
                key="manual.film",
                text=say("Watch the video"),
                icon=Icon.PLAY,
                on_tap=start,
                locked=state.locked(Restriction.NO_VIDEO),
            ),
        )
    played_s = state.time_s - film.since_s
    frame = rect.top(128)
    return (
        Card(
            rect=frame,
            look="raised",
            children=(
                Glyph(
                    rect=frame.middle(96, 96),
                    key="manual.film.picture",
                    description=say(
                        "The video is at {time} of {length}", time=minutes(played_s), length=minutes(FILM_S)
                    ),
                    icon=icon,
                    size=64 + 8 * (int(played_s) % 5),
                    tone="accent",
                ),
                Bar(rect=frame.inset(20, 12).bottom_part(8), share=round(played_s / FILM_S, 2)),
            ),
        ),
        Button(
            rect=button,
            key="manual.film",
            text=say("Stop the video"),
            icon=Icon.STOP,
            on_tap=Put(ManualFilm(), say("The video is stopped")),
        ),
    )


def manual(state: State) -> tuple[Widget, ...]:
    """Topics of the manual, and the text of one."""
    wanted = state.typed.get("manual.search", "").casefold().strip()
    found = [
        (at, topic)
        for at, topic in enumerate(TOPICS)
        if wanted in topic[0].casefold() or wanted in topic[2].casefold()
    ]
    chosen = int(state.picked["manual"])
    name, icon, text = TOPICS[chosen]
    left, right = panes(content(state), 420, REST)
    head, _, words, _, film = column(right.inset(32, 28), 72, 20, 160, REST, 208)
    picture, _, topic = row(head, 72, 24, REST)
    first: Message | None = Show("manual", str(found[0][0])) if found else None
    return (
        search(left.top(60), "manual.search", say("Search the manual"), say("Search the manual"), state, first),
        rows(
            left.below(72),
            "manual.topics",
            say("Topics"),
            state,
            len(found),
            lambda index, cell: Row(
                rect=cell,
                key=f"manual.topic.{found[index][0]}",
                text=found[index][1][0],
                icon=found[index][1][1],
                selected=found[index][0] == chosen,
                on_tap=Pick("manual", str(found[index][0])),
            ),
            height=56,
        )
        if found
        else note(left.below(72), "manual.empty", say("The manual does not mention it")),
        Card(
            rect=right,
            children=(
                Glyph(rect=picture, icon=icon, size=64, tone="accent"),
                Label(
                    rect=topic,
                    key="manual.title",
                    text=name,
                    style=Type.HEADLINE,
                ),
                Label(
                    rect=words,
                    key="manual.text",
                    text=text,
                    style=Type.BODY,
                    lines=5,
                ),
                *_film(film, chosen, icon, state),
            ),
        ),
    )
