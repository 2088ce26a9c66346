"""What a congestion study runs: the traffic of every seed, without an intervention and with each."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.errors import UserError
from automotive_cosim.formats.incidents import AnyIncident, EgoIncident, RushHour
from automotive_cosim.scenarios import Scenario, Trip
from automotive_cosim.scenarios.wording import KINDS, read_line
from automotive_cosim.studies.calls.flow import Advice, SignalControl
from automotive_cosim.studies.congestion.rows import CongestionRow
from automotive_cosim.studies.plan import SeedJob, check_edges, check_values, driven_at, opened
from automotive_cosim.studies.settings import CongestionSettings

INTERVAL_S, EPOCH_S = 60.0, 300.0
"""Length of the intervals of the flow on every edge, and of those over which travel times vary (five minutes, as in
FHWA's reports on reliability)."""

Intervention = AnyIncident | Advice | SignalControl
INTERVENTIONS = {**KINDS, "advice": Advice, "signals": SignalControl}


@dataclass(frozen=True, slots=True)
class CongestionPlan(CongestionSettings):
    """A congestion study."""

    def check(self) -> None:
        """Checks every name and number before anything runs.

        Raises UserError: one does not exist or is out of range."""
        check_values(self)
        if self.minutes % (EPOCH_S / 60):
            raise UserError(f"--minutes is {self.minutes:g}; give a multiple of {EPOCH_S / 60:g}")
        if self.duration_s % (len(self.demand) * EPOCH_S):
            raise UserError(
                f"--demand has {len(self.demand)} periods in {self.minutes:g} minutes; each must be a multiple of "
                f"{EPOCH_S / 60:g} minutes"
            )
        for text, place in (*((each, "--intervention") for each in self.interventions), *self._incidents):
            found = intervention_in(text, place)
            if not isinstance(found, Advice | SignalControl):
                if isinstance(found, EgoIncident):
                    raise UserError(f"{place} has {found.kind!r}, which needs the ego, but this study has none")
                check_edges(found, place, self.opened)
        self.scene()

    @property
    def _incidents(self) -> list[tuple[str, str]]:
        return [(each, "--incident") for each in self.incidents]

    @property
    def opened(self) -> Scenario:
        """The scenario before the study's changes. Raises ScenarioError: it cannot be read."""
        return opened(self.scenario)

    def scene(self) -> Scenario:
        """The scenario as it is driven, without an intervention. Raises ScenarioError: it cannot be read."""
        incidents: list[AnyIncident] = [read_line(text, KINDS, place) for text, place in self._incidents]
        scenario = driven_at(
            self.opened,
            step_s=self.driven_step_s(self.opened),
            share=self.share,
            scale=self.scale,
            warm_up_s=self.warm_up_s,
            redraw=self.redraw,
            incidents=incidents,
        )
        hours = [
            RushHour(
                scale=factor,
                from_s=-scenario.sumo.warm_up_s if not number else number * self.period_s,
                to_s=(number + 1) * self.period_s,
            )
            for number, factor in enumerate(self.demand)
            if factor != 1
        ]
        return replace(scenario, incidents=(*scenario.incidents, *hours))

    @property
    def duration_s(self) -> float:
        """How long after the warm-up is measured."""
        return self.minutes * 60

    @property
    def period_s(self) -> float:
        """Length of the periods of the demand."""
        return self.duration_s / len(self.demand)

    @property
    def along(self) -> Trip:
        """The trip along which the time-space diagrams go."""
        return self.opened.ego.trips[0]

    def jobs(self) -> tuple[CongestionJob, ...]:
        """One for every seed, with all interventions; a city runs slower than real time."""
        limit_s = 3_600.0 + 10 * self.duration_s * (1 + len(self.interventions))
        return tuple(SeedJob(self, seed, CongestionRow, limit_s) for seed in self.seeds)


CongestionJob = SeedJob[CongestionPlan, CongestionRow]


def intervention_in(text: str, place: str) -> Intervention:
    """The intervention that a line describes, as ``closure edge=c2c3``, ``advice share=0.5`` or
    ``signals control=static``.

    Raises UserError: it is none."""
    found: Intervention = read_line(text, INTERVENTIONS if place == "--intervention" else KINDS, place)
    return found
