"""Sub-screens of Vehicle: driving, doors and windows, seats, mirrors, interior lights."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.vehicle.commands import Honk
from automotive_cosim.cockpit.apps.vehicle.screens import car_card, right_side, tabs
from automotive_cosim.cockpit.apps.vehicle.state import REMEMBERED, CarMemory
from automotive_cosim.cockpit.camera import scene
from automotive_cosim.cockpit.commands import Put, Set, SetAll
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.notices import LOW_KPA
from automotive_cosim.cockpit.parts import (
    StepWays,
    choices,
    fact,
    forward_back,
    grouped,
    heading,
    left_right,
    levels,
    lower_higher,
    pressure,
    slider,
    stepper,
    switch,
    upright_back,
)
from automotive_cosim.cockpit.signals import BODY, CABIN, DRIVE, HMI, MIRROR, MOTION, SEAT, TYRE, Signal
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.vehicle import LOCKS, WINDOWS
from automotive_cosim.cockpit.widgets import Button, CameraView, Card, Choice, Label, Tile, Widget
from automotive_cosim.contracts.text import say

MODES = {
    "NORMAL": ("normal", say("Normal")),
    "ECONOMY": ("economy", say("Economy")),
    "SPORT": ("sport", say("Sport")),
    "SNOW": ("snow", say("Snow")),
    "RAIN": ("rain", say("Rain")),
}
A_LITTLE = 20
"""Percent that the windows are opened for some air."""
MASSAGE_LEVELS = ((0.0, say("Off")), (50.0, say("Low")), (100.0, say("High")))
COLOURS = {
    "#FFE3B0": ("warm", say("Warm")),
    "#4FA8FF": ("blue", say("Blue")),
    "#45D18A": ("green", say("Green")),
    "#B57BFF": ("violet", say("Violet")),
    "#FF5C5C": ("red", say("Red")),
}


def _page(state: State, *cards: Widget) -> tuple[Widget, ...]:
    return car_card(state), tabs(state), *cards


def _area(state: State) -> Rect:
    return right_side(state).below(64 + GAP)


# --- driving ----------------------------------------------------------------------------------------------


def driving(state: State) -> tuple[Widget, ...]:
    """Drive mode, brakes and tyres."""
    signals = state.signals
    area = _area(state)
    mode, lower = area.top(132), area.below(132 + GAP)
    left, right = lower.columns(2, GAP)
    inner, hold = mode.inset(20, 14), left.inset(20, 16)
    now = signals[DRIVE.MODE]
    tiles = hold.below(36).rows(4, 10)
    return _page(
        state,
        Card(
            rect=mode,
            children=(
                heading(inner.top(28), say("Drive mode")),
                choices(
                    inner.bottom_part(68),
                    "drive.mode",
                    [
                        (key, text, None, now == value, Set(DRIVE.MODE, value))
                        for value, (key, text) in MODES.items()
                    ],
                ),
            ),
        ),
        Card(
            rect=left,
            children=(
                heading(hold.top(28), say("Brake and horn")),
                switch(
                    tiles[0],
                    "drive.parking_brake",
                    say("Parking brake"),
                    Icon.PARKING_BRAKE,
                    DRIVE.PARKING_BRAKE,
                    signals,
                    state.vehicle.held(DRIVE.PARKING_BRAKE),
                ),
                switch(
                    tiles[1],
                    "drive.parking_brake_auto",
                    say("Automatic parking brake"),
                    Icon.PARKING_BRAKE,
                    DRIVE.PARKING_BRAKE_AUTO,
                    signals,
                ),
                Button(rect=tiles[2], key="drive.horn", text=say("Horn"), icon=Icon.WARN, on_tap=Honk()),
                Card(
                    rect=tiles[3],
                    look="none",
                    children=fact(
                        tiles[3], "drive.washer", say("Washer fluid"), f"{signals[BODY.WASHER_FLUID]:.0f} %"
                    ),
                ),
            ),
        ),
        _tyres(right, state),
    )


def _tyres(rect: Rect, state: State) -> Widget:
    inner = rect.inset(20, 16)
    corners = (
        ("front_left", say("Front left"), say("Front left tyre"), TYRE.FRONT_LEFT),
        ("front_right", say("Front right"), say("Front right tyre"), TYRE.FRONT_RIGHT),
        ("rear_left", say("Rear left"), say("Rear left tyre"), TYRE.REAR_LEFT),
        ("rear_right", say("Rear right"), say("Rear right tyre"), TYRE.REAR_RIGHT),
    )
    cells = [cell for line in inner.below(36).rows(2, 12) for cell in line.columns(2, 12)]
    children: list[Widget] = [heading(inner.top(28), say("Tyre pressures"))]
    for cell, (key, name, tyre, signal) in zip(cells, corners, strict=True):
        low = state.signals[signal] < LOW_KPA
        children.append(
            Card(
                rect=cell,
                look="raised",
                children=(
                    Label(
                        rect=cell.inset(16, 12).top(26),
                        text=say("{name}: {value}", name=name, value=say("low")) if low else name,
                        style=Type.LABEL,
                        tone="text" if low else "muted",
                    ),
                    Label(
                        rect=cell.inset(16, 12).bottom_part(48),
                        key=f"tyre.{key}",
                        text=pressure(state.signals, state.signals[signal]),
                        description=tyre,
                        style=Type.TITLE,
                    ),
                ),
            )
        )
    return Card(rect=rect, children=tuple(children))


# --- doors, windows, roof -----------------------------------------------------------------------------------


def doors(state: State) -> tuple[Widget, ...]:
    """Locks, windows and the roof."""
    signals = state.signals
    upper, _, lower = column(_area(state), 176, GAP, REST)
    head, _, tiles = column(upper.inset(20, 14), 28, 4, REST)
    locked = all(signals[lock] for lock in LOCKS)
    cells = [cell for line in tiles.rows(2, 8) for cell in line.columns(4, 8)]
    return _page(
        state,
        Card(
            rect=upper,
            children=(
                heading(head, say("Locks and trunk")),
                *(
                    (
                        Label(
                            rect=head.right_part(head.width - 200),
                            key="door.driving",
                            text=say("Keep the doors locked while driving"),
                            style=Type.LABEL,
                            align="right",
                        ),
                    )
                    if signals[MOTION.IS_MOVING]
                    else ()
                ),
                Tile(
                    rect=cells[0],
                    key="door.all",
                    text=say("Lock all"),
                    icon=Icon.LOCK if locked else Icon.UNLOCKED,
                    checked=locked,
                    on_tap=SetAll(
                        tuple((lock, not locked) for lock in LOCKS),
                        say("all doors are unlocked") if locked else say("all doors are locked"),
                    ),
                ),
                *(
                    grouped(
                        switch(cell, f"door.{key}", name, icon, signal, signals, state.vehicle.held(signal)),
                        say("Doors") if signal is CABIN.TRUNK else say("Locks"),
                    )
                    for cell, (key, name, icon, signal) in zip(
                        cells[1:],
                        (
                            ("driver", say("Driver"), Icon.DOOR, CABIN.DRIVER_LOCK),
                            ("passenger", say("Passenger"), Icon.DOOR, CABIN.PASSENGER_LOCK),
                            ("rear_left", say("Rear left"), Icon.DOOR, CABIN.REAR_LEFT_LOCK),
                            ("rear_right", say("Rear right"), Icon.DOOR, CABIN.REAR_RIGHT_LOCK),
                            ("child_left", say("Left child lock"), Icon.CHILD, CABIN.LEFT_CHILD_LOCK),
                            ("child_right", say("Right child lock"), Icon.CHILD, CABIN.RIGHT_CHILD_LOCK),
                            ("trunk", say("Trunk"), Icon.TRUNK, CABIN.TRUNK),
                        ),
                        strict=True,
                    )
                ),
            ),
        ),
        Card(rect=lower, children=_windows(lower.inset(20, 12), state)),
    )


def _windows(rect: Rect, state: State) -> tuple[Widget, ...]:
    signals = state.signals
    head, _, body, _, acts = column(rect, 28, 4, REST, 8, 56)
    cells = [cell for line in body.rows(2, 4) for cell in line.columns(3, 24)]
    panes = (
        ("driver", say("Driver"), CABIN.DRIVER_WINDOW),
        ("passenger", say("Passenger"), CABIN.PASSENGER_WINDOW),
        ("sunroof", say("Sunroof"), CABIN.SUNROOF),
        ("rear_left", say("Rear left"), CABIN.REAR_LEFT_WINDOW),
        ("rear_right", say("Rear right"), CABIN.REAR_RIGHT_WINDOW),
        ("shade", say("Shade closed"), CABIN.SUNROOF_SHADE),
    )
    closed = all(signals[window] == 0 for window in WINDOWS)
    buttons = acts.columns(3, 24)
    return (
        heading(head, say("Windows and roof")),
        *(
            slider(cell, f"window.{key}", name, Icon.WINDOW, signal, signals)
            for cell, (key, name, signal) in zip(cells, panes, strict=True)
        ),
        Button(
            rect=buttons[0],
            key="window.close_all",
            text=say("Close all windows"),
            icon=Icon.WINDOW,
            on_tap=SetAll(tuple((window, 0.0) for window in WINDOWS), say("all windows are closed")),
            disabled=say("All windows are closed") if closed else "",
        ),
        Button(
            rect=buttons[1],
            key="window.vent",
            text=say("Open all windows {percent} %", percent=A_LITTLE),
            icon=Icon.WINDOW,
            on_tap=SetAll(
                tuple((window, float(A_LITTLE)) for window in WINDOWS),
                say("all windows are open {percent} %", percent=A_LITTLE),
            ),
            disabled=say("They are already open {percent} %", percent=A_LITTLE)
            if all(signals[window] == A_LITTLE for window in WINDOWS)
            else "",
        ),
        switch(buttons[2], "window.lock", say("Window lock"), Icon.CHILD, CABIN.WINDOW_LOCK, signals),
    )


# --- seats ------------------------------------------------------------------------------------------------

_SEATS: dict[str, tuple[tuple[str, str, Signal[float], str, StepWays], ...]] = {
    "driver": (
        ("position", say("Position"), SEAT.DRIVER_POSITION, "mm", forward_back),
        ("height", say("Height"), SEAT.DRIVER_HEIGHT, "mm", lower_higher),
        ("recline", say("Backrest"), SEAT.DRIVER_RECLINE, "°", upright_back),
        ("lumbar", say("Lumbar"), SEAT.DRIVER_LUMBAR, "%", lower_higher),
    ),
    "passenger": (
        ("position", say("Position"), SEAT.PASSENGER_POSITION, "mm", forward_back),
        ("height", say("Height"), SEAT.PASSENGER_HEIGHT, "mm", lower_higher),
        ("recline", say("Backrest"), SEAT.PASSENGER_RECLINE, "°", upright_back),
        ("lumbar", say("Lumbar"), SEAT.PASSENGER_LUMBAR, "%", lower_higher),
    ),
}


def seats(state: State) -> tuple[Widget, ...]:
    """Positions of the front seats, massage, the driver's memory, and the way to who is aboard."""
    signals = state.signals
    area = _area(state)
    who = state.picked["seats"]
    left, right = area.left(540), area.right_part(area.width - 540 - GAP)
    inner = left.inset(20, 16)
    lines = inner.below(76).rows(5, 10)
    massage = SEAT.DRIVER_MASSAGE if who == "driver" else SEAT.PASSENGER_MASSAGE
    return _page(
        state,
        Card(
            rect=left,
            children=(
                choices(
                    inner.top(60),
                    "seat.who",
                    [
                        (key, text, Icon.SEAT, who == key, Pick("seats", key))
                        for key, text in (("driver", say("Driver")), ("passenger", say("Passenger")))
                    ],
                ),
                *(
                    part
                    for line, (key, name, signal, unit, ways) in zip(lines, _SEATS[who], strict=False)
                    for part in _adjust(line, f"seat.{who}.{key}", name, signal, unit, ways, state)
                ),
                levels(
                    lines[4], f"seat.{who}.massage", say("Massage"), Icon.MASSAGE, massage, signals, MASSAGE_LEVELS
                ),
            ),
        ),
        _memory(right, state),
    )


def _adjust(
    rect: Rect, key: str, name: str, signal: Signal[float], unit: str, ways: StepWays, state: State
) -> tuple[Widget, ...]:
    def show(value: float) -> str:
        return f"{value:.0f}{unit}" if unit == "°" else f"{value:.0f} {unit}"

    return (
        Label(rect=rect.left(150), text=name, style=Type.LABEL, tone="muted"),
        *stepper(
            rect.right_part(rect.width - 160),
            key,
            say("Seats: {name}", name=name),
            signal,
            state.signals,
            show,
            Type.STRONG,
            state.vehicle.held(signal),
            ways,
            gauge=True,
        ),
    )


def _memory(rect: Rect, state: State) -> Widget:
    inner = rect.inset(20, 16)
    *lines, onward = inner.below(40).rows(4, 14)
    held = state.vehicle.held(SEAT.DRIVER_POSITION)
    now = tuple(state.signals[signal] for signal in REMEMBERED)
    children: list[Widget] = [heading(inner.top(30), say("Driver's memory"))]
    for slot, line in enumerate(lines):
        recall: Message = SetAll(
            tuple(zip(REMEMBERED, state.of(CarMemory).memory[slot], strict=True)),
            say("seat and mirrors are set as in {position}", position=slot + 1),
        )
        same = state.of(CarMemory).memory[slot] == now
        children += [
            Choice(
                rect=line.left(line.width - 84),
                key=f"seat.memory.{slot + 1}",
                text=say("Recall {position}", position=slot + 1),
                icon=Icon.SEAT,
                selected=same,
                look="boxed",
                on_tap=recall,
                locked=held,
            ),
            Button(
                rect=line.right_part(72),
                key=f"seat.store.{slot + 1}",
                description=say("Store the seat as position {position}", position=slot + 1),
                icon=Icon.SAVE,
                on_tap=Put(
                    state.of(CarMemory).with_memory(slot, state.signals),
                    say("Position {position} is stored", position=slot + 1),
                ),
                disabled=say("The seat is already in this position") if same else "",
            ),
        ]
    children.append(
        Button(
            rect=onward,
            key="seat.cabin",
            text=say("Airbag, occupants"),
            icon=Icon.AIRBAG,
            on_tap=Show("cabin"),
        )
    )
    return Card(rect=rect, children=tuple(children))


# --- mirrors, light inside ----------------------------------------------------------------------------------


def mirrors(state: State) -> tuple[Widget, ...]:
    """Outside mirrors, and what the cameras see behind."""
    upper, _, lower = column(_area(state), 252, GAP, REST)
    left, right = upper.columns(2, GAP)
    night = state.signals[HMI.DAY_NIGHT] == "NIGHT"
    driving = None if state.outside is None else state.outside.driving
    cameras = tuple(
        CameraView(
            rect=rect,
            key=f"camera.{key}",
            description=name,
            scene=scene(driving, night=night, beside=key == "door", left_hand=state.roads.network.left_hand),
        )
        for rect, (key, name) in zip(
            lower.columns(2, GAP), (("rear", say("Rear camera")), ("door", say("Door camera"))), strict=True
        )
    )
    return _page(
        state,
        _mirror(
            left,
            "driver",
            say("Driver's mirror"),
            (MIRROR.DRIVER_PAN, MIRROR.DRIVER_TILT),
            (MIRROR.DRIVER_FOLDED, MIRROR.DRIVER_HEATING),
            state,
        ),
        _mirror(
            right,
            "passenger",
            say("Passenger's mirror"),
            (MIRROR.PASSENGER_PAN, MIRROR.PASSENGER_TILT),
            (MIRROR.PASSENGER_FOLDED, MIRROR.PASSENGER_HEATING),
            state,
        ),
        *cameras,
    )


_ANGLES = {
    "driver": (say("Driver's mirror sideways"), say("Driver's mirror up, down")),
    "passenger": (say("Passenger's mirror sideways"), say("Passenger's mirror up, down")),
}


def _mirror(
    rect: Rect,
    who: str,
    name: str,
    angles: tuple[Signal[float], Signal[float]],
    switches: tuple[Signal[bool], Signal[bool]],
    state: State,
) -> Widget:
    signals = state.signals
    inner = rect.inset(20, 12)
    pan, tilt, last = inner.below(30).rows(3, 8)
    fold, heat = last.columns(2, 10)
    children: list[Widget] = [heading(inner.top(28), name)]
    sideways, upwards = _ANGLES[who]
    for line, key, text, told, signal, ways in (
        (pan, "pan", say("Left +, right −"), sideways, angles[0], left_right),
        (tilt, "tilt", say("Down, up"), upwards, angles[1], lower_higher),
    ):
        children += [
            Label(rect=line.left(110), text=text, style=Type.LABEL, tone="muted"),
            *stepper(
                line.right_part(line.width - 116),
                f"mirror.{who}.{key}",
                told,
                signal,
                signals,
                lambda value: f"{value:+.0f}" if value else "0",
                Type.STRONG,
                ways=ways,
                gauge=True,
            ),
        ]
    children += [
        grouped(
            switch(
                fold,
                f"mirror.{who}.fold",
                say("Fold"),
                Icon.MIRROR,
                switches[0],
                signals,
                state.vehicle.held(switches[0]),
            ),
            name,
        ),
        grouped(switch(heat, f"mirror.{who}.heat", say("Heat"), Icon.HEAT, switches[1], signals), name),
    ]
    return Card(rect=rect, children=tuple(children))


# --- interior lights -----------------------------------------------------------------------------------------


def interior(state: State) -> tuple[Widget, ...]:
    """The lights in the cabin."""
    return _page(state, _inside(_area(state).top(376), state))


def _inside(rect: Rect, state: State) -> Widget:
    signals = state.signals
    head, _, lamps, _, glow, _, name, _, hues = column(rect.inset(20, 16), 28, 8, 104, 16, 84, 12, 28, 4, 60)
    tiles = lamps.columns(3, 10)
    colour = signals[CABIN.AMBIENT_COLOUR]
    return Card(
        rect=rect,
        children=(
            heading(head, say("Interior lights")),
            switch(tiles[0], "light.dome", say("Dome light"), Icon.DOME_LIGHT, CABIN.DOME_LIGHT, signals),
            switch(
                tiles[1],
                "light.driver_reading",
                say("Driver's reading light"),
                Icon.READING_LIGHT,
                CABIN.DRIVER_READING_LIGHT,
                signals,
            ),
            switch(
                tiles[2],
                "light.passenger_reading",
                say("Passenger's reading light"),
                Icon.READING_LIGHT,
                CABIN.PASSENGER_READING_LIGHT,
                signals,
            ),
            slider(glow, "light.ambient", say("Ambient light"), Icon.PALETTE, CABIN.AMBIENT_LIGHT, signals),
            heading(name, say("Colour")),
            choices(
                hues,
                "light.colour",
                [
                    (key, text, None, colour == value, Set(CABIN.AMBIENT_COLOUR, value))
                    for value, (key, text) in COLOURS.items()
                ],
            ),
        ),
    )
