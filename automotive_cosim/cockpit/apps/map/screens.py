"""Map: the road around the car, the route ahead, and destinations."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import timedelta

from automotive_cosim.cockpit.apps.map import lookout
from automotive_cosim.cockpit.apps.map.commands import Follow, Guide, Zoom
from automotive_cosim.cockpit.apps.map.scene import Spot, box_of, ego, goal, incidents, jam, map_camera, scene
from automotive_cosim.cockpit.apps.map.state import Navigation, Turn, Viewpoint, turns
from automotive_cosim.cockpit.cards import HELD_STEPS, choices, content, heading, note, rows, search
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.flow import Block, at, card, fill, framed, grid, line, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.map import ZOOMS_M_PER_PX, Camera
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.pois import Gazetteer, PoiKind
from automotive_cosim.cockpit.restrictions import ENTRIES_LIMIT
from automotive_cosim.cockpit.signals import VOICE
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.telltales import RoadSign, SignKind
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.values import distance, sign_figure, sign_in_words
from automotive_cosim.cockpit.widgets import Badge, Button, Card, Glyph, Label, Look, MapView, Row, SignView, Widget
from automotive_cosim.contracts import IncidentKind, Road, RoadHere
from automotive_cosim.contracts.text import say

INCIDENTS: Mapping[IncidentKind, tuple[str, Icon]] = {
    IncidentKind.CLOSURE: (say("Road closed"), Icon.CLOSURE),
    IncidentKind.BREAKDOWN: (say("Broken-down vehicle"), Icon.HAZARD),
    IncidentKind.ROADWORKS: (say("Roadworks"), Icon.ROADWORKS),
    IncidentKind.JAM: (say("Traffic jam"), Icon.JAM),
    IncidentKind.SCHOOL_ZONE: (say("School zone"), Icon.CHILD),
}
"""Incidents of live traffic, the most serious first: of overlapping marks, the first is shown."""
_CLASSES = {
    "motorway": say("Motorway"),
    "trunk": say("Expressway"),
    "service": say("Service road"),
    "residential": say("Side street"),
}
PANEL_WIDTH, PANEL_HEIGHT = 372, 544
RESULTS = ENTRIES_LIMIT
CHARGER, MARK, STEP = 28, 40, 5
"""Side of the mark of a charging stop, of any other mark, and by how much that moves on its road, in pixels."""


def map_screen(state: State) -> tuple[Widget, ...]:
    """Search, favourites and recent destinations next to the map."""
    return *fill(panel(state), _panel(state)), sight(state)


def panel(state: State) -> Rect:
    """The box next to the map; where it is taller than wide, below."""
    return _parts(content(state))[0]


def _parts(rect: Rect) -> tuple[Rect, Rect]:
    """The panel and the map."""
    if rect.height > rect.width:
        above, _, below = column(rect, REST, GAP, PANEL_HEIGHT)
        return below, above
    left, right = panes(rect, PANEL_WIDTH, REST)
    return left, right


def sight(state: State) -> Widget:
    """The map, with the next turn, the road and the buttons over it."""
    rect = _parts(content(state))[1]
    left, _, keys = row(rect.inset(20), 560, REST, 64)
    turn, _, lowest = column(left, 72, REST, 56)
    plate = lowest.left(420)
    ahead = next_turn(state)
    zoom = state.of(Viewpoint).zoom
    noticed = lookout.plate(rect.x + 20, turn.bottom + 12 if ahead else turn.y, 440, state)
    sign = sign_view(Rect(plate.right + 12, plate.bottom - 64, 64, 64), "map.sign", state)
    silent = state.signals[VOICE.GUIDANCE] == "MUTED"
    voice = Button(
        key="map.voice",
        description=say("Guidance is silent") if silent else say("Guidance speaks"),
        icon=Icon.MUTE if silent else Icon.VOICE,
        look=Look.FLOATING,
        on_tap=Set(VOICE.GUIDANCE, "UNMUTED" if silent else "MUTED"),
    )

    def zoomed(key: str, words: str, icon: Icon, by: int, end: str) -> Button:
        return Button(
            key=f"map.zoom_{key}",
            description=words,
            icon=icon,
            look=Look.FLOATING,
            on_tap=Zoom(by),
            on_hold=Zoom(by * HELD_STEPS),
            disabled="" if 0 <= zoom + by < len(ZOOMS_M_PER_PX) else end,
        )

    closer = zoomed("in", say("Zoom in"), Icon.PLUS, -1, say("The map cannot zoom in further"))
    further = zoomed("out", say("Zoom out"), Icon.MINUS, 1, say("The map cannot zoom out further"))
    buttons = fill(keys, stack((64, _orientation(state)), REST, (64, voice), 12, (64, closer), 12, (64, further)))
    north, *others = (button.rect for button in buttons)
    over = (
        *(each.rect for each in sign),
        plate,
        *others,
        north,
        *((turn,) if ahead else ()),
        *(card.rect for card in noticed),
    )
    view = map_view(rect, "map.view", state, map_camera(state), over, None, Zoom(-1) if zoom else None, pans=True)
    return Card(
        rect=rect,
        look="none",
        children=(
            view,
            *(fill(turn, _turn_plate(ahead, state)) if ahead else ()),
            *noticed,
            *sign,
            *fill(plate, street_plate(state)),
            *buttons,
        ),
    )


def sign_view(rect: Rect, key: str, state: State) -> tuple[SignView, ...]:
    """The last road sign over a map; none without the camera."""
    if not state.sign_camera:
        return ()
    sign = state.last_sign
    figure = "" if sign is None or sign.limit_kmh is None else sign_figure(sign.limit_kmh, sign.unit)
    told = _last_sign(sign, state)
    return (SignView(rect=rect, key=key, description=told, sign=sign, figure=figure),)


def _last_sign(sign: RoadSign | None, state: State) -> str:
    """What the last sign says, for the list."""
    if sign is None:
        return say("Last sign")
    match sign.kind:
        case SignKind.LIMIT:
            limit = sign_in_words(state.signals, sign.limit_kmh or 0.0, sign.unit)
            shown = say("Limit sign {limit}", limit=limit)
        case SignKind.END_OF_LIMIT:
            shown = say("End of limit")
        case SignKind.SCHOOL:
            shown = say("School zone")
        case SignKind.TUNNEL:
            shown = say("Tunnel")
    return say("Last sign: {sign}", sign=shown)


def _orientation(state: State) -> Button:
    """Back to the car if the map was moved away; otherwise turns the map."""
    view = state.of(Viewpoint)
    if view.panned is not None:
        words, icon, message = say("Back to the car"), Icon.GPS, Follow(view.north_up)
    elif view.north_up:
        words, icon, message = say("North up"), Icon.COMPASS, Follow(False)
    else:
        words, icon, message = say("Heading up"), Icon.NAVIGATION, Follow(True)
    return Button(key="map.orientation", description=words, icon=icon, look=Look.FLOATING, on_tap=message)


def map_view(
    rect: Rect,
    key: str,
    state: State,
    camera: Camera,
    avoid: tuple[Rect, ...],
    on_tap: Message | None = None,
    on_double_tap: Message | None = None,
    pans: bool = False,
) -> MapView:
    """The moving map in a box, with the street names and marks that fit next to what is over it."""
    marks = _marks(rect, state, camera, avoid)
    taken = (*avoid, *(mark.rect for mark in marks))
    names = state.roads.names_in_sight(rect, camera, taken)
    chargers = _chargers(rect, state, camera, (*taken, *(name.rect for name in names)))
    return MapView(
        rect=rect,
        key=key,
        description=_sight(state),
        roads=state.roads,
        scene=scene(state, camera),
        on_tap=on_tap,
        on_double_tap=on_double_tap,
        pans=pans,
        children=(
            *(
                Label(rect=name.rect, text=name.text, style=Type.SMALL, align="centre", plate=True)
                for name in names
            ),
            *chargers,
            *marks,
        ),
    )


def _sight(state: State) -> str:
    """A description of the map; without live traffic, also the time of the last report."""
    if state.heard is None or state.heard is state.outside:
        return say("Map around {street}", street=street(state))
    return say(
        "Map around {street}, traffic as of {time}",
        street=street(state),
        time=state.clock_at(state.heard.local_time),
    )


def _chargers(rect: Rect, state: State, camera: Camera, avoid: tuple[Rect, ...]) -> tuple[Badge, ...]:
    """Small marks of the charging stops in sight that cover nothing else."""
    here = ego(state)
    taken = [*avoid] if here is None else [*avoid, box_of(camera, rect, here[:2], 48)]
    room, found = rect.inset(4), list[Badge]()
    for stop in state.of(Gazetteer).of(PoiKind.CHARGING):
        box = box_of(camera, rect, (stop.x_m, stop.y_m), CHARGER)
        if room.encloses(box) and not any(box.overlaps(other) for other in taken):
            taken.append(box)
            found.append(Badge(rect=box, icon=Icon.CHARGING, charges=True))
    return tuple(found)


def _marks(rect: Rect, state: State, camera: Camera, avoid: tuple[Rect, ...]) -> tuple[Widget, ...]:
    """Marks of jam, destination and incidents, as far as they are visible.

    A mark that would cover the car stands before or behind it on its road."""
    known: list[tuple[str, str, Icon, Spot | None]] = [
        ("jam", say("Traffic jam starts here"), Icon.JAM, jam(state)),
        ("end", say("The route ends here"), Icon.GOAL, goal(state)),
    ]
    told = enumerate(incidents(state, besides_jam=known[0][3] is not None))
    for number, (kind, spot) in sorted(told, key=lambda one: list(INCIDENTS).index(one[1][0])):
        words, icon = INCIDENTS[kind]
        named = say("{name}: {value}", name=words, value=road_name(spot.road))
        known.append((f"incident.{number}", named, icon, spot))
    here = ego(state)
    car = None if here is None else box_of(camera, rect, here[:2], 48)
    found: list[Badge] = []
    for name, words, icon, place in known:
        if place is None:
            continue
        points = place.points(STEP * camera.metres_per_pixel)
        box = first = box_of(camera, rect, next(points), MARK)
        if car is not None and box.overlaps(car):
            others = (box_of(camera, rect, point, MARK) for point in points)
            box = next((each for each in others if not each.overlaps(car)), first)
        taken = (*avoid, *(mark.rect for mark in found))
        if rect.inset(4).encloses(box) and not any(box.overlaps(other) for other in taken):
            found.append(Badge(rect=box, key=f"map.{name}", description=words, icon=icon, warns=name != "end"))
    return tuple(found)


def road_name(road: Road | RoadHere) -> str:
    """Name of a road, or its kind."""
    return road.name or _CLASSES.get(road.road_class, say("Unnamed road"))


def street(state: State) -> str:
    """Name of the present road, or its kind."""
    if state.outside is None:
        return say("Locating")
    return road_name(state.outside.driving.road)


def turns_ahead(state: State) -> tuple[tuple[Turn, float], ...]:
    """The turns of the route and their distances in metres."""
    if state.outside is None:
        return ()
    driving = state.outside.driving
    found = turns(state.roads, driving.ahead.route_edges)
    return tuple((turn, max(0.0, turn.after_m - driving.road.lane_position_m)) for turn in found)


def next_turn(state: State) -> tuple[Turn, float] | None:
    """The next turn."""
    return next(iter(turns_ahead(state)), None)


def _turn_plate(ahead: tuple[Turn, float], state: State) -> Block:
    turn, away_m = ahead
    far = Label(
        key="map.next_turn.distance",
        text=distance(state.signals, away_m),
        description=say("Distance to the next turn"),
        style=Type.TITLE,
    )
    words = Label(
        key="map.next_turn",
        text=say("{name}: {value}", name=turn.words, value=turn.street),
        description=say("Next turn"),
        style=Type.LABEL,
        lines=2,
    )
    picture = at(lambda box: box.middle(44, 44), Glyph(icon=turn.icon, size=42, tone="accent"))
    texts = line((116, far), 4, words)
    parts = line((44, picture), 14, at(lambda box: box.inset(0, 8), texts))
    return framed(parts, (14, 0), look="plate")


def street_plate(state: State) -> Block:
    """The present road, over a map."""
    tunnel = state.outside is not None and state.outside.driving.road.in_tunnel
    picture = Glyph(
        icon=Icon.TUNNEL if tunnel else Icon.MAP,
        size=26,
        tone="accent",
        key="map.tunnel" if tunnel else "",
        description=say("In a tunnel") if tunnel else "",
    )
    words = Label(key="map.street", text=street(state), description=say("Current road"), style=Type.STRONG)
    shown = at(lambda box: box.right_part(28).middle(28, 28), picture)
    return framed(line((44, shown), 12, words, 20), look="plate")


def _panel(state: State) -> Block:
    found = matches(state)
    typed = bool(state.typed.get("map.search")) or state.focus == "map.search"
    shown = state.picked["map.list"]
    known = state.of(Navigation)
    names = found if typed else known.recents if shown == "recent" else known.favourites
    tabs = choices(
        "map.list",
        [
            ("saved", say("Saved"), Icon.STAR, shown == "saved", Pick("map.list", "saved", rewinds="map.")),
            ("recent", say("Recent"), Icon.HISTORY, shown == "recent", Pick("map.list", "recent", rewinds="map.")),
            ("explore", say("Near"), Icon.PLACE, False, Show("explore", "all")),
        ],
    )
    results = at(lambda box: box.moved(4, 14).top(28), heading(say("Results"), "map.results"))
    nothing = say("No street or place with this name") if typed else say("No destinations yet")
    places = rows(
        "map.places",
        say("Destinations"),
        state,
        names,
        lambda index, name: destination(f"map.place.{index}", name, state),
        height=60,
        gap=6,
    )
    field = search(
        "map.search",
        say("Search for a place or street"),
        say("Where to?"),
        state,
        Guide(found[0]) if typed and found else None,
    )
    return stack(
        (64, field),
        12,
        (56, results if typed else tabs),
        12,
        (REST, places if names else note("map.places.empty", nothing)),
        GAP,
        (184, _way(state)),
    )


def destination(key: str, name: str, state: State) -> Row:
    """A line of a list of destinations."""
    place = state.of(Gazetteer).find(name)
    return Row(
        key=key,
        text=name,
        detail=place.street if place else say("Street"),
        trail=away(state, name),
        icon=place.icon if place else Icon.ROUTE,
        selected=name == state.of(Navigation).destination,
        on_tap=Show("place", name),
    )


def away(state: State, name: str) -> str:
    """Straight-line distance of a place; empty for a street."""
    place = state.of(Gazetteer).find(name)
    if place is None or state.outside is None:
        return ""
    driving = state.outside.driving
    return distance(state.signals, place.away_m(driving.x_m, driving.y_m))


def matches(state: State) -> tuple[str, ...]:
    """Places and streets whose name contains the typed text."""
    wanted = state.typed.get("map.search", "").casefold().strip()
    if not wanted:
        return ()
    places = (place.name for place in state.of(Gazetteer).places if wanted in place.name.casefold())
    streets = (name for name in state.roads.names if wanted in name.casefold())
    return (*places, *streets)[:RESULTS]


def _way(state: State) -> Block:
    goal = state.of(Navigation).destination
    faster = Button(key="map.faster_route", text=say("Faster"), icon=Icon.ROUTE, on_tap=Guide(""))
    details = Button(key="map.route", text=say("Route"), icon=Icon.TURNS, on_tap=Show("route"))
    return card(
        heading(say("To {place}", place=goal) if goal else say("Arrival"), "map.goal"),
        2,
        (50, arrival("map", state)),
        REST,
        (56, grid(2, 12, faster, details)),
        padding=(20, 14),
    )


def arrival(key: str, state: State) -> Block:
    """Arrival time, distance and delay."""
    ahead = None if state.outside is None else state.outside.driving.ahead
    time, left, late = "--:--", "", ""
    if state.outside is not None and ahead is not None:
        time = state.clock_at(state.outside.local_time + timedelta(seconds=ahead.eta_s))
        left = distance(state.signals, ahead.route_left_m)
        late = say("{minutes} min delay", minutes=ahead.delay_min) if ahead.delay_min else say("No delay")
    far = Label(
        key=f"{key}.route_left", text=left, description=say("Distance left"), style=Type.LABEL, align="right"
    )
    delay = Label(
        key=f"{key}.delay",
        text=late,
        description=say("Traffic delay"),
        style=Type.CAPTION,
        tone="muted",
        align="right",
    )
    when = Label(key=f"{key}.arrival", text=time, description=say("Arrival time"), style=Type.HEADLINE)
    return grid(2, 12, when, stack((26, far), REST, (24, delay)))
