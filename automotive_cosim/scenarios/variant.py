"""A copy of a scenario with another demand: vehicles with fixed routes."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from xml.sax.saxutils import quoteattr

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds, files
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.writing import appearing, copy, make_folder, write_whole
from automotive_cosim.traffic.file_check import files_in
from automotive_cosim.traffic.options import Configuration

NOT_TAKEN = re.compile(rb"<(stop|person|personFlow|container|containerFlow|ride|walk)[\s/>]")
"""Elements of a demand that a copy cannot take over."""

DEMAND = re.compile(rb"<(vehicle|trip|flow|person|personFlow|container|containerFlow)[\s/>]")

OF_GIVEN_DEMAND = frozenset({"scale", "device.rerouting.probability", "device.rerouting.explicit"})
"""Options that would change a demand that is complete and keeps its routes."""

MOST_COPIED_BYTES = 2**32
"""Of all files of a scenario together; the network and the demand of a city take a tenth."""


def check_target(target: Path) -> None:
    """Refuses a folder that is not empty. Raises UserError: it is not."""
    if target.exists() and any(target.iterdir()):
        raise UserError(f"{target} exists; give --out another folder, or delete that one")


@contextmanager
def new_folder(target: Path) -> Iterator[Path]:
    """A folder for a copy, which becomes the target at the end if it is filled; nobody else makes it meanwhile.

    Raises:
        UserError: the target is not empty, or another program is making it.
        OSError: it cannot be written."""
    check_target(target)
    with appearing(make_folder(target.parent) / target.name) as draft:
        yield draft


def check_demand(configuration: Configuration) -> None:
    """Refuses demand that would be lost.

    Raises UserError: it has stops or persons, or stands in additional files."""
    for option, pattern in (("route-files", NOT_TAKEN), ("additional-files", DEMAND)):
        given = configuration.files.get(option, ())
        found = {path: element for path in given if (element := _element(path, pattern))}
        if found:
            named = " and ".join(f"{path.name} has <{element}>" for path, element in found.items())
            left = [path.name for path in given if path not in found]
            if option == "route-files" and not left:
                how = "put the vehicles without stops into a route file of their own, and name that alone"
            else:
                how = f"name only {', '.join(left)} as {option}" if left else f"leave out {option}"
            raise UserError(
                f"{named}: only vehicles without stops, in route files, can change routes; in a copy of "
                f"{configuration.path}, {how}"
            )


def _element(path: Path, pattern: re.Pattern[bytes]) -> str:
    """The name of the first element that a pattern finds in a file; empty without one."""
    with files.opened(path) as file:
        found = pattern.search(file.read())
    return found[1].decode() if found else ""


def with_fixed_routes(scenario: Scenario) -> Scenario:
    """The scenario for a demand that is complete and keeps its routes."""
    sumo = replace(
        scenario.sumo, scale=1.0, background_rerouting=0.0, random_traffic_per_km_h=0.0, redraws_trips=False
    )
    return replace(scenario, sumo=sumo)


def vehicle(name: str, type_id: str, depart_s: float, edges: Iterable[str]) -> str:
    """A vehicle with its route, as SUMO's XML."""
    return (
        f'    <vehicle id={quoteattr(name)} type={quoteattr(type_id)} depart="{depart_s:.2f}" departLane="best"'
        f' departSpeed="max"><route edges={quoteattr(" ".join(edges))}/></vehicle>\n'
    )


def demand(types: str, vehicles: Iterable[str]) -> str:
    """Vehicles, in the order of their departures, as a file of SUMO's."""
    return f"<routes>\n    {types}\n{''.join(vehicles)}</routes>\n"


def write_variant(
    draft: Path,
    scenario: Scenario,
    configuration: Configuration,
    routes: tuple[str, str],
    record: tuple[str, Json],
    *,
    begin_s: float | None = None,
    start_hour: int | None = None,
) -> None:
    """Copies a scenario with another demand.

    Only the files that its configuration names are copied, and those that they name: regular ones, through no link
    out of its folder; beside them its ``scenario.toml`` and README. Without ``scenario.toml`` the copy is again a
    folder with one ``.sumocfg``, whose time of day is its own.

    Args:
        draft: of ``new_folder``.
        routes: name and text of the file of the new demand.
        record: name and content of a JSON file on how it was made.
        begin_s: when the simulation begins; None keeps it.
        start_hour: local hour of the ego's departure; None keeps it.

    Raises:
        UserError: a file leads out of the folder or is too large.
        OSError: a file cannot be read or written."""
    toml = scenario.folder / "scenario.toml"
    described = toml.is_file()
    home = scenario.folder if described else configuration.path.absolute().parent
    config = draft / (scenario.sumo.config if described else f"{scenario.name}.sumocfg")
    folder = make_folder(draft, config.parent.relative_to(draft).as_posix())
    dropped = {"end"} if described else OF_GIVEN_DEMAND | {"end"}  # that only spaces out flows
    options = {name: value for name, value in configuration.options.items() if name not in dropped}
    inputs = _copied(configuration, home, draft, folder) | {"route-files": routes[0]}
    if begin_s is not None:
        options["begin"] = f"{begin_s:g}"
    lines = (f"    <{name} value={quoteattr(value)}/>\n" for name, value in {**inputs, **options}.items())
    write_whole(config, f"<configuration>\n{''.join(lines)}</configuration>\n")
    write_whole(folder / routes[0], routes[1])
    if described:
        text = settings(files.read_text(_inside(toml, home)))
        if start_hour is not None:
            start = r"(?m)^(start = \"?\d{4}-\d\d-\d\dT)\d\d:\d\d(:\d\d)?"
            text = re.sub(start, rf"\g<1>{start_hour:02}:00:00", text)
        write_whole(draft / toml.name, text)
        if (about := home / "README.md").is_file():  # whose map it is
            copy(_inside(about, home), draft / about.name, bounds.TEXT_BYTES)
    write_whole(draft / record[0], json.dumps(record[1], indent=1, ensure_ascii=False))


def _copied(configuration: Configuration, home: Path, draft: Path, folder: Path) -> dict[str, str]:
    """Copies the files of a configuration, but not its demand, and those that they name.

    Args:
        home: the scenario's folder; a file in it has the same place in the copy.

    Returns:
        Option -> names as the copy's configuration has them, separated by commas."""
    places: dict[Path, Path] = {}
    left = MOST_COPIED_BYTES
    inputs: dict[str, str] = {}
    for option, named in ({"net-file": (configuration.net,)} | dict(configuration.files)).items():
        if option == "route-files":
            continue
        for path in (inner for each in named for inner in (each, *files_in(each))):
            if path in places:
                continue
            if (place := Path(os.path.normpath(path))).is_relative_to(home):
                inside = make_folder(draft, place.parent.relative_to(home).as_posix())
                places[path] = inside / place.name
            elif path in named:
                taken = (folder / path.name).exists()
                places[path] = folder / (f"{option}{len(places)}-{path.name}" if taken else path.name)
            else:
                raise UserError(
                    f"{path}, which a file of {configuration.path} names, is not in {home}; put it there"
                )
            left -= copy(_inside(path, home), places[path], left)
        inputs[option] = ",".join(os.path.relpath(places[path], folder) for path in named)
    return inputs


def _inside(path: Path, home: Path) -> Path:
    """The path, unless it is in a folder and a link leads it out of there. Raises UserError: one does."""
    if Path(os.path.normpath(path)).is_relative_to(home) and not path.resolve().is_relative_to(home.resolve()):
        raise UserError(f"{path} is a link that leads out of {home}; put the file itself there")
    return path


def settings(text: str) -> str:
    """The scenario's settings for a demand that is complete and keeps its routes."""
    for name, value in (
        ("background_rerouting", "0.0"),
        ("scale", "1.0"),
        ("random_traffic_per_km_h", "0.0"),
        ("redraws_trips", "false"),
    ):
        text = re.sub(rf"(?m)^{name}\s*=.*$", "", text)
        text = re.sub(r"(?m)^\[sumo\]\s*$", f"[sumo]\n{name} = {value}", text, count=1)
    return re.sub(r"\n{3,}", "\n\n", text)
