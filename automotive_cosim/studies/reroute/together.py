"""The cost when many cars take the other route at the same fork."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from automotive_cosim.studies.reroute.compare import Future
from automotive_cosim.studies.reroute.rows import Together


def together(
    share: float,
    draw: int,
    pair: tuple[Future, Future],
    group: Sequence[str],
    took: Sequence[str],
    could: int,
    excluded: str,
) -> Together:
    """Savings of the ego, of the cars rerouted with it, and of all the rest.

    Args:
        share: share of the eligible cars that were rerouted with the ego.
        draw: number of the draw.
        pair: the future in which everyone keeps their route, and the one in which they do not.
        group: the other vehicles that were present.
        took: those that were rerouted with the ego.
        could: how many were eligible.
        excluded: why the future does not count.
    """
    stay, other = pair
    until_s = min(future.settled.time_s for future in pair)
    went = set(took)

    def gains_s(who: Sequence[str]) -> Iterator[float]:
        for vehicle in who:
            before_s, after_s = (min(future.settled.arrivals_s.get(vehicle, until_s), until_s) for future in pair)
            yield before_s - after_s

    return Together(
        share=share,
        draw=draw,
        could=could,
        took=len(took),
        ego_gain_s=round(stay.totals().time_s - other.totals().time_s, 3),
        took_gain_s=round(sum(gains_s(took)), 3),
        rest_gain_s=round(sum(gains_s([vehicle for vehicle in group if vehicle not in went])), 3),
        excluded=excluded,
    )
