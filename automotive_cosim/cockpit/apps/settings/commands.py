"""The command of the profiles."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.apps.settings.state import Profiles
from automotive_cosim.cockpit.commands import set_all
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class SwitchProfile(Command):
    """Switch to a driver's profile."""

    profile: str

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"driver.profile"})

    def perform(self, state: State) -> Feedback:
        """The profile's seat, mirrors, temperature and brightness."""
        name, profiles = self.profile, state.of(Profiles)
        values = next(profile.values for profile in profiles.known if profile.name == name)
        feedback = set_all(state, values, say("{name} is now the driver", name=name))
        if feedback.code is FeedbackCode.REFUSED:
            return feedback
        state.keep(replace(profiles, driver=name))
        return Feedback(FeedbackCode.OK, say("{name} is now the driver", name=name))
