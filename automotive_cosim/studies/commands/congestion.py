"""``automotive-cosim study congestion``: a whole network's delay before and after a measure."""

from __future__ import annotations

from typing import Any

from automotive_cosim.cli.batches import ExecutorSettings, tell_notes
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson
from automotive_cosim.contracts.plain import counted
from automotive_cosim.studies.commands.shared import StudyFolder, driven, folder_of, tell_reading, tell_whole
from automotive_cosim.studies.settings import CongestionSettings


@takes(CongestionSettings)
@takes(ExecutorSettings)
def congestion(
    out: StudyFolder = None,
    as_json: AsJson = False,
    **settings: Any,
) -> None:
    """Measure the delay of a whole network before and after a measure, in copies of the same traffic.

    Rerun the command to resume a stopped study.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.congestion.drive import run_congestion
    from automotive_cosim.studies.congestion.page import answer, warnings, write_congestion
    from automotive_cosim.studies.congestion.plan import CongestionPlan
    from automotive_cosim.studies.congestion.results import read_congestion
    from automotive_cosim.studies.congestion.tables import whole

    plan = filled(CongestionPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    tell_notes([plan.opened])
    folder = out or folder_of(plan)
    where = filled(ExecutorSettings, settings).opened()
    console = Console(stderr=as_json, highlight=False)
    measures, over = counted(len(plan.measures), "measure"), counted(len(plan.seeds), "seed")
    console.print(
        f"{measures} and none, {over}, in steps of {plan.driven_step_s(plan.opened):g} s, into {folder}",
        soft_wrap=True,
    )
    with where, driven(console, "seeds", folder) as tell:
        run_congestion(plan, folder, executor=where, tell=tell)
    study = read_congestion(folder)
    tell_whole(console, study, write_congestion, answer, warnings, [whole(study)], as_json=as_json)
