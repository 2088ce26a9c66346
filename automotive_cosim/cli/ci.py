"""``automotive-cosim ci init``: the script and the workflow with which every pull request is evaluated."""

from __future__ import annotations

import json
import re
from importlib.metadata import distribution
from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

SCRIPT, WORKFLOW = "ci/evaluate.sh", ".github/workflows/evaluate.yml"

app = typer.Typer(help="Evaluate every change of an agent on a server.", no_args_is_help=True)


@app.callback()
def _group() -> None: ...


@app.command()
def init(
    plan: Annotated[Path, typer.Argument(help="Plan of the evaluation, a file below this folder.")] = Path(
        "plan.toml"
    ),
) -> None:
    """Write a script and a GitHub workflow that compare every pull request's agents with those of its base.

    Nothing is overwritten. The script needs nothing of GitHub's: any runner can call it."""
    from automotive_cosim.errors import UserError
    from automotive_cosim.formats.writing import make_folder, write_whole
    from automotive_cosim.run.plan import make_plan, read_plan
    from automotive_cosim.traffic.sumo import DEBIAN_PACKAGES

    make_plan(read_plan(plan)).jobs()
    if plan.is_absolute() or not re.fullmatch(r"[\w./-]+", str(plan)) or ".." in plan.parts:
        raise UserError(f"{plan} is not below this folder by a name of letters, digits, - and _; move it there")
    home = files("automotive_cosim.cli")
    told = {"PLAN": plan.as_posix(), "SCRIPT": SCRIPT, "LIBRARIES": DEBIAN_PACKAGES, "SUITE": _suite()}
    workflow = home.joinpath("workflow.yml").read_text(encoding="utf-8")
    for name, value in told.items():
        workflow = workflow.replace(f"@{name}@", value)
    texts = {SCRIPT: home.joinpath("evaluate.sh").read_text(encoding="utf-8"), WORKFLOW: workflow}
    for name in texts:
        if Path(name).exists() or Path(name).is_symlink():
            raise UserError(f"{name} exists, and nothing is overwritten; delete or move it, then run this again")
    for name, text in texts.items():
        write_whole(make_folder(Path(), str(Path(name).parent)) / Path(name).name, text)
    typer.echo(
        f"{SCRIPT} and {WORKFLOW} written. Try it here: bash {SCRIPT} . {plan} runs/ci\n"
        f"Then commit both: a pull request fails if its agents succeed less often than those of its base. The "
        f"workflow installs {told['SUITE']!r}; where pip finds none, put the address of a wheel there."
    )


def _suite() -> str:
    """What pip installs this very package by: the commit that it is from, or else its version."""
    found = distribution("automotive-cosim")
    origin = json.loads(found.read_text("direct_url.json") or "{}")
    name, url = "automotive-cosim", origin.get("url", "")
    if commit := origin.get("vcs_info", {}).get("commit_id"):
        return f"{name} @ git+{url}@{commit}"
    return f"{name} @ {url}" if url.startswith("https:") else f"{name}=={found.version}"
