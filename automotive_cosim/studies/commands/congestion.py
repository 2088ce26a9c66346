"""``automotive-cosim study congestion``: a whole network's delay before and after a measure."""

from __future__ import annotations

from typing import Any

from automotive_cosim.cli.batches import ExecutorSettings, tell_notes
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson
from automotive_cosim.contracts.plain import counted
from automotive_cosim.studies.commands.shared import StudyFolder, run_whole, tell_reading
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
    from automotive_cosim.studies.congestion.drive import CONGESTION
    from automotive_cosim.studies.congestion.page import shown
    from automotive_cosim.studies.congestion.plan import CongestionPlan
    from automotive_cosim.studies.congestion.results import CongestionStudy

    plan = filled(CongestionPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    tell_notes([plan.opened])
    measures, over = counted(len(plan.measures), "measure"), counted(len(plan.seeds), "seed")
    about = f"{measures} and none, {over}, in steps of {plan.driven_step_s(plan.opened):g} s"
    run_whole(plan, CONGESTION, CongestionStudy, shown, "seeds", out, settings, as_json=as_json, about=about)
