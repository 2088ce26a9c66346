"""Drives the futures of a drive's decisions to their ends, those of one draw at the same time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack, closing

import numpy as np

from automotive_cosim.formats.incidents import Closure
from automotive_cosim.studies.calls.accounts import Settled
from automotive_cosim.studies.calls.chance import Fresh, fresh_of, renew
from automotive_cosim.studies.calls.divert import Edges, divert
from automotive_cosim.studies.calls.ledger import own_choice, settle, stage
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.plan import AHEAD, StudyJob
from automotive_cosim.studies.reroute.points import Diverted, Drawn, Shut, shows_signs
from automotive_cosim.traffic.base import WarmUpProgress
from automotive_cosim.traffic.chance import SEED_RANGE
from automotive_cosim.traffic.fork import Forked, RemoteTraffic


class Futures:
    """The possible futures of a drive at the current decision; nothing here changes the drive itself."""

    def __init__(self, job: StudyJob, traffic: RemoteTraffic, simulation: Forked) -> None:
        self._job = job
        self._traffic = traffic
        self._simulation = simulation
        self.decisions = 0
        """Number of earlier decisions."""
        self.fresh: Fresh | None = None
        """How futures got fresh random numbers, as soon as one did."""

    def replicates(
        self, begun: Sequence[RemoteTraffic | None], group: Sequence[str], tell: Callable[[float], None]
    ) -> list[Drawn]:
        """Further draws of keeping the route and of every branch, in their state after the choice; none if nobody
        left the route, since all futures of a draw are then the same. ``tell`` is told the share that is driven."""
        drawn: list[Drawn] = []
        fewest, most = self._job.plan.draws.start, self._job.plan.draws.stop
        if not any(begun):
            return drawn
        while len(drawn) < fewest or (len(drawn) < most and not shows_signs(drawn)):
            tell(len(drawn) / most)
            seed = self.seed(len(drawn) + 1)
            stay, *others = self.renewed([self._traffic, *filter(None, begun)], seed, group)
            driven = iter(others)
            drawn.append(Drawn(seed, stay, [stay if branch is None else next(driven) for branch in begun]))
        return drawn

    def diverted(
        self, begun: RemoteTraffic, ways: tuple[Edges, Edges], seeds: Sequence[int], group: Sequence[str]
    ) -> list[Diverted]:
        """The futures in which others also take the ego's new route, in the scored draws."""
        found: list[Diverted] = []
        old, new = ways
        for share in self._job.plan.together if old else ():
            for draw, seed in enumerate(seeds):
                with closing(begun.branch()) as copy:
                    took, could = copy.call(divert, old, new, share, self.seed(0))
                    if draw:
                        copy.call(renew, fresh_of(self._simulation), seed)
                    self.begin(copy, group)
                    found.append(Diverted(share, draw, ended(copy), took, could))
        return found

    def shut(
        self, begun: RemoteTraffic, offered: int, own: Edges, seeds: Sequence[int], group: Sequence[str]
    ) -> list[Shut]:
        """The futures of the two routes with a road closed now, in the scored draws."""
        edge = self._job.plan.close
        if edge == AHEAD:  # in the middle of the section that the other route avoids
            edge = own[len(own) // 2] if len(own) > 2 else ""
        found: list[Shut] = []
        for draw, seed in enumerate(seeds if edge else ()):
            with ExitStack() as stack:
                copies = [stack.enter_context(closing(way.branch())) for way in (self._traffic, begun)]
                for copy in copies:
                    copy.call(stage, Closure(edge=edge))
                    if draw:
                        copy.call(renew, fresh_of(self._simulation), seed)
                    self.begin(copy, group)
                found.append(Shut(edge, draw, offered, *map(ended, copies)))
        return found

    def renewed(self, drives: Sequence[RemoteTraffic], seed: int, group: Sequence[str]) -> list[Future]:
        """The futures of copies with fresh random numbers, driven at the same time."""
        self.fresh = fresh_of(self._simulation)
        with ExitStack() as stack:
            copies = [stack.enter_context(closing(each.branch())) for each in drives]
            for copy in copies:
                copy.call(renew, self.fresh, seed)
                self.begin(copy, group)
            return [ended(copy) for copy in copies]

    def seed(self, draw: int) -> int:
        """The seed of a draw of the current decision."""
        entropy = (*self._job.entropy, 4, self.decisions, draw)
        return int(np.random.default_rng(entropy).integers(SEED_RANGE))

    def begin(self, branch: RemoteTraffic | None, group: Sequence[str]) -> None:
        """Starts driving it to its end."""
        if branch is not None:
            branch.begin(settle, [group], self._job.plan.arrived, self._job.plan.limit_s)


def ended(traffic: RemoteTraffic, progress: WarmUpProgress | None = None) -> Future:
    """The future of a drive that has begun to settle; ``progress`` is called as by ``RemoteTraffic.ended``."""
    settled: Settled = traffic.ended(progress)
    return Future(traffic.state, settled)


def own_choice_of(traffic: RemoteTraffic) -> tuple[str, ...]:
    """The route that SUMO's rerouting device would take now, from the present edge."""
    with closing(traffic.branch()) as copy:
        return copy.call(own_choice)


def close_all(branches: Iterable[RemoteTraffic | None]) -> None:
    """Ends them at once, even while they run."""
    for branch in filter(None, branches):
        branch.close()
