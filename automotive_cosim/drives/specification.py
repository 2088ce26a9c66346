"""The specification of a drive, and how it begins."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.contracts.given import Language
from automotive_cosim.drives.departure import depart
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.result import DriveOutcome, result_of
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.watch import Watch
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.listener import Listener
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import UserError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.traffic.fork import Simulations

MOST_STEPS = 100_000
"""Far more than a drive has seconds."""


@dataclass(frozen=True, slots=True)
class DriveSpec:
    """One drive, by name: the same specification and the same actions give the same trace."""

    family: str
    """Id of the family that it is drawn from."""
    seed: int = 0
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What the agent is given, and at what speed."""

    def check(self) -> None:
        """Refuses what no drive has.

        Raises:
            UserError: another language than English.
        """
        if self.conditions.language is not Language.ENGLISH:
            raise UserError(f"drives are in English, not in {self.conditions.language.words}; omit the language")

    def begin(
        self,
        simulations: Simulations,
        channels: frozenset[Channel] = ALL,
        listener: Listener | None = None,
        script: DriveScript | None = None,
    ) -> Watch:
        """Departs; the caller closes the watch.

        Args:
            simulations: warm traffic, shared with others.
            channels: what the agent wants to see.
            listener: notified of progress.
            script: used instead of the family's script for the seed.

        Raises:
            UserError: something in the specification does not exist.
            InfrastructureError: no gap opened for the car, or the traffic simulation failed.
        """
        self.check()
        drive = script or family_named(self.family).draw(self.seed)
        setup = SessionSetup(channels, self.conditions, MOST_STEPS, drive.duration_s)
        world = depart(drive, simulations, listener)
        try:
            return Watch.depart_with(world, setup, listener)
        except BaseException:
            world.close()
            raise

    def outcome(self, episode_id: str, session: Watch) -> DriveOutcome:
        """The result, once the drive is over."""
        assert session.end is not None
        seconds = round(session.seconds, 3)
        return DriveOutcome(episode_id, self.family, self.seed, session.end, seconds, result_of(session))
