"""What studies can be told, and what they write, keep the laws of all commands and rows."""

from automotive_cosim.studies.calibration.settings import CalibrationOptions
from automotive_cosim.studies.commands.reroute import IN_PYTHON
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings, OptimumSettings
from automotive_cosim.studies.reroute.rows import NOBODY, NOTHING, Branch, Decision, News, TripRow
from automotive_cosim.studies.settings import CongestionSettings, DaysSettings, RerouteSettings
from tests.cli.test_derived import is_option, settings_of
from tests.laws import over
from tests.run.test_job_row import comes_back, required_of

COMMANDS: tuple[tuple[str, type, set[str]], ...] = (
    ("scenarios equilibrate", EquilibriumSettings, {"seed"}),
    ("scenarios equilibrate", OptimumSettings, set()),
    ("scenarios calibrate", CalibrationOptions, {"seed"}),
    ("study reroute", RerouteSettings, {"scenario", "warm_up_s", *IN_PYTHON}),
    ("study congestion", CongestionSettings, {"redraw", "step_s"}),
    ("study days", DaysSettings, {"lag"}),
)


@over(settings_of(COMMANDS))
def test_every_setting_is_an_option(name: str, kind: type, field: str) -> None:
    is_option(name, kind, field)


def test_a_drive_comes_back_from_its_line_and_what_is_added_to_it_has_a_default() -> None:
    news = News(age_s=0.0, stay_s=100.0, delay_s=40.0, offered_s=None, branch=None)
    branch = Branch(gains=NOTHING, totals=NOTHING, others=NOBODY)
    decision = Decision(
        at_s=900.0, edge="e", delay_s=40.0, eta_s=100.0, relative_speed=0.5, complies_above=0.3, news=(news,),
        own=0, agents={"asurada": 0}, agents_rerouted=("asurada",), branches=(branch,), placebo=branch,
    )  # fmt: skip
    row = TripRow(
        id="d", scenario="grid", share=0.5, seed=0, departure_s=60.0, trip="t", stay=NOTHING, decisions=(decision,)
    )
    comes_back(row)
    assert required_of(TripRow) == {"id", "scenario", "share", "seed", "departure_s", "trip"}
