"""The notifications: what requires attention now, and earlier notices."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.phone.state import Directory, Phone
from automotive_cosim.cockpit.cards import content, note, rows, title
from automotive_cosim.cockpit.flow import card, fill, line
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Dismiss, Show
from automotive_cosim.cockpit.notices import LOW_BATTERY_PCT, LOW_KPA, NOTICED, TYRES
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.signals import ENERGY, GLASS
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.widgets import Button, Row, Widget
from automotive_cosim.contracts.text import counted, say


def wanting(state: State) -> tuple[tuple[str, Icon, str, str], ...]:
    """What requires attention: text, icon, and the screen where something can be done."""
    signals = state.signals
    low = [signal for signal in TYRES if signals[signal] < LOW_KPA]
    count = len(state.of(Directory).unread(state.of(Phone)))
    return tuple(
        (text, icon, screen, item)
        for holds, text, icon, screen, item in (
            (count, counted("{n} unread message", "{n} unread messages", count), Icon.MESSAGE, "phone", "messages"),
            (bool(low), say("Tyre pressure is low"), Icon.TYRE, "driving", ""),
            (signals[ENERGY.LEVEL] <= LOW_BATTERY_PCT, say("Battery is low"), Icon.BATTERY, "charging", ""),
            (
                signals[GLASS.WINDSHIELD_FOG] >= NOTICED,
                say("Windshield is fogged"),
                Icon.DEFROST_FRONT,
                "climate",
                "",
            ),
        )
        if holds
    )


def notifications(state: State) -> tuple[Widget, ...]:
    """What requires attention now, and below it earlier notices, the newest first."""
    lines: list[tuple[str, str, Icon, Show | None]] = [
        *((text, "", icon, Show(screen, item)) for text, icon, screen, item in wanting(state)),
        *(
            (notice.text, notice.clock, notice.icon, Show(*notice.opens) if notice.opens else None)
            for notice in reversed(state.notices)
        ),
    ]
    nothing = say("These clear once they are resolved") if lines else say("There is nothing to clear")
    clear = Button(
        key="notifications.clear",
        text=say("Clear all"),
        icon=Icon.DELETE,
        on_tap=Dismiss(all=True),
        disabled="" if state.notices else nothing,
    )

    def entry(index: int, each: tuple[str, str, Icon, Show | None]) -> Row:
        text, clock, icon, opens = each
        return Row(
            key=f"notifications.{index}",
            text=text,
            trail=clock,
            icon=icon,
            tone="accent" if opens is None else "warning",
            raised=True,
            on_tap=opens,
        )

    every = rows("notifications.all", say("Notifications"), state, lines, entry, height=60)
    listed = every if lines else note("notifications.empty", say("No notifications"))
    head = line((600, title(Icon.BELL, say("Notifications"))), REST, (200, clear))
    return fill(content(state), card((56, head), 16, (REST, listed), padding=(28, 20)))


APP = App(
    name="notifications",
    title=say("Notices"),
    icon=Icon.BELL,
    order=19,
    where=Where.STATUS,
    pages={"notifications": AppPage(notifications, Room.ONE)},
)
