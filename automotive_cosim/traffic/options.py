"""A scenario's ``.sumocfg`` and ``scenario.toml`` -> SUMO's command line, without outputs.

The scenario's files are only read. Of its options those in ``vocabulary`` are taken, files are named by absolute
paths, and those that would write are copied to a scratch folder without their outputs (``vetting``).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.formats.files import is_file
from automotive_cosim.formats.xml import scan
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic import random_traffic
from automotive_cosim.traffic.mirror import write_mirrored
from automotive_cosim.traffic.network import read_network, root_of
from automotive_cosim.traffic.redraw import redraw
from automotive_cosim.traffic.vetting import vet
from automotive_cosim.traffic.vocabulary import IGNORED, REFUSED, TAKEN

INPUTS = ("net-file", "route-files", "additional-files", "weight-files")

DEFAULTS = {
    "time-to-teleport": "300",
    "ignore-junction-blocker": "20",
    "device.rerouting.period": "60",
    "device.rerouting.adaptation-steps": "180",
}
"""Options that keep traffic from locking up; a configuration may override them."""

QUIET = {
    "no-step-log": "true",
    "no-warnings": "true",
    "duration-log.disable": "true",
    "xml-validation": "never",
    "xml-validation.net": "never",
}

FIXED = {"collision.action": "remove"}
"""Options of every run: SUMO's default would teleport who collides, and the ego's collision must end its drive."""

OUTPUTS = ("fcd.xml", "tripinfo.xml")
"""SUMO's own outputs that a run may write."""


@dataclass(frozen=True, slots=True)
class Setup:
    """Everything that determines a simulation before the ego departs."""

    scenario: Scenario
    seed: int = 0
    """Seed of SUMO's random numbers."""
    allow_unprojected: bool = False
    """Whether to accept a network without projection, with lon and lat None."""
    outputs: Path | None = None
    """Folder for SUMO's own outputs: the ego's positions (``fcd.xml``) and everybody's trips (``tripinfo.xml``),
    the ego's with its emissions."""


@dataclass(frozen=True, slots=True)
class Configuration:
    """The content of a ``.sumocfg``."""

    path: Path
    net: Path
    options: dict[str, str]
    """Option name -> value, only those that are taken; files absolute."""
    ignored: tuple[str, ...] = ()
    """Names of the options that have no effect here."""

    @property
    def begin_s(self) -> float:
        """Simulation time at which the demand starts.

        Raises:
            ScenarioError: it is neither seconds nor a clock time.
        """
        return self.number("begin", 0.0)

    def number(self, option: str, otherwise: float, most: float = 1e9) -> float:
        """The value of an option; times may be written ``[days:]hours:minutes:seconds``.

        Raises:
            ScenarioError: it is not a number, or beyond ``most`` either way.
        """
        text = self.options.get(option, "")
        try:
            parts = [float(part) for part in text.split(":")] if text else [otherwise]
        except ValueError:
            parts = [math.nan]
        if not all(map(math.isfinite, parts)) or len(parts) not in (1, 3, 4):
            raise ScenarioError(f"{self.path}: {option} = {text[:80]!r} is not a number")
        weights = (86_400.0, 3_600.0, 60.0, 1.0)
        value = sum(part * weight for part, weight in zip(parts, weights[-len(parts) :], strict=True))
        if abs(value) > most:
            raise ScenarioError(f"{self.path}: {option} = {text[:80]!r} is beyond {most:g}")
        return value


def read_configuration(path: Path) -> Configuration:
    """Reads a ``.sumocfg``; a plain network counts as one that names nothing else.

    Raises:
        ScenarioError: it is not XML, names no network, or names a missing file.
    """
    if root_of(path).tag == "net":
        return Configuration(path, path.absolute(), {"net-file": str(path.absolute())})
    reader = _Reader(path)
    scan(path, reader.start, text=reader.text, error=ScenarioError, what="a SUMO configuration")
    if "net-file" not in reader.options:
        raise ScenarioError(f"{path} names no net-file")
    return Configuration(path, Path(reader.options["net-file"]), reader.options, tuple(reader.ignored))


@dataclass(slots=True)
class _Reader:
    """Takes the options of a configuration."""

    path: Path
    options: dict[str, str] = field(default_factory=dict)
    ignored: dict[str, None] = field(default_factory=dict)
    """Names, in their order."""

    def start(self, element: str, attributes: dict[str, str], line: int) -> None:
        """Takes an option, or passes a section."""
        value = attributes.get("value", attributes.get("v"))
        if value is None:
            return
        where = f"{self.path} line {line}"
        if element in TAKEN:
            name = TAKEN[element]
            if value:
                self.options[name] = self._files(name, value, where) if name in INPUTS else value
        elif element in IGNORED:
            self.ignored[IGNORED[element]] = None
        elif element in REFUSED:
            raise ScenarioError(f"{where}: <{element}> names files that are not checked here; remove it")
        else:
            raise ScenarioError(
                f"{where}: {UnknownNameError('option of SUMO', element[:80], TAKEN, 'sumo --help')}"
            )

    def text(self, piece: str, line: int) -> None:
        """Refuses the old form, which SUMO still reads."""
        if piece.strip():
            raise ScenarioError(f'{self.path} line {line}: {piece.strip()[:80]!r}; write <option value="..."/>')

    def _files(self, name: str, value: str, where: str) -> str:
        """The comma-separated files, absolute."""
        files = [self.path.parent / part.strip() for part in value.split(",") if part.strip()]
        for file in files:
            if "${" in file.name or not is_file(file):  # SUMO may put a variable's value there
                raise ScenarioError(f"{where}: its {name} {str(file)!r} is missing")
        return ",".join(str(file.absolute()) for file in files)


def command_line(options: Mapping[str, str]) -> list[str]:
    """The command line of SUMO, its name first. Each option is one word, so that no value can pass as an option."""
    return ["sumo", *(f"--{name}={value}" for name, value in options.items())]


def run_options(configuration: Configuration, setup: Setup, scratch: Path) -> dict[str, str]:
    """The options of a run, name -> value.

    Args:
        configuration: the scenario's own.
        setup: seed, and the scenario's step lengths, scale and rerouting.
        scratch: an empty folder for changed files.

    Raises:
        ScenarioError: a file of the scenario is not one of SUMO's, or may write (``vetting``).
    """
    options = DEFAULTS | configuration.options | QUIET | FIXED
    for name in INPUTS:
        if files := options.get(name):
            options[name] = ",".join(str(vet(Path(file), scratch)) for file in files.split(","))
    if setup.scenario.mirrored:
        options["net-file"] = str(write_mirrored(Path(options["net-file"]), scratch / "mirrored.net.xml"))
    sumo = setup.scenario.sumo
    step_s = sumo.step_length_s
    if sumo.redraws_trips:
        routes = filter(None, options.get("route-files", "").split(","))
        days = (redraw(Path(file), scratch / f"day{n}.rou.xml", setup.seed + n) for n, file in enumerate(routes))
        options["route-files"] = ",".join(map(str, days))
    if sumo.random_traffic_per_km_h > 0:
        drawn = scratch / "random.add.xml"
        random_traffic.write(drawn, read_network(configuration.net), sumo.random_traffic_per_km_h, setup.seed)
        options["additional-files"] = ",".join(filter(None, (options.get("additional-files"), str(drawn))))
    options |= {
        "step-length": f"{step_s:g}",
        "default.action-step-length": f"{max(step_s, sumo.action_step_length_s):g}",
        "seed": str(setup.seed),
        "scale": f"{sumo.scale:g}",
        "device.rerouting.probability": f"{sumo.background_rerouting:g}",
    }
    if sumo.lateral_resolution_m is not None:
        options["lateral-resolution"] = f"{sumo.lateral_resolution_m:g}"
    if setup.outputs is not None:
        options |= {
            "fcd-output": str(setup.outputs / "fcd.xml"),
            "fcd-output.skip-empty": "true",
            "device.fcd.explicit": "ego",
            "device.emissions.explicit": "ego",
            "tripinfo-output": str(setup.outputs / "tripinfo.xml"),
            "precision": "6",
        }
    return options
