"""Fits the flows of candidate routes to counts, as near to a prior as the counts allow.

Among all flows that meet the counts, a linear programme returns a corner: as few routes as there are counts. This
takes the flows with the least relative entropy to the prior, so every candidate keeps a share. Counts are met
within a variance, since they contradict each other, and bounds hold roads to what they carry:

    minimize  sum(x log(x / p) - x + p) + sum((A x - c)^2 / 2 v)   subject to   B x <= b, within a variance too

Its dual has one variable for each count and bound and is smooth, so scipy's L-BFGS-B solves it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Floats = npt.NDArray[np.float64]

STEEPEST = 12.0
"""Largest multiplier, the logarithm of a count's factor on the prior. A count that would need more is an outlier,
and what is missing stays missing."""

MOST_STEPS = 500


@dataclass(frozen=True, slots=True)
class CountedFlows:
    """Counts of n candidate flows."""

    prior: Floats
    """(n,), above zero."""
    counted_by: csr_array
    """(m, n): share of each flow that each of m counts sees."""
    counts: Floats
    """(m,)."""
    variances: Floats
    """(m,)."""


def fit(problem: CountedFlows, bounded_by: csr_array, bounds: Floats) -> Floats:
    """The flows, (n,), all above zero.

    Args:
        bounded_by: (k, n), share of each flow that each of k bounds concerns."""
    from scipy.optimize import Bounds, minimize
    from scipy.sparse import vstack

    seen: Any = vstack([problem.counted_by, -bounded_by]).tocsr()
    targets = np.concatenate([problem.counts, -bounds])
    variances = np.concatenate([problem.variances, 0.01 * np.maximum(bounds, 1.0)])
    scale = 1 / np.sqrt(seen.power(2) @ problem.prior + variances)

    def flows(y: Floats) -> Floats:
        return np.asarray(problem.prior * np.exp(np.clip(seen.T @ (scale * y), -50.0, 50.0)))

    def dual(y: Floats) -> tuple[float, Floats]:
        x, multipliers = flows(y), scale * y
        value = x.sum() - multipliers @ targets + 0.5 * variances @ multipliers**2
        return float(value), np.asarray(scale * (seen @ x - targets + variances * multipliers))

    least = np.concatenate([np.full(len(problem.counts), -STEEPEST), np.zeros(len(bounds))])
    limits = Bounds(least / scale, STEEPEST / scale)
    found = minimize(
        dual, np.zeros(len(targets)), jac=True, method="L-BFGS-B", bounds=limits, options={"maxiter": MOST_STEPS}
    )
    return flows(found.x)
