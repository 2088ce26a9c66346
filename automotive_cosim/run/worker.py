"""Runs an evaluation's trials in a worker, which share its warm simulations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, closing, contextmanager
from dataclasses import replace
from pathlib import Path

from automotive_cosim.agents import Agent, AgentSettings, make_agent, model_of
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.own_prompt import instructions
from automotive_cosim.episode.session import Session
from automotive_cosim.formats.layout import PICTURES
from automotive_cosim.formats.writing import beneath
from automotive_cosim.run.budget import Metered, MeterHandle
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.executor import Runner, doing, failed_by, warming_up
from automotive_cosim.run.fleet import run_fleet
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.outside import OutsideAgent, is_outside
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.run.rows import FleetRow, TrialRow
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.trial import Limits, Shot, TrialObserver, TrialRun, TrialSetup, run_trial
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.fork import Simulations

WARM = 2
"""Warm simulations that a worker keeps; the episodes come sorted, so one is in use and one may be used again."""


@contextmanager
def trials(
    pictures: Pictures, meter: MeterHandle | None = None, simulations: Simulations | None = None
) -> Iterator[Runner[TrialSetup, TrialRow]]:
    """Makes the runner of an evaluation's jobs; ``meter`` is what its workers share, and warm simulations are its
    own unless given."""
    with ExitStack() as ends:
        fork_server = ends.enter_context(closing(ForkServer()))
        warm = simulations or ends.enter_context(closing(Simulations(count_limit=WARM)))
        yield lambda job, folder: run_job(job, folder, pictures, warm, fork_server, meter)


def run_job(
    job: TrialSetup,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    fork_server: ForkServer,
    meter: MeterHandle | None = None,
) -> TrialRow:
    """Runs one trial with its agent, as ``run_with`` does, or all drives of a fleet, each with its own.

    Raises OSError: trace or pictures cannot be written."""
    agents = [agent_of(car, fork_server, meter) for car in job.cars]
    if not isinstance(job, DriveSetup) or not job.settings.cars:
        return run_with(agents[0], job, folder, pictures, simulations)
    try:
        with ExitStack() as ends:
            recorders = [ends.enter_context(_recorded(car, folder, pictures)) for car in job.cars]
            agents_in = [ends.enter_context(agent) for agent in agents]
            runs = [
                TrialRun(car, agent, observers)
                for car, agent, (_, observers) in zip(job.cars, agents_in, recorders, strict=True)
            ]
            kept = None if pictures is Pictures.NONE else folder
            rows = run_fleet(job.cars, runs, simulations, kept)
    except Exception as error:  # must not end the evaluation; it is counted and listed
        ended: TrialRow = failed_by(job, error)
        return ended
    for (recorder, _), row in zip(recorders, rows, strict=True):
        _keep(recorder, row, folder, pictures)
    return FleetRow.of(rows)


def run_with(
    agent: AbstractContextManager[Agent],
    job: TrialSetup,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    observers: Sequence[TrialObserver] = (),
) -> TrialRow:
    """Runs one trial, writes its trace, screenshots and road, and returns its row; an error becomes a row too.

    Raises OSError: trace or pictures cannot be written."""
    try:
        with _recorded(job, folder, pictures, observers) as (recorder, everyone), agent as acting:
            row = run_trial(job, acting, everyone, simulations=simulations)
    except Exception as error:  # must not end the evaluation; it is counted and listed
        ended: TrialRow = failed_by(job, error)
        return ended
    _keep(recorder, row, folder, pictures)
    return row


class _PhaseObserver(TrialObserver):
    """Tells the phases of a trial, the agent's by its steps or, on a drive, by the time."""

    _session: Session | None = None

    def loading(self, scenario: Scenario) -> None:
        doing(f"loading {scenario.name}", is_warm_up=True)

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        warming_up(done_s, total_s)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        if self._session is None:
            doing("driving to the hand-over")
        elif self._watches and (most_s := self._session.setup.max_sim_s):
            done_s = min(self._session.seconds, most_s)
            doing("agent on watch", f"{done_s:.0f} of {most_s:.0f} s", share=done_s / most_s)

    def begun(self, session: Session, shot: Shot) -> None:
        self._session = session
        if self._watches:
            doing("agent on watch", share=0.0)
        else:
            doing("agent at work", "step 0")

    def stepped(self, shot: Shot) -> None:
        if not self._watches:
            doing("agent at work", f"step {len(shot.session.steps) - 1}")

    @property
    def _watches(self) -> bool:
        """Whether it is a drive, of which the time says more than the step."""
        return self._session is not None and self._session.observation.on_watch


@contextmanager
def _recorded(
    job: TrialSetup, folder: Path, pictures: Pictures, observers: Sequence[TrialObserver] = ()
) -> Iterator[tuple[Recorder, Sequence[TrialObserver]]]:
    """What records a trial, and all that observe it."""
    kept = None if pictures is Pictures.NONE else beneath(folder, f"{PICTURES}/{job.id}")
    with ExitStack() as ends:
        recorder = ends.enter_context(closing(Recorder(job, kept)))
        everyone = [*observers, recorder, _PhaseObserver()]
        if kept is not None:
            everyone.append(ends.enter_context(closing(RoadRecorder(kept, job.about))))
        yield recorder, everyone


def _keep(recorder: Recorder, row: TrialRow, folder: Path, pictures: Pictures) -> None:
    recorder.keep_in(folder)
    if pictures is Pictures.FAILURES and row.has_succeeded:
        recorder.discard()


def agent_of(
    job: TrialSetup, fork_server: ForkServer, meter: MeterHandle | None = None
) -> AbstractContextManager[Agent]:
    """The agent of a job; see ``agent_for``."""
    settings = AgentSettings(job.conditions, seed=job.seed, instructions=instructions(job.conditions.prompt))
    return agent_for(job.agent, job.asked_model, settings, job.limits, fork_server, meter)


@contextmanager
def agent_for(
    name: str,
    model: str,
    settings: AgentSettings,
    limits: Limits,
    fork_server: ForkServer,
    meter: MeterHandle | None = None,
) -> Iterator[Agent]:
    """An agent, in a separate process unless it is a reference or a negative control.

    Args:
        name: as in ``make_agent``, like the model.
        settings: what it is given, and the seed of an agent that draws.
        meter: what it shares with the evaluation's other workers.

    Raises UserError: there is no such agent or model."""
    if not is_outside(name):
        yield make_agent(name, settings=settings)
        return
    # It is not told the episode's seed.
    settings = replace(settings, seed=0, most_tokens=limits.tokens, most_seconds=limits.model_s)
    settings = replace(settings, answer_s=limits.agent_step_s)
    asked = model_of(name, model, meter, settings)
    outside = OutsideAgent(
        fork_server,
        name,
        model,
        settings,
        chat_model=asked if asked is None or meter is None else Metered(asked, meter),
        step_s=limits.agent_step_s,
        episode_s=limits.agent_s,
    )
    with closing(outside) as agent:
        yield agent
