"""A reference solution's way through another make: the same touches, by the menus that lead to them there."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain

from automotive_cosim.cockpit.make import Make
from automotive_cosim.cockpit.registry import by_any_name
from automotive_cosim.cockpit.signals import HMI, Signals
from automotive_cosim.cockpit.tree import SUBPAGES, opens, shelf, way
from automotive_cosim.cockpit.values import pressure, speed, speed_unit
from automotive_cosim.contracts import ActionType
from automotive_cosim.tasking.moves import Do, Move, Open, Slide, Tap, TapUntil, TypeText
from automotive_cosim.tasking.task import Task

ELSEWHERE = {
    "dock.front_defroster": "hvac.front_defroster",
    "dock.rear_defroster": "hvac.rear_defroster",
    "dock.driver_temperature": "hvac.driver_temperature",
    "dock.passenger_temperature": "hvac.passenger_temperature",
}
"""What has the same effect as a control of home's dock."""
UNITS = {
    "settings.distance": HMI.DISTANCE_UNIT.path,
    "settings.temperature": HMI.TEMPERATURE_UNIT.path,
    "settings.pressure": HMI.PRESSURE_UNIT.path,
}
_FIGURE = re.compile(r"([0-9.]+) (km/h|bar)")
_LEAVES = frozenset({ActionType.NAVIGATE_BACK, ActionType.NAVIGATE_HOME})


def in_make(moves: tuple[Move, ...], make: Make, units: Mapping[str, str]) -> tuple[Move, ...]:
    """The moves of a solution as one makes them in a car of another make, which shows these units."""
    return tuple(_in_units(move, units) for move in _led(moves, make))


def _led(moves: tuple[Move, ...], make: Make) -> Iterator[Move]:
    here, aside = "", ""  # the screen of home's that one is on, and the make's own where one has gone for a control
    for move in moves:
        target, part = _target(move)
        key = getattr(move, "key", "")
        there = "" if target else shelf(make, key) if key else ""
        if key.startswith("dock.") and not target and not make.has_quick:
            name = next(each for each in ELSEWHERE if key.startswith(each))
            key = ELSEWHERE[name] + key.removeprefix(name)
            there = shelf(make, key) or "climate"
        if target or (isinstance(move, Do) and move.action.action_type in _LEAVES):
            here, aside = target, target if target in make.screens else ""
        elif there and there != aside:
            aside = there
            yield from _go(make, there)
        elif key and not there and aside and aside != here:
            aside = ""
            yield from _go(make, here or "home")
        if target:
            yield from _go(make, target)
            if part:
                yield Tap(f"{target}.tab.{part}")
        else:
            yield replace(move, key=key) if isinstance(move, Tap | TapUntil | Slide | TypeText) else move


def _target(move: Move) -> tuple[str, str]:
    """The screen of home's, and its part, that a move leads to wherever one is; empty for any other move."""
    if isinstance(move, Open):
        return by_any_name()[move.app]
    if isinstance(move, Tap) and not move.text:
        found = next((screen for screen, (_, _, key) in SUBPAGES.items() if key == move.key), "")
        home, _, app = move.key.partition(".")
        return found or (app if home in ("dock", "apps") and app in by_any_name() else ""), ""
    return "", ""


def _go(make: Make, screen: str) -> Iterator[Move]:
    if screen in opens(make).values():
        yield Open(screen)
        return
    first, *others = way(make, screen)
    yield Open(first.removeprefix("dock."))
    yield from map(Tap, others)


def _in_units(move: Move, units: Mapping[str, str]) -> Move:
    """The move with what a control shall read in these units."""
    if not units or not isinstance(move, TapUntil) or (figure := _FIGURE.fullmatch(move.text)) is None:
        return move
    shown = Signals(dict(units))
    value, unit = float(figure[1]), figure[2]
    text = pressure(shown, value * 100) if unit == "bar" else f"{speed(shown, value)} {speed_unit(shown)}"
    return replace(move, text=text)


def units_in(make: Make, task: Task) -> Mapping[str, str]:
    """The make's units at the hand-over, by path of the signal.

    They stay those of home where the task is about them, or asks for figures in an answer; and degrees, where it
    names half degrees, which whole degrees Fahrenheit do not tell apart."""
    halves = [task.half(name) for name in task.halves]
    every = [str(move) for half in halves for move in chain(half.moves, *half.ways, *half.slips)]
    taken = {path for key, path in UNITS.items() for move in every if key in move}
    told = "".join(str(text) for half in halves for tells in half.tells for text in tells)
    if taken or any(char.isdigit() or char == "{" for char in told):  # a drawn one may be a figure
        return {}
    degrees = any("TapUntil" in move and "_temperature" in move for move in every)
    kept = {HMI.TEMPERATURE_UNIT.path} if degrees else set[str]()
    return {path: unit for path, unit in make.units.signals.items() if path not in kept}
