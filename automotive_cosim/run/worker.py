"""Runs an evaluation's trials in a worker, which share its warm simulations."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from automotive_cosim.agents import Agent, AgentSettings, make_agent, model_of
from automotive_cosim.contracts import Json
from automotive_cosim.episode.judged import JudgedSession
from automotive_cosim.episode.own_prompt import instructions
from automotive_cosim.errors import CosimError
from automotive_cosim.run.collect import Collector
from automotive_cosim.run.drive import DriveRecord, run_drive
from automotive_cosim.run.drive_recorder import DriveRecorder
from automotive_cosim.run.episode import EpisodeResult, run_episode
from automotive_cosim.run.executor import Runner
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.jobs import DriveJob, EpisodeJob, Limits, TrialJob, failed
from automotive_cosim.run.meter import Metered, MeterHandle
from automotive_cosim.run.moments import JudgeInput, write_judged
from automotive_cosim.run.observer import TrialObserver
from automotive_cosim.run.outside import OutsideAgent, is_outside
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.stage import DriveStageObserver, StageObserver
from automotive_cosim.run.store import write_trace
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.traffic.fork import Simulations

WARM = 2
"""Warm simulations that a worker keeps; the episodes come sorted, so one is in use and one may be used again."""


AnyTrialObserver = TrialObserver[JudgedSession, EpisodeResult | DriveRecord]
"""Observes a trial of either kind."""


@contextmanager
def trials(pictures: Pictures, meter: MeterHandle | None = None) -> Iterator[Runner[TrialJob, TrialRow]]:
    """Makes the runner of an evaluation's jobs; ``meter`` is what its workers share."""
    with closing(Simulations(count_limit=WARM)) as simulations, closing(ForkServer()) as fork_server:
        yield lambda job, folder: run_job(job, folder, pictures, simulations, fork_server, meter)


def run_job(
    job: TrialJob,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    fork_server: ForkServer,
    meter: MeterHandle | None = None,
) -> TrialRow:
    """Runs one trial with its agent, as ``run_with`` does.

    Raises:
        OSError: trace or pictures cannot be written.
    """
    return run_with(agent_of(job, fork_server, meter), job, folder, pictures, simulations)


def run_with(
    agent: AbstractContextManager[Agent],
    job: TrialJob,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    observers: Sequence[AnyTrialObserver] = (),
) -> TrialRow:
    """Runs one trial, writes its trace, screenshots and road, and returns its row; an error becomes a row too.

    Args:
        agent: who acts.
        job: what to run.
        folder: the evaluation's.
        pictures: whether to keep screenshots and road.
        simulations: warm simulations to use.
        observers: notified before anything is kept.

    Raises:
        OSError: trace or pictures cannot be written.
    """
    try:
        with agent as acting:
            if isinstance(job, DriveJob):
                kept = _driven(acting, job, folder, pictures, simulations, observers)
            else:
                kept = _played(acting, job, folder, pictures, simulations, observers)
    except CosimError as error:
        return failed(job, type(error).__name__, str(error))
    except Exception as error:
        # A fault in this package must not end the evaluation; it is counted and listed.
        return failed(job, type(error).__name__, f"{type(error).__name__}: {error}")
    if kept.lines:
        write_trace(folder, job.id, kept.lines)
        if kept.judged is not None:
            write_judged(folder, job.id, kept.judged)
        kept.keep_pictures()
    return kept.row


@dataclass(frozen=True, slots=True)
class _Kept:
    """What is kept of a trial."""

    row: TrialRow
    lines: Sequence[Json]
    """Its trace, with the result as its last line."""
    judged: JudgeInput | None
    keep_pictures: Callable[[], None]


def _played(
    agent: Agent,
    job: EpisodeJob,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    observers: Sequence[AnyTrialObserver],
) -> _Kept:
    collector = Collector(pictures)
    road = RoadRecorder(folder / "pictures" / job.id, job.setup.about)
    everyone = (*observers, StageObserver(), collector, *(() if pictures is Pictures.NONE else (road,)))
    with closing(road):
        result = run_episode(job.setup, agent, everyone, simulations=simulations)

    def keep() -> None:
        if collector.keeps_pictures_of(result):
            collector.keep_pictures(folder / "pictures" / job.id)
        else:
            road.discard()

    return _Kept(collector.row(job, result), collector.trace(result), collector.judged(), keep)


def _driven(
    agent: Agent,
    job: DriveJob,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    observers: Sequence[AnyTrialObserver],
) -> _Kept:
    recorder = DriveRecorder(folder / "pictures" / job.id)
    road = RoadRecorder(recorder.folder, job.setup.about)
    everyone = (*observers, DriveStageObserver(), *(() if pictures is Pictures.NONE else (recorder, road)))
    with closing(recorder), closing(road):
        record = run_drive(job.planned(), job.setup, agent, simulations=simulations, observers=everyone)

    def keep() -> None:
        if pictures is Pictures.FAILURES and record.row.has_succeeded:
            shutil.rmtree(recorder.folder, ignore_errors=True)

    return _Kept(record.row, record.lines, record.judged, keep)


def agent_of(
    job: TrialJob, fork_server: ForkServer, meter: MeterHandle | None = None
) -> AbstractContextManager[Agent]:
    """The agent of a job; see ``agent_for``."""
    setup = job.setup
    settings = AgentSettings(setup.conditions, seed=setup.seed, instructions=instructions(setup.conditions.prompt))
    return agent_for(setup.agent, job.model, settings, job.limits, fork_server, meter)


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
        model: its model.
        settings: what it is given, and the seed of an agent that draws.
        limits: of its process and its tokens.
        fork_server: starts its process.
        meter: what it shares with the evaluation's other workers.

    Raises:
        UserError: there is no such agent or model.
    """
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
