"""Runs an evaluation's episodes in a worker, which share its warm simulations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import replace
from pathlib import Path

from automotive_cosim.agents import Agent, AgentSettings, make_agent, model_of
from automotive_cosim.errors import CosimError
from automotive_cosim.run.collect import Collector, Pictures, failed
from automotive_cosim.run.episode import Watcher, run_episode
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.executor import Runner
from automotive_cosim.run.meter import Metered, MeterHandle
from automotive_cosim.run.moments import write_judged
from automotive_cosim.run.nursery import Nursery
from automotive_cosim.run.outside import OutsideAgent, is_outside
from automotive_cosim.run.plan import EpisodeJob, Limits
from automotive_cosim.run.road_recorder import RoadRecorder
from automotive_cosim.run.store import write_trace
from automotive_cosim.traffic.fork import Simulations

WARM = 2
"""Warm simulations that a worker keeps; the episodes come sorted, so one is in use and one may be used again."""


@contextmanager
def episodes(pictures: Pictures, meter: MeterHandle | None = None) -> Iterator[Runner[EpisodeJob, EpisodeRow]]:
    """Makes the runner of an evaluation's jobs; ``meter`` is what its workers share."""
    with closing(Simulations(count_limit=WARM)) as simulations, closing(Nursery()) as nursery:
        yield lambda job, folder: run_job(job, folder, pictures, simulations, nursery, meter)


def run_job(
    job: EpisodeJob,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    nursery: Nursery,
    meter: MeterHandle | None = None,
) -> EpisodeRow:
    """Runs one episode with its agent, as ``run_with`` does.

    Raises:
        OSError: trace or pictures cannot be written.
    """
    return run_with(agent_of(job, nursery, meter), job, folder, pictures, simulations)


def run_with(
    agent: AbstractContextManager[Agent],
    job: EpisodeJob,
    folder: Path,
    pictures: Pictures,
    simulations: Simulations,
    watchers: Sequence[Watcher] = (),
) -> EpisodeRow:
    """Runs one episode, writes its trace, screenshots and road, and returns its row; an error becomes a row too.

    Args:
        agent: who acts.
        job: what to run.
        folder: the evaluation's.
        pictures: whether to keep screenshots and road.
        simulations: warm simulations to use.
        watchers: notified before anything is kept.

    Raises:
        OSError: trace or pictures cannot be written.
    """
    collector = Collector(pictures)
    road = RoadRecorder(folder / "pictures" / job.id, job.setup)
    watchers = (*watchers, collector, *(() if pictures is Pictures.NONE else (road,)))
    try:
        with closing(road), agent as acting:
            result = run_episode(job.setup, acting, watchers, simulations=simulations)
    except CosimError as error:
        return failed(job, type(error).__name__, str(error))
    except Exception as error:
        # A fault in this package must not end the evaluation; it is counted and listed.
        return failed(job, type(error).__name__, f"{type(error).__name__}: {error}")
    if lines := collector.trace(result):
        write_trace(folder, job.id, lines)
        if judged := collector.judged():
            write_judged(folder, job.id, judged)
        if collector.keeps_pictures_of(result):
            collector.keep_pictures(folder / "pictures" / job.id)
        else:
            road.discard()
    return collector.row(job, result)


def agent_of(job: EpisodeJob, nursery: Nursery, meter: MeterHandle | None = None) -> AbstractContextManager[Agent]:
    """The agent of a job; see ``agent_for``."""
    setup = job.setup
    settings = AgentSettings(setup.conditions, seed=setup.seed)
    return agent_for(setup.agent, job.model, settings, job.limits, nursery, meter)


@contextmanager
def agent_for(
    name: str,
    model: str,
    settings: AgentSettings,
    limits: Limits,
    nursery: Nursery,
    meter: MeterHandle | None = None,
) -> Iterator[Agent]:
    """An agent, in a separate process unless it is a reference or a negative control.

    Args:
        name: as in ``make_agent``, like the model.
        model: its model.
        settings: what it is given, and the seed of an agent that draws.
        limits: of its process and its tokens.
        nursery: starts its process.
        meter: what it shares with the evaluation's other workers.

    Raises:
        UserError: there is no such agent or model.
    """
    if not is_outside(name):
        yield make_agent(name, settings=settings)
        return
    settings = replace(settings, seed=0, most_tokens=limits.tokens)  # it is not told the episode's seed
    asked = model_of(name, model, meter)
    outside = OutsideAgent(
        nursery,
        name,
        model,
        settings,
        chat_model=asked if asked is None or meter is None else Metered(asked, meter),
        step_s=limits.agent_step_s,
        episode_s=limits.agent_s,
    )
    with closing(outside) as agent:
        yield agent
