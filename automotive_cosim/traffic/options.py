"""A scenario's ``.sumocfg`` and ``scenario.toml`` -> SUMO's command line, without outputs.

The scenario's files are only read. Of its options those in ``vocabulary`` are taken, and its files are copied under
names of ours to a scratch folder, in which SUMO runs (``vetting``).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, timedelta
from itertools import chain
from pathlib import Path
from xml.sax.saxutils import quoteattr

from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.formats.files import is_file
from automotive_cosim.formats.scenario import Ego, Scenario, Sumo, Trip
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.formats.xml import FilePlace, read_root, scan
from automotive_cosim.traffic import random_traffic
from automotive_cosim.traffic.file_check import OTHER_EGO, copy_vetted, refuse_variables
from automotive_cosim.traffic.mirror import mirrored, write_mirrored
from automotive_cosim.traffic.network import FORM, Network, NetworkReader, read_network
from automotive_cosim.traffic.redraw import redraw
from automotive_cosim.traffic.sumo import EGO
from automotive_cosim.traffic.vocabulary import IGNORED, MESOSCOPIC, PARALLEL, REFUSED, TAKEN, WINDOW

INPUTS = ("net-file", "route-files", "additional-files", "weight-files")
"""Options that name files."""

TRUE, FALSE = frozenset(("1", "true", "on", "yes", "x", "t")), frozenset(("0", "false", "off", "no", "-", "f", ""))
"""How SUMO's files say so."""

EGO_LISTS = ".explicit"
"""The ending of options that list vehicles."""

DEFAULTS = {
    "time-to-teleport": "300",
    "ignore-junction-blocker": "20",
    "device.rerouting.period": "60",
    "device.rerouting.adaptation-steps": "180",
}
"""Options that keep traffic from locking up; a configuration may override them. SUMO's own experiments
(``Scenario.as_stated``) do without."""

COARSE = {"device.rerouting.adaptation-interval": "10", "device.rerouting.adaptation-steps": "18"}
"""Of traffic that is drawn, in which no vehicle has a rerouting device: then only who goes round something closed
reads what SUMO averages, and a value a second for every edge would be a sixth of a city's memory."""

AGAIN = ("device.rerouting.period", "device.rerouting.adaptation-steps")
"""Those of them that let rerouting devices choose again and again; also set where a run is asked for devices."""

QUIET = {
    "no-step-log": "true",
    "no-warnings": "true",
    "duration-log.disable": "true",
    "xml-validation": "never",
    "xml-validation.net": "never",
}

ANY_ROUTE = "ignore-route-errors"
INTERNAL = "no-internal-links"

COLLISIONS = "collision.action"

FIXED = {COLLISIONS: "remove"}
"""Options of a run that is not SUMO's own experiment, which would teleport who collides by default."""

UNCHECKED = {ANY_ROUTE: "true"}
"""Options of every run. SUMO would stop at a vehicle whose fixed route leads over a closed road; that goes round
instead (``detours``), and a route that is broken anyway is refused."""

NOTICED = {COLLISIONS: "warn", "collision.stoptime": "0"}
"""Of a run in which collisions have no effect: SUMO tells of the ego's, and nobody else drives otherwise."""

SCRATCH = "automotive-cosim-"
"""Beginning of the name of a simulation's scratch folder."""

EDGE_FLOWS = "edges.xml"
OUTPUTS = ("fcd.xml", "tripinfo.xml", EDGE_FLOWS)
"""SUMO's own outputs that a run may write."""

SUMO_STEP_S = 1.0
"""SUMO's own step length."""
REROUTING = "device.rerouting.probability"

NO_EGO = Ego((Trip("", "", ""),))

FLOW_ATTRIBUTES = "sampledSeconds timeLoss waitingTime speed entered left"
"""What is written of the flow on an edge."""


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
    flow_s: float | None = None
    """Length of the intervals in which the flow on every edge (``edges.xml``) is written instead, from the end of
    the warm-up; None for the ego's outputs."""

    @property
    def traffic(self) -> Setup:
        """The setup without what only counts once an ego departs: simulations of which this is the same have the
        same warm traffic, wherever on earth they are and whatever the ego is."""
        scenario = self.scenario
        warm_up = timedelta(seconds=scenario.sumo.warm_up_s)
        began = (scenario.start.astimezone(UTC) - warm_up).astimezone(scenario.start.tzinfo)
        at_home = replace(
            scenario,
            origin=None,
            country="",
            language="",
            notes=(),
            ego=NO_EGO,
            start=began.replace(tzinfo=UTC),  # by its own clock, by which roads open and close
            weather=scenario.weather[:1],
        )
        return replace(self, scenario=at_home)


@dataclass(frozen=True, slots=True)
class Configuration:
    """The content of a ``.sumocfg``."""

    path: Path
    net: Path
    options: Mapping[str, str] = field(default_factory=dict)
    """Option name -> value, only those that are taken, without files."""
    files: Mapping[str, tuple[Path, ...]] = field(default_factory=dict)
    """Option of ``INPUTS`` -> its files, absolute."""
    ignored: tuple[str, ...] = ()
    """Names of the options that have no effect here."""
    parallel: tuple[str, ...] = ()
    """Those that would make SUMO work in parallel."""

    @property
    def begin_s(self) -> float:
        """Simulation time at which the demand starts.

        Raises ScenarioError: it is neither seconds nor a clock time."""
        return self.number("begin", 0.0)

    def number(self, option: str, otherwise: float, most: float = 1e9) -> float:
        """The value of an option; times may be written ``[days:]hours:minutes:seconds``.

        Raises ScenarioError: it is not a number, or beyond ``most`` either way."""
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


@dataclass(frozen=True, slots=True)
class Copied(Configuration):
    """A configuration whose files are checked copies under names of ours."""

    folder: Path = Path()
    """The folder of the copies."""
    given: Mapping[str, tuple[Path, ...]] = field(default_factory=dict)
    """The files that were copied, like ``files``."""
    distributions: frozenset[str] = frozenset()
    """Names of the distributions of vehicle types. SUMO lists them among the types, but each call to one of that
    name is about another type, drawn at random (seen in SUMO 1.28)."""

    @contextmanager
    def named_as_given(self) -> Iterator[None]:
        """Names files in errors as the user does."""
        try:
            yield
        except ScenarioError as error:
            text = str(error)
            for name, files in self.given.items():
                for number, file in enumerate(files):
                    copies = rf"(?:\S*{re.escape(self.folder.name)}[/\\])?\b{name}{number}(?:-\d+)*\.xml"
                    text = str(file).join(re.split(copies, text))
            raise ScenarioError(text) from error


def read_configuration(path: Path) -> Configuration:
    """Reads a ``.sumocfg``; a plain network counts as one that names nothing else.

    Raises ScenarioError: it is not XML, names no network, or names a missing file."""
    if read_root(path, error=ScenarioError).tag == "net":
        return Configuration(path, path.absolute(), files={"net-file": (path.absolute(),)})
    reader = _Reader(path)
    scan(path, reader.start, text=reader.text, place=reader.place, error=ScenarioError, what="a SUMO configuration")
    if "net-file" not in reader.files:
        raise ScenarioError(f"{path} names no net-file")
    return Configuration(
        path,
        reader.files["net-file"][0],
        reader.options,
        reader.files,
        tuple(reader.ignored),
        tuple(reader.parallel),
    )


def stamp(configuration: Configuration) -> tuple[tuple[Path, int, int], ...]:
    """Size and time of change of each file that it names, to tell whether they are as they were read."""
    files = (configuration.path, configuration.net, *chain.from_iterable(configuration.files.values()))
    seen = ((path.absolute(), path.stat()) for path in files)
    return tuple((path, about.st_size, about.st_mtime_ns) for path, about in seen)


@dataclass(slots=True)
class _Reader:
    """Takes the options of a configuration."""

    path: Path
    place: FilePlace = field(default_factory=FilePlace)
    options: dict[str, str] = field(default_factory=dict)
    files: dict[str, tuple[Path, ...]] = field(default_factory=dict)
    ignored: dict[str, None] = field(default_factory=dict)
    """Names, in their order."""
    parallel: dict[str, None] = field(default_factory=dict)

    def start(self, element: str, attributes: dict[str, str]) -> None:
        """Takes an option, or passes a section."""
        value = attributes.get("value", attributes.get("v"))
        if value is None:
            return
        where = f"{self.path} line {self.place.line}"
        if element in TAKEN:
            self._take(TAKEN[element], value, where)
        elif element in IGNORED or element in WINDOW:
            if element != INTERNAL or value.lower() not in FALSE:
                self.ignored[IGNORED.get(element, element)] = None
        elif element in PARALLEL:
            self.parallel[PARALLEL[element]] = None
        elif element == MESOSCOPIC:
            if value.lower() not in FALSE:
                raise ScenarioError(
                    f"{where}: it is mesoscopic (<{element}>), and there no car is in a lane; remove it, or give a "
                    "scenario of single vehicles"
                )
        elif element in REFUSED:
            raise ScenarioError(f"{where}: <{element}> names files that are not checked here; remove it")
        else:
            raise ScenarioError(
                f"{where}: {UnknownNameError('option of SUMO', element[:80], TAKEN, 'sumo --help')}"
            )

    def text(self, piece: str) -> None:
        """Refuses the old form, which SUMO still reads."""
        if piece.strip():
            where = f"{self.path} line {self.place.line}"
            raise ScenarioError(f'{where}: {piece.strip()[:80]!r}; write <option value="..."/>')

    def _take(self, name: str, value: str, where: str) -> None:
        if not value:
            return
        refuse_variables(value, f"{where}: {name}")
        if name not in INPUTS:
            self.options[name] = value
            return
        files = [self.path.parent / part.strip() for part in value.split(",") if part.strip()]
        for file in files:
            if not is_file(file):
                raise ScenarioError(f"{where}: its {name} {str(file)!r} is missing")
        if files:
            self.files[name] = tuple(file.absolute() for file in files)


def command_line(options: Mapping[str, str]) -> list[str]:
    """The command line of SUMO, its name first. Each option is one word, so that no value can pass as an option."""
    return ["sumo", *(f"--{name}={value}" for name, value in options.items())]


def copied(configuration: Configuration, folder: Path, network: NetworkReader | None = None) -> Copied:
    """The configuration with checked copies of its files.

    Args:
        configuration: the scenario's own.
        folder: a folder for the copies, and for nothing else but what SUMO writes.

    Raises:
        ScenarioError: a file of the scenario is not one of SUMO's, or may write (``vetting``)."""
    known = network.known.digest if network and network.known else b""
    net = folder / copy_vetted(configuration.net, folder, "net-file0", network, FORM, known)
    distributions = _Distributions()
    files = {
        name: tuple(
            folder / copy_vetted(file, folder, f"{name}{number}", distributions)
            for number, file in enumerate(originals)
        )
        for name, originals in configuration.files.items()
        if name != "net-file"
    }
    files["net-file"] = (net,)
    return Copied(
        configuration.path,
        net,
        configuration.options,
        files,
        configuration.ignored,
        configuration.parallel,
        folder,
        configuration.files,
        frozenset(distributions.names),
    )


class _Distributions:
    """Reads the names of distributions of vehicle types."""

    def __init__(self) -> None:
        self.names: set[str] = set()

    def start(self, name: str, attributes: dict[str, str], depth: int) -> None:
        """Takes the start of an element."""
        if name == "vTypeDistribution":
            self.names.add(attributes.get("id", ""))


def edge_data(file: str, begin_s: float, period_s: float) -> str:
    """An additional file by which SUMO writes the flow on every edge, also within junctions."""
    return (
        f'<additional><edgeData id="flow" file={quoteattr(file)} begin="{begin_s:g}" period="{period_s:g}" '
        f'excludeEmpty="true" withInternal="true" writeAttributes="{FLOW_ATTRIBUTES}"/></additional>'
    )


def takes_any_route(configuration: Configuration, network: Network) -> bool:
    """Whether vehicles may set out on routes that their class cannot drive: the configuration says so, or roads of
    the network are closed at certain hours."""
    return network.has_hours or configuration.options.get(ANY_ROUTE, "").lower() in TRUE


def stated_and_set(configuration: Configuration, sumo: Sumo) -> dict[str, tuple[float, float]]:
    """What a configuration states, with SUMO's default if it does not, and what a scenario has, by option.

    Raises ScenarioError: the configuration states no number."""
    number = configuration.number
    return {
        "step-length": (number("step-length", SUMO_STEP_S), sumo.step_length_s),
        "scale": (number("scale", 1.0, 100), sumo.scale),
        REROUTING: (max(0.0, number(REROUTING, 0.0)), sumo.background_rerouting),
    }


def _given(configuration: Configuration, scenario: Scenario) -> dict[str, str]:
    """The configuration's options as a run takes them."""
    options = dict(configuration.options)
    if not scenario.as_stated:
        options.pop("end", None)
        sumo = scenario.sumo
        is_coarse = sumo.random_traffic_per_km_h > 0 and not sumo.background_rerouting
        return DEFAULTS | (COARSE if is_coarse else {}) | options | FIXED
    return options | (NOTICED if options.get(COLLISIONS) == "none" else {})


def run_options(configuration: Copied, setup: Setup, network: Network | None = None) -> dict[str, str]:
    """The options of a run, name -> value; names of files are those in the folder, in which SUMO must run.

    Args:
        configuration: the scenario's own, with copies of its files.
        setup: seed, and the scenario's step lengths, scale and rerouting.
        network: the configuration's as it drives, if it has been read."""
    options = _given(configuration, setup.scenario) | QUIET | UNCHECKED
    for name, value in options.items():
        if name.endswith(EGO_LISTS):
            options[name] = ",".join(OTHER_EGO if each == EGO else each for each in value.split(","))
    inputs = {name: [file.name for file in files] for name, files in configuration.files.items()}
    if setup.scenario.mirrored:
        image = network or mirrored(read_network(configuration.net))
        inputs["net-file"] = ["mirrored.net.xml"]
        write_mirrored(configuration.net, configuration.folder / "mirrored.net.xml", image.map)
    sumo = setup.scenario.sumo
    if sumo.redraws_trips:
        days = [f"day{number}.rou.xml" for number in range(len(inputs.get("route-files", ())))]
        for number, (file, day) in enumerate(zip(configuration.files.get("route-files", ()), days, strict=True)):
            redraw(file, configuration.folder / day, setup.seed + number)
        inputs["route-files"] = days
    if sumo.random_traffic_per_km_h > 0:
        drawn = "random.add.xml"
        roads = network or read_network(configuration.net)
        random_traffic.write(configuration.folder / drawn, roads, sumo.random_traffic_per_km_h, setup.seed)
        inputs.setdefault("additional-files", []).append(drawn)
    if setup.outputs is not None and setup.flow_s is not None:
        wanted = "flow.add.xml"
        begin_s = configuration.begin_s + sumo.warm_up_s
        flows = edge_data(str(setup.outputs / EDGE_FLOWS), begin_s, setup.flow_s)
        write_whole(configuration.folder / wanted, flows)
        inputs.setdefault("additional-files", []).append(wanted)
    options |= {name: ",".join(names) for name, names in inputs.items() if names}
    options["seed"] = str(setup.seed)
    for option, (stated, to_set) in stated_and_set(configuration, sumo).items():
        if stated != to_set:
            options[option] = f"{to_set:g}"
            if option == REROUTING:  # whose devices choose once only, unless a period is stated
                options = {name: DEFAULTS[name] for name in AGAIN} | options
    if sumo.action_step_length_s is not None:
        options["default.action-step-length"] = f"{max(sumo.step_length_s, sumo.action_step_length_s):g}"
    if sumo.lateral_resolution_m is not None:
        options["lateral-resolution"] = f"{sumo.lateral_resolution_m:g}"
    if setup.outputs is not None and setup.flow_s is not None:
        options["precision"] = "4"
    elif setup.outputs is not None:
        options |= {
            "fcd-output": str(setup.outputs / "fcd.xml"),
            "fcd-output.skip-empty": "true",
            "device.fcd.explicit": EGO,
            "device.emissions.explicit": EGO,
            "tripinfo-output": str(setup.outputs / "tripinfo.xml"),
            "precision": "6",
        }
    return options
