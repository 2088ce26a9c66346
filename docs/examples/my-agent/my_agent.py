"""An agent that does what its driver says if it knows the words, and declines otherwise."""

from automotive_cosim import Action, ActionType, Channel, GoalStatus, Observation, Reason

KNOWN = {"seat": "Seat heat", "hands": "Steering wheel heat", "fan": "Max"}
"""How the button of the climate screen begins that a word of the driver's asks for."""


class Careful:
    """Opens the climate screen, taps what a word asks for, and says so."""

    name, model = "careful", "none"
    channels = frozenset({Channel.ELEMENTS})

    def reset(self, goal: str) -> None:
        """Notes what is asked."""
        self.wanted = next((element for word, element in KNOWN.items() if word in goal.lower()), None)
        self.tapped = False

    def act(self, observation: Observation) -> Action:
        """One step."""
        if self.wanted is None:
            return Action(ActionType.STATUS, goal_status=GoalStatus.INFEASIBLE, reason=Reason.NOT_POSSIBLE)
        if self.tapped:
            return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
        for index, element in enumerate(observation.elements):
            if element.text.startswith(self.wanted):
                self.tapped = True
                return Action(ActionType.CLICK, index=index)
        return Action(ActionType.OPEN_APP, app_name="climate")
