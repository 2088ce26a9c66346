"""A finger on the screens: opens apps, touches controls by their keys and reads what they show."""

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Element, FeedbackCode
from automotive_cosim.contracts.ids import resource_id


def find(cockpit: Cockpit, key: str) -> Element:
    """The element of a widget on the screen."""
    return next(element for element in cockpit.elements() if element.resource_id == resource_id(key))


def middle(element: Element) -> tuple[int, int]:
    box = element.bbox_pixels
    return (box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2


def press(cockpit: Cockpit, *steps: str) -> FeedbackCode:
    """One step after another, ``open APP``, ``back`` or the key of what is touched, parted by ``; `` or alone.

    Returns:
        What the last one did."""
    code = FeedbackCode.OK
    for step in "; ".join(steps).split("; "):
        if step == "back":
            code = cockpit.back().code
        elif step.startswith("open "):
            code = cockpit.open_app(step.removeprefix("open ")).code
        else:
            code = cockpit.tap(*middle(find(cockpit, step))).code
    return code


def shown(cockpit: Cockpit, key: str) -> str:
    """The text of a widget; empty if it is not on the screen."""
    return next((each.text for each in cockpit.elements() if each.resource_id == resource_id(key)), "")
