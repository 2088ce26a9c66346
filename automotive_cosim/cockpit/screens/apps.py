"""Apps: the launcher, the store, and the notifications."""

from __future__ import annotations

from automotive_cosim.cockpit.desk import TOOLS
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.messages import Put, Show
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.screens.frame import DOCK
from automotive_cosim.cockpit.screens.notices import wanting
from automotive_cosim.cockpit.screens.parts import content, note, rows, title
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Row, Widget
from automotive_cosim.contracts.text import say


def apps(state: State) -> tuple[Widget, ...]:
    """All installed apps, and a link to the store."""
    offered: list[tuple[str, str, Icon]] = [
        *((name, TOOLS[name][0], TOOLS[name][1]) for name in state.desk.installed),
        ("cabin", say("Cabin"), Icon.CONTACTS),
        ("store", say("Store"), Icon.STORE),
        ("notifications", say("Notices"), Icon.BELL),
        *((name, text, icon) for name, (text, icon) in DOCK.items() if name not in ("home", "apps")),
    ]
    return (
        rows(
            content(state),
            "apps.all",
            say("Apps"),
            state,
            len(offered),
            lambda index, cell: Button(
                rect=cell,
                key=f"apps.{offered[index][0]}",
                text=offered[index][1],
                icon=offered[index][2],
                icon_size=44,
                stacked=True,
                style=Type.STRONG,
                on_tap=Show(offered[index][0]),
            ),
            columns=6,
            height=170,
            gap=16,
        ),
    )


def store(state: State) -> tuple[Widget, ...]:
    """Apps that can be installed and removed while parked."""
    area = content(state)
    inner = area.inset(28, 20)
    locked = state.locked(Restriction.NO_SETUP)
    names = tuple(TOOLS)

    def line(index: int, cell: Rect) -> Row:
        name = names[index]
        text, icon, about = TOOLS[name]
        there = name in state.desk.installed
        return Row(
            rect=cell,
            key=f"store.{name}",
            raised=True,
            text=text,
            detail=about,
            trail=say("Remove") if there else say("Install"),
            icon=icon,
            locked=locked,
            on_tap=Put(
                "desk",
                state.desk.with_app(name, not there),
                say("{name} is removed", name=text) if there else say("{app} is installed", app=text),
            ),
        )

    return (
        Card(
            rect=area,
            children=(
                title(inner.top(40), Icon.STORE, say("Store")),
                rows(inner.below(56), "store.apps", say("Apps"), state, len(names), line, height=68, gap=8),
            ),
        ),
    )


def notifications(state: State) -> tuple[Widget, ...]:
    """What requires attention now, and below it earlier notices, the newest first."""
    area = content(state)
    inner = area.inset(28, 20)
    lines = [
        *((text, "", icon, Show(screen, item)) for text, icon, screen, item in wanting(state)),
        *(
            (notice.text, notice.clock, notice.icon, Show(*notice.opens) if notice.opens else None)
            for notice in reversed(state.notices)
        ),
    ]
    return (
        Card(
            rect=area,
            children=(
                title(inner.top(56).left(600), Icon.BELL, say("Notifications")),
                Button(
                    rect=inner.top(56).right_part(200),
                    key="notifications.clear",
                    text=say("Clear all"),
                    icon=Icon.DELETE,
                    on_tap=Put("notices", (), say("The notifications are cleared")),
                    disabled=""
                    if state.notices
                    else say("These go when they are dealt with")
                    if lines
                    else say("There is nothing to clear"),
                ),
                rows(
                    inner.below(72),
                    "notifications.all",
                    say("Notifications"),
                    state,
                    len(lines),
                    lambda index, cell: Row(
                        rect=cell,
                        key=f"notifications.{index}",
                        text=lines[index][0],
                        trail=lines[index][1],
                        icon=lines[index][2],
                        tone="accent" if lines[index][3] is None else "warning",
                        raised=True,
                        on_tap=lines[index][3],
                    ),
                    height=60,
                )
                if lines
                else note(inner.below(72), "notifications.empty", say("No notifications")),
            ),
        ),
    )
