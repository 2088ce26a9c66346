"""Watchers with one fault each, to see whether a search finds it: ``--agent planted:Blind --space town.toml``."""

from automotive_cosim.contracts import Action, ActionType, AlertKind, Observation
from automotive_cosim.drives.reading import Gathered
from automotive_cosim.drives.watchers import RulePerfect

SIRENS = (AlertKind.YIELD, AlertKind.CORRIDOR, AlertKind.MOVE_OVER)


class _Planted(RulePerfect):
    """Does what is right, except where it fails."""

    def act(self, observation: Observation) -> Action:
        action = super().act(observation)
        known = self._reader.read(observation)
        fails = known is not None and self.fails(known, action)
        return Action(ActionType.WAIT, seconds=5) if fails else action

    def fails(self, known: Gathered, action: Action) -> bool:
        """Whether it does nothing now."""
        raise NotImplementedError


class Late(RulePerfect):
    """Is late by 8 s."""

    def __init__(self) -> None:
        super().__init__(8.0)


class Blind(_Planted):
    """Does nothing where one sees less than 300 m."""

    def fails(self, known: Gathered, action: Action) -> bool:
        return known.visibility_m < 300


class Deaf(_Planted):
    """Never tells of a blue light."""

    def fails(self, known: Gathered, action: Action) -> bool:
        return action.kind in SIRENS


class Wrong(_Planted):
    """Does not mind limits of 30 km/h and less."""

    def fails(self, known: Gathered, action: Action) -> bool:
        return action.kind is AlertKind.SPEED and known.limit_kmh is not None and known.limit_kmh <= 31


class Night(_Planted):
    """Sleeps while the sun is low."""

    def fails(self, known: Gathered, action: Action) -> bool:
        return known.sun_deg is not None and known.sun_deg < 15
