"""Opens a scenario from a name, a folder, a ``.sumocfg`` or a network, with the user's changes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Ego, Scenario
from automotive_cosim.formats.xml import read_root
from automotive_cosim.scenarios.foreign import foreign_scenario, set_aside
from automotive_cosim.scenarios.reader import load
from automotive_cosim.scenarios.relocation import at_home, relocated
from automotive_cosim.scenarios.routes import chosen_trips
from automotive_cosim.traffic.additional import placed, read_mapped
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.options import read_configuration

CONFIGURATIONS = ("configuration", "sumoConfiguration")
"""Root elements of a ``.sumocfg``."""


def open_scenario(
    name: str | Path,
    *,
    origin: tuple[float, float] | None = None,
    gps: bool = True,
    from_place: str = "",
    to_place: str = "",
) -> Scenario:
    """Opens a scenario.

    Args:
        name: name of a shipped scenario, or path of a scenario's folder, a ``.sumocfg`` or a ``.net.xml``
            (``.gz``).
        origin: longitude and latitude, in degrees, to which the network's middle is moved.
        gps: False runs without GPS, so the place is unknown; a network without projection then runs too.
        from_place: where the ego's route begins: an edge, a street or ``LON,LAT``. Empty: the scenario's own.
        to_place: where it ends. If only one of the two is given, the other is drawn.

    Raises:
        UnknownNameError: no such scenario.
        ScenarioError: its files are invalid, or no route leads from the one place to the other.
        UserError: ``origin`` is not a position on earth."""
    scenario = _opened(name, to_be_moved=origin is not None)
    if origin is not None:
        scenario = relocated(scenario, origin)
    if scenario.origin is not None:
        scenario = at_home(scenario)
    if not gps:
        scenario = replace(scenario, has_place=False)
    if from_place or to_place:
        trips = chosen_trips(network_of(scenario), from_place, to_place)
        scenario = replace(scenario, ego=Ego(trips, scenario.ego.driver, any_trip=len(trips) > 1))
    return scenario


def network_of(scenario: Scenario) -> Network:
    """The scenario's network, on its side of the road and at its place. Raises ScenarioError: it cannot be read."""
    return placed(read_mapped(read_configuration(scenario.config)), scenario)


def own_files(name: str | Path) -> tuple[Path, ...]:
    """The files of a scenario of one's own: its configuration, what that names, and its ``scenario.toml``.

    Args:
        name: as ``open_scenario`` takes it. A shipped scenario has none: it belongs to the version.

    Raises ScenarioError: it cannot be read."""
    path = _configuration(Path(name))
    described: tuple[Path, ...] = ()
    if path.is_dir() or path.name == "scenario.toml":
        scenario = load(path if path.is_dir() else path.parent)
        path, described = scenario.config, (scenario.folder / "scenario.toml",)
    if not path.is_file():
        return ()
    named = read_configuration(path).files.values()
    return tuple(dict.fromkeys((*described, path.absolute(), *(file for files in named for file in files))))


def _loaded(name_or_folder: str | Path) -> Scenario:
    """A scenario with a ``scenario.toml``, and what of its configuration is set aside."""
    scenario = load(name_or_folder)
    told = set_aside(read_configuration(scenario.config)) if scenario.config.is_file() else ()
    return replace(scenario, notes=(*scenario.notes, *told))


def _configuration(path: Path) -> Path:
    """The only configuration of a folder without ``scenario.toml``; any other path as it is."""
    if path.is_dir() and not (path / "scenario.toml").is_file():
        configurations = sorted(path.glob("*.sumocfg"))
        if len(configurations) > 1:
            found = ", ".join(configuration.name for configuration in configurations)
            raise ScenarioError(f"{path} has no scenario.toml but several configurations; name one of {found}")
        return configurations[0] if configurations else path
    return path


def _opened(name: str | Path, *, to_be_moved: bool) -> Scenario:
    path = _configuration(Path(name))
    if not path.is_file():
        if path.name.endswith((".sumocfg", ".xml", ".gz")):
            raise ScenarioError(f"there is no file {path}")
        return _loaded(name)
    if path.name == "scenario.toml":
        return _loaded(path.parent)
    root = read_root(path, error=ScenarioError).tag
    if root == "osm":
        raise ScenarioError(f"{path} is an OpenStreetMap extract; import it first: scenarios import {path}")
    if root != "net" and root not in CONFIGURATIONS:
        raise ScenarioError(f"{path} is neither a SUMO configuration nor a network: its root is <{root}>")
    return foreign_scenario(path, to_be_moved=to_be_moved)
