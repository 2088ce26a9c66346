"""The smaller apps: charging, parking, manual, memos, trip and calendar."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.desk import FILM_S, MANUAL, ZONES
from automotive_cosim.cockpit.errands import odometer, price
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Message, Pay, Pick, Put, Record, ResetTrip, Show
from automotive_cosim.cockpit.places import PlaceKind
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.screens.map import destination
from automotive_cosim.cockpit.screens.media import minutes
from automotive_cosim.cockpit.screens.parts import (
    choices,
    content,
    distance,
    heading,
    note,
    rows,
    search,
    slider,
    speed,
    speed_unit,
    switch,
    time_setter,
    title,
)
from automotive_cosim.cockpit.screens.way import nearest
from automotive_cosim.cockpit.signals import ENERGY, HMI
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.vehicle import BATTERY_KWH
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Glyph, Label, Look, Row, Tile, Widget
from automotive_cosim.contracts.text import Quantity, joined, say

STAYS = (30, 60, 120, 240)
"""Parking times that can be paid for, in minutes."""


def charging(state: State) -> tuple[Widget, ...]:
    """The battery, its charge limit and schedule, and stations nearby."""
    signals = state.signals
    left, right = panes(content(state), REST, REST)
    head, _, upper, _, bar, _, limit, _, flap, _, ready, _, time = column(
        left.inset(28, 20), 40, 8, 44, 8, 12, 14, 84, 16, 60, 12, 60, 16, 72
    )
    charge, _, reach = row(upper, 150, 10, REST)
    level, cable = signals[ENERGY.LEVEL], say("cable in") if signals[ENERGY.CABLE] else say("no cable")
    stations = nearest(state, state.atlas.of(PlaceKind.CHARGING))
    desk = state.desk
    timer = desk.charge_by
    return (
        Card(
            rect=left,
            children=(
                title(head, Icon.CHARGING, say("Charging")),
                Label(
                    rect=charge,
                    key="charging.level",
                    text=f"{level:.0f} %",
                    description=say("Battery"),
                    style=Type.HEADLINE,
                ),
                Label(
                    rect=reach,
                    key="charging.range",
                    text=say("{first}, {second}", first=distance(signals, signals[ENERGY.RANGE]), second=cable),
                    description=say("Range and cable"),
                    tone="muted",
                    style=Type.LABEL,
                    align="right",
                ),
                Bar(
                    rect=bar,
                    share=round(level / 100, 2),
                    tone="good" if level > 15 else "warning",
                ),
                slider(
                    limit,
                    "charging.limit",
                    say("Charge to"),
                    Icon.BATTERY,
                    ENERGY.CHARGE_LIMIT,
                    signals,
                ),
                switch(
                    flap,
                    "charging.flap",
                    say("Charging flap open"),
                    Icon.FLAP,
                    ENERGY.CHARGE_FLAP,
                    signals,
                    state.vehicle.held(ENERGY.CHARGE_FLAP),
                ),
                Tile(
                    rect=ready,
                    key="charging.schedule",
                    text=say("Ready at a set time"),
                    icon=Icon.CLOCK,
                    checked=timer.on,
                    on_tap=Put(
                        "desk",
                        replace(desk, charge_by=replace(timer, on=not timer.on)),
                        say("Charging starts at once")
                        if timer.on
                        else say("Charged by {shown}", shown=timer.shown),
                    ),
                ),
                *time_setter(
                    time,
                    "charging.schedule",
                    timer,
                    lambda moved: Put(
                        "desk", replace(desk, charge_by=moved), say("The time is {time}", time=moved.shown)
                    ),
                ),
            ),
        ),
        heading(right.top(32), say("Stations nearby")),
        rows(
            right.below(44),
            "charging.stations",
            say("Charging stations"),
            state,
            len(stations),
            lambda index, cell: replace(
                destination(cell, f"charging.station.{index}", stations[index].name, state),
                detail=stations[index].detail,
            ),
            height=64,
        ),
    )


def parking(state: State) -> tuple[Widget, ...]:
    """Pays for a parking space."""
    left, right = panes(content(state), 700, REST)
    head, _, zone_name, _, zones, _, stay_name, _, stays, _, total, _, pay = column(
        left.inset(28, 20), 40, 24, 28, 8, 72, 24, 28, 8, 72, 24, 56, REST, 88
    )
    desk = state.desk
    tickets = tuple(reversed(desk.tickets))
    return (
        Card(
            rect=left,
            children=(
                title(head, Icon.TICKET, say("Pay for parking")),
                heading(zone_name, say("Zone")),
                choices(
                    zones,
                    "parking.zone",
                    [
                        (
                            zone[-1].lower(),
                            zone,
                            None,
                            zone == desk.zone,
                            Put("desk", replace(desk, zone=zone), say("{zone} is set", zone=zone)),
                        )
                        for zone in ZONES
                    ],
                ),
                heading(stay_name, say("How long")),
                choices(
                    stays,
                    "parking.time",
                    [
                        (
                            str(stay),
                            f"{stay} min" if stay < 60 else f"{stay // 60} h",
                            None,
                            stay == desk.minutes,
                            Put(
                                "desk", replace(desk, minutes=stay), say("{minutes} minutes are set", minutes=stay)
                            ),
                        )
                        for stay in STAYS
                    ],
                ),
                Label(
                    rect=total,
                    key="parking.price",
                    text=say("Price {price}", price=Quantity(f"{price(desk.zone, desk.minutes):.2f}")),
                    style=Type.HEADLINE,
                ),
                Button(
                    rect=pay,
                    key="parking.pay",
                    text=say("Pay now"),
                    icon=Icon.TICKET,
                    icon_size=34,
                    style=Type.TITLE,
                    look=Look.ACCENT,
                    on_tap=Pay(),
                ),
            ),
        ),
        heading(right.top(32), say("Tickets")),
        rows(
            right.below(44),
            "parking.tickets",
            say("Tickets"),
            state,
            len(tickets),
            lambda index, cell: Row(
                rect=cell,
                key=f"parking.ticket.{index}",
                text=say("{zone} until {time}", zone=tickets[index].zone, time=tickets[index].until),
                detail=say("Paid {price}", price=Quantity(f"{tickets[index].price:.2f}")),
                icon=Icon.TICKET,
            ),
            height=68,
        )
        if tickets
        else note(right.below(44), "parking.tickets.empty", say("No tickets yet")),
    )


def _film(rect: Rect, topic: int, icon: Icon, state: State) -> tuple[Widget, ...]:
    """The topic's video: its picture, its progress while it plays, and the button."""
    desk, button = state.desk, rect.bottom_part(64).left(320)
    if desk.film is None or desk.film[0] != topic:
        start = Put("desk", replace(desk, film=(topic, state.time_s)), say("The video plays"))
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
    played_s = state.time_s - desk.film[1]
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
            on_tap=Put("desk", replace(desk, film=None), say("The video is stopped")),
        ),
    )


def manual(state: State) -> tuple[Widget, ...]:
    """Topics of the manual, and the text of one."""
    wanted = state.typed.get("manual.search", "").casefold().strip()
    found = [
        (at, topic)
        for at, topic in enumerate(MANUAL)
        if wanted in topic[0].casefold() or wanted in topic[2].casefold()
    ]
    chosen = int(state.picked["manual"])
    name, icon, text = MANUAL[chosen]
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


def memo(state: State) -> tuple[Widget, ...]:
    """Records spoken notes."""
    left, right = panes(content(state), REST, REST)
    head, _, picture, _, time, _, record = column(left.inset(28, 20), 40, 50, 128, 22, 52, REST, 88)
    desk = state.desk
    since = desk.recording_since_s
    memos = desk.memos

    def line(index: int, cell: Rect) -> Row:
        return Row(
            rect=cell,
            key=f"memo.{index}",
            text=memos[index],
            trail=say("Open"),
            icon=Icon.MEMO,
            on_tap=Show("note", memos[index]),
        )

    return (
        Card(
            rect=left,
            children=(
                title(head, Icon.MEMO, say("Memo")),
                Glyph(
                    rect=picture,
                    icon=Icon.MICROPHONE,
                    size=112,
                    tone="warning" if since is not None else "muted",
                ),
                Label(
                    rect=time,
                    key="memo.time",
                    text=minutes(state.time_s - since) if since is not None else say("Ready"),
                    description=say("Recording") if since is not None else say("Memo"),
                    style=Type.HEADLINE,
                    align="centre",
                ),
                Button(
                    rect=record,
                    key="memo.record",
                    text=say("Record") if since is None else say("Stop"),
                    icon=Icon.RECORD if since is None else Icon.STOP,
                    icon_size=34,
                    style=Type.TITLE,
                    look=Look.ACCENT if since is None else Look.CRITICAL,
                    on_tap=Record(),
                ),
            ),
        ),
        heading(right.top(32), say("Memos")),
        rows(right.below(44), "memo.all", say("Memos"), state, len(memos), line, height=60)
        if memos
        else note(right.below(44), "memo.empty", say("No memos yet")),
    )


def trip(state: State) -> tuple[Widget, ...]:
    """Distance, time and consumption since the last reset."""
    signals, area = state.signals, content(state)
    head, _, body, _, acts = column(area.inset(32, 24), 40, 20, 312, REST, 72)
    reset, _, other = row(acts, 320, REST, 320)
    metres, seconds, level = odometer(state)
    from_m, from_s, from_level = state.desk.trip_from
    driven_m, took_s, used_pct = max(0.0, metres - from_m), seconds - from_s, max(0.0, from_level - level)
    mean_kmh = 3.6 * driven_m / took_s if took_s > 0 else 0.0
    used_kwh = used_pct / 100 * BATTERY_KWH
    unit_m, unit = (1609.344, "mi") if signals[HMI.DISTANCE_UNIT] == "MILES" else (1000.0, "km")
    per_100 = 100 * unit_m * used_kwh / driven_m if driven_m > 100 else 0.0
    tiles = (
        ("trip.distance", say("Distance"), distance(signals, driven_m), Icon.ROUTE),
        ("trip.time", say("Driving time"), minutes(took_s), Icon.CLOCK),
        ("trip.speed", say("Mean speed"), f"{speed(signals, mean_kmh)} {speed_unit(signals)}", Icon.SPEED),
        ("trip.energy", say("Energy"), Quantity(f"{used_kwh:.2f} kWh"), Icon.BATTERY),
        ("trip.consumption", say("Consumption"), Quantity(f"{per_100:.1f} kWh/100 {unit}"), Icon.CHARGING),
        ("trip.range", say("Range"), distance(signals, signals[ENERGY.RANGE]), Icon.GOAL),
    )
    cells = [cell for line in body.rows(2, 16) for cell in line.columns(3, 16)]
    children: list[Widget] = [title(head, Icon.TRIP, say("Trip A"), "trip.title")]
    for cell, (key, name, value, icon) in zip(cells, tiles, strict=True):
        upper, _, lower = column(cell.inset(20, 16), 32, REST, 56)
        picture, _, words = row(upper, 32, 12, REST)
        children.append(
            Card(
                rect=cell,
                look="raised",
                children=(
                    Glyph(rect=picture, icon=icon, size=28, tone="accent"),
                    Label(rect=words, text=name, style=Type.LABEL, tone="muted"),
                    Label(rect=lower, key=key, text=value, description=name, style=Type.HEADLINE),
                ),
            )
        )
    children.append(Button(rect=reset, key="trip.reset", text=say("Reset"), icon=Icon.TRIP, on_tap=ResetTrip()))
    children.append(
        Button(
            rect=other,
            key="trip.other",
            text=say("Trip B"),
            icon=Icon.TRIP,
            on_tap=Show("trip_b"),
        )
    )
    return (Card(rect=area, children=tuple(children)),)


def calendar(state: State) -> tuple[Widget, ...]:
    """The day's appointments; each leads to its place."""
    area = content(state)
    inner = area.inset(28, 20)
    agenda = state.desk.agenda
    date = say("Today") if state.outside is None else f"{state.outside.local_time:%Y-%m-%d}"

    def line(index: int, cell: Rect) -> Row:
        entry = agenda[index]
        return Row(
            rect=cell,
            key=f"calendar.{index}",
            raised=True,
            text=joined(" ", (entry.at, entry.title)),
            detail=entry.place,
            trail=say("Open"),
            icon=Icon.CALENDAR,
            on_tap=Show("appointment", entry.name),
        )

    return (
        Card(
            rect=area,
            children=(
                title(inner.top(40), Icon.CALENDAR, date, "calendar.date"),
                rows(inner.below(56), "calendar.entries", say("Appointments"), state, len(agenda), line, height=76)
                if agenda
                else note(inner.below(56), "calendar.empty", say("Nothing today")),
            ),
        ),
    )
