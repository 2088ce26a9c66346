"""Makes: the same car as another maker would have built it, each from one file of ``makes/``.

    mirrored = true
    [bar]
    side = "left"
    entries = ["home", "map", "ease", "car", "apps"]
    [screens.ease]
    title = ["Comfort", "Confort", "Komfort", "快適"]
    icon = "SEAT"
    holds = ["climate", "heat", "seats"]
    [words]
    "Front defrost" = ["Clear screen", "Pare-brise", "Scheibe frei", "前面曇り取り"]

A make says where things lie, what they are called in each language, how menus are grouped, in which units and
colours it shows, and with which icons. What it does not say is as in ``HOME``. Screens with ``holds`` are menus,
those with ``shelves`` show controls of other screens; one with the name of a screen stands in its place. What the
car can do, and how, is the same in all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Annotated, Literal

from annotated_types import Ge, Le, MaxLen, MinLen

from automotive_cosim.cockpit.room import DisplayEdge, Frame
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.theme import DAY, HOME_STYLE, NIGHT, Icon, Style
from automotive_cosim.contracts.given import Language
from automotive_cosim.contracts.text import Text
from automotive_cosim.formats.annotations import OneOf

LANGUAGES = tuple(Language)
"""In the order in which a make's words stand."""
Told = Annotated[tuple[str, ...], MinLen(4), MaxLen(4)]
"""A text in every language, in their order."""
ShelfItem = Annotated[tuple[str, ...], MinLen(1), MaxLen(5)]
"""Key of a control, or the beginning of the keys of its parts; and its name in every language, if it shows none."""
ColourCodes = Mapping[str, str]
"""Six hexadecimal digits for each colour of ``Palette``."""
Radius = Annotated[int, Ge(0), Le(32)]


@dataclass(frozen=True, slots=True)
class Shelf:
    """Controls of one screen."""

    of: str
    """The screen that has them at home."""
    controls: Annotated[tuple[ShelfItem, ...], MinLen(1)]


@dataclass(frozen=True, slots=True)
class OwnScreen:
    """A screen of a make: a menu of others, or controls of others."""

    title: Told
    icon: str
    """Name of an ``Icon``."""
    holds: tuple[str, ...] = ()
    shelves: tuple[Shelf, ...] = ()

    @property
    def text(self) -> Text:
        return Text(self.title[0], {}, "make")


@dataclass(frozen=True, slots=True)
class BarOfMake:
    """The dock."""

    side: Annotated[DisplayEdge, OneOf(DisplayEdge)] = DisplayEdge.BELOW
    entries: tuple[str, ...] = ()
    """Screens that it leads to; empty for those of home."""
    quick: bool = True
    """Whether it has temperatures and defrosters too, where its entries stand side by side."""


@dataclass(frozen=True, slots=True)
class UnitsOfMake:
    """What it shows until the driver chooses otherwise."""

    distance: Literal["KILOMETERS", "MILES"] = "KILOMETERS"
    temperature: Literal["C", "F"] = "C"
    pressure: Literal["BAR", "KPA", "PSI"] = "BAR"

    @property
    def signals(self) -> Mapping[str, str]:
        """The units that are not those of home, by path."""
        known = (HMI.DISTANCE_UNIT, HMI.TEMPERATURE_UNIT, HMI.PRESSURE_UNIT)
        own = (self.distance, self.temperature, self.pressure)
        return {signal.path: unit for signal, unit in zip(known, own, strict=True) if unit != signal.default}


@dataclass(frozen=True, slots=True)
class LookOfMake:
    """Colours, corners and icons."""

    corners: tuple[Radius, Radius] = (HOME_STYLE.card, HOME_STYLE.button)
    """Radius of cards and of buttons, in logical pixels."""
    outlined: bool = False
    """Whether icons are outlines where the font has them."""
    icons: Mapping[str, str] = field(default_factory=dict)
    """Other icons, by the names that Material Design Icons 7 has for them."""
    day: ColourCodes = field(default_factory=dict)
    night: ColourCodes = field(default_factory=dict)


@dataclass(frozen=True)
class Make:
    """A maker's cockpit; the fields of its file."""

    bar: BarOfMake = BarOfMake()
    status: Annotated[DisplayEdge, OneOf((DisplayEdge.ABOVE, DisplayEdge.BELOW), "side")] = DisplayEdge.ABOVE
    mirrored: bool = False
    """Whether what home has on the left of a screen is on its right."""
    menus: Literal["tiles", "list"] = "tiles"
    """How menus look."""
    units: UnitsOfMake = UnitsOfMake()
    look: LookOfMake = field(default_factory=LookOfMake)
    screens: Mapping[str, OwnScreen] = field(default_factory=dict)
    words: Mapping[str, Told] = field(default_factory=dict)
    """By home's English words, its own."""

    def __hash__(self) -> int:
        return id(self)

    @cached_property
    def style(self) -> Style:
        """How it is drawn."""
        own = self.look
        day, night = (
            replace(palette, **{name: _rgb(code) for name, code in colours.items()})
            for palette, colours in ((DAY, own.day), (NIGHT, own.night))
        )
        icons = {Icon[name]: glyphs()[glyph] for name, glyph in own.icons.items()}
        if own.outlined:
            names = {code: name for name, code in glyphs().items()}
            outlines = {icon: glyphs().get(f"{names[icon]}_outline") for icon in Icon}
            icons = {icon: glyph for icon, glyph in outlines.items() if glyph} | icons
        return Style(day, night, icons, *own.corners)

    @property
    def has_quick(self) -> bool:
        """Whether its dock has temperatures and defrosters."""
        return self.bar.quick and self.bar.side in (DisplayEdge.ABOVE, DisplayEdge.BELOW)

    def frame(self, size: ScreenSize) -> Frame:
        """Where the parts of a display of that size lie."""
        return Frame(size, self.bar.side, self.status)

    @cached_property
    def holders(self) -> Mapping[str, str]:
        """The menu that holds each screen that one holds."""
        return {screen: name for name, place in self.screens.items() for screen in place.holds}

    @cached_property
    def placed(self) -> frozenset[str]:
        """Screens that its bar or a menu of its own leads to."""
        return frozenset({*self.bar.entries, *self.holders})

    def said(self, text: str, language: str = Language.ENGLISH) -> str:
        """Its own words for a message without fields; the same if it has none."""
        return self.told[language].get(text, text)

    @cached_property
    def told(self) -> Mapping[str, Mapping[str, str]]:
        """By language, what it says in place of home's words."""
        named = (
            control[1:] for place in self.screens.values() for shelf in place.shelves for control in shelf.controls
        )
        titles = (*(place.title for place in self.screens.values()), *(name for name in named if name))
        own = {**{title[0]: title for title in titles}, **self.words}
        return {code: {word: told[at] for word, told in own.items()} for at, code in enumerate(LANGUAGES)}


HOME = Make()


def _rgb(code: str) -> tuple[int, int, int]:
    red, green, blue = bytes.fromhex(code)
    return red, green, blue


@cache
def glyphs() -> Mapping[str, str]:
    """Code points of the icons' font by their names."""
    from fonticon_mdi7 import MDI7  # type: ignore[import-untyped]

    told = {name: getattr(MDI7, name) for name in dir(MDI7) if not name.startswith("_")}
    return {name: str(code).rpartition(".")[2] for name, code in told.items()}
