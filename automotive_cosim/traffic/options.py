"""A scenario's ``.sumocfg`` and ``scenario.toml`` -> SUMO's command line, without outputs.

The scenario's files are only read. Options that make SUMO write are omitted, files are named by absolute paths, and
additional files whose detectors would write are copied to a scratch folder without their outputs.
"""

from __future__ import annotations

import gzip
import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic import random_traffic
from automotive_cosim.traffic.network import read_network, root_of

ALIASES = {
    "n": "net-file",
    "net": "net-file",
    "r": "route-files",
    "routes": "route-files",
    "a": "additional-files",
    "additional": "additional-files",
    "b": "begin",
    "e": "end",
    "l": "log",
}
"""Short option names that a configuration may use."""

INPUTS = ("net-file", "route-files", "additional-files")

DROPPED = frozenset(
    {
        "end",
        "log",
        "message-log",
        "error-log",
        "netstate-dump",
        "gui-settings-file",
        "start",
        "quit-on-end",
        "delay",
        "threads",
        "device.rerouting.threads",
        "random",
        "verbose",
        "no-internal-links",
        "remote-port",
        "save-configuration",
        "duration-log.statistics",
    }
)
"""Options of a configuration that a run in this package ignores, in addition to everything that names an output,
SUMO's state files and the ``ssm`` device's file. ``threads``: forks must have one; ``end`` is the caller's.
"""

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

DETECTORS = "e1Detector inductionLoop e2Detector laneAreaDetector e3Detector entryExitDetector instantInductionLoop"
COLLECTORS = "edgeData laneData routeProbe vTypeProbe calibrator timedEvent"
WRITERS = frozenset(f"{DETECTORS} {COLLECTORS}".split())
"""Elements of an additional file that write to their ``file``, ``output`` or ``dest``."""

OUTPUTS = ("fcd.xml", "tripinfo.xml")
"""SUMO's own outputs that a run may write."""

NOWHERE = "NUL"
"""SUMO's name for no file, on every platform."""


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
    """Option name -> value, without the outputs; files absolute."""

    @property
    def begin_s(self) -> float:
        """Simulation time at which the demand starts.

        Raises:
            ScenarioError: it is neither seconds nor a clock time.
        """
        return self.number("begin", 0.0)

    def number(self, option: str, otherwise: float) -> float:
        """The value of an option; times may be written ``[days:]hours:minutes:seconds``.

        Raises:
            ScenarioError: it is not a number.
        """
        text = self.options.get(option, "")
        try:
            parts = [float(part) for part in text.split(":")] if text else [otherwise]
        except ValueError:
            parts = [math.nan]
        if not all(map(math.isfinite, parts)) or len(parts) not in (1, 3, 4):
            raise ScenarioError(f"{self.path}: {option} = {text!r} is not a number")
        weights = (86_400.0, 3_600.0, 60.0, 1.0)
        return sum(part * weight for part, weight in zip(parts, weights[-len(parts) :], strict=True))


def read_configuration(path: Path) -> Configuration:
    """Reads a ``.sumocfg``; a plain network counts as one that names nothing else.

    Raises:
        ScenarioError: it is not XML, names no network, or names a missing file.
    """
    if root_of(path).tag == "net":
        return Configuration(path, path.absolute(), {"net-file": str(path.absolute())})
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, OSError) as error:
        raise ScenarioError(f"{path} is not a SUMO configuration: {error}") from error
    options: dict[str, str] = {}
    for element in root.iter():
        value = element.get("value", element.get("v"))
        name = ALIASES.get(element.tag, element.tag)
        if value is not None and not _dropped(name):
            options[name] = _absolute(value, path.parent)
    for name in INPUTS:
        for file in options.get(name, "").split(","):
            if file and not Path(file.strip()).is_file():
                raise ScenarioError(f"{path.name}: its {name} {file.strip()!r} is missing in {path.parent}")
    if not options.get("net-file"):
        raise ScenarioError(f"{path} names no net-file")
    return Configuration(path, Path(options["net-file"]), options)


def command_line(configuration: Configuration, setup: Setup, scratch: Path) -> list[str]:
    """The command line of SUMO, its name first.

    Args:
        configuration: the scenario's own.
        setup: seed, and the scenario's step lengths, scale and rerouting.
        scratch: an empty folder for changed files.
    """
    options = DEFAULTS | configuration.options | QUIET
    if files := options.get("additional-files"):
        silenced = (silence(Path(file.strip()), scratch) for file in files.split(","))
        options["additional-files"] = ",".join(str(file) for file in silenced)
    sumo = setup.scenario.sumo
    step_s = sumo.step_length_s
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
        "collision.action": "remove",
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
    return ["sumo"] + [part for name, value in options.items() for part in (f"--{name}", value)]


def silence(path: Path, scratch: Path) -> Path:
    """The additional file, or a copy of it in ``scratch`` that writes nothing if it would.

    Raises:
        ScenarioError: it is not XML.
    """
    try:
        with gzip.open(path) if path.suffix == ".gz" else path.open("rb") as file:
            tree = ET.parse(file)
    except (ET.ParseError, OSError, EOFError) as error:
        raise ScenarioError(f"{path} is not a SUMO additional file: {error}") from error
    changed = [_cut_outputs(element, path.parent, scratch) for element in tree.iter()]
    if not any(changed):
        return path
    copy = scratch / f"{len(list(scratch.iterdir()))}-{path.name.removesuffix('.gz')}"
    tree.write(copy, encoding="utf-8")
    return copy


def _cut_outputs(element: ET.Element, folder: Path, scratch: Path) -> bool:
    """Removes one element's outputs and makes its input paths absolute; true if it had outputs."""
    if element.tag in WRITERS:
        names = [name for name in ("file", "output", "dest") if element.get(name)]
        element.attrib.update(dict.fromkeys(names, NOWHERE))
        return bool(names)
    if element.tag == "include":
        included = folder / element.get("href", "")
        silenced = silence(included, scratch)
        element.set("href", str(silenced.absolute()))
        return silenced != included
    for name in ("file", "imgFile"):
        if element.get(name):
            element.set(name, str((folder / element.attrib[name]).absolute()))
    return False


def _dropped(name: str) -> bool:
    return name in DROPPED or "output" in name or name.startswith(("save-state", "device.ssm", "gui", "step-log"))


def _absolute(value: str, folder: Path) -> str:
    """File names among the comma-separated parts, made absolute; everything else as it is."""
    parts = [part.strip() for part in value.split(",")]
    return ",".join(
        str((folder / part).absolute()) if part and (folder / part).is_file() else part for part in parts
    )
