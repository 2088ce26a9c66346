"""One drive of a study, and the branches forked from it at each decision point.

The drive itself is the future in which the ego keeps its route. All its decisions share it, so a drive with five
decisions takes one future and five branches, not ten futures. A branch is a fork of the running simulation: bit
for bit the same traffic, and the same random numbers from there on. A replicate drives all futures of a decision
once more, with fresh random numbers from the decision on.
"""

import os
from collections import deque
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import DrivingState, Reroute, RouteOption
from automotive_cosim.errors import NoRoomError
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.run.executor import doing
from automotive_cosim.studies.calls.accounts import TrafficSummary
from automotive_cosim.studies.calls.chance import fresh_of
from automotive_cosim.studies.calls.divert import section
from automotive_cosim.studies.calls.ledger import account, others, settle
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.driver import decided, drive_on
from automotive_cosim.studies.reroute.futures import Futures, close_all, ended, own_choice_of
from automotive_cosim.studies.reroute.live import LiveTrip
from automotive_cosim.studies.reroute.plan import StudyJob
from automotive_cosim.studies.reroute.points import Diverted, Point, Shut, compared
from automotive_cosim.studies.reroute.policies import PolicyRule, parse_policy
from automotive_cosim.studies.reroute.rows import Decision, News, TripRow
from automotive_cosim.studies.reroute.tracks import write_tracks
from automotive_cosim.studies.reroute.whole import whole_drives
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked, RemoteTraffic

SAME_PLACE = "start is goal"
NO_ROOM = "no room to enter"
NO_CONGESTION = "no congestion met"
NO_ALTERNATIVE = "no alternative"
"""Reasons to exclude a drive from the averages."""

LEAVES_OUT = "leaves out a stop"
"""Reason to exclude a decision. Only an agent's route can; all others are searched through the trip's ``via``."""

DECIDING = 0.5
"""Share of a drive's time until its last decision; the rest drives every future to its end."""

AT_ONCE = os.cpu_count() or 1
"""Decisions whose branches may run while the drive continues; each takes some 50 MB per branch."""


def run_drive(
    job: StudyJob,
    simulation: Forked,
    history: Sequence[TrafficSummary],
    tracks: Path | None = None,
    study: Path | None = None,
) -> TripRow:
    """Runs a drive, branches at every decision point, and compares the futures.

    Args:
        simulation: its traffic at the ego's departure, watched.
        history: measurements of the traffic so far, ``gridlock.MEASURED_EVERY_S`` apart.
        tracks: folder for the ego's tracks in a simulation that keeps them; None leaves them out.
        study: the study's folder, in which it can be watched; None if it cannot.

    Raises:
        TrafficError: the simulation failed.
        UserError: the scenario or an agent cannot be used."""
    row = job.planned()
    if job.trip.from_edge == job.trip.to_edge and not job.trip.via:
        return replace(
            row, excluded=SAME_PLACE, why=f"trip {job.trip.name!r} begins and ends on {job.trip.to_edge}"
        )
    try:
        traffic = depart(job, simulation)
    except NoRoomError as error:
        return replace(row, excluded=NO_ROOM, why=str(error))
    with closing(traffic):
        if job.plan.whole_drives:
            fresh = fresh_of(simulation) if job.plan.draws.stop else None
            row = replace(row, fresh=fresh, whole=whole_drives(job, traffic, fresh, history))
        live = LiveTrip(job, traffic, study)
        with closing(live), closing(_Drive(job, traffic, simulation, live)) as drive:
            drive.go()
            if not drive.points:
                excluded, why = drive.why_not()
                return replace(row, looks=drive.looks, excluded=excluded, why=why)
            traffic.begin(settle, [point.group for point in drive.points], job.plan.arrived, job.plan.limit_s)
            stay = drive.finish()
            decisions = tuple(compared(point, stay, history) for point in drive.points)
            live.over(decisions)
    if tracks is not None:
        write_tracks(tracks, job.id, stay, drive.points)
    return replace(
        row, looks=drive.looks, fresh=drive.futures.fresh or row.fresh, stay=stay.totals(), decisions=decisions
    )


def depart(job: StudyJob, simulation: Forked) -> RemoteTraffic:
    """Starts the ego in the scenario's weather, or the one drawn for its place and month."""
    scenario = job.plan.scene(job.share)
    seed = int(np.random.default_rng([*job.entropy, 0]).integers(2**31))
    plan = EgoPlan(
        job.trip,
        scenario.ego.driver,
        seed,
        scenario.weather,
        scenario.start,
        emission_class=job.plan.ego_class,
        keeps_stops=job.plan.via == "stops",
    )
    traffic = simulation.depart(plan)
    if plan.weather:
        return traffic
    with closing(traffic):
        plan = replace(plan, weather=drawn_weather(traffic.state, scenario.start, seed))
    return simulation.depart(plan)


class _Drive:
    """The drive on its own route, up to its last decision."""

    def __init__(self, job: StudyJob, traffic: RemoteTraffic, simulation: Forked, live: LiveTrip) -> None:
        self.job = job
        self.traffic = traffic
        self._live = live
        self.futures = Futures(job, traffic, simulation)
        self.points: list[Point] = []
        self.looks = 0
        """Number of instants with congestion ahead but no alternative route."""
        self._draws = np.random.default_rng([*job.entropy, 1])
        self._running: deque[tuple[Point, Sequence[RemoteTraffic | None]]] = deque()
        """Decisions whose branches are still being driven; None stands for the drive itself."""
        self._rules = {parse_policy(text).rule for text in job.plan.policies}
        self._most_delay_s = 0.0
        self._way_m = max(1.0, traffic.state.ahead.route_left_m)
        self._settled = 0.0
        """The share of the vehicles that has arrived in the future that is farthest."""

    def go(self) -> None:
        """Drives and decides until the drive or its decisions are over."""
        plan = self.job.plan
        self._most_delay_s = drive_on(self.traffic, plan, self._decide, plan.per_drive, self._advance)

    def finish(self) -> Future:
        """Waits for all futures; returns that in which the ego keeps its route, which has begun to settle."""
        self._wait()
        return self._ended(self.traffic)

    def _wait(self, but: int = 0) -> None:
        """Waits for the branches of all decisions, or of all but the given number."""
        while len(self._running) > but:
            point, branches = self._running[0]
            point.branches = [None if branch is None else self._ended(branch) for branch in branches]
            close_all(branches)
            self._running.popleft()
            self._live.driven(point.branches)

    def _ended(self, traffic: RemoteTraffic) -> Future:
        """Waits for a future. All run at the same time: what one said while another was waited for is past."""

        def tell(done: float, total: float) -> None:
            part = done / total if total else 1.0
            if part >= self._settled:
                self._settled, amount = part, f"{done:.0f} of {total:.0f} vehicles arrived"
                doing("driving every route to its end", amount, share=DECIDING + (1 - DECIDING) * part)

        return ended(traffic, tell)

    def _advance(self, duration_s: float) -> None:
        self._tell("driving to the next decision")
        self._live.advance(duration_s)

    def _tell(self, what: str, part: float = 0.0) -> None:
        """Says how far the drive is: by its decisions, and the part of one that is done, or by its way."""
        decided = (len(self.points) + part) / self.job.plan.per_drive
        driven = 1 - self.traffic.state.ahead.route_left_m / self._way_m
        doing(what, share=DECIDING * min(1.0, max(decided, driven, 0.0)))

    def close(self) -> None:
        """Ends the branches that are still being driven."""
        while self._running:
            close_all(self._running.popleft()[1])

    def why_not(self) -> tuple[str, str]:
        """The reason why there was no decision at all, with its figures."""
        if self.looks:
            return NO_ALTERNATIVE, f"at {self.looks} instants with congestion ahead"
        least_s, most_s = self.job.plan.least_delay_s, self._most_delay_s
        return NO_CONGESTION, f"at most {most_s:.0f} s of delay ahead; {least_s:g} s are required"

    def _decide(self, now: DrivingState) -> bool:
        """Runs the branches of a decision; false if there is no decision here."""
        plan, traffic, futures = self.job.plan, self.traffic, self.futures
        news = {age_s: traffic.alternatives(age_s) for age_s in plan.ages_s}
        own = own_choice_of(traffic) if PolicyRule.SUMO in self._rules else now.ahead.route_edges
        ways = _ways(now, news, own)
        if not ways and not plan.agents:
            self.looks += 1
            return False
        group, summary = traffic.call(others)
        numbers: dict[tuple[str, ...], int] = {}
        agents: dict[str, int] = {}
        turned: list[str] = []
        with ExitStack() as stack:
            begun: list[RemoteTraffic | None] = []
            taken = [now.ahead.route_edges]
            for edges in ways:
                branch = traffic.branch()
                stack.callback(branch.close)
                if branch.request(Reroute(edges=edges)).accepted:  # otherwise it is too late to take it
                    numbers[edges] = len(begun)
                    begun.append(branch)
                    taken.append(edges)
                else:
                    branch.close()
            for agent in plan.agents:
                branch = traffic.branch()
                stack.callback(branch.close)
                decided(agent, self.job, branch)
                agents[agent] = len(begun)
                begun.append(branch if branch.is_steered else None)
                if not branch.is_steered:
                    branch.close()
                edges = branch.state.ahead.route_edges
                taken.append(edges)
                if now.ahead.route_edges[-len(edges) :] != edges:
                    turned.append(agent)
            if not begun:
                self.looks += 1
                return False
            what = f"driving the routes of decision {len(self.points) + 1}"
            self._tell(what)
            replicates = futures.replicates(begun, group, lambda part: self._tell(what, part))
            offered = next((number for edges, number in numbers.items() if edges == _offered(news)), None)
            diverted: list[Diverted] = []
            shut: list[Shut] = []
            if offered is not None and (other := begun[offered]) is not None and not self.points:
                ways_apart = section(now.ahead.route_edges, _offered(news))
                seeds = [0, *(each.seed for each in replicates[: plan.draws.start])]
                diverted = futures.diverted(other, ways_apart, seeds, group)
                shut = futures.shut(other, offered, ways_apart[0], seeds, group)
            for other in begun:
                futures.begin(other, group)
            stack.pop_all()  # they are driven while the drive continues
        stops = (*(self.job.trip.via if plan.via == "stops" else ()), self.job.trip.to_edge)
        missed = [stop for way in taken[1:] for stop in left_out(taken[0], way, stops)]
        decision = Decision(
            excluded=LEAVES_OUT if missed else "",
            why=f"a route does not pass {missed[0]}" if missed else "",
            lost_s=round(traffic.call(account).lost_s, 3),
            at_s=now.time_s,
            edge=now.road.edge_id,
            delay_s=round(now.ahead.delay_s, 1),
            eta_s=round(now.ahead.eta_s, 1),
            relative_speed=round(now.ahead.relative_speed, 3),
            complies_above=float(self._draws.random()),
            news=tuple(self._told(age_s, options, numbers) for age_s, options in news.items()),
            ways=tuple(taken),
            own=numbers.get(own),
            agents=agents,
            agents_rerouted=tuple(turned),
            planned_draws=1 + plan.draws.start if replicates else 1,
        )
        point = Point(decision, group, summary, replicates=replicates, together=diverted, shut=shut)
        self._live.decided(decision)
        self._running.append((point, begun))
        self._wait(but=AT_ONCE)
        if not self.points and self._has_placebo() and not plan.draws.stop:
            (point.placebo,) = futures.renewed([traffic], futures.seed(1), group)
        self.points.append(point)
        futures.decisions += 1
        return True

    def _told(self, age_s: float, options: Sequence[RouteOption], numbers: dict[tuple[str, ...], int]) -> News:
        """What news of that age says about the current route and the quickest alternative."""
        offered = options[1] if len(options) > 1 else None
        return News(
            age_s=age_s,
            stay_s=round(options[0].eta_s, 1) if options else None,
            delay_s=round(options[0].delay_s, 1) if options else 0.0,
            offered_s=None if offered is None else round(offered.eta_s, 1),
            branch=None if offered is None else numbers.get(offered.edges),
        )

    def _has_placebo(self) -> bool:
        """Drawn randomly, so that it does not depend on the results of other drives."""
        every = self.job.plan.placebo_every
        return every > 0 and self._draws.random() < 1 / every


def left_out(route: Sequence[str], way: Sequence[str], stops: Sequence[str]) -> list[str]:
    """The stops still ahead on a route that another one, which may begin later on it, does not pass."""
    driven = route[: route.index(way[0])] if way and way[0] in route else ()
    return [stop for stop in stops if stop in route and stop not in driven and stop not in way]


def _offered(news: dict[float, tuple[RouteOption, ...]]) -> tuple[str, ...]:
    """The quickest other route by the newest news of the plan; empty without one."""
    options = next(iter(news.values()))
    return options[1].edges if len(options) > 1 else ()


def _ways(
    now: DrivingState, news: dict[float, tuple[RouteOption, ...]], own: tuple[str, ...]
) -> list[tuple[str, ...]]:
    """Every other route that some policy may choose, once."""
    offered = [options[1].edges for options in news.values() if len(options) > 1]
    return [edges for edges in dict.fromkeys([*offered, own]) if edges and edges != now.ahead.route_edges]
