"""Whole drives under a policy: the value of following it, not of a single deviation.

Every policy drives a copy of the traffic at the departure to its destination and reroutes wherever it wants to. It
is compared with the copy that keeps its route. With replicates, all of them are driven again with the same fresh
random numbers from the departure on.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from itertools import product

import numpy as np

from automotive_cosim.contracts import DrivingState, Reroute
from automotive_cosim.studies.calls.accounts import TrafficSummary
from automotive_cosim.studies.calls.chance import Fresh, renew
from automotive_cosim.studies.calls.ledger import others, settle
from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.driver import decided, drive_on
from automotive_cosim.studies.reroute.futures import ended, own_choice_of
from automotive_cosim.studies.reroute.plan import StudyJob
from automotive_cosim.studies.reroute.points import branched, exclusion
from automotive_cosim.studies.reroute.policies import Policy, PolicyRule, parse_policy
from automotive_cosim.studies.reroute.rows import NOBODY, NOTHING, Branch, WholeTrip
from automotive_cosim.traffic.chance import SEED_RANGE
from automotive_cosim.traffic.fork import RemoteTraffic

SAME = Branch(gains=NOTHING, totals=NOTHING, others=NOBODY)
"""A drive that never left the route equals the other drive, so it is not run to its end."""


def whole_drives(
    job: StudyJob, traffic: RemoteTraffic, fresh: Fresh | None, history: Sequence[TrafficSummary]
) -> tuple[WholeTrip, ...]:
    """Drives every policy but ``never`` and ``best`` from the departure to the destination.

    Args:
        fresh: how copies get fresh random numbers; None without replicates.
        history: measurements of the traffic so far."""
    policies = [parse_policy(text) for text in job.plan.policies]
    followed = [each for each in policies if each.rule not in (PolicyRule.NEVER, PolicyRule.BEST)]
    draws = 1 + job.plan.draws.start
    return tuple(
        drive
        for draw in range(draws)
        for drive in _drawn(job, followed, traffic, fresh if draw else None, draw, history)
    )


def _drawn(
    job: StudyJob,
    policies: Sequence[Policy],
    traffic: RemoteTraffic,
    fresh: Fresh | None,
    draw: int,
    history: Sequence[TrafficSummary],
) -> list[WholeTrip]:
    """All policies at every compliance with the same random numbers."""
    entropy = (*job.entropy, 5, draw)
    with closing(traffic.branch()) as start:
        if fresh is not None:
            start.call(renew, fresh, int(np.random.default_rng(entropy).integers(SEED_RANGE)))
        group, summary = start.call(others)
        made: list[tuple[Policy, float, int, Future | None]] = []
        for policy, compliance in product(policies, job.plan.compliance):
            with closing(start.branch()) as copy:
                reroutings = _follow(job, policy, compliance, copy, draw)
                made.append((policy, compliance, reroutings, _left(job, copy, group) if reroutings else None))
        stay = _left(job, start, group) if any(future is not None for *_, future in made) else None
    drives = []
    for policy, compliance, reroutings, future in made:
        excluded = why = ""
        branch = SAME
        if future is not None and stay is not None:
            excluded, why = exclusion([(stay, future)], [*history, summary])
            branch = branched(stay, future, group)
        drives.append(
            WholeTrip(
                policy=policy.text,
                compliance=compliance,
                draw=draw,
                reroutings=reroutings,
                branch=branch,
                excluded=excluded,
                why=why,
            )
        )
    return drives


def _left(job: StudyJob, traffic: RemoteTraffic, group: Sequence[str]) -> Future:
    traffic.begin(settle, [group], job.plan.arrived, job.plan.limit_s)
    return ended(traffic)


def _follow(job: StudyJob, policy: Policy, compliance: float, traffic: RemoteTraffic, draw: int) -> int:
    """Drives under a policy with the newest news of the plan; returns how often it left its route."""
    draws = np.random.default_rng((*job.entropy, 6, draw))
    reroutings = 0

    def decide(now: DrivingState) -> bool:
        nonlocal reroutings
        if draws.random() >= compliance:
            return True
        before = now.ahead.route_edges
        if policy.agent:
            decided(policy.agent, job, traffic)
            after = traffic.state.ahead.route_edges
            reroutings += before[-len(after) :] != after
            return True
        edges = _wanted(policy, traffic, job.plan.ages_s[0])
        if edges is None or edges == before:
            return edges is not None
        reroutings += traffic.request(Reroute(edges=edges)).accepted
        return True

    drive_on(traffic, job.plan, decide)
    return reroutings


def _wanted(policy: Policy, traffic: RemoteTraffic, age_s: float) -> tuple[str, ...] | None:
    """The route that a policy takes now; None if there is no other."""
    if policy.rule is PolicyRule.SUMO:
        return own_choice_of(traffic)
    options = traffic.alternatives(age_s)
    if len(options) < 2:
        return None
    stay, offered = options[:2]
    return offered.edges if policy.leaves(stay.eta_s, stay.delay_s, offered.eta_s) else stay.edges
