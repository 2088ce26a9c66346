"""Outside: rain, fog, ice, glare, dust and air as sensed by the car, and remedies for each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.climate import glass_words
from automotive_cosim.cockpit.apps.safety.commands import WarnDriver
from automotive_cosim.cockpit.apps.vehicle.state import WASH
from automotive_cosim.cockpit.cards import content, heading
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.controls import CONTROLS
from automotive_cosim.cockpit.flow import Block, card, fill, grid, line, panels, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Pick
from automotive_cosim.cockpit.notices import ICE_C
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    DRIVE,
    GLASS,
    HMI,
    HVAC,
    LIGHTS,
    MIRROR,
    OUTSIDE,
    Signal,
    Signals,
)
from automotive_cosim.cockpit.sky import air_grade, is_dusty
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import distance, speed, speed_unit, temperature
from automotive_cosim.cockpit.widgets import Bar, Button, Glyph, Label, Look, Row, Tile, Widget
from automotive_cosim.contracts import Alert, AlertKind
from automotive_cosim.contracts.text import Quantity, say, say_in

DENSE_FOG_M, FOG_M, MIST_M = 200.0, 1000.0, 5000.0
"""Dense fog, fog and mist, the latter two by the WMO's definitions."""
DRIZZLE_MM = 0.1
"""Rain or snow per hour from which it is that, not fog, which takes the sight."""


@dataclass(frozen=True, slots=True)
class OutsideReading:
    """The reading of one phenomenon."""

    word: str
    value: str
    share: float
    """Severity, 0 to 1."""


class Act(NamedTuple):
    """A remedy: a setting, on or off; ``text`` and ``icon`` if they are not those of its control."""

    key: str
    signal: Signal[Any]
    on: Any = True
    off: Any = False
    text: str = ""
    icon: Icon | None = None


@dataclass(frozen=True, slots=True)
class Phenomenon:
    """One phenomenon that the car senses."""

    title: str
    icon: Icon
    about: str
    read: Callable[[State], OutsideReading]
    acts: tuple[Act, ...]
    alert: AlertKind


def _rain(state: State) -> OutsideReading:
    rate = 0.0 if state.outside is None else state.outside.weather.precipitation
    word = (
        say("No rain")
        if rate < DRIZZLE_MM
        else say("Light")
        if rate < 2.5
        else say("Moderate")
        if rate < 10
        else say("Heavy")
    )
    return OutsideReading(word, Quantity(f"{rate:.1f} mm/h"), state.signals[BODY.RAIN_INTENSITY] / 100)


def _fog(state: State) -> OutsideReading:
    sight = state.signals[OUTSIDE.VISIBILITY]
    weather = None if state.outside is None else state.outside.weather
    is_fog = weather is None or not (is_dusty(weather) or weather.precipitation >= DRIZZLE_MM)
    words = (
        (say("Clear"), say("Mist"), say("Fog"), say("Dense fog"))
        if is_fog
        else (say("Good"), say("Moderate"), say("Poor"), say("Very poor"))
    )
    word = words[sum(sight < bound_m for bound_m in (MIST_M, FOG_M, DENSE_FOG_M))]
    return OutsideReading(word, distance(state.signals, sight), 1 - min(1.0, sight / MIST_M))


def _ice(state: State) -> OutsideReading:
    signals = state.signals
    grip, air = signals[ADAS.ROAD_FRICTION], signals[OUTSIDE.TEMPERATURE]
    word = (
        say("Slippery")
        if grip < 50
        else say("Ice possible")
        if air <= ICE_C
        else say("Wet")
        if grip < 90
        else say("Good grip")
    )
    return OutsideReading(
        word,
        say("{temperature}, grip {grip} %", temperature=temperature(signals, air, 0), grip=f"{grip:.0f}"),
        1 - grip / 100,
    )


def _glare(state: State) -> OutsideReading:
    share = state.signals[OUTSIDE.GLARE] / 100
    word = say("No glare") if share < 0.1 else say("Low sun ahead") if share < 0.5 else say("Strong")
    return OutsideReading(word, f"{100 * share:.0f} %", share)


def _dust(state: State) -> OutsideReading:
    dusty = state.outside is not None and is_dusty(state.outside.weather)
    sight = state.signals[OUTSIDE.VISIBILITY]
    word = say("No dust") if not dusty else say("Blowing dust") if sight >= FOG_M else say("Dust storm")
    return OutsideReading(
        word,
        say("Visibility {distance}", distance=distance(state.signals, sight)),
        1 - min(1.0, sight / MIST_M) if dusty else 0.0,
    )


def _air(state: State) -> OutsideReading:
    fine = state.signals[OUTSIDE.FINE_DUST]
    inside = state.signals[HVAC.CABIN_FINE_DUST]
    return OutsideReading(
        air_grade(fine),
        say("Outside {fine} µg/m³, in the cabin {inside} µg/m³", fine=f"{fine:.0f}", inside=f"{inside:.0f}"),
        min(1.0, fine / 140),
    )


def _wind(state: State) -> OutsideReading:
    wind = state.signals[OUTSIDE.WIND]
    calm = say_in("wind", "Light")
    word = calm if wind < 20 else say("Breeze") if wind < 50 else say("Strong") if wind < 75 else say("Storm")
    return OutsideReading(word, f"{speed(state.signals, wind)} {speed_unit(state.signals)}", min(1.0, wind / 100))


def _glass(state: State) -> OutsideReading:
    signals: Signals = state.signals
    fog, film = signals[GLASS.WINDSHIELD_FOG], signals[GLASS.WINDSHIELD_FILM]
    word = glass_words(fog, film)[0]
    hidden = fog + film - fog * film
    return OutsideReading(word, say("Windshield {share} % clear", share=f"{100 * (1 - hidden):.0f}"), hidden)


_LOW_BEAM = Act("low_beam", LIGHTS.LOW_BEAM)
_RECIRCULATION = Act("recirculation", HVAC.RECIRCULATION)
_PURIFIER = Act("purifier", HVAC.PURIFIER)
_FRONT_DEFROST = Act("front_defroster", HVAC.FRONT_DEFROSTER)
_REAR_DEFROST = Act("rear_defroster", HVAC.REAR_DEFROSTER)


def _mode(key: str, text: str, value: str) -> Act:
    return Act(key, DRIVE.MODE, value, "NORMAL", text, Icon.DRIVE_MODE)


PHENOMENA: dict[str, Phenomenon] = {
    "rain": Phenomenon(
        say("Rain"),
        Icon.RAIN,
        say("The rain sensor sees the drops on the windshield."),
        _rain,
        (
            Act("wipers", BODY.FRONT_WIPER, "RAIN_SENSOR", "OFF", say("Wipers auto"), Icon.WASHER),
            _LOW_BEAM,
            _mode("rain_mode", say("Rain mode"), "RAIN"),
            _REAR_DEFROST,
        ),
        AlertKind.WEATHER,
    ),
    "fog": Phenomenon(
        say("Visibility"),
        Icon.REAR_FOG,
        say("Visibility as the forward camera estimates it. Whether fog lamps may be lit depends on local law."),
        _fog,
        (
            _LOW_BEAM,
            Act("front_fog", LIGHTS.FRONT_FOG),
            Act("rear_fog", LIGHTS.REAR_FOG),
            Act("hazard", LIGHTS.HAZARD),
        ),
        AlertKind.VISIBILITY,
    ),
    "ice": Phenomenon(
        say("Ice and grip"),
        Icon.SLIPPERY,
        say("Grip estimated by stability control, compared with a dry road."),
        _ice,
        (
            _mode("snow_mode", say("Snow mode"), "SNOW"),
            Act("mirrors", MIRROR.DRIVER_HEATING, text=say("Mirror heat"), icon=Icon.MIRROR),
            _REAR_DEFROST,
            Act("max_defrost", HVAC.MAX_DEFROST),
        ),
        AlertKind.SLIPPERY,
    ),
    "glare": Phenomenon(
        say("Glare"),
        Icon.DAY,
        say("Low sun ahead, measured by the light sensor at the mirror. A clean windshield reduces glare."),
        _glare,
        (Act("brightness", HMI.BRIGHTNESS, 100.0, 70.0, say("Bright screen")), _LOW_BEAM),
        AlertKind.VISIBILITY,
    ),
    "dust": Phenomenon(
        say("Dust"),
        Icon.DUST,
        say("Dust and sand ahead."),
        _dust,
        (_RECIRCULATION, _PURIFIER, _LOW_BEAM),
        AlertKind.VISIBILITY,
    ),
    "air": Phenomenon(
        say("Air quality"),
        Icon.AIR_QUALITY,
        say("Fine particles at the air intake, rated by the European Air Quality Index."),
        _air,
        (_RECIRCULATION, _PURIFIER),
        AlertKind.WEATHER,
    ),
    "wind": Phenomenon(
        say("Wind"),
        Icon.AIR_MIDDLE,
        say("Wind from the weather service and the stability control."),
        _wind,
        (Act("stability", ADAS.STABILITY_CONTROL, text=say("Stability")), Act("lane_keeping", ADAS.LANE_KEEPING)),
        AlertKind.WEATHER,
    ),
    "glass": Phenomenon(
        say("Windows"),
        Icon.AIR_UP,
        say("Fog inside clears with dry air, drops outside with the wipers."),
        _glass,
        (_FRONT_DEFROST, _REAR_DEFROST, Act("air_conditioning", HVAC.AIR_CONDITIONING), _RECIRCULATION),
        AlertKind.VISIBILITY,
    ),
}


def outside(state: State) -> tuple[Widget, ...]:
    """The outside screen."""
    chosen = state.picked["outside"]
    lines = []
    for name, known in PHENOMENA.items():
        reading = known.read(state)
        line = Row(
            key=f"outside.{name}",
            text=known.title,
            detail=reading.word,
            icon=known.icon,
            tone="warning" if reading.share >= 0.5 else "accent",
            selected=name == chosen,
            on_tap=Pick("outside", name),
        )
        lines.append(line)
    return fill(content(state), panels((400, grid(1, 8, *lines)), _detail(PHENOMENA[chosen], state)))


def _detail(known: Phenomenon, state: State) -> Block:
    reading = known.read(state)
    bad = reading.share >= 0.5
    words = stack(
        (52, Label(key="outside.word", text=reading.word, description=known.title, style=Type.HEADLINE)),
        REST,
        (36, Label(key="outside.value", text=reading.value, tone="muted")),
    )
    explained = Label(key="outside.about", text=known.about, style=Type.LABEL, tone="muted", lines=2)
    warn = Button(
        key="outside.warn",
        text=say("Warn the driver"),
        icon=Icon.WARN,
        look=Look.ACCENT,
        on_tap=WarnDriver(Alert(known.alert)),
    )
    wash = Button(key="outside.wash", text=say("Wash the windshield"), icon=Icon.WASHER, on_tap=WASH)
    picture = Glyph(icon=known.icon, size=88, tone="warning" if bad else "accent")
    acts = [_act(act, state) for act in known.acts]
    return card(
        (96, line((96, picture), 32, words)),
        28,
        (12, Bar(share=round(reading.share, 2), tone="warning" if bad else "good")),
        16,
        (56, explained),
        24,
        heading(say("What to do")),
        12,
        (104, grid(4, 12, *acts, *[None] * (4 - len(acts)))),
        REST,
        (72, grid(2, 12, warn, wash)),
        padding=(32, 28),
    )


def _act(act: Act, state: State) -> Tile:
    on = state.signals[act.signal] == act.on
    return Tile(
        key=f"outside.act.{act.key}",
        text=act.text or CONTROLS[act.signal].name,
        icon=act.icon or CONTROLS[act.signal].icon,
        checked=on,
        on_tap=Set(act.signal, act.off if on else act.on),
    )


APP = App(
    name="outside",
    title=say("Outside"),
    icon=Icon.OUTSIDE,
    order=6,
    where=Where.DOCK,
    pages={"outside": AppPage(outside)},
    aliases={"weather": "", "phenomenon": ""},
    picked={"outside": "rain"},
)
