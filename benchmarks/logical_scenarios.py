"""Shows that each scenario of the library occurs: drives of its space, nominal but for place and seed.

    python -m benchmarks.logical_scenarios [--only cut-in,tunnel] [--tries 6] [--minutes 3]

Nobody acts on these drives. A scenario has occurred when an event of its kind required an act, or when the road
told of it in its words.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from itertools import islice, product
from time import perf_counter

from automotive_cosim.agents import make_agent
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.errors import InfrastructureError
from automotive_cosim.run.drive import DriveObserver, run_drive
from automotive_cosim.run.jobs import DriveJob, Limits
from automotive_cosim.safety.space import LIBRARY, FactorChoices, SearchPoint, Space, read_space
from automotive_cosim.safety.trying import trial_of
from automotive_cosim.traffic.fork import Simulations

AGENT = "silent"


@dataclass
class Told(DriveObserver):
    """Keeps what the road told."""

    texts: list[str] = field(default_factory=list)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        self.texts += [event.text for event in moment.events]


def points(space: Space) -> Iterator[SearchPoint]:
    """Nominal but for place and seed: every place with a seed before the next seed."""
    places, seeds = space.factor("drive"), space.factor("seed")
    assert isinstance(places, FactorChoices)
    for seed, place in product(seeds.values if isinstance(seeds, FactorChoices) else range(10), places.values):
        yield {**space.nominal, "drive": place, "seed": seed}


def occurred(space: Space, point: SearchPoint, minutes: float | None, simulations: Simulations) -> str:
    """How it occurred; empty if it did not."""
    trial = trial_of(point if minutes is None else {**point, "minutes": minutes})
    job = trial.job(AGENT, "none", 0, Limits(), ())
    assert isinstance(job, DriveJob)
    told = Told()
    row = run_drive(job.planned(), job.setup, make_agent(AGENT), simulations=simulations, observers=[told]).row
    events = [event for event in row.events if event.kind == space.occurs and event.outcome.counts]
    if events:
        return f"{space.occurs} {events[0].outcome}, {events[0].words}"
    return next((text for text in told.texts if space.occurs in text), "")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default=",".join(LIBRARY), help="spaces, with commas between them")
    parser.add_argument("--tries", type=int, default=6, help="most drives for each")
    parser.add_argument("--minutes", type=float, help="of each drive; without it, as the space says")
    given = parser.parse_args()
    print("| scenario | drives | where it occurred | how | s |")
    print("|---|---:|---|---|---:|")
    missing = []
    with closing(Simulations(count_limit=4)) as simulations:
        for name in given.only.split(","):
            space, began_s, how, where, tried = read_space(LIBRARY[name]), perf_counter(), "", "", 0
            for point in islice(points(space), given.tries):
                tried += 1
                try:
                    how = occurred(space, point, given.minutes, simulations)
                except InfrastructureError as error:
                    where = f"{point['drive']}: {error}"
                    continue
                if how:
                    where = f"{point['drive']}, seed {int(point['seed'])}"
                    break
            missing += [] if how else [name]
            print(f"| {name} | {tried} | {where} | {how or 'not'} | {perf_counter() - began_s:.0f} |", flush=True)
    print(f"\n{len(given.only.split(',')) - len(missing)} occurred; not: {', '.join(missing) or 'none'}")


if __name__ == "__main__":
    main()
