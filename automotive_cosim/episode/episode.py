"""An episode: a session on a task, judged at its end against the baseline run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.baseline import Baseline
from automotive_cosim.episode.counterfactual import counterfactual
from automotive_cosim.episode.judged import JudgedSession
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import beginning
from automotive_cosim.episode.situation import HandOver
from automotive_cosim.episode.specification import End, SessionSetup
from automotive_cosim.tasking.dialogue import Question, Says, dialogue, questions, topic_of
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.policy import Conduct
from automotive_cosim.tasking.verdict import Verdict, judge


@dataclass(kw_only=True)
class Episode(JudgedSession):
    """A session on a task, from its hand-over. Make one with ``take_over``."""

    instance: Instance
    at_hand_over: Cockpit
    """The cockpit as the agent took it over, which nobody touches."""
    owns_baseline: bool = True
    """Whether it owns the baseline run; false for a branch, which shares it."""
    verdict: Verdict | None = None
    """The verdict; None until the episode is over."""
    unsaid: tuple[Says, ...] = ()
    """What the driver may still say by himself."""

    @classmethod
    def take_over(cls, hand_over: HandOver, setup: SessionSetup, observer: Observer | None = None) -> Episode:
        """The episode that begins at a hand-over, and takes over its drive.

        Raises:
            TrafficError: the traffic simulation failed.
        """
        instance, world = hand_over.instance, hand_over.world
        if setup.max_steps is None:
            setup = replace(setup, max_steps=instance.task.max_steps)
        begun: dict[str, Any] = beginning(world, instance.goal, setup, hand_over.drive, observer)
        return cls(
            **begun,
            instance=instance,
            at_hand_over=world.cockpit.copy(),
            unsaid=instance.half.says,
            baseline=Baseline(world),
        )

    def think(self, seconds: float) -> None:
        """As in a session, but no longer than the task's deadline, after which it is too late anyway."""
        super().think(min(seconds, self.instance.half.deadline.seconds))

    def branch(self, max_steps: int | None = None) -> Episode:
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
            observer=Observer(),
        )

    def aftermath(self, duration_s: float) -> tuple[Moment, ...]:
        """What happens on the road after the end, for the record; it changes neither verdict nor trace."""
        self.baseline.prepare(duration_s)
        moments = self._heard(self.world.advance(duration_s))
        self.baseline.see(moments)
        return moments

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
    def conduct(self) -> Conduct:
        """What the house rules are held against, with the seat that the wish comes from."""
        return replace(super().conduct, voice=self.instance.half.start.voice)

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

    def _remarks(self) -> tuple[str, ...]:
        start, now, steps = self.moments[0], self.moments[-1], len(self.steps)
        due = tuple(says for says in self.unsaid if says.is_due(start, now, steps))
        self.unsaid = tuple(says for says in self.unsaid if says not in due)
        return tuple(says.text for says in due)

    def _finish(self, end: End) -> None:
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
        super()._finish(end)
