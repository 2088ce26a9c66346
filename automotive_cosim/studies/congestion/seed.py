"""One seed of a congestion study: its traffic is warmed up once, and copied for no intervention and for each.

All copies start from the same instant with the same random numbers, so they differ by the intervention alone.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import partial
from pathlib import Path

from automotive_cosim.run.batch import BatchKind
from automotive_cosim.run.executor import alone, doing, warming_up
from automotive_cosim.studies.calls.flow import FlowSummary, flow, take
from automotive_cosim.studies.calls.ledger import keep_ledger
from automotive_cosim.studies.congestion.outputs import EDGES, EdgeFlow, cells, class_in, read_flows, write_edges
from automotive_cosim.studies.congestion.plan import (
    EPOCH_S,
    INTERVAL_S,
    CongestionJob,
    CongestionPlan,
    intervention_in,
)
from automotive_cosim.studies.congestion.rows import (
    CongestionRow,
    Emitted,
    FlowCell,
    FlowState,
    InterventionOutcome,
)
from automotive_cosim.studies.gridlock import gridlock
from automotive_cosim.traffic.fork import Forked, RemoteCopy
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import read_configuration


def run_seed(job: CongestionJob, folder: Path) -> CongestionRow:
    """Runs a seed; the flows on every edge are written into the study's folder."""
    plan = job.plan
    scenario = plan.scene()
    configuration = read_configuration(scenario.config)
    of = class_in(read_network(configuration.net))
    begin_s = configuration.begin_s + scenario.sumo.warm_up_s
    names = ("", *plan.interventions)
    outcomes: list[InterventionOutcome] = []
    edges: list[Sequence[EdgeFlow]] = []
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-flow-") as scratch, ExitStack() as stack:
        warm = Forked(
            scenario, job.seed, warming_up, allow_unprojected=True, outputs=Path(scratch), flow_s=INTERVAL_S
        )
        stack.enter_context(closing(warm))
        warm.call(keep_ledger, consumptions=plan.emissions)
        running: list[RemoteCopy] = []
        for name in names:
            copy = stack.enter_context(closing(warm.copy()))
            if name:
                copy.call(take, intervention_in(name, "--intervention"), job.seed)
            copy.begin(flow, plan.duration_s, INTERVAL_S)
            running.append(copy)
        tell = _teller()
        for name, copy in zip(names, running, strict=True):
            summaries: tuple[FlowSummary, ...] = copy.ended(tell)
            copy.close()
            assert copy.outputs is not None
            flows = list(read_flows(copy.outputs, begin_s, [each.slowed for each in summaries[1:]]))
            edges.append(flows)
            found = cells(flows, [each.queues for each in summaries[1:]], of)
            outcomes.append(_outcome(name, plan, found, summaries))
    write_edges(folder / EDGES, job.id, edges)
    return replace(job.planned(), outcomes=tuple(outcomes))


CONGESTION: BatchKind[CongestionPlan, CongestionJob, CongestionRow] = BatchKind(
    CongestionRow, partial(alone, run_seed), parts=(EDGES,)
)


def _teller() -> Callable[[float, float], None]:
    """Says how far the copies are, which run at the same time; what one said while another was awaited is old."""
    far_s = 0.0

    def tell(done_s: float, total_s: float) -> None:
        nonlocal far_s
        if done_s >= far_s:
            far_s, amount = done_s, f"{done_s:.0f} of {total_s:.0f} s"
            doing("driving the traffic with and without interventions", amount, share=done_s / total_s)

    return tell


def _outcome(
    name: str, plan: CongestionPlan, found: tuple[FlowCell, ...], summaries: Sequence[FlowSummary]
) -> InterventionOutcome:
    """An outcome from the flows and from the traffic's states, the first of which is that of the copy."""
    first = summaries[0]
    states = tuple(
        FlowState(
            at_s=number * INTERVAL_S,
            running=each.summary.running,
            backlog=each.summary.backlog,
            departed=each.summary.departed - first.summary.departed,
            arrived=each.arrived - first.arrived,
            teleported=each.summary.teleported - first.summary.teleported,
            collided=each.summary.collided - first.summary.collided,
        )
        for number, each in enumerate(summaries)
    )
    jam = gridlock([each.summary for each in summaries[:: round(EPOCH_S / INTERVAL_S)]])
    return InterventionOutcome(
        intervention=name,
        cells=found,
        states=states,
        emitted=tuple(_emitted(plan, summaries)),
        gridlock="" if jam is None else jam.why,
        cut_short=summaries[-1].cut_short - first.cut_short,
        kept_in=max(0, summaries[-1].kept_in - first.kept_in),
    )


def _emitted(plan: CongestionPlan, summaries: Sequence[FlowSummary]) -> Iterator[Emitted]:
    """What each class emitted in each period."""
    each_s = round(plan.period_s / INTERVAL_S)
    for period in range(len(plan.demand)):
        before, after = (summaries[number * each_s].consumed for number in (period, period + 1))
        for name, (_, *sums) in sorted(after.items()):
            _, *earlier = before.get(name, (0, 0.0, 0.0, 0.0, 0.0, 0.0))
            own = (round(one - two, 3) for one, two in zip(sums, earlier, strict=True))
            yield Emitted(name, *own, period=period)
