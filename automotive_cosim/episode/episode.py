"""An episode: a session on a task, judged at its end against the baseline run."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Self

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.occupants import Seat
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import Baseline, JudgedSession, TakesTime, beginning
from automotive_cosim.episode.situation import HandOver, SituationFinder
from automotive_cosim.episode.specification import ROUNDING_S, End, EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.errors import InfrastructureError, TriggerNotReachedError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.scenarios import Scenario
from automotive_cosim.tasking.dialogue import TALKED_OVER, Question, Says, dialogue, questions, spoken_s, topic_of
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.verdict import Verdict, judge
from automotive_cosim.traffic.fork import RemoteTraffic, Simulations

AFTERMATH_S = 12.0
"""The car drives on for this long after the end: enough for a driver to react and to brake from 80 to 50 km/h."""


@dataclass(kw_only=True)
class Episode(JudgedSession):
    """A session on a task, from its hand-over. Make one with ``take_over``."""

    instance: Instance
    scenario: Scenario
    traffic_seed: int
    """Seed of the traffic in which the situation has arisen."""
    at_hand_over: Cockpit
    """The cockpit as the agent took it over, which nobody touches."""
    owns_baseline: bool = True
    """Whether it owns the baseline run; false for a branch, which shares it."""
    verdict: Verdict | None = None
    """The verdict; None until the episode is over."""
    unsaid: tuple[Says, ...] = ()
    """What the driver may still say by himself."""
    after: list[Moment] = field(default_factory=list)
    """The aftermath."""
    compared: tuple[Moment, ...] = ()
    """The baseline run of a pair, up to the end of the aftermath."""

    @classmethod
    def begin_at(
        cls,
        spec: EpisodeSpec,
        simulations: Simulations,
        channels: Callable[[], frozenset[Channel]],
        observer: Observer | None = None,
        spare_traffic: Sequence[int] = (),
    ) -> Self:
        """Drives to the hand-over, and begins there.

        Args:
            simulations: warm traffic, shared with others.
            channels: what the agent wants to see, asked for at the hand-over.
            observer: notified of progress.
            spare_traffic: seeds of traffic to try in turn if the situation does not arise in the seed's own.

        Raises:
            UserError: something in the specification does not exist.
            TriggerNotReachedError: the situation arose in no traffic; the error is that of the first.
            TrafficError: the traffic simulation failed.
        """
        finder, seeds = SituationFinder(spec, simulations, observer=observer), SeedSource(spec.seed).next()
        missed: TriggerNotReachedError | None = None
        for traffic in (seeds.traffic, *spare_traffic):
            try:
                hand_over = finder.find(replace(seeds, traffic=traffic))
            except TriggerNotReachedError as error:
                missed = missed or error
                continue
            try:
                if isinstance(drive := hand_over.world.traffic.wrapped, RemoteTraffic):
                    drive.handed_over()
                return cls.take_over(hand_over, spec.session(channels()), observer)
            except BaseException:
                hand_over.world.close()
                raise
        assert missed is not None
        raise missed

    @classmethod
    def take_over(cls, hand_over: HandOver, setup: SessionSetup, observer: Observer | None = None) -> Self:
        """The episode that begins at a hand-over, and takes over its drive.

        Raises TrafficError: the traffic simulation failed."""
        instance, world = hand_over.instance, hand_over.world
        if setup.max_steps is None:
            setup = replace(setup, max_steps=instance.task.max_steps)
        begun: dict[str, Any] = beginning(world, instance.goal, setup, hand_over.drive, observer)
        return cls(
            **begun,
            instance=instance,
            scenario=hand_over.scenario,
            traffic_seed=hand_over.traffic_seed,
            at_hand_over=world.cockpit.copy(),
            unsaid=instance.half.says,
            baseline=Baseline(world),
        )

    def thinking(self, seconds: float) -> TakesTime[None]:
        """As in a session, but no longer than the task's deadline, after which it is too late anyway."""
        return super().thinking(min(seconds, self.instance.half.deadline.seconds))

    def branch(self, max_steps: int | None = None) -> Self:
        """An independent episode from this instant, which nobody watches: neither affects the other from here on.

        The baseline run is shared, so close branches before the episode that they come from.

        Args:
            max_steps: limit of the branch, counted from the hand-over; None keeps the episode's.
        """
        self._check_open()
        self.baseline.part()
        setup = self.setup if max_steps is None else replace(self.setup, max_steps=max_steps)
        return replace(
            self,
            world=self.world.branch(),
            setup=setup,
            moments=list(self.moments),
            steps=list(self.steps),
            hashed=self.hashed.copy(),
            owns_baseline=False,
            after=list(self.after),
            observer=Observer(),
        )

    def aftermath(self, duration_s: float) -> tuple[Moment, ...]:
        """What happens on the road after the end, for the record; it changes neither verdict nor trace."""
        self.baseline.prepare(duration_s)
        moments = self._heard(self.world.advance(duration_s))
        self.baseline.see(moments)
        self.after += moments
        return moments

    def drive_on(self) -> None:
        """The aftermath of one that is over; if the road fails in it, there is no verdict either."""
        try:
            for _ in range(int(AFTERMATH_S)):
                self.aftermath(1.0)
            if self.instance.task.second is not None:
                self.compared = self.baseline.until(self.driven[-1].time_s)
        except InfrastructureError:
            # The figures of the row count the aftermath: without it they would not be those of another run.
            self.verdict = None
            raise

    @property
    def driven(self) -> list[Moment]:
        """Moments from the hand-over to the end of the aftermath."""
        return [*self.moments, *self.after]

    def close(self) -> None:
        """Ends the drive and, if it owns it, the baseline run; may be called again."""
        if self.owns_baseline:
            self.baseline.close()
        self.world.close()

    @property
    def is_judged(self) -> bool:
        """Whether it has a verdict."""
        return self.verdict is not None

    @property
    def questions(self) -> tuple[Question, ...]:
        """What the driver was asked, and what of it was needed."""
        half = self.instance.half
        texts = (asked["text"] for asked in questions(self.moments[0], self.moments[-1]))
        return dialogue(texts, half.topics, half.needed_topics, half.neutral)

    @property
    def _voice(self) -> Seat:
        return self.instance.half.start.voice

    @property
    def counterfactual(self) -> Mapping[str, Any]:
        """What would be commanded now, had the agent given only the commands that belong to the goal."""
        return counterfactual(
            self.at_hand_over, self.world.cockpit.given, self.moments, self.instance.half.allowed_writes
        )

    def _reply(self, question: str) -> str:
        half = self.instance.half
        topic = topic_of(question, half.topics)
        return half.neutral if topic is None else topic.reply

    def _is_topic(self, question: str) -> bool:
        return topic_of(question, self.instance.half.topics) is not None

    def _talked_over(self, action: Action) -> tuple[Feedback, float, tuple[str, ...]] | None:
        if action.action_type not in (ActionType.ASK_DRIVER, ActionType.ANSWER):
            return None
        hand_over, now, done, lasts_s = (
            self.moments[0],
            self.moments[-1],
            len(self.steps) - 1,
            spoken_s(action.text or ""),
        )
        for says in self.unsaid:
            if 0 < says.over_s < lasts_s and says.is_due(hand_over, now, done):
                self.unsaid = tuple(each for each in self.unsaid if each is not says)
                self.remarks += (says.text,)
                return Feedback(FeedbackCode.OK, TALKED_OVER), says.over_s + spoken_s(says.text), (says.text,)
        return None

    def _remarks(self) -> tuple[str, ...]:
        hand_over, now, steps = self.moments[0], self.moments[-1], len(self.steps)
        due = tuple(says for says in self.unsaid if not says.over_s and says.is_due(hand_over, now, steps))
        self.unsaid = tuple(says for says in self.unsaid if says not in due)
        return tuple(says.text for says in due)

    def _finish(self, end: End) -> TakesTime[None]:
        self.verdict = judge(
            self.instance,
            self.moments,
            self.baseline_moments,
            lambda: self.counterfactual,
            self.declared,
            self.reason,
            self.failure,
            self.said,
        )
        yield from super()._finish(end)


def replayed(
    cockpit: Cockpit, given: Sequence[CommandRecord], moments: Sequence[Moment], keys: Collection[str] | None = None
) -> Cockpit:
    """A cockpit that went through a drive again, with its commands in full or in part.

    Args:
        cockpit: as it was at the first moment; it stays so.
        given: what was commanded since, in order.
        moments: of the drive, whose roads and skies it senses.
        keys: the commands to give (``Moment.commands``); all if None.
    """
    twin, left = cockpit.copy(), list(given)
    for before, now in pairwise(moments):
        while left and left[0].time_s <= before.time_s + ROUNDING_S:
            record = left.pop(0)
            twin.repeat(record, record.aims if keys is None else keys)
        twin.sense(now.surroundings, now.time_s - before.time_s)
    return twin


def counterfactual(
    cockpit: Cockpit, given: Sequence[CommandRecord], moments: Sequence[Moment], keys: Collection[str]
) -> Mapping[str, Any]:
    """What would be commanded at the end, had only the commands on these keys been given; see ``replayed``."""
    return replayed(cockpit, given, moments, keys).commands()
