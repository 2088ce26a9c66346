"""The second trip meter, which keeps counting when the first is reset."""

from __future__ import annotations

from automotive_cosim.cockpit.errands import odometer
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.messages import Back, ResetTrip
from automotive_cosim.cockpit.screens.media import minutes
from automotive_cosim.cockpit.screens.parts import content, distance, fact, title
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.vehicle import BATTERY_KWH
from automotive_cosim.cockpit.widgets import Button, Card, Widget
from automotive_cosim.contracts.text import Quantity, say


def trip_b(state: State) -> tuple[Widget, ...]:
    """Distance, time and energy of trip B; the mean is left to the reader."""
    area = content(state)
    head, _, body, _, buttons = column(area.inset(32, 24), 40, 20, 3 * 64, REST, 72)
    driven_m, took_s, used_kwh = state.desk.trip_b.at(odometer(state), BATTERY_KWH)
    facts = (
        ("trip_b.distance", say("Distance"), distance(state.signals, driven_m)),
        ("trip_b.time", say("Driving time"), minutes(took_s)),
        ("trip_b.energy", say("Energy"), Quantity(f"{used_kwh:.1f} kWh")),
    )
    lines = body.left(640).rows(3, 8)
    return (
        Card(
            rect=area,
            children=(
                title(head, Icon.TRIP, say("Trip B"), "trip_b.title"),
                *(
                    widget
                    for rect, (key, name, value) in zip(lines, facts, strict=True)
                    for widget in fact(rect, key, name, value)
                ),
                Button(
                    rect=buttons.left(320),
                    key="trip_b.reset",
                    text=say("Reset"),
                    icon=Icon.TRIP,
                    on_tap=ResetTrip("b"),
                ),
                Button(
                    rect=buttons.right_part(320),
                    key="trip_b.back",
                    text=say("Trip A"),
                    icon=Icon.BACK,
                    on_tap=Back(),
                ),
            ),
        ),
    )
