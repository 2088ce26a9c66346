"""What pages and tests say of outside things, run again with their newest versions: what has changed is printed.

    python -m docs.outside                              # versions of all; what has a newer one is run again
    python -m docs.outside readers hours                # these, whatever their versions
    python -m docs.outside vss --vss CHECKOUT           # of VSS's repository, at the tag of a release

Newest versions are those that pip's and npm's indexes have, in environments of their own in a temporary folder.
Nothing here is changed. It needs the extra ``test``, and takes an hour if everything is run.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import venv
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.exchange.catalogs import NAMELESS, table

TOP = Path(__file__).parents[1]
SEEN = re.compile(r"<!-- readers, seen by `python -m docs\.outside` -->\n\n(.*?)\n\n<!-- end -->", re.DOTALL)
HOURS = TOP / "docs" / "reference" / "scenarios.md"
VSS = TOP / "tests" / "cockpit" / "vss.tsv"
WORDS = TOP / "agents" / "native" / "words.txt"
SCHEMA = "{http://www.w3.org/2001/XMLSchema}"
PLACE = "48.85, 2.35"
"""In France, for the table of opening hours."""


@dataclass(frozen=True, slots=True)
class Outside:
    """A table, or some claims, about outside things."""

    home: str
    """Where it stands."""
    seen: tuple[str, ...]
    """The packages that it is about, in the versions in which it was seen; npm's begin with ``npm:``."""
    again: Callable[[Path, argparse.Namespace], Iterator[str]] | None = None
    """Runs it again in a scratch folder, and yields what has changed; without it, the home says how."""


def newest(package: str) -> str:
    """The newest version that an index has; empty if it has none or cannot be reached."""
    if package.startswith("npm:"):
        return printed(["npm", "view", package[4:], "version"]) if shutil.which("npm") else ""
    told = printed([sys.executable, "-m", "pip", "index", "versions", package])
    found = re.search(r"\(([^)]+)\)", told)
    return found[1] if found else ""


def printed(command: Sequence[str | Path], **settings: object) -> str:
    """What a command prints on standard output; if it fails, the last line that it prints at all."""
    ran = subprocess.run(command, capture_output=True, text=True, check=False, **settings)  # type: ignore[call-overload]
    if not ran.returncode:
        return str(ran.stdout.strip())
    return f"failed: {([*ran.stdout.strip().splitlines(), *ran.stderr.strip().splitlines()] or ['no word'])[-1]}"


def environment(scratch: Path, *packages: str) -> Path:
    """The interpreter of a new environment with the newest versions of packages."""
    home = scratch / re.sub(r"\W", "_", packages[0])
    venv.create(home, with_pip=True)
    subprocess.run([home / "bin" / "python", "-m", "pip", "install", "-qq", *packages], check=True)
    return home / "bin" / "python"


def changed(before: list[str], now: list[str]) -> Iterator[str]:
    """Lines that are gone, and new ones."""
    yield from (f"- {line}" for line in before if line not in now)
    yield from (f"+ {line}" for line in now if line not in before)


# --- each again ---------------------------------------------------------------------------------------------------


def _readers(scratch: Path, _: argparse.Namespace) -> Iterator[str]:
    """Two drives, exported and read."""
    for family, name in (("grid_june", "grid"), ("london_july", "london")):
        drive = ["drive", family, "--minutes", "2", "--agent", "rule-perfect", "--out", str(scratch / name)]
        subprocess.run([sys.executable, "-m", "automotive_cosim_main", *drive], check=True, capture_output=True)
    command = [sys.executable, "-m", "benchmarks.readers", "--newest", "--environments", scratch / "readers"]
    now = printed([*command, scratch / "grid", scratch / "london"], cwd=TOP).splitlines()
    before = SEEN.search((TOP / "benchmarks" / "README.md").read_text(encoding="utf-8"))
    assert before is not None
    yield from changed(before[1].splitlines(), now)


def _openscenario(scratch: Path, _: argparse.Namespace) -> Iterator[str]:
    """Every element and attribute of the schemas that two packages have, against the words of the import."""
    schemas = scratch / "schemas"
    packages = ("asam-qc-openscenarioxml", "scenariogeneration")
    command = [sys.executable, "-m", "pip", "install", "-qq", "--no-deps", "--target", schemas, *packages]
    subprocess.run(command, check=True, capture_output=True)
    rows, looked = table(), 0
    for path in sorted(schemas.rglob("*OpenSCENARIO*.xsd")):
        root = ET.parse(path).getroot()
        types = {each.get("name"): each for each in root.iter(f"{SCHEMA}complexType")}
        looked += 1
        for element in root.iter(f"{SCHEMA}element"):
            tag, made = element.get("name", ""), types.get(element.get("type"), element)
            row = rows.get(tag, NAMELESS)
            for kind, known, sign in (("attribute", row.attributes, "@"), ("element", row.parts, "")):
                names = {each.get("name", "") for each in made.iter(f"{SCHEMA}{kind}") if each is not element}
                yield from (f"{path.relative_to(schemas)}: {tag} has {sign}{name}, which has no word"
                            for name in sorted(names - known.keys()))  # fmt: skip
    if looked < len(packages):
        yield f"only {looked} schemas were found"


def _hours(scratch: Path, _: argparse.Namespace) -> Iterator[str]:
    """The columns of the two libraries."""
    lines = [line for line in HOURS.read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    rows = [row for row in rows if len(row) == 5 and re.fullmatch(r"\d{4}-\d\d-\d\d \d\d:\d\d", row[1])]
    asked = json.dumps([[row[0].strip("`"), row[1]] for row in rows])
    python = environment(scratch, "opening-hours-py")
    answers = {"opening-hours-py": json.loads(printed([python, "-c", _IN_PYTHON, asked, PLACE]))}
    if shutil.which("npm"):
        subprocess.run(
            ["npm", "install", "--silent", "opening_hours"], cwd=scratch, check=True, capture_output=True
        )
        told = printed(["node", "-e", _IN_NODE, asked, PLACE], cwd=scratch)
        answers["opening_hours.js"] = json.loads(told)
    for library, column in (("opening_hours.js", 2), ("opening-hours-py", 3)):
        for row, now in zip(rows, answers.get(library, []), strict=False):
            if row[column] != now:
                yield f"{row[0]} at {row[1]}: {library} says {now}, {row[column]} before"


_IN_PYTHON = """
import json, sys
from datetime import datetime
from opening_hours import OpeningHours
place = tuple(map(float, sys.argv[2].split(",")))
def told(value, at):
    try:
        hours, then = OpeningHours(value, coords=place), datetime.fromisoformat(at)
    except Exception:
        return "refused"
    return "yes" if hours.is_open(then) else "unknown" if hours.is_unknown(then) else "no"
print(json.dumps([told(*each) for each in json.loads(sys.argv[1])]))
"""
_IN_NODE = """
const found = require("opening_hours"), hours = found.default || found;
const [lat, lon] = process.argv[2].split(",").map(Number);
const where = {lat, lon, address: {country_code: "fr", state: "Île-de-France"}};
console.log(JSON.stringify(JSON.parse(process.argv[1]).map(([value, at]) => {
  try {
    const read = new hours(value, where, 2), then = new Date(at.replace(" ", "T"));
    return read.getUnknown(then) ? "unknown" : read.getState(then) ? "yes" : "no";
  } catch (error) { return "refused"; }
})));
"""


def _vss(scratch: Path, given: argparse.Namespace) -> Iterator[str]:
    """Every signal that VSS has, by its own tools; those of older releases are left as they are."""
    if given.vss is None:
        yield "give --vss with a checkout of github COVESA/vehicle_signal_specification at the tag of a release"
        return
    tree = scratch / "spec"
    shutil.copytree(given.vss / "spec", tree)
    units = (tree / "units.yaml").read_text(encoding="utf-8")  # 6.0 has an alias that its tools refuse
    (tree / "units.yaml").write_text(re.sub(r"^mpg:\n(?: .*\n)+", "", units, flags=re.MULTILINE), encoding="utf-8")
    program = environment(scratch, "vss-tools").with_name("vspec")
    files = ["-s", "VehicleSignalSpecification.vspec", "-u", "units.yaml", "-q", "quantities.yaml"]
    subprocess.run([program, "export", "json", *files, "-o", "vss.json"], cwd=tree, check=True, capture_output=True)
    leaves: dict[str, dict[str, object]] = {}

    def walk(branch: dict[str, dict[str, object]], above: str) -> None:
        for name, each in branch.items():
            path = f"{above}.{name}".lstrip(".")
            if isinstance(below := each.get("children"), dict):
                walk(below, path)
            else:
                leaves[path] = each

    walk(json.loads((tree / "vss.json").read_text(encoding="utf-8")), "")
    rows = list(csv.DictReader(VSS.read_text(encoding="utf-8").splitlines(), delimiter="\t"))
    newest_seen = max(row["release"] for row in rows)
    for row in rows:
        leaf = leaves.get(row["path"])
        if row["release"] != newest_seen and leaf is None:
            continue  # it had gone before
        if leaf is None:
            yield f"{row['path']}, of {row['release']}: not in this release"
            continue
        for name in ("type", "datatype", "unit", "min", "max", "allowed"):
            value = leaf.get(name, "")
            now = (
                ",".join(value)
                if isinstance(value, list)
                else f"{value:g}"
                if isinstance(value, float | int)
                else value
            )
            if now != row[name]:
                yield f"{row['path']}: {name} is {now or 'not stated'}, {row[name] or 'not stated'} before"


def _words(scratch: Path, _: argparse.Namespace) -> Iterator[str]:
    """OpenAI's actions and Anthropic's tools, by their packages; and what the sources of other words stand at."""
    text = WORDS.read_text(encoding="utf-8")
    python = environment(scratch, "openai", "anthropic")
    told = json.loads(printed([python, "-c", _TOLD_BY_PACKAGES]))
    known = set(re.findall(r"[\w.]+", text))
    yield from (
        f"openai has the action {word}, which words.txt has not" for word in told["actions"] if word not in known
    )
    yield from (
        f"anthropic has the tool {tool}, which words.txt has not" for tool in told["tools"] if tool not in text
    )
    for repository, commit in sorted(set(re.findall(r"([\w-]+/[\w.-]+) ([0-9a-f]{7})\b", text))):
        ask = ["git", "ls-remote", f"https://github.com/{repository}", "HEAD"]
        head = printed(ask, env={**os.environ, "GIT_TERMINAL_PROMPT": "0"})
        if head.startswith("failed"):
            yield f"{repository}: not reached"
        elif not head.startswith(commit):
            yield f"{repository}: at {head[:7]}, {commit} when its words were read"


_TOLD_BY_PACKAGES = """
import json, pkgutil, re, typing
import anthropic.types.beta, openai.types.responses.computer_action as actions
kinds = typing.get_args(typing.get_args(actions.ComputerAction)[0])
names = [typing.get_args(kind.model_fields["type"].annotation)[0] for kind in kinds]
modules = [each.name for each in pkgutil.iter_modules(anthropic.types.beta.__path__)]
found = (re.search(r"(computer(?:_toolset|_use)?)_(20\\d{6})_param$", name) for name in modules)
tools = sorted({f"{each[1].removesuffix('_use')}_{each[2]}" for each in found if each})
print(json.dumps({"actions": names, "tools": tools}))
"""


def _sumo(scratch: Path, _: argparse.Namespace) -> Iterator[str]:
    """The table of what SUMO decides, laid over this environment."""
    packages = ("libsumo", "sumolib", "sumo-data", "traci", "eclipse-sumo")
    command = [sys.executable, "-m", "pip", "install", "-qq", "--no-deps", "--target", scratch / "sumo", *packages]
    subprocess.run(command, check=True, capture_output=True)
    over = {**os.environ, "PYTHONPATH": str(scratch / "sumo")}
    tests = ["tests/traffic/test_beside_sumo.py", "-q", "--tb=line", "-p", "no:cacheprovider"]
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", *tests], cwd=TOP, env=over, capture_output=True, text=True, check=False
    )
    yield from (line for line in ran.stdout.splitlines() if line.startswith(("FAILED", "ERROR")))


def _findings(scratch: Path, _: argparse.Namespace) -> Iterator[str]:
    """Each with the newest versions in place of those that it pins."""
    for script in sorted((TOP / "findings").glob("*.sh")):
        loose = scratch / script.name
        loose.write_text(re.sub(r"==[\d.]+", "", script.read_text(encoding="utf-8")), encoding="utf-8")
        told = printed(["bash", loose], cwd=scratch)
        if told.startswith("failed"):
            yield f"{script.name}: {told}"


SUMO = ("libsumo==1.28.0", "eclipse-sumo==1.28.0")
TABLES = {
    "words": Outside("agents/native/words.txt", ("openai==3.57.0", "anthropic==2.14.0"), _words),
    "vss": Outside("tests/cockpit/vss.tsv", ("vss-tools==6.1.0",), _vss),
    "hours": Outside(
        "docs/reference/scenarios.md", ("opening-hours-py==2.1.4", "npm:opening_hours==3.15.0"), _hours
    ),
    "openscenario": Outside(
        "automotive_cosim/exchange/openscenario.txt",
        ("asam-qc-openscenarioxml==1.0.0", "scenariogeneration==0.16.7"),
        _openscenario,
    ),
    "readers": Outside(
        "benchmarks/README.md",
        (
            *("scenic==3.1.1", "commonroad-scenario-designer==0.8.5", "lanelet2==1.2.3", "betterosi==0.9.0"),
            *("asam-osi-utilities==0.4.0", "osi-python==3.8.0", "mcap==1.6.0", "mcap-protobuf-support==0.6.0"),
        ),
        _readers,
    ),
    "sumo": Outside("tests/traffic/test_beside_sumo.py", SUMO, _sumo),
    "findings": Outside("findings/", SUMO, _findings),
    "checkers": Outside("benchmarks/README.md", ("asam-qc-opendrive==1.0.0", "asam-qc-openscenarioxml==1.0.0")),
    "measures": Outside("benchmarks/README.md", ("commonroad-crime==0.4.5", "sumo-rl==1.4.5")),
}
"""Each by its name here."""


def main() -> None:
    """Prints a line for each package, and what has changed below."""
    parser = argparse.ArgumentParser(prog="python -m docs.outside", description=__doc__)
    parser.add_argument("names", nargs="*", choices=[[], *TABLES], help="run these again, whatever their versions")
    parser.add_argument("--vss", type=Path, help="a checkout of VSS at the tag of a release")
    given = parser.parse_args()
    for name, each in TABLES.items():
        if given.names and name not in given.names:
            continue
        is_newer = False
        for package, _, seen in (seen.partition("==") for seen in each.seen):
            now = newest(package)
            is_newer |= now not in ("", seen)
            print(f"{name}: {package} {seen}, {f'now {now}' if now else 'not in an index'}", flush=True)
        if each.again is None or not (is_newer or given.names):
            continue
        with tempfile.TemporaryDirectory(prefix="automotive-cosim-outside-") as scratch:
            lines = [*each.again(Path(scratch), given)]
        print("\n".join([f"  {line}" for line in lines] or [f"  {each.home} says what it says now"]), flush=True)


if __name__ == "__main__":
    main()
