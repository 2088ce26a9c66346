"""The environment of drives: an agent keeps watch over a car in traffic, as a gymnasium ``Env``."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.contracts import Action
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.result import figures
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import MOST_STEPS, DriveSpec
from automotive_cosim.envs.base import ActT, ObsT, SessionEnv, StepResult, action_of, ended, info_of, spaces_of
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.formats.checked import Steps, checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.interface import spaces
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.tasking.draws import SEED_LIMIT
from automotive_cosim.traffic.base import Traffic
from automotive_cosim.traffic.fork import Simulations


class DrivesEnv(SessionEnv[ObsT, ActT, DriveSession]):
    """An environment of one drive after another, on a road of its own or beside other cars."""

    def __init__(
        self,
        simulations: Simulations | None,
        render_mode: str | None,
        channels: frozenset[Channel],
        observer: Observer | None = None,
        *,
        lean: bool = False,
    ) -> None:
        """Begins without a drive; ``channels`` and ``lean`` are those of ``SessionSetup``."""
        super().__init__(simulations, render_mode)
        self._given_channels, self._observer, self._lean = channels, observer, lean

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ObsT, dict[str, Any]]:
        """Departs on a drive: that of the seed; without a seed on another one.

        Raises:
            ScenarioError: the scenario cannot be read, or a drive cannot take place in it.
            InfrastructureError: no gap opened for the car, or the traffic simulation failed.
        """
        return self.depart(self.draw(seed))

    def draw(self, seed: int | None) -> DriveSpec:
        """The drive that ``reset`` with that seed departs on, and the end of the one before."""
        super().reset(seed=seed)
        self._end()
        return self._drawn(int(self.np_random.integers(SEED_LIMIT)) if seed is None else seed)

    def depart(
        self, spec: DriveSpec, script: DriveScript | None = None, traffic: Traffic | None = None
    ) -> tuple[ObsT, dict[str, Any]]:
        """Departs on a drive that was drawn; script and traffic are those of ``DriveSpec.begin``."""
        self._episode = spec.begin(
            self._simulations, self._given_channels, self._observer, script, traffic, lean=self._lean
        )
        return self._departed()

    @abstractmethod
    def _drawn(self, seed: int) -> DriveSpec:
        """The drive of a seed."""

    @abstractmethod
    def _departed(self) -> tuple[ObsT, dict[str, Any]]:
        """The first observation of a drive, and its info."""


class DriveEnv(DrivesEnv[dict[str, Any], Any]):
    """A drive of ten to thirty minutes, on which something may require an act.

    Spaces are those of ``CockpitEnv``; the readings that the car notes are in ``vehicle`` (``noticed``). A ``wait``
    lasts until something changes, at most a minute. The reward is 0 until the drive is over, then its score in
    hundredths: 0 for doing nothing, 1 for the rule-perfect watcher, and negative for who disturbs more than he
    helps. ``info`` holds ``step``, ``action_result`` and ``events`` of the road; at the end also ``score``,
    ``result`` and ``trace_sha256``. ``env.unwrapped.episode`` is the typed session behind it.

    Seeds: ``reset(seed=s)`` draws drive ``s`` of the family, with the traffic of that seed; ``reset()`` draws
    another one. ``options`` are not used.
    """

    def __init__(
        self,
        family: str = "grid_june",
        *,
        scenario: str = "",
        minutes: float | None = None,
        max_steps: int = MOST_STEPS,
        errands: bool = False,
        channels: Iterable[str] = ALL,
        render_mode: str | None = None,
        simulations: Simulations | None = None,
        observer: Observer | None = None,
        **conditions: str,
    ) -> None:
        """Makes an environment of one family; nothing runs before ``reset``.

        Args:
            family: which drives; ``automotive-cosim show drives`` lists them.
            scenario: where to drive instead of on the family's own roads.
            minutes: when a drive is over, if its script ends later.
            max_steps: actions, waits among them, after which nobody watches.
            errands: whether people aboard also ask for things on the way.
            channels: as in ``SessionSetup``.
            render_mode: ``"rgb_array"`` or None.
            simulations: warm simulations; by default those that the environments of this process share.
            observer: told of progress.
            conditions: ``geo``, ``see`` and so on, as in ``Conditions``.

        Raises:
            UnknownNameError: no such family, channel or condition.
            UserError: ``minutes`` is out of bounds, or ``see`` leaves nothing of the screen.
        """
        family_named(family)
        under = Conditions.named(conditions)
        self._spec = DriveSpec(
            family,
            conditions=under,
            scenario=scenario,
            settings=settings_of(minutes=minutes, errands=errands),
            max_steps=max_steps,
        )
        self._setup = SessionSetup(frozenset(map(Channel, channels)), under)
        super().__init__(simulations, render_mode, self._setup.channels, observer)
        self.observation_space, self.action_space = spaces_of(self._setup)

    def _drawn(self, seed: int) -> DriveSpec:
        self._spec = replace(self._spec, seed=seed)
        return self._spec

    def _departed(self) -> tuple[dict[str, Any], dict[str, Any]]:
        return self._encoded(), info_of(self.episode)

    def stepping(self, action: Action | Mapping[str, Any] | str) -> TakesTime[StepResult]:
        session = self._running()
        yield from session.stepping(action_of(action))
        info, reward = info_of(session), 0.0
        if session.end is not None:
            result = figures(session)
            info |= {"score": result["value"], "result": result, "trace_sha256": session.trace_sha256}
            reward = result["value"] / 100.0
        return self._encoded(), reward, *ended(session), info

    def _encoded(self) -> dict[str, Any]:
        seen, given = self.episode.observation, self._setup.given
        if Channel.SCREENSHOT in given and seen.screenshot is None:  # as after a wait, and a space has no gaps
            seen = replace(seen, screenshot=self.episode.screenshot())
        return spaces.encode(seen, given)


def settings_of(**told: float | bool | None) -> DriveSettings:
    """The settings of a drive from an environment's arguments; None leaves one as it is.

    Raises:
        UserError: a value is out of bounds.
    """
    return checked(DriveSettings, {name: value for name, value in told.items() if value is not None}, _named)


def _named(steps: Steps) -> tuple[str, str]:
    return "the drive", dotted(steps)
