"""``automotive-cosim study days``: advice from day to day until traffic settles."""

from __future__ import annotations

from typing import Any

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson
from automotive_cosim.studies.commands.shared import StudyFolder, driven, folder_of, tell_reading, tell_whole
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
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.days.days import DaysPlan, read_days, run_days
    from automotive_cosim.studies.days.page import answer, tables, warnings, write_days

    plan = filled(DaysPlan, settings)
    tell_reading(plan.scenario)
    plan.check()
    folder = out or folder_of(plan)
    where = filled(ExecutorSettings, settings).opened()
    console = Console(stderr=as_json, highlight=False)
    with where, driven(console, "shares and seeds", folder) as tell:
        run_days(plan, folder, executor=where, tell=tell)
    study = read_days(folder)
    tell_whole(console, study, write_days, answer, warnings, tables(study)[:1], as_json=as_json)
