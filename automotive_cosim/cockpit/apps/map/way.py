"""Sub-screens of Map: places by kind, one place before departure, and the route with its turns and options."""

from __future__ import annotations

from collections.abc import Sequence

from automotive_cosim.cockpit.apps.map.commands import Guide, Take
from automotive_cosim.cockpit.apps.map.screens import arrival, away, destination, panel, sight, turns_ahead
from automotive_cosim.cockpit.apps.map.state import AVOIDABLE, NO_GOAL, Navigation
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.messages import Back, Pick, Show
from automotive_cosim.cockpit.parts import choices, distance, heading, note, rows
from automotive_cosim.cockpit.places import SORTS, Destination, Gazetteer, PlaceKind
from automotive_cosim.cockpit.signals import VOICE
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Glyph, Label, Look, Row, Tile, Widget
from automotive_cosim.contracts.text import say, say_in

_EVERYDAY = tuple(kind for kind in PlaceKind if kind not in (PlaceKind.HOME, PlaceKind.WORK))


def explore(state: State) -> tuple[Widget, ...]:
    """Kinds of places, and those of the chosen kind, the nearest first."""
    chosen = state.picked["explore"]
    if chosen == "all":
        return *_head(state, say("Places nearby"), Icon.PLACE, "explore"), _kinds(state), sight(state)
    kind = PlaceKind(chosen)
    found = nearest(state, state.of(Gazetteer).of(kind))
    return (
        *_head(state, SORTS[kind].title, SORTS[kind].icon, "explore"),
        _places(state, found) if found else note(panel(state).below(72), "explore.empty", say("None found nearby")),
        sight(state),
    )


def nearest(state: State, places: Sequence[Destination]) -> tuple[Destination, ...]:
    """Places by distance from the car."""
    if state.outside is None:
        return tuple(places)
    driving = state.outside.driving
    return tuple(sorted(places, key=lambda place: (place.away_m(driving.x_m, driving.y_m), place.name)))


def along(state: State, places: Sequence[Destination]) -> tuple[Destination, ...]:
    """Places by their distance from the route."""
    route = () if state.outside is None else state.outside.driving.ahead.route_edges
    ways = [road for road in map(state.roads.find, route) if road is not None]
    if not ways:
        return nearest(state, places)
    ends = [road.shape_m[-1] for road in ways]
    beside = {place: min(place.away_m(*end) for end in ends) for place in places}
    return tuple(sorted(places, key=lambda place: (beside[place], place.name)))


def _head(state: State, text: str, icon: Icon, key: str) -> tuple[Widget, ...]:
    back, _, picture, _, words = row(panel(state).top(56), 56, 16, 32, 8, REST)
    return (
        Button(rect=back, key=f"{key}.back", description=say("Back"), icon=Icon.BACK, on_tap=Back()),
        Glyph(rect=picture.middle(32, 32), icon=icon, size=28, tone="accent"),
        Label(rect=words, key=f"{key}.title", text=text, style=Type.TITLE),
    )


def _kinds(state: State) -> Widget:
    return rows(
        panel(state).below(72),
        "explore.kinds",
        say("Place types"),
        state,
        len(_EVERYDAY),
        lambda index, cell: Button(
            rect=cell,
            key=f"explore.kind.{_EVERYDAY[index]}",
            text=SORTS[_EVERYDAY[index]].title,
            icon=SORTS[_EVERYDAY[index]].icon,
            icon_size=30,
            stacked=True,
            on_tap=Show("explore", _EVERYDAY[index]),
        ),
        columns=2,
        height=84,
        gap=10,
    )


def _places(state: State, found: tuple[Destination, ...]) -> Widget:
    return rows(
        panel(state).below(72),
        "explore.places",
        say("Places"),
        state,
        len(found),
        lambda index, cell: destination(cell, f"explore.place.{index}", found[index].name, state),
        height=64,
    )


def place(state: State) -> tuple[Widget, ...]:
    """One destination, before departure."""
    name = state.picked.get("place") or next(iter(state.of(Navigation).favourites), "")
    known = state.of(Gazetteer).find(name)
    _, card, _, buttons = column(panel(state), 72, 200, GAP, REST)
    inner = card.inset(20, 16)
    facts = (
        (known.street if known else say("Street in this area"), "place.street", Type.STRONG, "text"),
        (known.detail if known else say("The nearest point of the street"), "place.detail", Type.LABEL, "muted"),
        (
            say("{distance} away", distance=away(state, name)) if known else "",
            "place.distance",
            Type.LABEL,
            "muted",
        ),
    )
    lines = tuple(
        Label(rect=line, key=key, text=text, style=style, tone="text" if tone == "text" else "muted", lines=2)
        for line, (text, key, style, tone) in zip(inner.rows(3, 4), facts, strict=True)
    )
    return (
        *_head(state, name, known.icon if known else Icon.ROUTE, "place"),
        Card(rect=card, children=lines),
        *_place_buttons(buttons, name, known, state),
        sight(state),
    )


def _place_buttons(rect: Rect, name: str, known: Destination | None, state: State) -> tuple[Widget, ...]:
    navigation = state.of(Navigation)
    saved = name in navigation.favourites
    goal = navigation.destination
    cells = column(rect, 56, 8, 56, 8, 56, 8, 56)[::2]
    there = say("Already navigating there") if goal == name else ""
    extra: tuple[Widget, ...] = ()
    if known is not None and known.kind is PlaceKind.PARKING and "parking" in state.of(Installed).apps:
        extra = (
            Button(
                rect=cells[3],
                key="place.pay",
                text=say("Pay for parking"),
                icon=Icon.TICKET,
                on_tap=Show("parking"),
            ),
        )
    return (
        Button(
            rect=cells[0],
            key="place.start",
            text=say("Navigating there") if there else say("Start guidance"),
            icon=Icon.ROUTE,
            look=Look.ACCENT,
            on_tap=Guide(name),
            disabled=there,
        ),
        Button(
            rect=cells[1],
            key="place.stop",
            text=say("Add as a stop"),
            icon=Icon.PLACE,
            on_tap=Guide(name, goal),
            disabled=there or ("" if goal else NO_GOAL),
        ),
        Button(
            rect=cells[2],
            key="place.save",
            text=say("Remove from saved") if saved else say("Save"),
            icon=Icon.STAR if saved else Icon.STAR_OUTLINE,
            on_tap=Put(
                navigation.with_favourite(name, not saved),
                say("{name} is no longer saved", name=name) if saved else say("{name} is now saved", name=name),
            ),
        ),
        *extra,
    )


def route(state: State) -> tuple[Widget, ...]:
    """The route ahead: its turns, alternatives, and what to avoid."""
    shown = state.picked["route"]
    goal = state.of(Navigation).destination or say("Route")
    _, summary, _, tabs, _, body = column(panel(state), 64, 72, 12, 56, 12, REST)
    pages = {"turns": _turn_list, "ways": _ways, "options": _options}
    return (
        *_head(state, goal, Icon.TURNS, "route"),
        Card(rect=summary, children=arrival(summary.inset(20, 10), "route", state)),
        choices(
            tabs,
            "route.tab",
            [
                (name, text, None, shown == name, Pick("route", name))
                for name, text in (
                    ("turns", say("Directions")),
                    ("ways", say("Routes")),
                    ("options", say("Options")),
                )
            ],
        ),
        *pages[shown](body, state),
        sight(state),
    )


def _turn_list(rect: Rect, state: State) -> tuple[Widget, ...]:
    ahead = turns_ahead(state)
    if not ahead:
        return (note(rect, "route.turns.empty", say("The route is not known yet")),)
    return (
        rows(
            rect,
            "route.turns",
            say("Directions"),
            state,
            len(ahead),
            lambda index, cell: Row(
                rect=cell,
                key=f"route.turn.{index}",
                text=ahead[index][0].words,
                detail=ahead[index][0].street,
                trail=distance(state.signals, ahead[index][1]),
                icon=ahead[index][0].icon,
            ),
            height=60,
            gap=6,
        ),
    )


def _ways(rect: Rect, state: State) -> tuple[Widget, ...]:
    """The present route, alternatives, and places to charge on the way."""
    ahead = None if state.outside is None else state.outside.driving.ahead
    others = () if ahead is None else ahead.alternatives
    chargers = along(state, state.of(Gazetteer).of(PlaceKind.CHARGING))
    lines: list[tuple[str, str, str, Icon, Take | Guide | Show]] = [
        (
            say("Route {number}", number=at + 2),
            say(
                "{first}, {second}",
                first=_more(other.eta_s, 0 if ahead is None else ahead.eta_s),
                second=say("{minutes} min delay", minutes=f"{other.delay_s / 60:.0f}"),
            ),
            distance(state.signals, other.length_m),
            Icon.ROUTE,
            Take(other.edges),
        )
        for at, other in enumerate(others)
    ]
    lines.append((say("Look for a faster route"), say("In current traffic"), "", Icon.ROUTE, Guide("")))
    lines += [
        (charger.name, charger.detail, away(state, charger.name), Icon.CHARGING, Show("place", charger.name))
        for charger in chargers
    ]
    return (
        rows(
            rect,
            "route.ways",
            say("Other routes and charging stops"),
            state,
            len(lines),
            lambda index, cell: Row(
                rect=cell,
                key=f"route.way.{index}",
                text=lines[index][0],
                detail=lines[index][1],
                trail=lines[index][2],
                icon=lines[index][3],
                on_tap=lines[index][4],
            ),
            height=60,
            gap=6,
        ),
    )


def _more(eta_s: float, now_s: float) -> str:
    minutes = round((eta_s - now_s) / 60)
    if minutes == 0:
        return say("Same time")
    if minutes > 0:
        return say("{minutes} min longer", minutes=minutes)
    return say("{minutes} min shorter", minutes=-minutes)


def _options(rect: Rect, state: State) -> tuple[Widget, ...]:
    navigation = state.of(Navigation)
    avoid, _, tiles, _, spoken, _, voices, _, stop = column(rect, 28, 4, 128, 8, 28, 4, 56, 12, 56)
    cells = [cell for line in tiles.rows(2, 8) for cell in line.columns(2, 8)]
    guidance = state.signals[VOICE.GUIDANCE]
    onward = navigation.onward
    return (
        heading(avoid, say("Avoid")),
        *(
            Tile(
                rect=cell,
                key=f"route.avoid.{name}",
                text=text,
                icon=icon,
                checked=name in navigation.avoid,
                on_tap=Put(
                    navigation.with_avoided(name, name not in navigation.avoid),
                    say("{roads} are no longer avoided", roads=text)
                    if name in navigation.avoid
                    else say("{roads} are avoided", roads=text),
                ),
            )
            for cell, (name, (text, icon)) in zip(cells, AVOIDABLE.items(), strict=True)
        ),
        heading(spoken, say("Voice guidance")),
        choices(
            voices,
            "route.voice",
            [
                (key, text, None, guidance == value, Set(VOICE.GUIDANCE, value))
                for key, text, value in (
                    ("all", say_in("guidance", "All"), "UNMUTED"),
                    ("alerts", say("Alerts"), "ALERT_ONLY"),
                    ("off", say("Off"), "MUTED"),
                )
            ],
        ),
        Button(
            rect=stop,
            key="route.onward",
            text=say("Skip the stop: {place}", place=onward) if onward else say("Remove the stop"),
            icon=Icon.GOAL,
            on_tap=Guide(onward),
            disabled="" if onward else say("There is no stop on the route"),
        ),
    )
