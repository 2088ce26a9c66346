"""Runs a trial: one spec goes in, a session runs, one row comes out.

started -> reset, brief -> begun -> (act -> step -> stepped)* -> judged -> drive on -> row -> finished
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from math import inf

from automotive_cosim.agents import Agent, Learner, Privileged
from automotive_cosim.contracts import Element
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.judged import JudgedSession
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.observer import Observers
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import InfrastructureError
from automotive_cosim.run.answers import Answers
from automotive_cosim.run.jobs import TrialSetup
from automotive_cosim.run.observer import Shot, TrialObserver
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.traffic.fork import Simulations


def run_trial(
    trial: TrialSetup,
    agent: Agent,
    observers: Sequence[TrialObserver] = (),
    *,
    simulations: Simulations | None = None,
    wall_s: float = inf,
) -> TrialRow:
    """Runs a trial to its end and judges it.

    Args:
        trial: what to run; its ``agent`` and ``model`` are only written into the row.
        agent: the agent that acts.
        observers: notified of everything as it happens.
        simulations: warm simulations to use; by default its own, closed with the trial.
        wall_s: wall seconds from the hand-over or departure after which it is cut off.

    Returns:
        Its row, without the fields that a batch adds; of an infrastructure error, the row says which.

    Raises:
        UserError: something in the trial does not exist or is invalid; no observer has seen the agent take over.
        KeyboardInterrupt: passed on after the observers have received the row so far.
    """
    session: JudgedSession | None = None
    answers = Answers(agent, trial.conditions)

    def over(end: End, error: InfrastructureError | None = None) -> TrialRow:
        row, told = trial.row(session, end, answers), None if session is None else trial.told(session)
        if error is not None:
            row = replace(row, error=str(error), error_kind=type(error).__name__)
        for observer in observers:
            observer.finished(row, told)
        return row

    with ExitStack() as ends:
        own = simulations or ends.enter_context(closing(Simulations()))
        try:
            session = trial.started(own, agent, Observers(observers))
            ends.callback(session.close)
            end = _played(session, agent, answers, observers, wall_s)
        except InfrastructureError as error:
            return over(End.ERROR, error)
        except KeyboardInterrupt:
            over(End.INTERRUPTED)
            raise
        return over(end)


def _played(
    session: JudgedSession, agent: Agent, answers: Answers, observers: Sequence[TrialObserver], wall_s: float
) -> End:
    """Lets the agent act until the session is over, and returns why it is."""

    def stepped(session: JudgedSession, seen: Sequence[Element]) -> None:
        shot = Shot(session, session.steps[-1], tuple(seen), answers.stages())
        for observer in observers:
            observer.stepped(shot)

    agent.reset(session.goal)
    if isinstance(agent, Privileged) and isinstance(session, Episode):
        agent.brief(session.instance, drawn=session.world.cockpit.drawn, branch=session.branch)
    first = Shot(session, session.steps[0])
    for observer in observers:
        observer.begun(session, first)
    end = play(session, agent, stepped, answers.took_s, wall_s)
    if end in (End.OUT_OF_BUDGET, End.AGENT_FAILED):
        answers.stages(finished=False)
    if isinstance(agent, Learner) and isinstance(session, Episode) and session.verdict is not None:
        agent.learn(session.verdict.success)
    session.drive_on()
    return end
