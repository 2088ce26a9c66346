"""Makes the shipped schemas anew: ``python -m automotive_cosim.schemas.make``."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

from automotive_cosim.cockpit import actions
from automotive_cosim.contracts import Json
from automotive_cosim.formats.schema import documented
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.geo.rulefile import RuleFile
from automotive_cosim.publish.contents import Contents
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.plan import Plan
from automotive_cosim.scenarios.reader import ScenarioFile
from automotive_cosim.schemas import SUFFIX

DIALECT = {"$schema": "http://json-schema.org/draft-07/schema#"}
FORMATS: Mapping[str, tuple[str, Callable[[], Json]]] = {
    "action": ("one action of an agent, a line of `run --actions`", actions.json_schema),
    "bundle": ("bundle.json, what a bundle of an evaluation holds", lambda: documented(Contents)),
    "episode": ("what one episode runs, `setup` in a trial.json", lambda: documented(EpisodeSetup, null=True)),
    "plan": ("plan.toml, what `eval --plan` runs", lambda: documented(Plan)),
    "rules": ("traffic rules of a place, a file in `show context --rules FOLDER`", lambda: documented(RuleFile)),
    "scenario": ("scenario.toml, what SUMO's own files have no word for", lambda: documented(ScenarioFile)),
}
"""What each is of, and what makes it."""


def made(name: str) -> str:
    """The schema of a format as its file should be."""
    about, make = FORMATS[name]
    whole = DIALECT | make() | {"title": name, "description": about}
    return json.dumps(whole, indent=2, ensure_ascii=False) + "\n"


def main() -> None:
    """Writes the schema of every user-written format."""
    for name in FORMATS:
        path = Path(__file__).with_name(f"{name}{SUFFIX}")
        write_whole(path, made(name))
        print(path)


if __name__ == "__main__":
    main()
