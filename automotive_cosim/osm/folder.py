"""The text files of an imported scenario's folder."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from datetime import datetime
from pathlib import Path

from automotive_cosim.contracts import Weather
from automotive_cosim.scenarios import Sumo, Trip

ATTRIBUTION = "Map data © OpenStreetMap contributors, Open Database License (ODbL) 1.0"
COPYRIGHT_PAGE = "https://www.openstreetmap.org/copyright"

START = datetime(2026, 6, 16, 10, 0)
"""A Tuesday by daylight, dry: a stand-in until the scenario's owner sets another."""

WEATHER = Weather(
    temperature_2m=20.0,
    relative_humidity_2m=55.0,
    precipitation=0.0,
    weather_code=1,
    cloud_cover=25.0,
    visibility=20_000.0,
    wind_speed_10m=10.0,
)


def write_config(target: Path, net: str, routes: str, sumo: Sumo) -> None:
    """Writes the ``.sumocfg``: it runs in sumo-gui as the scenario runs here.

    Others reroute, and push through a junction blocked for 20 s, because random traffic otherwise locks up.
    """
    sections: dict[str, dict[str, object]] = {
        "input": {"net-file": net, "route-files": routes},
        "time": {"step-length": sumo.step_length_s},
        "processing": {
            "default.action-step-length": sumo.action_step_length_s,
            "scale": sumo.scale,
            "ignore-junction-blocker": 20,
            "time-to-teleport": 300,
        },
        "routing": {
            "device.rerouting.probability": sumo.background_rerouting,
            "device.rerouting.period": 120,
            "device.rerouting.pre-period": 60,
            "device.rerouting.adaptation-interval": 10,
            "device.rerouting.adaptation-steps": 18,
        },
    }
    lines = ["<configuration>"]
    for section, options in sections.items():
        lines.append(f"    <{section}>")
        lines += [f'        <{option} value="{value}"/>' for option, value in options.items()]
        lines.append(f"    </{section}>")
    target.write_text("\n".join([*lines, "</configuration>", ""]), encoding="utf-8")


def write_scenario(
    target: Path,
    *,
    name: str,
    title: str,
    about: str,
    country: str,
    time_zone: str,
    sumo: Sumo,
    trips: Sequence[Trip],
) -> None:
    """Writes ``scenario.toml``."""
    blocks: list[str | dict[str, object]] = [
        {"name": name, "title": title, "about": about, "country": country, "time_zone": time_zone, "start": START},
        "[sumo]",
        asdict(sumo),
        "[ego]",
        {"driver": "average"},
    ]
    for trip in trips:
        blocks += ["[[ego.trips]]", {key: value for key, value in asdict(trip).items() if value}]
    blocks += ["[[weather]]", {"at_s": 0.0} | asdict(WEATHER)]
    text = ""
    for block in blocks:
        if isinstance(block, str):
            text += f"\n{block}\n"
        else:
            text += "".join(f"{key} = {_toml(value)}\n" for key, value in block.items() if value is not None)
    target.write_text(text, encoding="utf-8")


def _toml(value: object) -> str:
    if isinstance(value, datetime):
        return value.isoformat()
    return json.dumps(value, ensure_ascii=False)


def write_readme(target: Path, *, title: str, source: str, lines: Sequence[str]) -> None:
    """Writes the folder's README: whose map it is, what was made of it."""
    text = [
        f"# {title}",
        "",
        f"{ATTRIBUTION}: <{COPYRIGHT_PAGE}>.",
        "The network in this folder is derived from it and stays under that licence.",
        "",
        f"Made from `{source}` by `automotive-cosim scenarios import`; `import.json` has the figures.",
        "",
        *(f"- {line}" for line in lines),
        "",
        "Drive it with `automotive-cosim run --scenario .`, look at it with `sumo-gui -c *.sumocfg`. Date, weather",
        "and ego trips stand in `scenario.toml` and are there to be changed.",
        "",
    ]
    target.write_text("\n".join(text), encoding="utf-8")
