"""The detection-response task of ISO 17488:2016, which a study with people may ask of them beside the cockpit.

A red dot appears every 3 to 5 s, for a second at most, and the person answers it with a key. Answers from 100 to
2,500 ms count: slower ones, and those that come too soon to be answers, are no hits. The longer the reactions and
the fewer the hits, the more the cockpit asks of the person; while the car drives to the place where the driver
speaks, nothing is asked, and what is measured then is the person's own figure to compare with.
"""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError

EVERY_MS, SHOWN_MS = (3000, 5000), 1000
"""From one onset to the next, drawn uniformly; and how long a stimulus is shown if nobody answers it."""
VALID_MS = (100, 2500)
"""Reactions that count."""
PHASES = ("rest", "task")
"""While the car drives to the situation, and while the person operates the cockpit."""
TOLD: Json = {"every_ms": EVERY_MS, "shown_ms": SHOWN_MS, "valid_ms": VALID_MS}
"""What the page is told."""
FIGURES = ("stimuli", "hits", "hit_rate", "reaction_ms")


def detected(asked: Json) -> Json:
    """What came of a stimulus, as the page sends it: the phase, and the reaction in ms, None if there was none.

    Raises UserError: it is something else."""
    phase, reaction_ms = asked.get("phase"), asked.get("reaction_ms")
    is_reaction = isinstance(reaction_ms, (int, float)) and not isinstance(reaction_ms, bool)
    if phase not in PHASES or not (reaction_ms is None or (is_reaction and 0 <= reaction_ms <= EVERY_MS[0])):
        raise UserError(
            f"phase {phase!r} with reaction_ms {reaction_ms!r} is no reaction; give {' or '.join(PHASES)}, and "
            f"null or 0 to {EVERY_MS[0]} ms"
        )
    return {"phase": phase, "reaction_ms": reaction_ms and round(reaction_ms, 1)}


def figures(events: Sequence[Json], phase: str) -> Json:
    """Stimuli of a phase, hits, their share, and the mean reaction of hits in ms."""
    reactions = [event["reaction_ms"] for event in events if event["phase"] == phase]
    hits = [each for each in reactions if each is not None and VALID_MS[0] <= each <= VALID_MS[1]]
    return {
        "stimuli": len(reactions),
        "hits": len(hits),
        "hit_rate": round(len(hits) / len(reactions), 3) if reactions else None,
        "reaction_ms": round(fmean(hits), 1) if hits else None,
    }
