"""Sub-screens of Vehicle: driving, doors and windows, seats, mirrors, interior lights."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.vehicle.screens import page
from automotive_cosim.cockpit.apps.vehicle.state import HONK, REMEMBERED, CarMemory
from automotive_cosim.cockpit.camera import scene
from automotive_cosim.cockpit.cards import SMALL, choice, choices, fact, heading, levels, slider, stepper, switch
from automotive_cosim.cockpit.commands import Put, SetAll
from automotive_cosim.cockpit.controls import CONTROLS
from automotive_cosim.cockpit.flow import Block, card, framed, grid, line
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Pick, Show
from automotive_cosim.cockpit.notices import LOW_KPA
from automotive_cosim.cockpit.signals import BODY, CABIN, DRIVE, HMI, MIRROR, MOTION, SEAT, TYRE, Signal
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.values import pressure
from automotive_cosim.cockpit.vehicle import LOCKS, WINDOWS
from automotive_cosim.cockpit.widgets import Button, CameraView, Choice, Label, Tile, Widget
from automotive_cosim.contracts.text import say

A_LITTLE = 20
"""Percent that the windows are opened for some air."""
MASSAGE_LEVELS = ((0.0, say("Off")), (50.0, say("Low")), (100.0, say("High")))


def driving(state: State) -> tuple[Widget, ...]:
    """Drive mode, brakes and tyres."""
    mode = card(heading(say("Drive mode")), REST, (68, choice(DRIVE.MODE, state)), padding=(20, 14))
    washer = fact("drive.washer", say("Washer fluid"), f"{state.signals[BODY.WASHER_FLUID]:.0f} %")
    tiles = grid(
        1,
        10,
        switch(DRIVE.PARKING_BRAKE, state),
        switch(DRIVE.PARKING_BRAKE_AUTO, state),
        Button(key="drive.horn", text=say("Horn"), icon=Icon.WARN, on_tap=HONK),
        framed(washer, look="none"),
    )
    hold = card(heading(say("Brake and horn")), 8, (REST, tiles), padding=SMALL)
    return page(state, (132, mode), GAP, (REST, grid(2, GAP, hold, _tyres(state))))


def _tyres(state: State) -> Block:
    corners = (
        ("front_left", say("Front left"), say("Front left tyre"), TYRE.FRONT_LEFT),
        ("front_right", say("Front right"), say("Front right tyre"), TYRE.FRONT_RIGHT),
        ("rear_left", say("Rear left"), say("Rear left tyre"), TYRE.REAR_LEFT),
        ("rear_right", say("Rear right"), say("Rear right tyre"), TYRE.REAR_RIGHT),
    )
    cells = []
    for key, name, tyre, signal in corners:
        kpa = state.signals[signal]
        low = kpa < LOW_KPA
        shown = say("{name}: {value}", name=name, value=say("low")) if low else name
        value = Label(key=f"tyre.{key}", text=pressure(state.signals, kpa), description=tyre, style=Type.TITLE)
        label = Label(text=shown, style=Type.LABEL, tone="text" if low else "muted")
        cells.append(card((26, label), REST, (48, value), padding=(16, 12), look="raised"))
    return card(heading(say("Tyre pressures")), 8, (REST, grid(2, 12, *cells)), padding=SMALL)


def doors(state: State) -> tuple[Widget, ...]:
    """Locks, windows and the roof."""
    signals = state.signals
    locked = all(signals[lock] for lock in LOCKS)
    head = [heading(say("Locks and trunk"))]
    if signals[MOTION.IS_MOVING]:
        held = Label(
            key="door.driving", text=say("Keep the doors locked while driving"), style=Type.LABEL, align="right"
        )
        head.append(held)
    every = Tile(
        key="door.all",
        text=say("Lock all"),
        icon=Icon.LOCK if locked else Icon.UNLOCKED,
        checked=locked,
        on_tap=SetAll(
            tuple((lock, not locked) for lock in LOCKS),
            say("all doors are unlocked") if locked else say("all doors are locked"),
        ),
    )
    ones = (*LOCKS, CABIN.LEFT_CHILD_LOCK, CABIN.RIGHT_CHILD_LOCK)
    tiles = [switch(lock, state, group=say("Locks")) for lock in ones]
    trunk = switch(CABIN.TRUNK, state, group=say("Doors"))
    return page(
        state,
        (
            176,
            card(
                (28, Block(tuple(head), lambda box: (box, box.right_part(box.width - 200)))),
                4,
                (REST, grid(4, 8, every, *tiles, trunk)),
                padding=(20, 14),
            ),
        ),
        GAP,
        (REST, _windows(state)),
    )


def _windows(state: State) -> Block:
    openings = (
        CABIN.DRIVER_WINDOW,
        CABIN.PASSENGER_WINDOW,
        CABIN.SUNROOF,
        CABIN.REAR_LEFT_WINDOW,
        CABIN.REAR_RIGHT_WINDOW,
        CABIN.SUNROOF_SHADE,
    )

    def all_at(key: str, text: str, percent: int, said: str, already: str) -> Button:
        return Button(
            key=key,
            text=text,
            icon=Icon.WINDOW,
            on_tap=SetAll(tuple((window, float(percent)) for window in WINDOWS), said),
            disabled=already if all(state.signals[window] == percent for window in WINDOWS) else "",
        )

    return card(
        heading(say("Windows and roof")),
        4,
        (REST, grid(3, (24, 4), *(slider(opening, state) for opening in openings))),
        8,
        (
            56,
            grid(
                3,
                24,
                all_at(
                    "window.close_all",
                    say("Close all windows"),
                    0,
                    say("all windows are closed"),
                    say("All windows are closed"),
                ),
                all_at(
                    "window.vent",
                    say("Open all windows {percent} %", percent=A_LITTLE),
                    A_LITTLE,
                    say("all windows are open {percent} %", percent=A_LITTLE),
                    say("They are already open {percent} %", percent=A_LITTLE),
                ),
                switch(CABIN.WINDOW_LOCK, state),
            ),
        ),
        padding=(20, 12),
    )


_SEATS = {
    "driver": (SEAT.DRIVER_POSITION, SEAT.DRIVER_HEIGHT, SEAT.DRIVER_RECLINE, SEAT.DRIVER_LUMBAR),
    "passenger": (SEAT.PASSENGER_POSITION, SEAT.PASSENGER_HEIGHT, SEAT.PASSENGER_RECLINE, SEAT.PASSENGER_LUMBAR),
}


def seats(state: State) -> tuple[Widget, ...]:
    """Positions of the front seats, massage, the driver's memory, and the way to who is aboard."""
    who = state.picked["seats"]
    massage = SEAT.DRIVER_MASSAGE if who == "driver" else SEAT.PASSENGER_MASSAGE
    known = (("driver", say("Driver")), ("passenger", say("Passenger")))
    whose = choices("seat.who", ((key, text, Icon.SEAT, who == key, Pick("seats", key)) for key, text in known))
    lines = [_adjust(signal, CONTROLS[signal].name, "", 150, 10, state) for signal in _SEATS[who]]
    left = card((60, whose), 16, (REST, grid(1, 10, *lines, levels(massage, state, MASSAGE_LEVELS))), padding=SMALL)
    return page(state, (REST, line((540, left), GAP, _memory(state))))


def _adjust(signal: Signal[float], text: str, name: str, width: int, gap: int, state: State) -> Block:
    """A name and minus and plus; ``name`` is the one that the buttons are told by, if it is not the seat's."""
    steps = stepper(
        signal,
        state.signals,
        name=name or say("Seats: {name}", name=text),
        style=Type.STRONG,
        locked=state.vehicle.held(signal),
        gauge=True,
    )
    return line((width, heading(text)), gap, steps)


def _memory(state: State) -> Block:
    held = state.vehicle.held(SEAT.DRIVER_POSITION)
    now, memory = tuple(state.signals[signal] for signal in REMEMBERED), state.of(CarMemory)
    lines: list[Block | Widget] = []
    for slot, kept in enumerate(memory.memory, 1):
        same = kept == now
        recall = Choice(
            key=f"seat.memory.{slot}",
            text=say("Recall {position}", position=slot),
            icon=Icon.SEAT,
            selected=same,
            look="boxed",
            on_tap=SetAll(
                tuple(zip(REMEMBERED, kept, strict=True)),
                say("seat and mirrors are set as in {position}", position=slot),
            ),
            locked=held,
        )
        store = Button(
            key=f"seat.store.{slot}",
            description=say("Store the seat as position {position}", position=slot),
            icon=Icon.SAVE,
            on_tap=Put(
                memory.with_memory(slot - 1, state.signals), say("Position {position} is stored", position=slot)
            ),
            disabled=say("The seat is already in this position") if same else "",
        )
        lines.append(line(recall, 12, (72, store)))
    lines.append(Button(key="seat.cabin", text=say("Airbag, occupants"), icon=Icon.AIRBAG, on_tap=Show("cabin")))
    return card((30, heading(say("Driver's memory"))), 10, (REST, grid(1, 14, *lines)), padding=SMALL)


def mirrors(state: State) -> tuple[Widget, ...]:
    """Outside mirrors, and what the cameras see behind."""
    driver = (MIRROR.DRIVER_PAN, MIRROR.DRIVER_TILT, MIRROR.DRIVER_FOLDED, MIRROR.DRIVER_HEATING)
    passenger = (MIRROR.PASSENGER_PAN, MIRROR.PASSENGER_TILT, MIRROR.PASSENGER_FOLDED, MIRROR.PASSENGER_HEATING)
    night = state.signals[HMI.DAY_NIGHT] == "NIGHT"
    road = None if state.outside is None else state.outside.driving
    cameras = (
        CameraView(
            key=f"camera.{key}",
            description=name,
            scene=scene(road, night=night, beside=key == "door", left_hand=state.roads.network.left_hand),
        )
        for key, name in (("rear", say("Rear camera")), ("door", say("Door camera")))
    )
    both = grid(
        2,
        GAP,
        _mirror(say("Driver's mirror"), *driver, state),
        _mirror(say("Passenger's mirror"), *passenger, state),
    )
    return page(state, (252, both), GAP, (REST, grid(2, GAP, *cameras)))


def _mirror(
    name: str, pan: Signal[float], tilt: Signal[float], fold: Signal[bool], heat: Signal[bool], state: State
) -> Block:
    lines = [
        _adjust(signal, text, CONTROLS[signal].name, 110, 6, state)
        for signal, text in ((pan, say("Left +, right −")), (tilt, say("Down, up")))
    ]
    switches = grid(2, 10, switch(fold, state, group=name), switch(heat, state, group=name))
    return card(heading(name), 2, (REST, grid(1, 8, *lines, switches)), padding=(20, 12))


def interior(state: State) -> tuple[Widget, ...]:
    """The lights in the cabin."""
    lamps = (CABIN.DOME_LIGHT, CABIN.DRIVER_READING_LIGHT, CABIN.PASSENGER_READING_LIGHT)
    inside = card(
        heading(say("Interior lights")),
        8,
        (104, grid(3, 10, *(switch(lamp, state) for lamp in lamps))),
        16,
        slider(CABIN.AMBIENT_LIGHT, state),
        12,
        heading(say("Colour")),
        4,
        (60, choice(CABIN.AMBIENT_COLOUR, state)),
        padding=SMALL,
    )
    return page(state, (376, inside))
