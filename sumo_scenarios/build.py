"""Compiles a shipped scenario's plain XML into the net that SUMO runs.

    python -m automotive_cosim.sumo_scenarios.build paris_centre
    python -m automotive_cosim.sumo_scenarios.build all

Each scenario folder holds ``NAME.netccfg``, netconvert's own configuration, which names the plain XML; the
result is the net that ``NAME.sumocfg`` names, compressed if its name ends in ``.gz``. netconvert comes with the
``eclipse-sumo`` distribution (``pip install automotive-cosim[import]``). The same input gives the same bytes:
netconvert's comment with date and paths is dropped, gzip's time stamp is 0.
"""

from __future__ import annotations

import gzip
import re
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

from automotive_cosim.errors import ScenarioError, UnknownNameError, UserError
from automotive_cosim.traffic import sumo_programs

ROOT = Path(__file__).resolve().parent
_GENERATED = re.compile(rb"<!-- generated on .*?-->\s*", re.DOTALL)


def buildable() -> tuple[str, ...]:
    """Names of the scenarios that have plain XML to build from."""
    return tuple(sorted(path.stem for path in ROOT.glob("*/*.netccfg") if path.stem == path.parent.name))


def compile_net(name: str) -> bytes:
    """The net of a scenario, as XML.

    Raises:
        UnknownNameError: no scenario of that name has plain XML.
        ScenarioError: netconvert refuses it; the text is netconvert's.
        SetupError: eclipse-sumo is not installed."""
    if name not in buildable():
        raise UnknownNameError("scenario with plain XML", name, buildable())
    with tempfile.TemporaryDirectory() as folder:
        net = Path(folder) / f"{name}.net.xml"
        built, printed = sumo_programs.run("netconvert", ["-c", ROOT / name / f"{name}.netccfg", "-o", net])
        if not built:
            raise ScenarioError(f"netconvert refused {name}: {sumo_programs.first_error(printed)}")
        return _GENERATED.sub(b"", net.read_bytes(), count=1)


def build(name: str) -> Path:
    """Writes the net into the scenario's folder and returns its path; raises as ``compile_net``."""
    net, path = compile_net(name), net_of(name)
    path.write_bytes(gzip.compress(net, mtime=0) if path.suffix == ".gz" else net)
    return path


def shipped_net(name: str) -> bytes:
    """The net in the scenario's folder, as XML."""
    path = net_of(name)
    return gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()


def net_of(name: str) -> Path:
    """The net file that the scenario's ``.sumocfg`` names."""
    files = ElementTree.parse(ROOT / name / f"{name}.sumocfg").iter("net-file")
    return ROOT / name / next(files).attrib["value"]


def main(names: list[str]) -> int:
    """The command line: builds each named scenario, or ``all``. Returns the exit code."""
    try:
        if not names:
            raise ScenarioError(f"name a scenario to build, or all; there are: {', '.join(buildable())}")
        for name in buildable() if names == ["all"] else names:
            path = build(name)
            print(f"{path} {path.stat().st_size / 1e3:.0f} kB")
    except UserError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
