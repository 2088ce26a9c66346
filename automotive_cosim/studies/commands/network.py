"""``automotive-cosim study congestion``, ``days`` and ``adoption``: studies of a whole network."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from automotive_cosim.cli.batches import ExecutorSettings, tell_notes
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, tells_json
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.studies.commands.shared import StudyFolder, driven, folder_of, raise_errors, tell_reading
from automotive_cosim.studies.settings import AdoptionSettings, CongestionSettings, DaysSettings, TrafficSettings

if TYPE_CHECKING:
    from automotive_cosim.run.batch import BatchKind

IN_PYTHON = ("redraw", "step_s")
"""What only a plan of one's own sets."""


@tells_json
@takes(CongestionSettings, but=IN_PYTHON)
@takes(ExecutorSettings)
def congestion(out: StudyFolder = None, as_json: bool = False, **settings: Any) -> None:
    """Measure the delay of a whole network before and after an intervention, in copies of the same traffic.

    Rerun the command to resume a stopped study."""
    from automotive_cosim.studies.congestion.plan import CongestionPlan
    from automotive_cosim.studies.congestion.seed import CONGESTION

    plan = filled(CongestionPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    tell_notes([plan.opened])
    interventions, over = counted(len(plan.interventions), "intervention"), counted(len(plan.seeds), "seed")
    about = f"{interventions} and none, {over}, in steps of {plan.driven_step_s(plan.opened):g} s"
    _run(plan, CONGESTION, "seeds", out, settings, as_json=as_json, about=about)


@tells_json
@takes(DaysSettings, but=("lag",))
@takes(ExecutorSettings)
def days(out: StudyFolder = None, as_json: bool = False, **settings: Any) -> None:
    """Advise a share of the drivers day after day until traffic settles, beside the user equilibrium.

    Rerun the command to resume a stopped study."""
    from automotive_cosim.studies.days.days import DAYS, DaysPlan

    plan = filled(DaysPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    _run(plan, DAYS, "shares and seeds", out, settings, as_json=as_json)


@tells_json
@takes(AdoptionSettings, but=("emissions", "driver", "every_s", *IN_PYTHON))
@takes(ExecutorSettings)
def adoption(out: StudyFolder = None, as_json: bool = False, **settings: Any) -> None:
    """Put an assistant into a growing share of the cars of one traffic: what it does to them and to all others.

    Rerun the command to resume a stopped study."""
    from automotive_cosim.studies.adoption.adoption import ADOPTION, AdoptionPlan

    plan = filled(AdoptionPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    tell_notes([plan.opened])
    _run(plan, ADOPTION, "seeds", out, settings, as_json=as_json)


COMMANDS = (congestion, adoption, days)
"""In the order in which they are listed."""


def _run(
    plan: TrafficSettings,
    kind: BatchKind[Any, Any, Any],
    units: str,
    out: Path | None,
    settings: Mapping[str, Any],
    *,
    as_json: bool,
    about: str = "",
) -> None:
    """Runs what is left of a study of a whole network, and prints its result, if anything of it ran.

    Args:
        units: what it runs, in words.
        out: its folder; None for the one of its plan.
        as_json: print an object alone.
        about: what is said of it before it runs.

    Raises InfrastructureError: parts of it ended in an error."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.content import read_study, shown_of, write_shown

    folder = out or folder_of(plan)
    where = filled(ExecutorSettings, settings).opened()
    console = Console(stderr=as_json, highlight=False)
    if about:
        console.print(f"{about}, into {folder}", soft_wrap=True)
    with where, driven(console, units, folder) as tell:
        kind.run(plan, folder, executor=where, tell=tell)
    study = read_study(folder, plan.kind)
    if len(study.errors) < len(study.rows):
        shown = shown_of(study)
        page = write_shown(study, shown)
        tables = shown.tables[:1]
        if as_json:
            told: Json = {"answer": shown.answer, "warnings": list(shown.warnings), "out": str(folder)}
            print_json(told | {table.name: table.records() for table in tables})
        else:
            for text in (*(table.markdown() for table in tables), *shown.warnings, shown.answer):
                console.print(text, soft_wrap=True)
            console.print(f"report written to {page}", soft_wrap=True)
    raise_errors(study.errors, len(study.rows), "run")
