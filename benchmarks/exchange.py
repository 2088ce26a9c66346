"""Checks exported roads and trials with ASAM's own quality checkers, which live in an environment of their own.

python -m venv qc && qc/bin/pip install asam-qc-opendrive asam-qc-openscenarioxml
PATH=$PATH:$PWD/qc/bin python -m benchmarks.exchange [--scenarios grid,london] [TRIAL ...]
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path
from xml.sax.saxutils import quoteattr

from automotive_cosim import scenarios
from automotive_cosim.exchange.opendrive import write_opendrive
from automotive_cosim.exchange.openscenario import VERSIONS, write_openscenario
from automotive_cosim.exchange.recording import read_recording
from automotive_cosim.scenery import open_scenario
from automotive_cosim.traffic.options import read_configuration

CHECKERS = {".xodr": ("qc_opendrive", "xodrBundle"), ".xosc": ("qc_openscenario", "xoscBundle")}
LEVELS = {"1": "errors", "2": "warnings", "3": "notes"}


def checked(path: Path) -> str:
    """A line of the table."""
    program, application = CHECKERS[path.suffix]
    found, config = path.with_suffix(".xqar"), path.with_suffix(".config.xml")
    config.write_text(
        f'<Config><Param name="InputFile" value={quoteattr(str(path))}/><CheckerBundle application="{application}">'
        f'<Param name="resultFile" value={quoteattr(str(found))}/></CheckerBundle></Config>',
        encoding="utf-8",
    )
    subprocess.run([program, "-c", str(config)], cwd=path.parent, check=True, capture_output=True)
    root = ET.parse(found).getroot()
    states = Counter(checker.attrib["status"] for checker in root.iter("Checker"))
    issues = Counter(LEVELS[issue.attrib["level"]] for issue in root.iter("Issue"))
    counts = *(states[name] for name in ("completed", "skipped")), *(issues[name] for name in LEVELS.values())
    return f"| {path.name} | {path.stat().st_size / 1e6:.2f} MB | " + " | ".join(map(str, counts)) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", nargs="*", type=Path, help="folders of recorded trials")
    parser.add_argument("--scenarios", default=",".join(scenarios.shipped()), help="whose roads are checked")
    given = parser.parse_args()
    missing = [program for program, _ in CHECKERS.values() if shutil.which(program) is None]
    if missing:
        sys.exit(f"{', '.join(missing)} not found: install ASAM's checkers as above")
    print("| file | size | checks completed | skipped | errors | warnings | notes |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scenario in filter(None, given.scenarios.split(",")):
            road = folder / f"{scenario}.xodr"
            write_opendrive(read_configuration(open_scenario(scenario).config).net, road)
            print(checked(road), flush=True)
        for trial in given.trials:
            recording = read_recording(trial)
            road = folder / "road.xodr"
            write_opendrive(read_configuration(open_scenario(recording.scenario).config).net, road)
            for version in VERSIONS:
                path = folder / f"{trial.name}-{version.replace('.', '_')}.xosc"
                write_openscenario(recording, path, version, road)
                print(checked(path), flush=True)


if __name__ == "__main__":
    main()
