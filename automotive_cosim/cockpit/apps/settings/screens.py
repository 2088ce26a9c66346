"""Settings: display and units, sound, connections, language and time, privacy, profiles."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.settings.commands import SwitchProfile
from automotive_cosim.cockpit.apps.settings.state import NETWORKS, PHONES, TABLET, Connections, Profiles
from automotive_cosim.cockpit.commands import Put, Set, SetAll
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.parts import choices, content, fact, heading, menu, slider, switch, title
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import HMI, LINK, MEDIA, VOICE, Signal
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Row, Widget
from automotive_cosim.contracts.text import say

PAGES = (
    ("settings", say("Display, units"), Icon.BRIGHTNESS),
    ("sound", say("Sound"), Icon.VOLUME),
    ("connections", say("Connections"), Icon.WIFI),
    ("language", say("Language, time"), Icon.LANGUAGE),
    ("privacy", say("Privacy"), Icon.PRIVACY),
    ("profiles", say("Profiles"), Icon.PROFILE),
)
LANGUAGES = {"en": "English", "fr": "Français", "de": "Deutsch", "ja": "日本語"}
PADDING = 28, 24


def _page(state: State, *cards: Widget) -> tuple[Widget, ...]:
    return menu(row(content(state), 264, REST)[0], "settings.page", PAGES, state), *cards


def _paper(state: State) -> Rect:
    """The area of a page, beside the menu."""
    return row(content(state), 264, GAP, REST)[-1]


# --- display, units -----------------------------------------------------------------------------------------


def settings(state: State) -> tuple[Widget, ...]:
    """The display, and its units."""
    left, right = panes(_paper(state), REST, REST)
    return _page(state, _display(left, state), _units(right, state))


def _display(rect: Rect, state: State) -> Widget:
    signals = state.signals
    head, _, bright, _, name, _, modes, _, about, _, sounds = column(
        rect.inset(*PADDING), 40, 24, 92, 24, 28, 8, 112, 12, 56, REST, 64
    )
    by_itself, mode = signals[HMI.DAY_NIGHT_AUTO], signals[HMI.DAY_NIGHT]
    return Card(
        rect=rect,
        children=(
            title(head, Icon.BRIGHTNESS, say("Display")),
            slider(bright, "settings.brightness", say("Brightness"), Icon.BRIGHTNESS, HMI.BRIGHTNESS, signals),
            heading(name, say("Appearance")),
            choices(
                modes,
                "settings.appearance",
                [
                    ("auto", say("Auto"), Icon.DAY_NIGHT, by_itself, Set(HMI.DAY_NIGHT_AUTO, True)),
                    ("day", say("Day"), Icon.DAY, not by_itself and mode == "DAY", Set(HMI.DAY_NIGHT, "DAY")),
                    (
                        "night",
                        say("Night"),
                        Icon.NIGHT,
                        not by_itself and mode == "NIGHT",
                        Set(HMI.DAY_NIGHT, "NIGHT"),
                    ),
                ],
                stacked=True,
            ),
            Label(
                rect=about,
                key="settings.appearance.about",
                text=say("Auto follows the light outside: night after sunset and in tunnels."),
                style=Type.CAPTION,
                tone="muted",
                lines=2,
            ),
            switch(sounds, "settings.touch_sounds", say("Touch sounds"), Icon.VOLUME, VOICE.TOUCH_SOUNDS, signals),
        ),
    )


def _units(rect: Rect, state: State) -> Widget:
    signals = state.signals
    head, _, units, _, fitted = column(rect.inset(*PADDING), 40, 20, 318, REST, 72)
    groups: tuple[tuple[str, str, Signal[str], tuple[tuple[str, str, str], ...]], ...] = (
        (
            "distance",
            say("Distance and speed"),
            HMI.DISTANCE_UNIT,
            (("kilometres", say("Kilometres"), "KILOMETERS"), ("miles", say("Miles"), "MILES")),
        ),
        (
            "temperature",
            say("Temperature"),
            HMI.TEMPERATURE_UNIT,
            (("celsius", say("Celsius"), "C"), ("fahrenheit", say("Fahrenheit"), "F")),
        ),
        (
            "pressure",
            say("Tyre pressure"),
            HMI.PRESSURE_UNIT,
            (("bar", "bar", "BAR"), ("kpa", "kPa", "KPA"), ("psi", "psi", "PSI")),
        ),
    )
    children: list[Widget] = [title(head, Icon.UNITS, say("Units"))]
    for line, (key, name, signal, options) in zip(units.rows(3, 10), groups, strict=True):
        now = signals[signal]
        children += [
            heading(line.top(28), name),
            choices(
                line.bottom_part(64),
                f"settings.{key}",
                [(unit, text, None, now == value, Set(signal, value)) for unit, text, value in options],
            ),
        ]
    gps = say("Not fitted") if state.outside is None or state.outside.gps is None else say("Fitted")
    camera = say("Fitted") if state.sign_camera else say("Not fitted")
    facts = fitted.rows(2, 4)
    children += fact(facts[0], "settings.sign_camera", say("Sign camera"), camera)
    children += fact(facts[1], "settings.positioning", say("Satellite positioning"), gps)
    return Card(rect=rect, children=tuple(children))


# --- sound ------------------------------------------------------------------------------------------------


def sound(state: State) -> tuple[Widget, ...]:
    """Volumes and the equaliser."""
    signals = state.signals
    left, right = panes(_paper(state), REST, REST)
    volume, _, levels, _, mute = column(left.inset(*PADDING), 40, 20, 288, REST, 64)
    equaliser, _, tones, _, neutral = column(right.inset(*PADDING), 40, 12, 376, REST, 56)
    volumes = (
        ("sound.media", say("Media"), Icon.MEDIA, MEDIA.VOLUME),
        ("sound.guidance", say("Guidance"), Icon.VOICE, VOICE.GUIDANCE_VOLUME),
        ("sound.calls", say("Calls"), Icon.PHONE, VOICE.CALL_VOLUME),
    )
    bands = (
        ("sound.bass", say("Bass"), MEDIA.BASS, _decibels(signals[MEDIA.BASS])),
        ("sound.middle", say("Mid"), MEDIA.MIDDLE, _decibels(signals[MEDIA.MIDDLE])),
        ("sound.treble", say("Treble"), MEDIA.TREBLE, _decibels(signals[MEDIA.TREBLE])),
        ("sound.balance", say("Left, right"), MEDIA.BALANCE, _left_right(signals[MEDIA.BALANCE])),
        ("sound.fader", say("Rear, front"), MEDIA.FADER, _rear_front(signals[MEDIA.FADER])),
    )
    flat = tuple((signal, 0.0) for _, _, signal, _ in bands)
    even = all(signals[signal] == 0 for signal, _ in flat)
    return _page(
        state,
        Card(
            rect=left,
            children=(
                title(volume, Icon.VOLUME, say("Volume")),
                *(
                    slider(line, key, name, icon, signal, signals)
                    for line, (key, name, icon, signal) in zip(levels.rows(3, 12), volumes, strict=True)
                ),
                switch(mute, "sound.mute", say("Mute media"), Icon.MUTE, MEDIA.MUTED, signals),
            ),
        ),
        Card(
            rect=right,
            children=(
                title(equaliser, Icon.EQUALIZER, say("Equaliser")),
                *(
                    slider(line, key, name, Icon.EQUALIZER, signal, signals, shown)
                    for line, (key, name, signal, shown) in zip(tones.rows(5, 6), bands, strict=True)
                ),
                Button(
                    rect=neutral,
                    key="sound.flat",
                    text=say("Flat"),
                    icon=Icon.EQUALIZER,
                    on_tap=SetAll(flat, say("the equaliser is flat")),
                    disabled=say("It is already flat") if even else "",
                ),
            ),
        ),
    )


def _decibels(gain: float) -> str:
    return f"{gain:+.0f} dB" if gain else "0"


def _left_right(balance: float) -> str:
    share = f"{abs(balance):.0f}"
    if not balance:
        return share
    return say("right {share}", share=share) if balance > 0 else say("left {share}", share=share)


def _rear_front(fader: float) -> str:
    share = f"{abs(fader):.0f}"
    if not fader:
        return share
    return say("front {share}", share=share) if fader > 0 else say("rear {share}", share=share)


# --- connections --------------------------------------------------------------------------------------------


def connections(state: State) -> tuple[Widget, ...]:
    """Networks and phones. They are paired while parked."""
    signals = state.signals
    left, right = panes(_paper(state), REST, REST)
    head, _, links, _, networks = column(left.inset(*PADDING), 40, 16, 192, 20, 228)
    bluetooth, _, power, _, name, _, devices, _, about = column(
        right.inset(*PADDING), 40, 16, 60, 16, 28, 8, 188, REST, 64
    )
    locked = state.locked(Restriction.NO_SETUP)
    now = state.of(Connections)
    wifi_off = "" if signals[LINK.WIFI] else say("Wi-Fi is off")
    bluetooth_off = "" if signals[LINK.BLUETOOTH] else say("Bluetooth is off")
    return _page(
        state,
        Card(
            rect=left,
            children=(
                title(head, Icon.WIFI, say("Networks")),
                *(
                    switch(line, key, name, icon, signal, signals)
                    for line, (key, name, icon, signal) in zip(
                        links.rows(3, 8),
                        (
                            ("link.mobile", say("Mobile data"), Icon.MOBILE, LINK.MOBILE_DATA),
                            ("link.wifi", say("Wi-Fi"), Icon.WIFI, LINK.WIFI),
                            ("link.hotspot", say("Hotspot"), Icon.HOTSPOT, LINK.HOTSPOT),
                        ),
                        strict=True,
                    )
                ),
                *(
                    Row(
                        rect=line,
                        key=f"link.network.{at}",
                        raised=True,
                        text=name,
                        trail=say("Connected") if name == now.network else "",
                        icon=Icon.WIFI,
                        selected=name == now.network,
                        disabled=wifi_off,
                        locked=locked,
                        on_tap=Put(replace(now, network=name), say("{name} is connected", name=name)),
                    )
                    for at, (line, name) in enumerate(zip(networks.rows(4, 6), NETWORKS, strict=True))
                ),
            ),
        ),
        Card(
            rect=right,
            children=(
                title(bluetooth, Icon.BLUETOOTH, "Bluetooth"),
                switch(power, "link.bluetooth", "Bluetooth", Icon.BLUETOOTH, LINK.BLUETOOTH, signals),
                heading(name, say("Devices")),
                *(
                    Row(
                        rect=line,
                        key=f"link.device.{at}",
                        raised=True,
                        text=name,
                        trail=say("Paired") if paired else "",
                        icon=Icon.MOBILE,
                        selected=paired,
                        disabled=bluetooth_off,
                        locked=locked,
                        on_tap=pair,
                    )
                    for at, (line, (name, paired, pair)) in enumerate(
                        zip(devices.rows(len(PHONES) + 1, 8), _devices(state), strict=True)
                    )
                ),
                Label(
                    rect=about,
                    key="link.about",
                    text=say(
                        "Connect and pair while parked. Without Bluetooth, no phone is connected."
                        " A tablet only adds its music."
                    ),
                    style=Type.CAPTION,
                    tone="muted",
                    lines=2,
                ),
            ),
        ),
    )


def _devices(state: State) -> tuple[tuple[str, bool, Message], ...]:
    """Each device, whether it is paired, and what a tap does: a phone takes the other's place, the tablet none."""
    now = state.of(Connections)
    phones = tuple(
        (name, name == now.phone, Put(replace(now, phone=name), say("{name} is paired", name=name)))
        for name in PHONES
    )
    said = say("{name} is no longer paired", name=TABLET) if now.tablet else say("{name} is paired", name=TABLET)
    return (*phones, (TABLET, now.tablet, Put(replace(now, tablet=not now.tablet), said)))


# --- language, time -------------------------------------------------------------------------------------------


def language(state: State) -> tuple[Widget, ...]:
    """The language, and the format of times."""
    signals = state.signals
    left, right = panes(_paper(state), REST, REST)
    head, _, words = column(left.inset(*PADDING), 40, 20, 272)
    when, _, name, _, forms, _, facts, _, about = column(
        right.inset(*PADDING), 40, 16, 28, 8, 68, 20, 132, REST, 64
    )
    now, form = signals[HMI.LANGUAGE], signals[HMI.TIME_FORMAT]
    date = say("Not available yet") if state.outside is None else f"{state.outside.local_time:%Y-%m-%d}"
    zone = say("Not available yet") if state.outside is None else f"UTC{state.outside.local_time:%z}"
    lines = facts.rows(3, 8)
    return _page(
        state,
        Card(
            rect=left,
            children=(
                title(head, Icon.LANGUAGE, say("Language")),
                *(
                    Row(
                        rect=line,
                        key=f"language.{code}",
                        raised=True,
                        text=name,
                        selected=code == now,
                        on_tap=Set(HMI.LANGUAGE, code),
                    )
                    for line, (code, name) in zip(words.rows(4, 8), LANGUAGES.items(), strict=True)
                ),
            ),
        ),
        Card(
            rect=right,
            children=(
                title(when, Icon.CLOCK, say("Date and time")),
                heading(name, say("Time format")),
                choices(
                    forms,
                    "language.time",
                    [
                        ("24", say("{n} hours", n=24), None, form == "HR_24", Set(HMI.TIME_FORMAT, "HR_24")),
                        ("12", say("{n} hours", n=12), None, form == "HR_12", Set(HMI.TIME_FORMAT, "HR_12")),
                    ],
                ),
                *fact(lines[0], "language.clock", say("Local time"), state.clock),
                *fact(lines[1], "language.date", say("Date"), date),
                *fact(lines[2], "language.zone", say("Time zone"), zone),
                Label(
                    rect=about,
                    key="language.about",
                    text=say("Clock and time zone are set by satellite."),
                    style=Type.CAPTION,
                    tone="muted",
                    lines=2,
                ),
            ),
        ),
    )


# --- privacy, profiles ----------------------------------------------------------------------------------------


def privacy(state: State) -> tuple[Widget, ...]:
    """Data sharing and the microphone."""
    signals = state.signals
    paper = _paper(state)
    head, _, body = column(paper.inset(*PADDING), 40, 24, 330)
    options = (
        (
            "privacy.position",
            say("Share position"),
            Icon.GPS,
            LINK.SHARE_POSITION,
            say("Contacts can follow the car, and apps know where it is. Emergency calls always send it."),
        ),
        (
            "privacy.driving",
            say("Share driving data"),
            Icon.CAR_BESIDE,
            LINK.SHARE_DRIVING,
            say("Speed, braking and consumption are sent to the manufacturer to improve the car."),
        ),
        (
            "privacy.microphone",
            say("Voice assistant"),
            Icon.MICROPHONE,
            LINK.VOICE_ASSISTANT,
            say("The microphone listens for spoken requests."),
        ),
    )
    children: list[Widget] = [title(head, Icon.PRIVACY, say("Privacy"))]
    for line, (key, name, icon, signal, about) in zip(body.rows(3, 12), options, strict=True):
        share, _, words = column(line, 64, 2, 32)
        children += [
            switch(share, key, name, icon, signal, signals),
            Label(rect=words.inset(16, 0), text=about, style=Type.CAPTION, tone="muted"),
        ]
    return _page(state, Card(rect=paper, children=tuple(children)))


def profile_list(state: State) -> tuple[Widget, ...]:
    """Driver profiles with seat, mirrors, temperature and brightness. They change only while parked."""
    paper = _paper(state)
    head, _, body, _, about = column(paper.inset(*PADDING), 40, 24, 252, 20, 64)
    now = state.of(Profiles)
    locked = state.locked(Restriction.NO_SETUP)
    lines = body.rows(len(now.known), 12)
    return _page(
        state,
        Card(
            rect=paper,
            children=(
                title(head, Icon.PROFILE, say("Profiles")),
                *(
                    Row(
                        rect=line,
                        key=f"profile.{at}",
                        raised=True,
                        text=profile.name,
                        trail=say("Active") if profile.name == now.driver else "",
                        icon=Icon.ACCOUNT,
                        selected=profile.name == now.driver,
                        locked=locked,
                        on_tap=SwitchProfile(profile.name),
                    )
                    for at, (line, profile) in enumerate(zip(lines, now.known, strict=True))
                ),
                Label(
                    rect=about,
                    key="profile.about",
                    text=say("A profile sets its own seat, mirrors, temperature and brightness."),
                    style=Type.CAPTION,
                    tone="muted",
                    lines=2,
                ),
            ),
        ),
    )
