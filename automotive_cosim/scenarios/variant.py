"""A copy of a scenario with another demand: vehicles with fixed routes."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from xml.sax.saxutils import quoteattr

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats import files
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.traffic.options import Configuration

NOT_TAKEN = re.compile(rb"<(stop|person|personFlow|container|containerFlow|ride|walk)[\s/>]")
"""Elements of a demand that a copy cannot take over."""

DEMAND = re.compile(rb"<(vehicle|trip|flow|person|personFlow|container|containerFlow)[\s/>]")

OF_GIVEN_DEMAND = frozenset({"scale", "device.rerouting.probability", "device.rerouting.explicit"})
"""Options that would change a demand that is complete and keeps its routes."""


def check_target(target: Path) -> None:
    """Refuses a folder that is not empty.

    Raises:
        UserError: it is not.
    """
    if target.exists() and any(target.iterdir()):
        raise UserError(f"{target} exists; give --out another folder, or delete that one")


def check_demand(configuration: Configuration) -> None:
    """Refuses demand that would be lost.

    Raises:
        UserError: it has stops or persons, or stands in additional files.
    """
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
    target: Path,
    scenario: Scenario,
    configuration: Configuration,
    routes: tuple[str, str],
    record: tuple[str, Json],
    *,
    begin_s: float | None = None,
    start_hour: int | None = None,
) -> None:
    """Copies a scenario with another demand; the copy appears whole.

    Of a scenario without ``scenario.toml``, the configuration and its files are copied, and nothing else in their
    folder: the copy is again a folder with one ``.sumocfg``, whose time of day is its own.

    Args:
        target: the copy's folder; what is there is replaced.
        scenario: what to copy.
        configuration: its configuration.
        routes: name and text of the file of the new demand.
        record: name and content of a JSON file on how it was made.
        begin_s: when the simulation begins; None keeps it.
        start_hour: local hour of the ego's departure; None keeps it.
    """
    draft = target.with_name(f".{target.name}.part")
    shutil.rmtree(draft, ignore_errors=True)
    described = (scenario.folder / "scenario.toml").is_file()
    if described:
        shutil.copytree(scenario.folder, draft)
        inputs = {name: _local(paths, scenario.config.parent) for name, paths in configuration.files.items()}
        options = {**inputs, **configuration.options}
        config = scenario.config.name
    else:
        draft.mkdir(parents=True)
        kept = {name: value for name, value in configuration.options.items() if name not in OF_GIVEN_DEMAND}
        options = {**_copied(configuration, draft), **kept}
        config = f"{scenario.name}.sumocfg"
    options.pop("end", None)  # which only spaces out the flows of the old demand
    (draft / routes[0]).write_text(routes[1], encoding="utf-8")
    options["route-files"] = routes[0]
    if begin_s is not None:
        options["begin"] = f"{begin_s:g}"
    lines = "".join(f"    <{name} value={quoteattr(value)}/>\n" for name, value in options.items())
    (draft / config).write_text(f"<configuration>\n{lines}</configuration>\n", encoding="utf-8")
    if described:
        toml = draft / "scenario.toml"
        text = settings(toml.read_text(encoding="utf-8"))
        if start_hour is not None:
            start = r"(?m)^(start = \"?\d{4}-\d\d-\d\dT)\d\d:\d\d(:\d\d)?"
            text = re.sub(start, rf"\g<1>{start_hour:02}:00:00", text)
        toml.write_text(text, encoding="utf-8")
    (draft / record[0]).write_text(json.dumps(record[1], indent=1, ensure_ascii=False), encoding="utf-8")
    shutil.rmtree(target, ignore_errors=True)
    draft.replace(target)


def _copied(configuration: Configuration, folder: Path) -> dict[str, str]:
    """Copies the files of a configuration, but not its demand; option -> names, separated by commas."""
    inputs: dict[str, str] = {}
    for option, paths in ({"net-file": (configuration.net,)} | dict(configuration.files)).items():
        if option != "route-files":
            names: list[str] = []
            for path in paths:
                taken = (folder / path.name).exists()
                names.append(f"{option}{len(names)}-{path.name}" if taken else path.name)
                shutil.copyfile(path, folder / names[-1])
            inputs[option] = ",".join(names)
    return inputs


def _local(paths: Iterable[Path], folder: Path) -> str:
    """The files of a configuration, those in its folder relative to it again."""
    here = folder.absolute()
    return ",".join(str(path.relative_to(here) if path.is_relative_to(here) else path) for path in paths)


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
