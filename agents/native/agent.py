"""The agent ``native``: a model that answers in the format that it was trained on. It sees the picture alone."""

from __future__ import annotations

from collections import deque

from automotive_cosim.agents import prompt
from automotive_cosim.agents.asking import Asking
from automotive_cosim.agents.base import StageName
from automotive_cosim.agents.lines import one_line
from automotive_cosim.agents.marks import png, road
from automotive_cosim.agents.native.formats import Format
from automotive_cosim.agents.native.grid import GuiScreen
from automotive_cosim.agents.native.syntax import END
from automotive_cosim.agents.native.verbs import GuiCall, Hand
from automotive_cosim.agents.settings import AgentSettings
from automotive_cosim.contracts import Action, FeedbackCode, Observation
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.models.base import ChatModel

MOST_ACTIONS = 10
"""Most actions of one answer; each is a step."""
FAILED = frozenset(
    {FeedbackCode.NO_SUCH_ELEMENT, FeedbackCode.DISABLED, FeedbackCode.RESTRICTED, FeedbackCode.REFUSED}
)
REMEMBERED = 200
"""Characters of a step in the history, which is told in the format's own words."""


class NativeAgent:
    """Asks its model once per answer, which may hold several actions; each costs a step.

    The model gets the driver's words, what it did so far and the picture. The elements stay with the agent, as in a
    phone: they say which field has the focus and which list lies under a point."""

    name = "native"
    channels = frozenset({Channel.SCREENSHOT, Channel.ELEMENTS})

    def __init__(self, model: str, chat_model: ChatModel, form: Format, settings: AgentSettings) -> None:
        """Puts the agent together.

        Args:
            model: the model's whole name, with its format, for results.

        Raises UserError: the model sees no pictures."""
        if not chat_model.sees_pictures:
            raise UserError(
                f"agent 'native' shows its model nothing but pictures, and {chat_model.name!r} sees none"
            )
        self.model = model
        self._form = form
        self._asking = Asking(chat_model, settings)
        self.stages = self._asking.stages
        self.reset("")

    def reset(self, goal: str) -> None:
        self._asking.reset()
        self._history: list[str] = []
        self._left: deque[tuple[Action, GuiCall]] = deque()
        self._last: tuple[int, int] | None = None
        self._problem = ""

    def act(self, observation: Observation) -> Action:
        """The next action of the last answer, or the first of another one.

        Raises:
            ActionError: the answer cannot be read, or asks for what the car does not have.
            OutOfBudgetError: the episode's tokens or seconds are spent.
            ModelError: the model does not answer."""
        self.stages.clear()
        if self._form.stops_at_failure and observation.feedback.code in FAILED:
            self._left.clear()
        if self._left:
            return self._next(observation)
        assert observation.screenshot is not None
        height, width = observation.screenshot.shape[:2]
        screen = GuiScreen(width, height, self._form.grid)
        text = self._question(observation, screen)
        self._asking.note(StageName.PERCEIVE, observation, text)
        pictures = (png(observation.screenshot), *road(observation))
        reply, asked = self._asking.ask(text, pictures)
        hand = Hand(screen, observation.elements or (), self._last)
        try:
            if reply.is_cut and not self._form.syntax.whole.search(reply.text):
                raise ActionError("the answer has no whole call")
            found = self._form.acts(reply.text, hand)
            if reply.ending and any(call.name == END for _, call in found):
                raise ActionError("the answer has words alone, and was not finished")
            if len(found) > MOST_ACTIONS:
                raise ActionError(f"the answer has {len(found)} actions; at most {MOST_ACTIONS} are allowed")
        except ActionError as error:
            told = f"{error}{reply.ending}"
            self._problem = f"It could not be carried out: {one_line(told)}"
            self._asking.note(StageName.ACT, observation, told, reply, asked, len(pictures))
            raise ActionError(told) from None
        self._problem = ""
        self._asking.note(StageName.INTERPRET, observation, reply.text, reply, asked, len(pictures))
        self._left.extend(found)
        return self._next(observation)

    def _next(self, seen: Observation) -> Action:
        action, call = self._left.popleft()
        if action.x is not None and action.y is not None:
            self._last = action.x, action.y
        said = ", ".join(f"{name}={value!r}" for name, value in call.arguments.items())
        line = f"Step {len(self._history) + 1} at {seen.time_s:.0f} s: {call.name}({said})"
        self._history.append(line[:REMEMBERED])
        self._asking.note(StageName.ACT, seen, prompt.action_words(action, seen))
        return action

    def _question(self, seen: Observation, screen: GuiScreen) -> str:
        span = self._form.grid.span(screen.width, screen.height)
        return prompt.fill(
            "native",
            {
                "grammar": self._form.syntax.describe(self._form.verbs, *span) or None,
                "policy": seen.policy,
                "goal": prompt.driver_words(seen),
                "history": "\n".join(map(one_line, self._history)) or "nothing yet",
                "pictures": None if seen.camera is None else f"The first picture is the screen. {prompt.ROAD}",
                "problem": self._problem or None,
                "passed": prompt.passed(seen),
            },
        )
