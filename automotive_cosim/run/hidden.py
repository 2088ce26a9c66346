"""The hidden split: seeds and places drawn from a key that an organiser publishes only afterwards.

A seed draws phrasing, parameters, content, weather, driver and traffic (``tasking.draws``), so that without the key
nobody can tell any of them. The drawn plan lists its trials, as any plan can: who has a bundle needs no key.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from automotive_cosim import scenarios
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import open_file
from automotive_cosim.interface.trace import canonical
from automotive_cosim.run.plan import Plan, PlannedTrial
from automotive_cosim.run.settings import HIDDEN
from automotive_cosim.tasking.draws import keyed

COMMITTED = ("key_sha256", "drawn_sha256")
"""What is published before."""
LEAST, MOST = 16, 1024
"""Bytes of a key."""


def read_key(path: Path) -> bytes:
    """The key in a file, without the line break at its end.

    Raises UserError: it cannot be read, or is too short to be secret or too long for a key."""
    try:
        with open_file(path) as file:
            key = file.read(MOST + 3).rstrip(b"\r\n")
    except OSError as error:
        raise UserError(f"cannot read the key in {path}: {error.strerror or error}") from error
    if not LEAST <= len(key) <= MOST:
        size = f"more than {MOST}" if len(key) > MOST else len(key)
        raise UserError(f"{path} has {size} bytes; a key has {LEAST} to {MOST}, as `openssl rand -hex 32` makes")
    return key


def drawn(plan: Plan, key: bytes) -> Plan:
    """The same agents, conditions and limits on trials that the key draws: each task or drive once for each of the
    plan's seeds, in a seed that the key gives in place of it, and each task in one of the places where it can run.

    Raises UserError: the plan is not one of the hidden split, or lists trials itself."""
    if plan.split != HIDDEN or plan.trials:
        raise UserError(f"a key draws the runs of --split {HIDDEN}, of a plan that lists none; give both or no key")
    return replace(
        plan, tasks=(), drives=(), scenarios=(), seeds=(0,), everywhere=False, trials=tuple(_drawn(plan, key))
    )


def commitment(key: bytes, plan: Plan) -> tuple[str, str]:
    """SHA-256 of the key, and of the key with the drawn trials: to be published before anything runs."""
    trials = canonical(plan.as_json()["trials"])
    return hashlib.sha256(key).hexdigest(), hashlib.sha256(key + b"\n" + trials).hexdigest()


def _drawn(plan: Plan, key: bytes) -> Iterator[PlannedTrial]:
    for asked in plan.seeds:
        seed = keyed(key, "seed", str(asked))
        for task in plan.spoken():
            places = plan.scenarios or ("", *filter(task.runs_whole_in, scenarios.shipped()))
            there = [name for name in places if not name or plan.everywhere or task.runs_whole_in(name)]
            place = there[keyed(key, "place", str(asked), task.id) % len(there)] if there else None
            if place is not None:
                own = (place,) if place else ()
                yield from replace(plan, tasks=(task.id,), drives=(), scenarios=own, seeds=(seed,)).unfolded()
        if plan.drives:
            yield from replace(plan, tasks=(), seeds=(seed,)).unfolded()
