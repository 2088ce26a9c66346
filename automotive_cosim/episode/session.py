"""A session: an agent at the cockpit of a car in live traffic, and beside it the same drive with nobody there.

step:  action -> perform -> advance -> observe
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from itertools import takewhile
from math import inf
from typing import Any, Protocol, Self, TypeAlias, TypeVar, overload

import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit.actions import check
from automotive_cosim.cockpit.calls import functions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.occupants import Seat
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import (
    BY_HAND,
    Action,
    ActionType,
    Element,
    Feedback,
    FeedbackCode,
    GoalStatus,
    Observation,
    Reason,
    RoadNetwork,
)
from automotive_cosim.contracts.given import CarMake, Hearing, ToldPolicy
from automotive_cosim.cosim.attention import Asked
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.specification import ROUNDING_S, SCREEN, End, SessionSetup
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError
from automotive_cosim.geo import sensor
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.reckoning import Roads
from automotive_cosim.interface import trace
from automotive_cosim.interface.controls import Shown, shown
from automotive_cosim.interface.feedback import FeedbackDetail, control, quiet
from automotive_cosim.interface.observe import Channel, observe
from automotive_cosim.tasking.dialogue import NEUTRAL, PARDON, TOLD_HEARD, asks_again, spoken_s, understood
from automotive_cosim.tasking.policy import Breach, Conduct, breaches
from automotive_cosim.voice.cabin import driver_snr_db, is_understood, level_db, voices
from automotive_cosim.voice.table import SPOKEN, came_from, heard, sounding

R = TypeVar("R")
TakesTime: TypeAlias = Generator[float, None, R]
"""Something that takes simulated time: yields each tick in seconds, and goes on once the road may run that far."""


def driven(passing: TakesTime[R]) -> R:
    """Lets it happen on a road of its own; its result."""
    while True:
        try:
            next(passing)
        except StopIteration as over:
            result: R = over.value
            return result


@dataclass(kw_only=True)
class Session:
    """One session at the cockpit. Make one with ``begin``."""

    world: CoSimulation
    """The running co-simulation; closing the session ends its drive."""
    goal: str
    """What the driver says."""
    setup: SessionSetup
    drive: tuple[Moment, ...]
    """The drive from departure to the beginning, included, for the virtual sensor and reports."""
    observer: Observer
    shown: Shown
    """Turns the receivers' readings into what the agent is told."""
    moments: list[Moment]
    """Moments since the beginning, one per simulated second."""
    elements: Sequence[Element]
    """The elements on the screen, to which the next action refers."""
    observation: Observation
    """The agent's present observation."""
    steps: list[trace.Step]
    """One step per action; the first is the beginning."""
    declared: GoalStatus | None = None
    """The status that the agent declared."""
    reason: Reason | None = None
    """The reason code of that declaration."""
    end: End | None = None
    """Why it is over; None while it is not."""
    failure: str | None = None
    """Why the agent can act no more, if that ended it."""
    thought_s: float = 0.0
    """Simulated seconds that have passed since the agent last saw the screen."""
    heard: tuple[str, ...] = ()
    """What the driver has said since the beginning, as it has reached the agent."""
    remarks: tuple[str, ...] = ()
    """What the driver has said unasked since the beginning."""
    hashed: trace.Hash = field(default_factory=trace.Hash, repr=False)
    """Hash of the steps so far, computed when asked for."""
    _roads: Callable[[], Roads] = field(repr=False)
    """What dead reckoning needs of the network, made when first asked for, once for all branches."""

    @classmethod
    def begin(
        cls,
        world: CoSimulation,
        goal: str,
        setup: SessionSetup,
        drive: Sequence[Moment] = (),
        observer: Observer | None = None,
    ) -> Self:
        """A session that begins now.

        Args:
            world: the running co-simulation, which the session takes over.
            goal: what the driver says.
            setup: the agent's input, conditions and limits.
            drive: moments from departure to now, if known.
            observer: notified of every second that passes.
        """
        return cls(**beginning(world, goal, setup, drive, observer))

    # --- the loop -----------------------------------------------------------------------------------------

    def step(self, action: Action) -> None:
        """Performs one action, lets its time pass and observes.

        Raises TrafficError: the traffic simulation failed."""
        driven(self.stepping(action))

    def thinking(self, seconds: float) -> TakesTime[None]:
        """Lets the time pass, tick by tick, that the agent takes to answer; what it then does refers to the screen
        that it saw."""
        self._check_open()
        if seconds > 0:
            yield from self._advance(seconds)
            self.thought_s += seconds

    def stepping(self, action: Action) -> TakesTime[None]:
        """As ``step``, tick by tick. What is done at an instant is done when it yields the tick that passes next,
        so several sessions can share a road (``episode.fleet``)."""
        self._check_open()
        if why := self._barred(action):
            yield from self.refusing(why)
            return
        feedback, cost_s, said = self._by_ear(action) or self._talked_over(action) or self._done(action)
        self._ask(action, said)
        if action.action_type is ActionType.STATUS:
            self.declared, self.reason = action.goal_status, action.reason
        yield from self._proceed(action, feedback, cost_s, said)

    def refuse(self, why: str) -> None:
        """Spends a step on an answer that could not be read as an action: only its time passes."""
        driven(self.refusing(why))

    def refusing(self, why: str) -> TakesTime[None]:
        """As ``refuse``, tick by tick."""
        self._check_open()
        yield from self._proceed(None, Feedback(FeedbackCode.MALFORMED, why))

    def cut_off(self, end: End) -> None:
        """Ends it early, e.g. for an agent that has spent its budget."""
        driven(self.ending(end))

    def ending(self, end: End, failure: str | None = None) -> TakesTime[None]:
        """As ``cut_off``, tick by tick; with the failure of an agent that can act no more, it is no success,
        whatever has been done."""
        self._check_open()
        self.failure = failure
        yield from self._finish(end)

    def close(self) -> None:
        """Ends the drive; may be called again."""
        self.world.close()

    @property
    def malformed(self) -> tuple[str, ...]:
        """Why each answer that was no action was refused, in order: the agent raised, or it could not be read."""
        refused = (step.feedback for step in self.steps)
        return tuple(str(each.text) for each in refused if each and each.code is FeedbackCode.MALFORMED)

    # --- what there is to see -----------------------------------------------------------------------------

    @property
    def network(self) -> RoadNetwork:
        """The roads, as a map draws them."""
        return self.world.traffic.network

    @property
    def seconds(self) -> float:
        """Simulated seconds since the beginning."""
        return self.moments[-1].time_s - self.moments[0].time_s

    @property
    def trace_sha256(self) -> str:
        """The hash of the trace so far."""
        for step in self.steps[self.hashed.count :]:
            self.hashed.add(step)
        return self.hashed.hex

    @property
    def said(self) -> tuple[str, ...]:
        """Every answer of the agent to the driver that he understood."""
        return tuple(text for step in self.steps for text in understood(step))

    @property
    def breaches(self) -> tuple[Breach, ...]:
        """What the agent did against the house rules so far, whether or not it was told them."""
        return breaches(self.conduct)

    @property
    def conduct(self) -> Conduct:
        """What the house rules are held against."""
        return Conduct(self.moments, self.steps, self.world.cockpit.given, self._voice)

    @property
    def _voice(self) -> Seat:
        """The seat that the wish comes from."""
        return Seat.DRIVER

    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The cockpit's screen, (height, width, 3)."""
        return self.world.cockpit.screenshot()

    # --- inside -------------------------------------------------------------------------------------------

    def _check_open(self) -> None:
        if self.end is not None:
            raise RuntimeError(f"the episode is over ({self.end}); begin another one")

    def _ask(self, action: Action, said: tuple[str, ...]) -> None:
        """An action asks for the driver's attention: a touch for the eyes, spoken words for the mind."""
        kind, text = action.action_type, action.text or ""
        if kind in BY_HAND:
            self.world.ask(Asked(self.world.moment.time_s, look_s=self.setup.action_cost_s))
        elif kind is ActionType.ANSWER:
            self.world.ask(Asked(self.world.moment.time_s, hear_s=spoken_s(text)))
        elif said:
            self.world.ask(Asked(self.world.moment.time_s, talk_s=spoken_s(text, *said)))

    def _barred(self, action: Action) -> str:
        """Why an agent with this interface cannot act so; empty if it can."""
        interface = self.setup.conditions.interface
        if action.action_type is ActionType.CALL and not interface.calls:
            return "functions cannot be called here; act on the screen"
        if action.action_type in BY_HAND and not interface.touches:
            return "the screen cannot be touched here; call a function"
        return ""

    def _done(self, action: Action) -> tuple[Feedback, float, tuple[str, ...]]:
        """The feedback to an action, the seconds that it takes besides its own, and what the driver says to it."""
        feedback, cost_s = self._answer(action) or (self._performed(action), 0.0)
        if action.action_type is ActionType.ASK_DRIVER and feedback.code is FeedbackCode.OK:
            reply = self._reply(action.text or "")
            return feedback, spoken_s(action.text or "", reply), (reply,)
        is_slow = self._hears and action.action_type is ActionType.ANSWER
        return feedback, spoken_s(action.text or "") if is_slow else cost_s, ()

    def _by_ear(self, action: Action) -> tuple[Feedback, float, tuple[str, ...]] | None:
        """As ``_done``, of words to a driver who does not understand them, or who shall repeat his own: nothing is
        done."""
        text = action.text or ""
        if not self._hears or action.action_type not in (ActionType.ASK_DRIVER, ActionType.ANSWER):
            return None
        if not self._is_understood:
            said: tuple[str, ...] = (PARDON,)
        elif action.action_type is ActionType.ASK_DRIVER and asks_again(text) and not self._is_topic(text):
            said = (self.goal, *self.remarks)
        else:
            return None
        return Feedback(FeedbackCode.OK, ""), spoken_s(text, *said), said

    def _talked_over(self, action: Action) -> tuple[Feedback, float, tuple[str, ...]] | None:
        """As ``_done``, of words that the driver talks over: nothing is done."""
        return None

    @property
    def _hears(self) -> bool:
        return self.setup.conditions.hear.is_by_ear

    @property
    def _is_understood(self) -> bool:
        """Whether the driver understands what the car says now."""
        noise_db = self._cabin_db
        return noise_db is None or is_understood(self.world.moment, noise_db)

    @property
    def _cabin_db(self) -> float | None:
        """How loud the cabin is now, dB(A); None if that is of no account."""
        now = self.world.moment
        spoken = ((step.moment.time_s, step.said) for step in self.steps)
        return level_db(now, voices(spoken, now.time_s)) if self._hears else None

    def _is_topic(self, question: str) -> bool:
        """Whether the driver has an answer to it."""
        return False

    def _performed(self, action: Action) -> Feedback:
        """The cockpit's feedback to an action; an agent without a list has no index to name."""
        is_listed = Channel.ELEMENTS in self.setup.given
        elements = self.elements if is_listed else ()
        is_read = action.action_type is ActionType.CALL and functions()[action.function or ""].reads
        if is_read or self.setup.conditions.feedback is FeedbackDetail.VERBOSE:
            return self.world.perform(action, elements)
        name = control(action, self.world.cockpit, elements, by_name=is_listed)
        return quiet(self.world.perform(action, elements), name, self.world.cockpit)

    def _answer(self, action: Action) -> tuple[Feedback, float] | None:
        """The virtual sensor's answer to a query and its seconds; None for any other action."""
        if action.action_type is not ActionType.QUERY:
            return None
        given = self.setup.given
        if Channel.CONTEXT not in given or not self.setup.conditions.geo.answers:
            return Feedback(FeedbackCode.REFUSED, "this car has no service to ask"), 0.0
        known = self.shown.moments([*self.drive, *self.moments])
        roads = None if self.network.projection is None else self._roads()
        reply = sensor.ask(action.text or "", known, with_position=Channel.GPS in given, roads=roads)
        return Feedback(FeedbackCode.OK if reply.ok else FeedbackCode.REFUSED, reply.text), reply.cost_s

    def _reply(self, question: str) -> str:
        """What the driver answers to a question."""
        return NEUTRAL

    def _remarks(self) -> tuple[str, ...]:
        """What the driver says unasked, after another action."""
        return ()

    def _proceed(
        self, action: Action | None, feedback: Feedback, cost_s: float = 0.0, said: tuple[str, ...] = ()
    ) -> TakesTime[None]:
        """Lets the action's time pass, plus ``cost_s``; the driver says ``said`` and what he has to say besides."""
        feedback = yield from self._spend(action, feedback, cost_s)
        remarks = self._remarks()
        self.remarks += remarks
        said += remarks
        noise_db = self._cabin_db
        reached = reaching(said, self.setup, noise_db)
        self.heard += reached
        begun_s = self.moments[0].time_s
        self.elements, self.observation = _seen(
            self.world,
            self.observation.goal,
            self._channels(action),
            self.shown,
            begun_s,
            feedback,
            self.heard,
            self.setup.conditions.policy,
            lean=self.setup.lean,
            sounds=(*self.observation.sounds, *_sounds(said, self.setup, noise_db)),
        )
        self.steps.append(
            trace.Step(
                len(self.steps), self.world.moment, self.elements, action, feedback, self.thought_s, said,
                reached if self._hears else None,
                noise_db,
            )
        )  # fmt: skip
        self.thought_s = 0.0
        end = self._ended()
        if end is not None:
            yield from self._finish(end)

    def _spend(self, action: Action | None, feedback: Feedback, cost_s: float) -> TakesTime[Feedback]:
        """Lets an action's time pass, and returns what the agent is told of its result."""
        waited_s = action.seconds if action and action.action_type is ActionType.WAIT else None
        yield from self._advance(self.setup.action_cost_s * (waited_s or 1) + cost_s)
        return feedback

    def _channels(self, action: Action | None) -> frozenset[Channel]:
        """The channels of the observation after an action."""
        return self.setup.given

    def _advance(self, duration_s: float) -> TakesTime[None]:
        """Advances tick by tick."""
        left_s = duration_s
        while left_s > ROUNDING_S and self.world.moment.driving.end is None:
            tick_s = min(TICK_S, left_s)
            yield tick_s
            self._passed(self._heard(self.world.advance(tick_s)))
            left_s -= tick_s

    def _passed(self, moments: tuple[Moment, ...]) -> None:
        """Takes note of what has just been driven."""
        self.moments += moments

    def _ended(self) -> End | None:
        if self.world.moment.driving.end is not None:
            return End.DRIVE_ENDED
        if self.declared is not None:
            return End.DECLARED
        if self.setup.max_steps is not None and len(self.steps) > self.setup.max_steps:
            return End.OUT_OF_STEPS
        most_s = self.setup.max_sim_s
        return End.OUT_OF_TIME if most_s is not None and self.seconds >= most_s - ROUNDING_S else None

    def _finish(self, end: End) -> TakesTime[None]:
        self.end = end
        yield from ()

    def _heard(self, moments: tuple[Moment, ...]) -> tuple[Moment, ...]:
        for moment in moments:
            self.observer.moved(moment, self.world.cockpit)
        return moments


def beginning(
    world: CoSimulation, goal: str, setup: SessionSetup, drive: Sequence[Moment], observer: Observer | None
) -> dict[str, Any]:
    """The fields of a session that begins now, on the screen that its conditions ask for."""
    first, is_by_ear = world.moment, setup.conditions.hear.is_by_ear
    noise_db = level_db(first) if is_by_ear else None
    (wish,) = reaching((goal,), setup, noise_db)
    make = setup.conditions.make
    world.cockpit.resize(setup.conditions.screen, None if make is CarMake.DRAWN else make_named(make))
    told = shown(setup.conditions.geo, Geo(), drive[0] if drive else first)
    feedback = Feedback(FeedbackCode.NONE, TOLD_HEARD if is_by_ear else "")
    elements, observation = _seen(
        world,
        wish,
        setup.given,
        told,
        first.time_s,
        feedback,
        policy=setup.conditions.policy,
        lean=setup.lean,
        sounds=_sounds((goal,), setup, noise_db),
    )
    return {
        "world": world,
        "goal": goal,
        "setup": setup,
        "drive": tuple(drive),
        "observer": observer or Observer(),
        "shown": told,
        "_roads": cache(partial(Roads, world.traffic.network)),
        "moments": [first],
        "elements": elements,
        "observation": observation,
        "steps": [
            trace.Step(
                0,
                first,
                elements,
                None,
                feedback,
                heard=(wish,) if is_by_ear else None,
                cabin_db=noise_db,
            )
        ],
    }


def reaching(said: tuple[str, ...], setup: SessionSetup, noise_db: float | None) -> tuple[str, ...]:
    """What reaches the agent of words that are said in so much noise; None where they are text.

    Raises InfrastructureError: they have not been recognised yet, and the extra ``voice`` is missing."""
    if noise_db is None:
        return said
    if setup.conditions.hear is Hearing.AUDIO:
        return tuple(came_from(text) + SPOKEN for text in said)
    return tuple(heard(text, driver_snr_db(noise_db)) for text in said)


def _sounds(said: tuple[str, ...], setup: SessionSetup, noise_db: float | None) -> tuple[bytes, ...]:
    """The same as sound, for an agent that gets it."""
    if noise_db is None or setup.conditions.hear is not Hearing.AUDIO:
        return ()
    return tuple(sounding(text, driver_snr_db(noise_db)) for text in said)


def _seen(
    world: CoSimulation,
    goal: str,
    channels: frozenset[Channel],
    told: Shown,
    begun_s: float,
    feedback: Feedback,
    said: tuple[str, ...] = (),
    policy: ToldPolicy = ToldPolicy.NONE,
    *,
    lean: bool = False,
    sounds: tuple[bytes, ...] = (),
) -> tuple[Sequence[Element], Observation]:
    """The elements on the screen, and the agent's observation."""
    listed = world.cockpit.elements() if channels & SCREEN else ()
    seen = observe(world, goal, begun_s, listed, feedback, channels, said, policy, sounds)
    elements = listed or (() if lean else _UnseenScreen(world.cockpit))
    return elements, told.observation(seen, world.moment)


class _UnseenScreen(Sequence[Element]):
    """The elements of a screen that no agent is given. They are in the trace, but to lay one out takes as long as
    all else in a second of a drive; so that is done when somebody asks."""

    def __init__(self, cockpit: Cockpit) -> None:
        self._cockpit = cockpit.copy()

    @cached_property
    def _listed(self) -> tuple[Element, ...]:
        listed = self._cockpit.elements()
        del self._cockpit
        return listed

    @overload
    def __getitem__(self, index: int) -> Element: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Element, ...]: ...
    def __getitem__(self, index: int | slice) -> Element | tuple[Element, ...]:
        return self._listed[index]

    def __len__(self) -> int:
        return len(self._listed)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and self._listed == tuple(other)

    def __hash__(self) -> int:
        return hash(self._listed)


class Actor(Protocol):
    """Whoever acts in a session."""

    def act(self, observation: Observation) -> Action:
        """The next action.

        Raises:
            ActionError: its answer could not be read; the step still counts.
            OutOfBudgetError: its budget is spent; the session ends as it is.
            AgentError: it can act no more; the session ends, and is not a success.
        """
        ...


T = TypeVar("T", bound=Session)


def play(session: Session, actor: Actor) -> End:
    """As ``playing``, on a road of the session's own."""
    return driven(playing(session, actor))


def playing(
    session: T,
    actor: Actor,
    stepped: Callable[[T, Sequence[Element]], None] = lambda session, seen: None,
    thought_s: Callable[[], float] = lambda: 0.0,
    wall_s: float = inf,
) -> TakesTime[End]:
    """Lets an actor act until the session is over, and returns why it is.

    Args:
        session: the session, which may be under way.
        actor: the actor, which has been told the goal.
        stepped: called after each step, including the last, with the session and the screen that was acted on.
        thought_s: gives the simulated seconds that the actor's last answer took, which pass before its action.
        wall_s: wall seconds after which it is cut off.

    Raises:
        TrafficError: the traffic simulation failed.
        ModelError: the actor's model could not be reached.
    """
    ends_s = time.monotonic() + wall_s
    while session.end is None:
        if time.monotonic() >= ends_s:
            yield from session.ending(End.OUT_OF_BUDGET)
            break
        seen = session.elements
        try:
            action = check(actor.act(session.observation))
        except ActionError as error:
            yield from session.thinking(thought_s())
            yield from session.refusing(str(error))
        except OutOfBudgetError:
            yield from session.ending(End.OUT_OF_BUDGET)
            break
        except AgentError as error:
            yield from session.ending(End.AGENT_FAILED, str(error))
            break
        else:
            yield from session.thinking(thought_s())
            yield from session.stepping(action)
        stepped(session, seen)
    assert session.end is not None
    return session.end


class Baseline:
    """The baseline run, driven along with the episode and only as far; the episode's branches share it.

    As long as the agent has done nothing, it is the episode's own drive, tick by tick, and takes over its moments.
    ``part`` then makes it a drive with a car of its own.
    """

    def __init__(self, world: CoSimulation) -> None:
        """Begins at the hand-over of the episode's world, which the episode keeps."""
        self._shared = world
        self._own: CoSimulation | None = None
        self._moments: list[Moment] = [world.moment]

    def part(self) -> None:
        """Makes it a drive of its own, just before the agent does something; may be called again."""
        if self._own is None:
            self._own = self._shared.shadow()

    def prepare(self, duration_s: float) -> None:
        """Parts if the episode is about to run for a time that ends between two ticks."""
        if duration_s % TICK_S:
            self.part()

    def see(self, passed: Sequence[Moment]) -> None:
        """Takes over what the episode has just driven, unless the two have parted."""
        if self._own is None:
            self._moments += passed

    def start(self, time_s: float) -> None:
        """Starts to run its traffic to a simulation time while the caller does something else."""
        if self._own is not None and self._is_before(time_s):
            self._own.traffic.start(TICK_S)

    def until(self, time_s: float) -> tuple[Moment, ...]:
        """Its moments from the hand-over to the first whole tick at or after that time, or to the end of its drive.

        Raises TrafficError: the traffic simulation failed."""
        self.follow(time_s)
        last = next(
            (i for i, moment in enumerate(self._moments) if moment.time_s >= time_s - ROUNDING_S),
            len(self._moments) - 1,
        )
        return tuple(self._moments[: last + 1])

    def since(self, time_s: float) -> list[Moment]:
        """Its moments so far that are later than that."""
        later = takewhile(lambda moment: moment.time_s > time_s + ROUNDING_S, reversed(self._moments))
        return list(later)[::-1]

    def follow(self, time_s: float) -> None:
        """Drives to that simulation time. Raises TrafficError: the traffic simulation failed."""
        while self._is_before(time_s):
            assert self._own is not None, "the episode's drive went on without the baseline run"
            self._moments += self._own.advance(TICK_S)

    def close(self) -> None:
        """Ends its drive; may be called again."""
        if self._own is not None:
            self._own.close()

    def _is_before(self, time_s: float) -> bool:
        last = self._moments[-1]
        return last.time_s < time_s - ROUNDING_S and last.driving.end is None


@dataclass(kw_only=True)
class JudgedSession(Session, ABC):
    """A session on a task or on a drive."""

    baseline: Baseline
    """The same drive from the beginning with nobody at the cockpit, for comparison."""

    @property
    @abstractmethod
    def is_judged(self) -> bool:
        """Whether it has been judged: false while it runs, and if it broke."""

    def drive_on(self) -> None:
        """What is still driven once it is over, for the record. Raises InfrastructureError: the road failed."""

    @property
    def baseline_moments(self) -> tuple[Moment, ...]:
        """The baseline run from the beginning to now."""
        return self.baseline.until(self.moments[-1].time_s)

    @property
    def _copies(self) -> Sequence[Baseline]:
        """All drives that go on beside this one with nobody at the cockpit."""
        return (self.baseline,)

    def _performed(self, action: Action) -> Feedback:
        if action.action_type is not ActionType.WAIT:
            for copy in self._copies:
                copy.part()
        return super()._performed(action)

    def _advance(self, duration_s: float) -> TakesTime[None]:
        """Advances second by second together with the copies: all simulations run at the same time."""
        left_s = duration_s
        while left_s > ROUNDING_S and self.world.moment.driving.end is None:
            tick_s = min(TICK_S, left_s)
            for copy in self._copies:
                copy.prepare(tick_s)
            yield tick_s
            for copy in self._copies:
                copy.start(self.world.moment.time_s + tick_s)
            passed = self._heard(self.world.advance(tick_s))
            for copy in self._copies:
                copy.see(passed)
                copy.follow(self.world.moment.time_s)
            self._passed(passed)
            left_s -= tick_s
