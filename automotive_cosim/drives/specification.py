"""The specification of a drive, and how it begins."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Language
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.elsewhere import elsewhere
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.result import figures
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.settings import AS_SCRIPTED, DriveSettings
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.specification import EpisodeSpec, SessionSetup
from automotive_cosim.errors import UserError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.trace import plain
from automotive_cosim.traffic.base import Traffic
from automotive_cosim.traffic.fork import Simulations

MOST_STEPS = 100_000
"""Far more than a drive has seconds: no limit."""


@dataclass(frozen=True, slots=True)
class DriveSpec:
    """One drive, by name: the same specification and the same actions give the same trace."""

    family: str
    """Id of the family that it is drawn from."""
    seed: int = 0
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What the agent is given, and at what speed."""
    scenario: str = ""
    """Where to drive instead of on the family's own roads; see ``drives.elsewhere``."""
    settings: DriveSettings = AS_SCRIPTED
    """What is set otherwise than the family's script has it."""
    max_steps: int = MOST_STEPS
    """Actions, waits among them, after which nobody watches."""

    @property
    def script(self) -> DriveScript:
        """The drive that these words name.

        Raises:
            UserError: something in the specification does not exist.
        """
        drawn = family_named(self.family).draw(self.seed)
        placed = elsewhere(drawn, self.scenario) if self.scenario else drawn
        return placed if self.settings == AS_SCRIPTED else self.settings.applied(placed)

    def begin(
        self,
        simulations: Simulations,
        channels: frozenset[Channel] = ALL,
        observer: Observer | None = None,
        script: DriveScript | None = None,
        traffic: Traffic | None = None,
        *,
        lean: bool = False,
    ) -> DriveSession:
        """Departs; the caller closes the session.

        Args:
            simulations: warm traffic, shared with others.
            channels: what the agent wants to see.
            observer: notified of progress.
            script: used instead of its own.
            traffic: a drive by it that has departed, as beside other cars; None lets one depart.
            lean: lays out no screen (``SessionSetup.lean``).

        Raises:
            UserError: something in the specification does not exist, or it is a fleet and no script is given.
            InfrastructureError: no gap opened for the car, or the traffic simulation failed.
        """
        if self.settings.cars and script is None:
            raise UserError("a car of a fleet cannot drive alone; run the fleet, by `eval` or `run --drive`")
        drive, conditions = script or self.script, self.conditions.at(self.seed)
        units = dict(make_named(conditions.make).units.signals)
        units.pop(HMI.TEMPERATURE_UNIT.path, None)  # what is asked for in half degrees
        drive = replace(drive, signals=units | dict(drive.signals)) if units else drive
        if self.conditions.language is not Language.ENGLISH:
            drive = replace(drive, signals={HMI.LANGUAGE.path: str(self.conditions.language), **drive.signals})
        if self.conditions.attention.is_limited:
            drive = replace(drive, attention=True)
        setup = SessionSetup(channels, conditions, self.max_steps, drive.duration_s, lean=lean)
        world = depart(drive, simulations, observer, traffic)
        try:
            return DriveSession.depart_with(world, setup, observer)
        except BaseException:
            world.close()
            raise

    def outcome(self, session: DriveSession) -> Json:
        """The result, once the drive is over."""
        result = {name: plain(each) for name, each in figures(session).items()}
        return {"family": self.family, "seed": self.seed, "result": result}


TrialSpec = EpisodeSpec | DriveSpec
"""What to run, by name, of either kind."""
