"""What an agent is told about its last action.

| ``--feedback`` | after an action that the car could perform |
|---|---|
| ``quiet`` | the control and whether it took: "Front defroster: done" |
| ``verbose`` | what became of the car: "IsFrontDefrosterActive is on" |

Both say alike why something could not be done, what a query or a reading found, and what the car reads out. With
the picture alone, a control without letters on it is not named.
"""

from __future__ import annotations

from collections.abc import Sequence

from automotive_cosim.cockpit.actions import FIELDS, point
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.widgets import Field, Slider, Widget
from automotive_cosim.contracts import Action, ActionType, Element, Feedback, FeedbackCode
from automotive_cosim.contracts.given import FeedbackDetail as FeedbackDetail
from automotive_cosim.contracts.text import say

DONE, UNCHANGED = say("done"), say("nothing changed")
_OUTCOMES = {FeedbackCode.OK: DONE, FeedbackCode.NO_EFFECT: UNCHANGED}


def control(action: Action, cockpit: Cockpit, elements: Sequence[Element], *, by_name: bool) -> str:
    """The control that an action is about to touch, in the words of the screen; empty if it touches none.

    Args:
        elements: the list to which an index refers.
        by_name: whether a control may be named by what a screen reader says, not only by the letters on it.
    """
    index = action.index
    if index is not None and not 0 <= index < len(elements):
        return ""
    if action.action_type is ActionType.CALL:
        return action.function or ""
    if action.action_type is ActionType.SCROLL:
        return elements[index].content_description if index is not None and by_name else ""
    if not FIELDS[action.action_type].target:
        return ""
    widget = cockpit.touched(*point(action, elements))
    return "" if widget is None else _name(widget, by_name=by_name)


def quiet(feedback: Feedback, name: str, cockpit: Cockpit) -> Feedback:
    """The feedback without what became of the car.

    Args:
        feedback: as the cockpit gives it.
        cockpit: whose language it is told in.
    """
    outcome = _OUTCOMES.get(feedback.code)
    if outcome is None or not feedback.text:
        return feedback
    words = cockpit.spoken(Feedback(feedback.code, outcome)).text
    return Feedback(feedback.code, f"{name}: {words}" if name else words)


def _name(widget: Widget, *, by_name: bool) -> str:
    """Its fixed name: a slider's text is its value, a field's what was typed."""
    if isinstance(widget, Slider):
        return widget.description
    if isinstance(widget, Field):
        return widget.description if by_name else widget.hint
    letters = widget.text.partition("\n")[0]
    return letters or (widget.description if by_name else "")
