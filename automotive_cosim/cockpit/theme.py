"""The look, in one place: colours by day and night, type scale, spacing, fonts and icons.

Fonts and icons come from dependencies, never from the system, and text is laid out by FreeType alone (BASIC), so
the pixels are the same on every machine: Roboto (``font-roboto``, Apache 2.0), Noto Sans CJK JP for East Asia
(``noto-cjk-sans-jp-regular``, SIL Open Font License 1.1), and Material Design Icons 7
(``fonticon-materialdesignicons7``, Apache 2.0). Only Arabic and Hebrew, written from the right and joined, are laid
out by Raqm, in the DejaVu Sans of ``matplotlib``, if both are there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, StrEnum
from functools import cache, lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from automotive_cosim.errors import SetupError, install_hint

if TYPE_CHECKING:
    from PIL import ImageFont  # takes long to load, and sizes of screens need no font

Colour = tuple[int, int, int]

STATUS_HEIGHT, DOCK_HEIGHT = 64, 96
"""Heights of one line of the status bar, and of the dock."""
MARGIN, GAP = 24, 16
TOUCH = 48
"""Minimum side of anything that can be tapped."""


@dataclass(frozen=True, slots=True)
class Palette:
    """Colours by purpose. Text colours have a contrast of at least 4.5:1 on their surfaces."""

    background: Colour
    surface: Colour
    raised: Colour
    pressed: Colour
    text: Colour
    muted: Colour
    accent: Colour
    on_accent: Colour
    tint: Colour
    """Accent, toned down for surfaces."""
    on_tint: Colour
    good: Colour
    warning: Colour
    on_warning: Colour
    critical: Colour
    on_critical: Colour
    land: Colour
    water: Colour
    green: Colour
    building: Colour
    street: Colour
    casing: Colour
    avenue: Colour
    motorway: Colour
    tunnel: Colour
    route: Colour
    alternative: Colour
    dense: Colour
    jam: Colour
    halo: Colour
    plate: Colour
    """Background of labels and buttons over other things."""
    disabled: Colour
    """Text of disabled widgets; still readable on ``raised``."""


def _hex(code: str) -> Colour:
    return int(code[0:2], 16), int(code[2:4], 16), int(code[4:6], 16)


NIGHT = Palette(
    background=_hex("0A0D12"),
    surface=_hex("151A21"),
    raised=_hex("212935"),
    pressed=_hex("2C3644"),
    text=_hex("F3F6FA"),
    muted=_hex("A6B2C2"),
    accent=_hex("4FA8FF"),
    on_accent=_hex("03131F"),
    tint=_hex("163A5F"),
    on_tint=_hex("D6E9FF"),
    good=_hex("45D18A"),
    warning=_hex("FFB42E"),
    on_warning=_hex("1E1400"),
    critical=_hex("D22F36"),
    on_critical=_hex("FFFFFF"),
    land=_hex("10151C"),
    water=_hex("0E2B47"),
    green=_hex("15301F"),
    building=_hex("1E2530"),
    street=_hex("39465A"),
    casing=_hex("0B0F15"),
    avenue=_hex("52627A"),
    motorway=_hex("7A6A3C"),
    tunnel=_hex("242D3A"),
    route=_hex("3E9BFF"),
    alternative=_hex("6F84A3"),
    dense=_hex("E8A33A"),
    jam=_hex("E5484D"),
    halo=_hex("10151C"),
    plate=_hex("212935"),
    disabled=_hex("98A4B3"),
)
DAY = Palette(
    background=_hex("D5DBE3"),
    surface=_hex("FBFCFD"),
    raised=_hex("E9EDF2"),
    pressed=_hex("D6DDE6"),
    text=_hex("0F151D"),
    muted=_hex("4A5768"),
    accent=_hex("0B63CE"),
    on_accent=_hex("FFFFFF"),
    tint=_hex("CFE3FB"),
    on_tint=_hex("0A3A75"),
    good=_hex("0E7A45"),
    warning=_hex("FFB42E"),
    on_warning=_hex("1E1400"),
    critical=_hex("C6262E"),
    on_critical=_hex("FFFFFF"),
    land=_hex("E9EDF1"),
    water=_hex("A5D0EC"),
    green=_hex("C9E4C5"),
    building=_hex("DADFE6"),
    street=_hex("FFFFFF"),
    casing=_hex("C3CBD6"),
    avenue=_hex("FFE9B0"),
    motorway=_hex("F7C66B"),
    tunnel=_hex("D5DAE1"),
    route=_hex("1F78E6"),
    alternative=_hex("93A9C7"),
    dense=_hex("F08C00"),
    jam=_hex("D6202B"),
    halo=_hex("FFFFFF"),
    plate=_hex("FFFFFF"),
    disabled=_hex("55606F"),
)


@dataclass(frozen=True, eq=False)
class Style:
    """How a make is drawn; ``HOME_STYLE`` unless it says otherwise."""

    day: Palette
    night: Palette
    icons: Mapping[Icon, str]
    """Code points of icons that are others than ours."""
    card: int
    """Radius of cards in logical pixels."""
    button: int


class Weight(StrEnum):
    """Files of the text fonts, and the icons."""

    LIGHT = "Roboto-Light.ttf"
    REGULAR = "Roboto-Regular.ttf"
    MEDIUM = "Roboto-Medium.ttf"
    BOLD = "Roboto-Bold.ttf"
    EAST_ASIAN = "NotoSansCJKjp-Regular.otf"
    RIGHT_TO_LEFT = "DejaVuSans.ttf"
    ICON = "materialdesignicons-webfont.ttf"


class Type(Enum):
    """The type scale: size in logical pixels, and weight."""

    HUGE = (104, Weight.LIGHT)
    DISPLAY = (64, Weight.LIGHT)
    HEADLINE = (36, Weight.REGULAR)
    TITLE = (26, Weight.MEDIUM)
    BODY = (22, Weight.REGULAR)
    STRONG = (22, Weight.MEDIUM)
    LABEL = (18, Weight.MEDIUM)
    CAPTION = (16, Weight.REGULAR)
    SMALL = (15, Weight.MEDIUM)
    FINE = (13, Weight.MEDIUM)

    @property
    def size(self) -> int:
        """Height of the em box."""
        return self.value[0]

    @property
    def weight(self) -> Weight:
        """The font's file."""
        return self.value[1]

    @property
    def pitch(self) -> int:
        """Line height."""
        return round(self.size * 1.3)


SMALLER = {
    Type.DISPLAY: Type.HEADLINE,
    Type.HEADLINE: Type.TITLE,
    Type.TITLE: Type.STRONG,
    Type.STRONG: Type.LABEL,
    Type.BODY: Type.CAPTION,
    Type.LABEL: Type.SMALL,
    Type.CAPTION: Type.SMALL,
    Type.SMALL: Type.FINE,
}
"""End of a text that is too long for its box."""

EAST_ASIAN_FROM = "\u2e80"
"""First character of East Asian scripts in Unicode, which Roboto lacks."""
RIGHT_TO_LEFT = ("\u0590", "\u08ff")
"""First and last character of Hebrew, Arabic and the scripts between them."""
_HOMES = {
    Weight.ICON: ("fonticon_mdi7", "fonts"),
    Weight.EAST_ASIAN: ("noto_cjk_sans_jp_regular", ""),
    Weight.RIGHT_TO_LEFT: ("matplotlib", "mpl-data/fonts/ttf"),
}
"""Package and folder of the fonts; of the others, Roboto's."""

MISSING = "\uffff"
"""No character, so a font draws its sign for a letter that it lacks."""

CAP_HEIGHT = 0.711
"""Height of Roboto's capitals, in em."""


@lru_cache(maxsize=128)
def font(weight: Weight, size: int) -> ImageFont.FreeTypeFont:
    """A face at a size in pixels. Raises SetupError: the package with the fonts is missing."""
    package, folder = _HOMES.get(weight, ("font_roboto", "files"))
    spec = find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise SetupError(f"the fonts of {package} are missing; install them with `{install_hint()}`")
    path = Path(spec.submodule_search_locations[0]) / folder / weight.value
    from PIL import ImageFont

    engine = ImageFont.Layout.RAQM if weight is Weight.RIGHT_TO_LEFT else ImageFont.Layout.BASIC
    return ImageFont.truetype(str(path), size, layout_engine=engine)


def face(text: str, weight: Weight, size: int) -> ImageFont.FreeTypeFont:
    """The face for a text; one with any letter of Arabic, Hebrew or East Asia is set in that font completely."""
    if text.isascii() or weight is Weight.ICON:
        return font(weight, size)
    first, last = RIGHT_TO_LEFT
    if any(first <= char <= last for char in text) and sets_right_to_left():
        return font(Weight.RIGHT_TO_LEFT, size)
    return font(Weight.EAST_ASIAN if max(text) >= EAST_ASIAN_FROM else weight, size)


@cache
def sets_right_to_left() -> bool:
    """Whether Arabic and Hebrew can be set: by Pillow's Raqm, in a font of ``matplotlib``."""
    from PIL import features

    return find_spec(_HOMES[Weight.RIGHT_TO_LEFT][0]) is not None and bool(features.check("raqm"))


def can_set(text: str, weight: Weight, size: int) -> bool:
    """Whether the fonts have every letter of a text; they lack the scripts of India, for example."""
    if text.isascii():
        return True
    letters = face(text, weight, size)
    missing = _drawn(letters, MISSING)
    return all(char.isspace() or _drawn(letters, char) != missing for char in set(text))


def _drawn(letters: ImageFont.FreeTypeFont, char: str) -> bytes:
    pixels: Any = letters.getmask(char)  # Pillow's own type for it lacks that it is a sequence
    return bytes(pixels)


class Icon(StrEnum):
    """Code points of Material Design Icons 7."""

    HOME = "\U000f02de"
    MAP = "\U000f18f0"
    CLIMATE = "\U000f0210"
    SAFETY = "\U000f0f83"
    VEHICLE = "\U000f010b"
    MEDIA = "\U000f075a"
    SETTINGS = "\U000f0493"
    DEFROST_FRONT = "\U000f0d61"
    DEFROST_REAR = "\U000f0d62"
    SNOWFLAKE = "\U000f0717"
    RECIRCULATION = "\U000f00e8"
    AUTO = "\U000f171d"
    SYNC = "\U000f0339"
    SEAT_HEATER = "\U000f0fa6"
    STEERING = "\U000f04d4"
    AIR_UP = "\U000f101c"
    AIR_MIDDLE = "\U000f059d"
    AIR_DOWN = "\U000f0482"
    LOW_BEAM = "\U000f0c4a"
    HIGH_BEAM = "\U000f0c4c"
    FRONT_FOG = "\U000f0c4b"
    POSITION = "\U000f0d63"
    LIGHTS_OFF = "\U000f0e4f"
    LIGHTS_AUTO = "\U000f1800"
    HAZARD = "\U000f0c89"
    REAR_FOG = "\U000f0591"
    CRUISE = "\U000f0d60"
    BRAKE = "\U000f0c48"
    COLLISION = "\U000f160f"
    STABILITY = "\U000f0d64"
    LANE = "\U000f0462"
    SPEED = "\U000f04c5"
    DISTANCE = "\U000f0b6e"
    FATIGUE = "\U000f04b2"
    DISTRACTION = "\U000f0209"
    SEAT_BELT = "\U000f0cc5"
    SLIPPERY = "\U000f0f29"
    WEATHER = "\U000f0596"
    TRAFFIC = "\U000f052b"
    JAM = "\U000f0b6e"
    ROADWORKS = "\U000f137c"
    CLOSURE = "\U000f0376"
    COMPASS = "\U000f018c"
    NAVIGATION = "\U000f0390"
    CORRIDOR = "\U000f00fb"
    AMBULANCE = "\U000f002f"
    MOVE_OVER = "\U000f1015"
    SCHOOL = "\U000f0474"
    TUNNEL = "\U000f183d"
    VEHICLE_FAULT = "\U000f1814"
    INFO = "\U000f02fc"
    WARNING = "\U000f0026"
    CRITICAL = "\U000f0029"
    KEYBOARD_CLOSE = "\U000f030f"
    PHONE = "\U000f03f2"
    PHONE_ALERT = "\U000f0f1a"
    PULL_OVER = "\U000f13b3"
    SLOWER = "\U000f0f86"
    WARN = "\U000f00e6"
    MINUS = "\U000f0374"
    PLUS = "\U000f0415"
    PLAY = "\U000f040a"
    PAUSE = "\U000f03e4"
    NEXT = "\U000f04ad"
    PREVIOUS = "\U000f04ae"
    VOLUME = "\U000f057e"
    BLUETOOTH = "\U000f00af"
    RADIO = "\U000f0439"
    RADIO_TOWER = "\U000f043b"
    NOTE = "\U000f0387"
    DAY = "\U000f05a8"
    NIGHT = "\U000f0594"
    DAY_NIGHT = "\U000f050e"
    BRIGHTNESS = "\U000f00df"
    SIGNAL_0 = "\U000f08bf"
    SIGNAL_1 = "\U000f08bc"
    SIGNAL_2 = "\U000f08bd"
    SIGNAL_3 = "\U000f08be"
    SIGNAL_OFF = "\U000f0783"
    GPS = "\U000f01a4"
    GPS_OFF = "\U000f0f45"
    BATTERY = "\U000f0079"
    SEARCH = "\U000f0349"
    LOCK = "\U000f033e"
    PLACE = "\U000f034e"
    ROUTE = "\U000f046a"
    UNITS = "\U000f046d"
    APPS = "\U000f003b"
    HANG_UP = "\U000f03f5"
    IN_CALL = "\U000f03f6"
    CALL_OUT = "\U000f03fb"
    CALL_IN = "\U000f03f7"
    CALL_MISSED = "\U000f03fa"
    MICROPHONE = "\U000f036c"
    MICROPHONE_OFF = "\U000f036d"
    MESSAGE = "\U000f0369"
    REPLY = "\U000f0368"
    ACCOUNT = "\U000f0004"
    CONTACTS = "\U000f0849"
    STAR = "\U000f04ce"
    STAR_OUTLINE = "\U000f04d2"
    HISTORY = "\U000f02da"
    DIALPAD = "\U000f061c"
    ERASE = "\U000f0b5c"
    BELL = "\U000f009a"
    BELL_OFF = "\U000f009b"
    OUTSIDE = "\U000f0f33"
    RAIN = "\U000f0597"
    DUST = "\U000f1b5a"
    PURIFIER = "\U000f0d44"
    AIR_QUALITY = "\U000f0bac"
    CHARGING = "\U000f05f1"
    PARKING = "\U000f03e3"
    MANUAL = "\U000f14f7"
    RECORD = "\U000f044b"
    MEMO = "\U000f050a"
    STORE = "\U000f04dc"
    INSTALL = "\U000f01da"
    DELETE = "\U000f0a7a"
    TRIP = "\U000f0199"
    CALENDAR = "\U000f00ed"
    WIFI = "\U000f05a9"
    MOBILE = "\U000f0815"
    HOTSPOT = "\U000f0003"
    CLOCK = "\U000f0150"
    PRIVACY = "\U000f099d"
    LANGUAGE = "\U000f05ca"
    MUTE = "\U000f075f"
    EQUALIZER = "\U000f066a"
    SHUFFLE = "\U000f049d"
    REPEAT = "\U000f0456"
    PLAYLIST = "\U000f0cb8"
    PLAYLIST_ADD = "\U000f0412"
    PLAYLIST_REMOVE = "\U000f0413"
    PODCAST = "\U000f0994"
    USB = "\U000f0553"
    DOOR = "\U000f0b6b"
    UNLOCKED = "\U000f033f"
    CHILD = "\U000f0e7d"
    CHILD_STANDING = "\U000f02e7"
    ELDERLY = "\U000f1581"
    PET = "\U000f03e9"
    OBJECT = "\U000f03d7"
    AIRBAG = "\U000f0be9"
    SCREEN = "\U000f0379"
    WINDOW = "\U000f11dc"
    TRUNK = "\U000f0e1b"
    SEAT = "\U000f0fa4"
    SEAT_COOLER = "\U000f0fa5"
    MIRROR = "\U000f11fd"
    TYRE = "\U000f0c4d"
    PARKING_BRAKE = "\U000f0d5f"
    WASHER = "\U000f0da6"
    STRAIGHT = "\U000f005d"
    TO_THE_LEFT = "\U000f004d"
    TO_THE_RIGHT = "\U000f0054"
    TURN_LEFT = "\U000f17a7"
    TURN_RIGHT = "\U000f17ab"
    SLIGHT_LEFT = "\U000f005b"
    SLIGHT_RIGHT = "\U000f005c"
    TURN_BACK = "\U000f17ad"
    TURN_BACK_RIGHT = "\U000f17af"
    GOAL = "\U000f023c"
    TURNS = "\U000f01d0"
    MOTORWAY = "\U000f05f7"
    TOLL = "\U000f0e86"
    FERRY = "\U000f0213"
    HOUSE = "\U000f0d15"
    WORK = "\U000f00d6"
    HOSPITAL = "\U000f02e1"
    PHARMACY = "\U000f0402"
    HOTEL = "\U000f02e3"
    RESTAURANT = "\U000f0a70"
    CAFE = "\U000f0176"
    SHOP = "\U000f0110"
    PARK = "\U000f0531"
    STATION = "\U000f052c"
    MUSEUM = "\U000f0070"
    GYM = "\U000f01e6"
    BACK = "\U000f0141"
    CLOSE = "\U000f0156"
    CHECK = "\U000f012c"
    FLAP = "\U000f06a5"
    HEAT = "\U000f1a45"
    DRIVE_MODE = "\U000f0f40"
    DOME_LIGHT = "\U000f0769"
    READING_LIGHT = "\U000f0335"
    PALETTE = "\U000f03d8"
    STOP = "\U000f04db"
    SAVE = "\U000f0193"
    MASSAGE = "\U000f0cd1"
    TICKET = "\U000f0516"
    EYE = "\U000f0208"
    CAR_BESIDE = "\U000f07ab"
    PROFILE = "\U000f0019"
    VOICE = "\U000f05cb"


HOME_STYLE = Style(DAY, NIGHT, {}, 20, 14)
