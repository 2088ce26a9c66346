"""An imported scenario's folder, created completely or not at all, and its text files."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from datetime import datetime
from pathlib import Path

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import UserError
from automotive_cosim.formats import writing
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.scenarios import Sumo, Trip

ATTRIBUTION = "Map data © OpenStreetMap contributors, Open Database License (ODbL) 1.0"
COPYRIGHT_PAGE = "https://www.openstreetmap.org/copyright"

START = datetime(2026, 6, 16, 10, 0)
"""A dry Tuesday by daylight: a placeholder until the scenario's owner sets another date."""

WEATHER = Weather(
    temperature_2m=20.0,
    relative_humidity_2m=55.0,
    precipitation=0.0,
    weather_code=1,
    cloud_cover=25.0,
    visibility=20_000.0,
    wind_speed_10m=10.0,
)


REROUTING_PERIOD_S = 120.0
"""How often the other vehicles reroute."""

OFTEN_UP_TO = 5_000
"""Edges of a network in which they do; in a larger one, the time between two searches grows with it. The number of
vehicles and the cost of a search both grow with the city, so that otherwise the work would grow with its square."""


@contextmanager
def appearing(out: Path, *, replaces: bool) -> Iterator[Path]:
    """An empty folder that becomes ``out`` if the block succeeds; otherwise nothing is left.

    Raises UserError: ``out`` exists and must not be replaced, is not a scenario's folder, or cannot be written."""
    if out.exists() and not replaces:
        raise UserError(f"{out} exists; choose another --out, or --force to replace the scenario in it")
    if out.exists() and not (out / "scenario.toml").is_file():
        raise UserError(f"{out} is not a scenario folder, so it is not replaced; choose another --out")
    try:
        with writing.appearing(out, replaces=replaces) as building:
            yield building
    except OSError as error:
        raise UserError(f"{out} cannot be written ({error.strerror}); choose another --out") from error


def write_config(target: Path, net: str, routes: str, sumo: Sumo, *, ground: str = "", edges: int = 0) -> None:
    """Writes the ``.sumocfg``, which runs in sumo-gui as the scenario runs here.

    Other vehicles reroute, and push through a junction blocked for 20 s, because random traffic otherwise locks up.
    In a city of more than ``OFTEN_UP_TO`` edges they reroute less often.
    """
    sections: dict[str, dict[str, object]] = {
        "input": {"net-file": net, "route-files": routes},
        "time": {"begin": 0.0, "step-length": sumo.step_length_s},
        "processing": {
            "default.action-step-length": sumo.action_step_length_s,
            "scale": sumo.scale,
            "ignore-junction-blocker": 20,
            "time-to-teleport": 300,
        },
        "routing": {
            "routing-algorithm": "astar",
            "device.rerouting.probability": sumo.background_rerouting,
            "device.rerouting.period": round(REROUTING_PERIOD_S * max(1.0, edges / OFTEN_UP_TO)),
            "device.rerouting.pre-period": 60,
            "device.rerouting.adaptation-interval": 10,
            "device.rerouting.adaptation-steps": 18,
        },
    }
    if ground:
        sections["input"]["additional-files"] = ground
    lines = ["<configuration>"]
    for section, options in sections.items():
        lines.append(f"    <{section}>")
        lines += [f'        <{option} value="{value}"/>' for option, value in options.items()]
        lines.append(f"    </{section}>")
    write_whole(target, "\n".join([*lines, "</configuration>", ""]))


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
            text += "".join(f"{key} = {toml_value(value)}\n" for key, value in block.items() if value is not None)
    write_whole(target, text)


def toml_value(value: object) -> str:
    """A value as TOML writes it."""
    if isinstance(value, datetime):
        return json.dumps(value.isoformat())  # as scenarios are written by hand
    return json.dumps(value, ensure_ascii=False)


def write_readme(target: Path, *, title: str, source: str, lines: Sequence[str]) -> None:
    """Writes the folder's README: the source of the map and how the folder was made."""
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
        "and ego trips are in `scenario.toml`; change them as you like.",
        "",
    ]
    write_whole(target, "\n".join(text))
