"""The owner's handbook, to search in and to watch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import content, note, rows, search
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import Block, card, fill, framed, line, panels, stack
from automotive_cosim.cockpit.functions import CallMade, locked, offered
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import AppData, Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import minutes
from automotive_cosim.cockpit.widgets import Bar, Button, Glyph, Label, Row, Widget
from automotive_cosim.contracts import Surroundings
from automotive_cosim.contracts.text import say
from automotive_cosim.formats.annotations import OneOf

ManualTopic = tuple[str, Icon, str]
"""Name, picture and text."""
TOPICS: tuple[ManualTopic, ...] = (
    (
        say("Windows are fogged"),
        Icon.DEFROST_FRONT,
        say(
            "Fog inside: blow dry air at the windshield with the front defroster, and switch recirculation off. "
            "Fog outside: use the wipers. The rear window has a heater of its own."
        ),
    ),
    (
        say("Fog lamps"),
        Icon.REAR_FOG,
        say(
            "Front fog lamps work with position lamps or low beam, the rear one with low beam or front fog lamps. "
            "When they may be lit is a matter of local law: the rear fog lamp dazzles those behind."
        ),
    ),
    (
        say("Tyre pressures"),
        Icon.TYRE,
        say(
            "Check them cold. The pressure falls by about a tenth of a bar for every ten degrees that it gets "
            "colder. Add air when a tyre is a fifth below the value on the door frame."
        ),
    ),
    (
        say("Cruise control"),
        Icon.CRUISE,
        say(
            "It holds the set speed and, when adaptive, the chosen gap to the car in front. The limiter lets you "
            "accelerate up to its speed but not beyond. Only one of them is active at a time."
        ),
    ),
    (
        say("Extending range"),
        Icon.BATTERY,
        say("Drive slower, use economy mode, and warm the seats rather than the air: a seat takes a tenth of it."),
    ),
    (
        say("Driving on ice"),
        Icon.SLIPPERY,
        say(
            "Snow mode softens the throttle. Keep stability control on, leave a gap several times as long as "
            "usual, and brake early and gently."
        ),
    ),
    (
        say("Child safety"),
        Icon.CHILD,
        say(
            "Child locks keep the rear doors from being opened from inside; the window lock blocks the rear "
            "switches."
        ),
    ),
    (
        say("After a crash"),
        Icon.PHONE_ALERT,
        say(
            "Switch the hazard lights on, call for help from the safety centre, which sends the position, and wait "
            "beyond the barrier."
        ),
    ),
    (
        say("Charging"),
        Icon.CHARGING,
        say("For daily driving charge to 80 %. Above that the battery takes power ever more slowly."),
    ),
    (
        say("Mirrors and seats"),
        Icon.SEAT,
        say("Set the seat first, then the mirrors. Up to three positions can be stored and recalled while parked."),
    ),
)
"""Name, icon and text."""
FILM_S = 40.0
"""Length of a topic's video."""


@dataclass(frozen=True, slots=True)
class _ManualFilm(AppData):
    """The topic whose video plays, and since when; None without."""

    topic: int | None = None
    since_s: float = 0.0

    def commands(self) -> dict[str, Any]:
        return {"apps.film": "" if self.topic is None else TOPICS[self.topic][0]}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """The video ends at its end, or when the car leaves park."""
        if self.topic is None:
            return
        if Restriction.NO_VIDEO in state.restrictions or state.time_s - self.since_s >= FILM_S:
            state.keep(_ManualFilm())


def _film(topic: int, icon: Icon, state: State) -> Block:
    """The topic's video: its picture, its progress while it plays, and the button."""
    film = state.of(_ManualFilm)
    if film.topic != topic:
        watch = Button(
            key="manual.film",
            text=say("Watch the video"),
            icon=Icon.PLAY,
            on_tap=Put(_ManualFilm(topic, state.time_s), say("The video plays")),
            locked=state.locked(Restriction.NO_VIDEO),
        )
        return stack(REST, (64, line((320, watch), REST)))
    played_s = state.time_s - film.since_s
    picture = Glyph(
        key="manual.film.picture",
        description=say("The video is at {time} of {length}", time=minutes(played_s), length=minutes(FILM_S)),
        icon=icon,
        size=64 + 8 * (int(played_s) % 5),
        tone="accent",
    )
    bar = Bar(share=round(played_s / FILM_S, 2))
    shown = Block((picture, bar), lambda box: (box.middle(96, 96), box.inset(20, 12).bottom_part(8)))
    stop = Button(
        key="manual.film",
        text=say("Stop the video"),
        icon=Icon.STOP,
        on_tap=Put(_ManualFilm(), say("The video is stopped")),
    )
    return stack((128, framed(shown, look="raised")), REST, (64, line((320, stop), REST)))


def manual(state: State) -> tuple[Widget, ...]:
    """Topics of the manual, and the text of one."""
    wanted = state.typed.get("manual.search", "").casefold().strip()
    found = [
        (number, topic)
        for number, topic in enumerate(TOPICS)
        if wanted in topic[0].casefold() or wanted in topic[2].casefold()
    ]
    chosen = int(state.picked["manual"])
    name, icon, text = TOPICS[chosen]
    first: Message | None = Show("manual", str(found[0][0])) if found else None
    field = search("manual.search", say("Search the manual"), say("Search the manual"), state, first)

    def entry(index: int, each: tuple[int, ManualTopic]) -> Row:
        number, (words, picture, _) = each
        return Row(
            key=f"manual.topic.{number}",
            text=words,
            icon=picture,
            selected=number == chosen,
            on_tap=Pick("manual", str(number)),
        )

    topics = rows("manual.topics", say("Topics"), state, found, entry, height=56)
    listed = topics if found else note("manual.empty", say("The manual does not mention it"))
    head = line(
        (72, Glyph(icon=icon, size=64, tone="accent")),
        24,
        Label(key="manual.title", text=name, style=Type.HEADLINE),
    )
    page = card(
        (72, head),
        20,
        (160, Label(key="manual.text", text=text, style=Type.BODY, lines=5)),
        REST,
        (208, _film(chosen, icon, state)),
        padding=(32, 28),
    )
    return fill(content(state), panels((420, stack((60, field), 12, (REST, listed))), page))


NAMES = tuple(str(topic[0]) for topic in TOPICS)


@offered
def play_manual_video(
    state: State,
    topic: Annotated[str, OneOf(NAMES), "The topic."],
    on: Annotated[bool, "True plays its video, false stops it."] = True,
) -> CallMade:
    """Play the video of a topic of the owner's manual, or stop it. Only while parked."""
    if not on:
        return Put(_ManualFilm(), "")
    return locked(state, Restriction.NO_VIDEO) or Put(_ManualFilm(NAMES.index(topic), state.time_s), "")


APP = App(
    name="manual",
    title=say("Manual"),
    icon=Icon.MANUAL,
    order=13,
    where=Where.STORE,
    about=say("The owner's handbook, to search in"),
    functions=(play_manual_video,),
    pages={"manual": AppPage(manual)},
    picked={"manual": "0"},
    starts=lambda state, rng: (_ManualFilm(),),
)
