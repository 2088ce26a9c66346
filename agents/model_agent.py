"""Agents that use a model: T3A, M3A and ASURADA, one cycle over different inputs.

reflect on an action that failed -> remember -> perceive -> interpret -> plan -> act
"""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.agents import answer, prompt, prompt_parts
from automotive_cosim.agents.asking import Asking
from automotive_cosim.agents.base import StageName
from automotive_cosim.agents.lines import one_line
from automotive_cosim.agents.marks import marked, png, road
from automotive_cosim.agents.memory import Memory, Strategy, where, why
from automotive_cosim.agents.settings import AgentProfile, AgentSettings
from automotive_cosim.agents.thoughts import spoken
from automotive_cosim.cockpit.actions import schema_of
from automotive_cosim.contracts import Action, FeedbackCode, Observation
from automotive_cosim.contracts.given import PromptLength
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.interface.observe import Channel, See
from automotive_cosim.models.base import ChatModel

LONGEST_LESSON, LONGEST_PLAN = 300, 2000
"""Characters of its own text that it carries over to the next turn."""
WENT_WELL = frozenset({FeedbackCode.NONE, FeedbackCode.OK, FeedbackCode.READ_OUT})
"""Results that teach nothing: the next picture shows what came of the act."""
DRIVE_HISTORY, SHORT_HISTORY = 20, 6
"""Lines of history in a watch, which lasts for hundreds of turns, and in a short prompt."""


@dataclass(frozen=True, slots=True)
class _Turn:
    """What was seen and done in a turn."""

    seen: Observation
    action: Action | None
    """None if the answer could not be read."""
    plan: str


class ModelAgent:
    """Asks its model what to do now and, after an action that failed, what follows from that.

    ``stages`` records the last turn."""

    def __init__(
        self,
        profile: AgentProfile,
        chat_model: ChatModel,
        settings: AgentSettings = AgentSettings(),  # noqa: B008, frozen
    ) -> None:
        """Puts the agent together.

        Args:
            settings: what to take away from the profile, the budget, and the memory's file.

        Raises UserError: the memory's file cannot be used, or the model would see nothing of the screen."""
        self._profile = profile.under(settings)
        self._asking = Asking(chat_model, settings)
        is_blind = settings.conditions.see is See.PICTURE and not self._sees
        if is_blind and not settings.conditions.interface.calls:
            why = "it is shown no pictures" if chat_model.sees_pictures else f"{chat_model.name!r} sees none"
            raise UserError(
                f"agent {profile.name!r} would see nothing: --see picture leaves it pictures alone, and {why}"
            )
        self._memory = Memory(settings.memory) if self._profile.remembers and settings.memory else None
        self.stages = self._asking.stages
        self.reset("")

    @property
    def name(self) -> str:
        return self._profile.name

    @property
    def model(self) -> str:
        return self._asking.chat_model.name

    @property
    def channels(self) -> frozenset[Channel]:
        """The profile's channels without those that the settings take away."""
        return self._profile.channels

    def reset(self, goal: str) -> None:
        """Forgets the previous episode, except for what the memory keeps."""
        self._asking.reset()
        self._history: list[str] = []
        self._done: list[str] = []
        self._recalled: tuple[str, ...] = ()
        self._first: Observation | None = None
        self._last: _Turn | None = None

    def act(self, observation: Observation) -> Action:
        """One turn of the cycle.

        Raises:
            ActionError: the answer has no action, a malformed one, or one that this agent does not have.
            OutOfBudgetError: the episode's tokens or seconds are spent.
            ModelError: the model does not answer."""
        self.stages.clear()
        if self._last is None:
            self._begin(observation)
        else:
            self._look_back(self._last, observation)
        plan = "" if self._last is None else self._last.plan
        self._last = _Turn(observation, None, plan)
        action, plan = self._decide(observation, plan)
        self._last = _Turn(observation, action, plan)
        return action

    def learn(self, success: bool) -> None:
        """Stores what was done in this episode and whether it worked, if it has a memory."""
        if self._memory is None or self._first is None or self._last is None:
            return
        steps = [*self._done, prompt.action_words(self._last.action, self._last.seen)]
        self._memory.keep(
            Strategy(where(self._first), one_line(self._first.goal), why(self._first), " > ".join(steps)),
            worked=success,
        )

    # --- the stages ---------------------------------------------------------------------------------------

    def _begin(self, observation: Observation) -> None:
        self._first = observation
        if self._memory is None:
            return
        recalled = self._memory.recall(where(observation), one_line(observation.goal))
        self._recalled = tuple(strategy.words for strategy in recalled)
        self._asking.note(StageName.REMEMBER, observation, "\n".join(self._recalled) or "nothing of this place")

    def _look_back(self, last: _Turn, now: Observation) -> None:
        has_failed = now.feedback.code not in WENT_WELL
        lesson = self._reflect(last, now) if self._profile.reflects and has_failed else ""
        done = prompt.action_words(last.action, last.seen)
        number = len(self._history) + 1
        line = prompt.step(number, last.action, last.seen, now, lesson)
        self._done.append(done)
        self._history.append(line)
        self._asking.note(StageName.REMEMBER, now, line)

    def _reflect(self, last: _Turn, now: Observation) -> str:
        before, after = (_shown(seen) if self._sees else None for seen in (last.seen, now))
        pictures = tuple(screen for screen in (before, after) if screen is not None)
        shown = before is not None, after is not None
        text = prompt.look_back(last.seen, last.action, now, last.plan, shown)
        reply, asked = self._asking.ask(text, pictures)
        try:
            said = spoken(reply.text)
        except ActionError:
            said = ""
        lesson = one_line(answer.labelled(said, "lesson") or said)[:LONGEST_LESSON]
        self._asking.note(StageName.REFLECT, now, lesson, reply, asked, len(pictures))
        return lesson

    def _decide(self, seen: Observation, plan: str) -> tuple[Action, str]:
        pictures: tuple[bytes, ...] = ()
        if self._sees and seen.screenshot is not None:
            with_marks = _marked(seen)
            pictures = (png(seen.screenshot), *([] if with_marks is None else [with_marks]), *road(seen))
        last = DRIVE_HISTORY if seen.on_watch else len(self._history)
        if self._profile.length is PromptLength.SHORT:
            last = SHORT_HISTORY
        history = self._history[len(self._history) - last :] if last < len(self._history) else self._history
        text = prompt.turn(self._profile, seen, history, plan, self._recalled, bool(pictures))
        self._asking.note(StageName.PERCEIVE, seen, text)
        action = schema_of(
            self._profile.actions,
            None if seen.elements is None else prompt_parts.indices(seen.elements),
            [each.name for each in self._profile.functions],
        )
        reply, asked = self._asking.ask(text, (*seen.sounds, *pictures), answer.schema(action))
        try:
            understood = answer.read(reply.text, is_cut=reply.is_cut)
            if understood.action.action_type not in self._profile.actions:
                raise ActionError(
                    f"this agent has no action {understood.action.action_type}; choose one that the prompt names"
                )
        except ActionError as error:
            told = f"{error}{reply.ending}"
            self._asking.note(StageName.ACT, seen, told, reply, asked, len(pictures))
            raise ActionError(told) from None
        self._asking.note(StageName.INTERPRET, seen, understood.situation, reply, asked, len(pictures))
        self._asking.note(StageName.PLAN, seen, understood.plan)
        form = "" if understood.strict else " (read forgivingly)"
        self._asking.note(StageName.ACT, seen, prompt.action_words(understood.action, seen) + form)
        return understood.action, understood.plan[:LONGEST_PLAN]

    @property
    def _sees(self) -> bool:
        return Channel.SCREENSHOT in self.channels and self._asking.chat_model.sees_pictures


def _shown(seen: Observation) -> bytes | None:
    """The screen, with its marks if there are elements; None without a screen."""
    plain = None if seen.screenshot is None else png(seen.screenshot)
    return _marked(seen) or plain


def _marked(seen: Observation) -> bytes | None:
    """The screen with its marks; None without a screen or without elements to mark."""
    if seen.screenshot is None or seen.elements is None:
        return None
    return png(marked(seen.screenshot, seen.elements))
