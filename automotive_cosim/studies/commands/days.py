"""``automotive-cosim study days``: advice from day to day until traffic settles."""

from __future__ import annotations

from typing import Any

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson
from automotive_cosim.studies.commands.shared import StudyFolder, run_whole, tell_reading
from automotive_cosim.studies.settings import DaysSettings


@takes(DaysSettings)
@takes(ExecutorSettings)
def days(
    out: StudyFolder = None,
    as_json: AsJson = False,
    **settings: Any,
) -> None:
    """Advise a share of the drivers day after day until traffic settles, beside the user equilibrium.

    Rerun the command to resume a stopped study.
    """
    from automotive_cosim.studies.days.days import DAYS, DaysPlan, DaysStudy
    from automotive_cosim.studies.days.page import shown

    plan = filled(DaysPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    run_whole(plan, DAYS, DaysStudy, shown, "shares and seeds", out, settings, as_json=as_json)
