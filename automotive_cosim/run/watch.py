"""Runs one drive with an agent, from departure to its row."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, fields, replace
from typing import Any

from automotive_cosim.agents import Agent, Thinker
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Element, Json
from automotive_cosim.contracts.given import Clock
from automotive_cosim.drives.elsewhere import elsewhere
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.result import DriveResult, result_of
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.timeline import timeline
from automotive_cosim.drives.watch import Watch
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.listener import Listener, Listeners
from automotive_cosim.episode.loop import play
from automotive_cosim.episode.specification import End
from automotive_cosim.interface.observe import Channel
from automotive_cosim.interface.trace import Step, canonical, plain
from automotive_cosim.models.base import ModelReply
from automotive_cosim.run.episode import Replayed, Timed
from automotive_cosim.run.watch_row import WatchRow
from automotive_cosim.traffic.fork import Simulations


@dataclass(frozen=True, slots=True)
class WatchSetup:
    """One drive to run, by name."""

    family: str
    seed: int = 0
    agent: str = ""
    model: str = "none"
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    repeat: int = 0
    scenario: str = ""
    """Where to drive instead of on the family's own roads; see ``drives.elsewhere``."""


@dataclass(frozen=True, slots=True)
class WatchRecord:
    """What is kept of a drive."""

    row: WatchRow
    timeline: Json
    """Speed, limit and the do-nothing run's speed, one value per second."""
    steps: tuple[Json, ...]
    """Action, thinking time and result of each step, with hashes of the state that followed."""


class WatchWatcher(Listener):
    """Sees a drive while it runs, e.g. to show or record it. It changes nothing."""

    def departed(self, watch: Watch) -> None:
        """The drive begins."""

    def acted(self, watch: Watch, seen: Sequence[Element]) -> None:
        """The agent has acted on a screen with these elements."""

    def arrived(self, watch: Watch, record: WatchRecord) -> None:
        """The drive is over, and judged."""


def planned_row(job_id: str, setup: WatchSetup) -> WatchRow:
    """The row of a drive before it has run."""
    family = family_named(setup.family)
    return WatchRow(
        id=job_id,
        family=family.id,
        seed=setup.seed,
        scenario=setup.scenario or family.scenario,
        season=family.season,
        agent=setup.agent,
        model=setup.model,
        conditions=setup.conditions,
        repeat=setup.repeat,
    )


def judged_row(
    planned: WatchRow, end: End, channels: tuple[Channel, ...], result: DriveResult, **totals: Any
) -> WatchRow:
    """The row of a drive that is over.

    Args:
        planned: its row before it had run.
        end: why it ended.
        channels: what the agent was given.
        result: how it was judged.
        totals: fields of the row about the agent's model.
    """
    found = {entry.name: getattr(result, entry.name) for entry in fields(result)}
    return replace(planned, end=end, channels=channels, **found, **totals)


def run_watch(
    job_id: str,
    setup: WatchSetup,
    agent: Agent,
    *,
    simulations: Simulations | None = None,
    watchers: Sequence[WatchWatcher] = (),
    plan: DriveScript | None = None,
) -> WatchRecord:
    """Runs a drive to its end and judges it.

    Args:
        job_id: id of its row.
        setup: what to run.
        agent: the agent that watches.
        simulations: warm simulations to use; by default its own, closed with the drive.
        watchers: notified of everything as it happens.
        plan: used instead of the family's plan for the seed.

    Raises:
        UserError: something in the setup does not exist.
        InfrastructureError: traffic or model failed.
    """
    planned = planned_row(job_id, setup)
    listener = Listeners(watchers)
    if setup.scenario and plan is None:
        plan = elsewhere(family_named(setup.family).draw(setup.seed), setup.scenario)
    spec = DriveSpec(setup.family, setup.seed, setup.conditions)
    with ExitStack() as ends:
        own = simulations or ends.enter_context(closing(Simulations()))
        watch = spec.begin(own, agent.channels, listener, plan)
        ends.callback(watch.close)
        meter, channels = _Meter(setup, agent), tuple(sorted(agent.channels))
        agent.reset(watch.goal)
        for watcher in watchers:
            watcher.departed(watch)
        end = play(watch, agent, (meter.stepped, *(watcher.acted for watcher in watchers)), meter.thought_s)
        record = WatchRecord(
            row=judged_row(planned, end, channels, result_of(watch), **meter.totals()),
            timeline=timeline(watch),
            steps=tuple(_steps(watch)),
        )
        for watcher in watchers:
            watcher.arrived(watch, record)
        return record


class _Meter:
    """What the agent's answers cost."""

    def __init__(self, setup: WatchSetup, agent: Agent) -> None:
        self._setup, self._agent = setup, agent
        self._replies: list[ModelReply] = []
        self._thought_s = 0.0

    def thought_s(self) -> float:
        """Simulated seconds of the last answer."""
        seconds = self._setup.conditions.latency_s
        agent = self._agent
        if isinstance(agent, Replayed):
            seconds = agent.thought_s
        elif self._setup.conditions.clock is Clock.MODEL and isinstance(agent, Timed):
            seconds += agent.answer_s
        elif self._setup.conditions.clock is Clock.MODEL and isinstance(agent, Thinker):
            seconds += sum(stage.reply.seconds for stage in agent.stages if stage.reply is not None)
        seconds = round(seconds, 1)
        self._thought_s += seconds
        return seconds

    def stepped(self, session: Watch, seen: Sequence[Element]) -> None:
        """Notes the model's replies of a step."""
        if isinstance(self._agent, Thinker):
            self._replies += [stage.reply for stage in self._agent.stages if stage.reply is not None]

    def totals(self) -> dict[str, Any]:
        """The fields of the row."""
        replies = self._replies
        return {
            "calls": len(replies),
            "thought_s": round(self._thought_s, 3),
            "tokens_in": sum(reply.tokens_in for reply in replies),
            "tokens_out": sum(reply.tokens_out for reply in replies),
            "cost_usd": sum(reply.cost_usd for reply in replies),
            "model_seconds": round(sum(reply.seconds for reply in replies), 3),
        }


def _steps(watch: Watch) -> list[Json]:
    begun_s = watch.moments[0].time_s
    return [
        {
            "step": step.number,
            "time_s": round(step.moment.time_s - begun_s, 3),
            "action": None if step.action is None else to_json(step.action),
            "thought_s": step.thought_s,
            "feedback": plain(step.feedback),
            "sha256": _digests(step),
        }
        for step in watch.steps
    ]


def _digests(step: Step) -> Json:
    """A short hash of each part of the trace, so that a replay can say what differs."""
    parts = {
        "traffic": plain(step.moment.driving),
        "signals": dict(step.moment.signals),
        "elements": plain(step.elements),
    }
    return {name: hashlib.sha256(canonical(part)).hexdigest()[:16] for name, part in parts.items()}
