"""Settings: display and units, sound, connections, language and time, privacy, profiles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from automotive_cosim.cockpit.apps.settings.state import (
    NETWORKS,
    PHONES,
    TABLET,
    Connections,
    Profiles,
    SwitchProfile,
)
from automotive_cosim.cockpit.cards import (
    about,
    choice,
    choices,
    content,
    fact,
    heading,
    menu,
    slider,
    switch,
    title,
)
from automotive_cosim.cockpit.commands import Put, Set, SetAll
from automotive_cosim.cockpit.flow import Block, at, card, fill, grid, line, panels, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import HMI, LINK, MEDIA, VOICE
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import GAP, Icon
from automotive_cosim.cockpit.widgets import Button, Row, Widget
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


def _page(state: State, *cards: Block) -> tuple[Widget, ...]:
    return fill(
        content(state),
        line(
            (264, menu("settings.page", [page for page in PAGES if state.beside(page[0])], state)),
            GAP,
            panels(*cards),
        ),
    )


def settings(state: State) -> tuple[Widget, ...]:
    """The display, and its units."""
    signals = state.signals
    by_itself, mode = signals[HMI.DAY_NIGHT_AUTO], signals[HMI.DAY_NIGHT]
    gps = say("Not fitted") if state.outside is None or state.outside.gps is None else say("Fitted")
    camera = say("Fitted") if state.sign_camera else say("Not fitted")
    units = (
        (say("Distance and speed"), HMI.DISTANCE_UNIT),
        (say("Temperature"), HMI.TEMPERATURE_UNIT),
        (say("Tyre pressure"), HMI.PRESSURE_UNIT),
    )
    return _page(
        state,
        card(
            title(Icon.BRIGHTNESS, say("Display")),
            24,
            (92, slider(HMI.BRIGHTNESS, state)),
            24,
            heading(say("Appearance")),
            8,
            (
                112,
                choices(
                    "settings.appearance",
                    (
                        ("auto", say("Auto"), Icon.DAY_NIGHT, by_itself, Set(HMI.DAY_NIGHT_AUTO, True)),
                        ("day", say("Day"), Icon.DAY, not by_itself and mode == "DAY", Set(HMI.DAY_NIGHT, "DAY")),
                        (
                            "night",
                            say("Night"),
                            Icon.NIGHT,
                            not by_itself and mode == "NIGHT",
                            Set(HMI.DAY_NIGHT, "NIGHT"),
                        ),
                    ),
                    stacked=True,
                ),
            ),
            12,
            (
                56,
                about(
                    "settings.appearance.about",
                    say("Auto follows the light outside: night after sunset and in tunnels."),
                ),
            ),
            REST,
            (64, switch(VOICE.TOUCH_SOUNDS, state)),
        ),
        card(
            title(Icon.UNITS, say("Units")),
            20,
            (318, grid(1, 10, *(stack(heading(name), REST, (64, choice(unit, state))) for name, unit in units))),
            REST,
            (34, fact("settings.sign_camera", say("Sign camera"), camera)),
            4,
            (34, fact("settings.positioning", say("Satellite positioning"), gps)),
        ),
    )


def sound(state: State) -> tuple[Widget, ...]:
    """Volumes and the equaliser."""
    bands = (MEDIA.BASS, MEDIA.MIDDLE, MEDIA.TREBLE, MEDIA.BALANCE, MEDIA.FADER)
    volumes = (MEDIA.VOLUME, VOICE.GUIDANCE_VOLUME, VOICE.CALL_VOLUME)
    flat = Button(
        key="sound.flat",
        text=say("Flat"),
        icon=Icon.EQUALIZER,
        on_tap=SetAll(tuple((band, 0.0) for band in bands), say("the equaliser is flat")),
        disabled="" if any(state.signals[band] for band in bands) else say("It is already flat"),
    )
    return _page(
        state,
        card(
            title(Icon.VOLUME, say("Volume")),
            20,
            (288, grid(1, 12, *(slider(volume, state) for volume in volumes))),
            REST,
            (64, switch(MEDIA.MUTED, state)),
        ),
        card(
            title(Icon.EQUALIZER, say("Equaliser")),
            12,
            (376, grid(1, 6, *(slider(band, state) for band in bands))),
            REST,
            (56, flat),
        ),
    )


def connections(state: State) -> tuple[Widget, ...]:
    """Networks and phones. They are paired while parked."""
    links = (LINK.MOBILE_DATA, LINK.WIFI, LINK.HOTSPOT)
    words = say(
        "Connect and pair while parked. Without Bluetooth, no phone is connected. A tablet only adds its music."
    )
    return _page(
        state,
        card(
            title(Icon.WIFI, say("Networks")),
            16,
            (192, grid(1, 8, *(switch(link, state) for link in links))),
            20,
            (228, grid(1, 6, *_networks(state))),
        ),
        card(
            title(Icon.BLUETOOTH, "Bluetooth"),
            16,
            switch(LINK.BLUETOOTH, state),
            16,
            heading(say("Devices")),
            8,
            (188, grid(1, 8, *_devices(state))),
            REST,
            (64, about("link.about", words)),
        ),
    )


def _networks(state: State) -> Iterator[Widget]:
    now = state.of(Connections)
    for index, name in enumerate(NETWORKS):
        yield _linked(
            f"link.network.{index}",
            name,
            say("Connected") if name == now.network else "",
            Icon.WIFI,
            "" if state.signals[LINK.WIFI] else say("Wi-Fi is off"),
            Put(replace(now, network=name), say("{name} is connected", name=name)),
            state,
        )


def _devices(state: State) -> Iterator[Widget]:
    """A phone takes the other's place, the tablet none."""
    now = state.of(Connections)
    said = say("{name} is no longer paired", name=TABLET) if now.tablet else say("{name} is paired", name=TABLET)
    devices: list[tuple[str, bool, Message]] = [
        (name, name == now.phone, Put(replace(now, phone=name), say("{name} is paired", name=name)))
        for name in PHONES
    ]
    devices.append((TABLET, now.tablet, Put(replace(now, tablet=not now.tablet), said)))
    off = "" if state.signals[LINK.BLUETOOTH] else say("Bluetooth is off")
    for index, (name, paired, pair) in enumerate(devices):
        yield _linked(f"link.device.{index}", name, say("Paired") if paired else "", Icon.MOBILE, off, pair, state)


def _linked(key: str, name: str, trail: str, icon: Icon, off: str, on_tap: Message, state: State) -> Row:
    return Row(
        key=key,
        raised=True,
        text=name,
        trail=trail,
        icon=icon,
        selected=bool(trail),
        disabled=off,
        locked=state.locked(Restriction.NO_SETUP),
        on_tap=on_tap,
    )


def language(state: State) -> tuple[Widget, ...]:
    """The language, and the format of times."""
    now, here = state.signals[HMI.LANGUAGE], state.outside
    date = say("Not available yet") if here is None else f"{here.local_time:%Y-%m-%d}"
    zone = say("Not available yet") if here is None else f"UTC{here.local_time:%z}"
    spoken = (
        Row(key=f"language.{code}", raised=True, text=name, selected=code == now, on_tap=Set(HMI.LANGUAGE, code))
        for code, name in LANGUAGES.items()
    )
    facts = (
        fact("language.clock", say("Local time"), state.clock),
        fact("language.date", say("Date"), date),
        fact("language.zone", say("Time zone"), zone),
    )
    return _page(
        state,
        card(title(Icon.LANGUAGE, say("Language")), 20, (272, grid(1, 8, *spoken))),
        card(
            title(Icon.CLOCK, say("Date and time")),
            16,
            heading(say("Time format")),
            8,
            (68, choice(HMI.TIME_FORMAT, state)),
            20,
            (132, grid(1, 8, *facts)),
            REST,
            (64, about("language.about", say("Clock and time zone are set by satellite."))),
        ),
    )


def privacy(state: State) -> tuple[Widget, ...]:
    """Data sharing and the microphone."""
    options = (
        (
            LINK.SHARE_POSITION,
            say("Contacts can follow the car, and apps know where it is. Emergency calls always send it."),
        ),
        (
            LINK.SHARE_DRIVING,
            say("Speed, braking and consumption are sent to the manufacturer to improve the car."),
        ),
        (LINK.VOICE_ASSISTANT, say("The microphone listens for spoken requests.")),
    )
    lines = (
        stack((64, switch(signal, state)), 2, (32, at(lambda box: box.inset(16, 0), about("", words, 1))))
        for signal, words in options
    )
    return _page(state, card(title(Icon.PRIVACY, say("Privacy")), 24, (330, grid(1, 12, *lines))))


def profile_list(state: State) -> tuple[Widget, ...]:
    """Driver profiles with seat, mirrors, temperature and brightness. They change only while parked."""
    now = state.of(Profiles)
    known = (
        Row(
            key=f"profile.{index}",
            raised=True,
            text=profile.name,
            trail=say("Active") if profile.name == now.driver else "",
            icon=Icon.ACCOUNT,
            selected=profile.name == now.driver,
            locked=state.locked(Restriction.NO_SETUP),
            on_tap=SwitchProfile(profile.name),
        )
        for index, profile in enumerate(now.known)
    )
    words = say("A profile sets its own seat, mirrors, temperature and brightness.")
    return _page(
        state,
        card(
            title(Icon.PROFILE, say("Profiles")),
            24,
            (252, grid(1, 12, *known)),
            20,
            (64, about("profile.about", words)),
        ),
    )
