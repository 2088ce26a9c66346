"""Sub-screens of Map: places by kind, one place before departure, and the route with its turns and options."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from automotive_cosim.cockpit.apps.map.commands import Guide, Take
from automotive_cosim.cockpit.apps.map.screens import arrival, away, destination, panel, sight, turns_ahead
from automotive_cosim.cockpit.apps.map.state import AVOIDABLE, NO_GOAL, Navigation, Turn
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.cards import SMALL, choice, choices, heading, note, rows
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import BlockItem, BlockPart, at, fill, framed, grid, line, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Back, Pick, Show
from automotive_cosim.cockpit.pois import SORTS, Destination, Gazetteer, PoiKind
from automotive_cosim.cockpit.signals import VOICE
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.values import distance
from automotive_cosim.cockpit.widgets import Button, Glyph, Label, Look, Row, Tile, Widget
from automotive_cosim.contracts import RouteOption
from automotive_cosim.contracts.text import say

_EVERYDAY = tuple(kind for kind in PoiKind if kind not in (PoiKind.HOME, PoiKind.WORK))


def explore(state: State) -> tuple[Widget, ...]:
    """Kinds of places, and those of the chosen kind, the nearest first."""
    chosen = state.picked["explore"]
    if chosen == "all":
        return _page(state, say("Places nearby"), Icon.PLACE, "explore", 16, (REST, _kinds(state)))
    kind = PoiKind(chosen)
    found = nearest(state, state.of(Gazetteer).of(kind))
    places = rows(
        "explore.places",
        say("Places"),
        state,
        found,
        lambda index, each: destination(f"explore.place.{index}", each.name, state),
    )
    listed = places if found else note("explore.empty", say("None found nearby"))
    return _page(state, SORTS[kind].title, SORTS[kind].icon, "explore", 16, (REST, listed))


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


def _page(state: State, text: str, icon: Icon, key: str, *items: BlockItem) -> tuple[Widget, ...]:
    """A title with a way back, what is given below it, and the map."""
    picture = at(lambda box: box.middle(32, 32), Glyph(icon=icon, size=28, tone="accent"))
    back = Button(key=f"{key}.back", description=say("Back"), icon=Icon.BACK, on_tap=Back())
    head = line((56, back), 16, (32, picture), 8, Label(key=f"{key}.title", text=text, style=Type.TITLE))
    return *fill(panel(state), stack((56, head), *items)), sight(state)


def _kinds(state: State) -> BlockPart:
    def entry(index: int, kind: PoiKind) -> Button:
        return Button(
            key=f"explore.kind.{kind}",
            text=SORTS[kind].title,
            icon=SORTS[kind].icon,
            icon_size=30,
            stacked=True,
            on_tap=Show("explore", kind),
        )

    return rows("explore.kinds", say("Place types"), state, _EVERYDAY, entry, columns=2, height=84, gap=10)


def place(state: State) -> tuple[Widget, ...]:
    """One destination, before departure."""
    name = state.picked.get("place") or next(iter(state.of(Navigation).favourites), "")
    known = state.of(Gazetteer).find(name)
    street = known.street if known else say("Street in this area")
    detail = known.detail if known else say("The nearest point of the street")
    far = say("{distance} away", distance=away(state, name)) if known else ""
    facts = grid(
        1,
        4,
        Label(key="place.street", text=street, style=Type.STRONG, lines=2),
        Label(key="place.detail", text=detail, style=Type.LABEL, tone="muted", lines=2),
        Label(key="place.distance", text=far, style=Type.LABEL, tone="muted", lines=2),
    )
    icon = known.icon if known else Icon.ROUTE
    return _page(
        state, name, icon, "place", 16, (200, framed(facts, SMALL)), GAP, *_place_buttons(name, known, state), REST
    )


def _place_buttons(name: str, known: Destination | None, state: State) -> Iterator[BlockItem]:
    navigation = state.of(Navigation)
    saved = name in navigation.favourites
    goal = navigation.destination
    there = say("Already navigating there") if goal == name else ""
    start = Button(
        key="place.start",
        text=say("Navigating there") if there else say("Start guidance"),
        icon=Icon.ROUTE,
        look=Look.ACCENT,
        on_tap=Guide(name),
        disabled=there,
    )
    stop = Button(
        key="place.stop",
        text=say("Add as a stop"),
        icon=Icon.PLACE,
        on_tap=Guide(name, goal),
        disabled=there or ("" if goal else NO_GOAL),
    )
    save = Button(
        key="place.save",
        text=say("Remove from saved") if saved else say("Save"),
        icon=Icon.STAR if saved else Icon.STAR_OUTLINE,
        on_tap=Put(
            navigation.with_favourite(name, not saved),
            say("{name} is no longer saved", name=name) if saved else say("{name} is now saved", name=name),
        ),
    )
    yield from ((56, start), 8, (56, stop), 8, (56, save))
    if known is not None and known.kind is PoiKind.PARKING and "parking" in state.of(Installed).apps:
        pay = Button(key="place.pay", text=say("Pay for parking"), icon=Icon.TICKET, on_tap=Show("parking"))
        yield from (8, (56, pay))


def route(state: State) -> tuple[Widget, ...]:
    """The route ahead: its turns, alternatives, and what to avoid."""
    shown = state.picked["route"]
    goal = state.of(Navigation).destination or say("Route")
    parts = (("turns", say("Directions")), ("ways", say("Routes")), ("options", say("Options")))
    tabs = choices("route.tab", ((name, text, None, shown == name, Pick("route", name)) for name, text in parts))
    body = {"turns": _turn_list, "ways": _ways, "options": _options}[shown](state)
    summary = framed(arrival("route", state), (20, 10))
    return _page(state, goal, Icon.TURNS, "route", 8, (72, summary), 12, (56, tabs), 12, (REST, body))


def _turn_list(state: State) -> BlockPart:
    def entry(index: int, each: tuple[Turn, float]) -> Row:
        turn, away_m = each
        return Row(
            key=f"route.turn.{index}",
            text=turn.words,
            detail=turn.street,
            trail=distance(state.signals, away_m),
            icon=turn.icon,
        )

    ahead = turns_ahead(state)
    turns = rows("route.turns", say("Directions"), state, ahead, entry, height=60, gap=6)
    return turns if ahead else note("route.turns.empty", say("The route is not known yet"))


def _ways(state: State) -> BlockPart:
    """The present route, alternatives, and places to charge on the way."""
    ahead = None if state.outside is None else state.outside.driving.ahead
    others = () if ahead is None else ahead.alternatives
    chargers = along(state, state.of(Gazetteer).of(PoiKind.CHARGING))

    def other(number: int, each: RouteOption) -> Row:
        longer = _more(each.eta_s, 0 if ahead is None else ahead.eta_s)
        delay = say("{minutes} min delay", minutes=f"{each.delay_s / 60:.0f}")
        return Row(
            text=say("Route {number}", number=number),
            detail=say("{first}, {second}", first=longer, second=delay),
            trail=distance(state.signals, each.length_m),
            icon=Icon.ROUTE,
            on_tap=Take(each.edges),
        )

    lines = [other(number, each) for number, each in enumerate(others, 2)]
    faster = Row(
        text=say("Look for a faster route"), detail=say("In current traffic"), icon=Icon.ROUTE, on_tap=Guide("")
    )
    lines.append(faster)
    lines += [
        Row(
            text=charger.name,
            detail=charger.detail,
            trail=away(state, charger.name),
            icon=Icon.CHARGING,
            on_tap=Show("place", charger.name),
        )
        for charger in chargers
    ]
    return rows(
        "route.ways",
        say("Other routes and charging stops"),
        state,
        lines,
        lambda index, each: replace(each, key=f"route.way.{index}"),
        height=60,
        gap=6,
    )


def _more(eta_s: float, now_s: float) -> str:
    minutes = round((eta_s - now_s) / 60)
    if minutes == 0:
        return say("Same time")
    if minutes > 0:
        return say("{minutes} min longer", minutes=minutes)
    return say("{minutes} min shorter", minutes=-minutes)


def _options(state: State) -> BlockPart:
    navigation = state.of(Navigation)
    onward = navigation.onward

    def avoided(name: str, text: str, icon: Icon) -> Tile:
        on = name in navigation.avoid
        said = say("{roads} are no longer avoided", roads=text) if on else say("{roads} are avoided", roads=text)
        put = Put(navigation.with_avoided(name, not on), said)
        return Tile(key=f"route.avoid.{name}", text=text, icon=icon, checked=on, on_tap=put)

    stop = Button(
        key="route.onward",
        text=say("Skip the stop: {place}", place=onward) if onward else say("Remove the stop"),
        icon=Icon.GOAL,
        on_tap=Guide(onward),
        disabled="" if onward else say("There is no stop on the route"),
    )
    return stack(
        heading(say("Avoid")),
        4,
        (128, grid(2, 8, *(avoided(name, text, icon) for name, (text, icon) in AVOIDABLE.items()))),
        8,
        heading(say("Voice guidance")),
        4,
        (56, choice(VOICE.GUIDANCE, state)),
        12,
        (56, stop),
    )
