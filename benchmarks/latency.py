"""Success against the seconds that each step takes, for each thing that hurries: a table, and a curve as SVG.

automotive-cosim eval --agents oracle --suite live --clock fixed --latency 0.5,2,5,15,40 --out runs/latency
python -m benchmarks.latency runs/latency docs/images/latency.svg
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Mapping
from math import log
from pathlib import Path

from automotive_cosim.formats.writing import write_whole
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.store import read_rows
from automotive_cosim.tasking.task import Hurry
from automotive_cosim.tasks import CATALOGUE

WIDTH, HEIGHT, EDGE = 520, 240, 44
COLOURS = {"all": "#333", Hurry.ROAD: "#0b63ce", Hurry.CALL: "#b06200", Hurry.WORDS: "#0e7a45"}
Rates = Mapping[str, Mapping[float, float]]
"""Share of episodes won, by what hurries and by the seconds of a step."""


def rates(folder: Path) -> Rates:
    """What a folder of an evaluation holds; episodes that were not run count for nothing."""
    won: dict[str, dict[float, list[bool]]] = defaultdict(lambda: defaultdict(list))
    for row in read_rows(folder, EpisodeRow).values():
        if row.error is not None:
            continue
        for name in ("all", str(CATALOGUE[row.task].hurries)):
            won[name][row.conditions.latency_s].append(bool(row.success))
    return {
        name: {at_s: sum(of) / len(of) for at_s, of in sorted(by.items())}
        for name, by in sorted(won.items(), key=lambda each: list(COLOURS).index(each[0]))
    }


def table(found: Rates) -> str:
    """The same in Markdown, in per cent."""
    steps = list(found["all"])
    head = f"| | {' | '.join(f'{at_s:g} s' for at_s in steps)} |\n|---|{'---:|' * len(steps)}"
    lines = (f"| {name} | {' | '.join(f'{100 * by[at_s]:.0f}' for at_s in steps)} |" for name, by in found.items())
    return "\n".join((head, *lines))


def curve(found: Rates) -> str:
    """The same as a picture, with the seconds on a logarithmic axis."""
    steps = list(found["all"])
    span = log(steps[-1] / steps[0])

    def x(at_s: float) -> float:
        return EDGE + (WIDTH - 2 * EDGE - 40) * log(at_s / steps[0]) / span

    def y(share: float) -> float:
        return HEIGHT - EDGE + 8 - (HEIGHT - EDGE - 12) * share

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif"'
        ' font-size="12">'
    ]
    for share in (0.0, 0.5, 1.0):
        parts.append(f'<path d="M{EDGE} {y(share):.0f}H{WIDTH - EDGE - 40}" stroke="#ccc"/>')
        parts.append(
            f'<text x="{EDGE - 6}" y="{y(share) + 4:.0f}" text-anchor="end" fill="#555">{100 * share:.0f} %</text>'
        )
    parts += [
        f'<text x="{x(at_s):.0f}" y="{HEIGHT - 18}" text-anchor="middle" fill="#555">{at_s:g} s</text>'
        for at_s in steps
    ]
    parts.append(
        f'<text x="{WIDTH / 2:.0f}" y="{HEIGHT - 3}" text-anchor="middle" fill="#555">'
        "seconds that each step takes</text>"
    )
    for name, by in found.items():
        points = " ".join(f"{x(at_s):.0f},{y(share):.0f}" for at_s, share in by.items())
        colour = COLOURS[name]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
    ends = sorted((by[steps[-1]], name) for name, by in found.items())
    low = HEIGHT
    for share, name in ends:
        low = min(low - 14, round(y(share)) + 4)
        parts.append(f'<text x="{x(steps[-1]) + 6:.0f}" y="{low}" fill="{COLOURS[name]}">{name}</text>')
    return "\n".join([*parts, "</svg>", ""])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="of the evaluation")
    parser.add_argument("picture", type=Path, help="SVG to write")
    told = parser.parse_args()
    seen = rates(told.folder)
    print(table(seen))
    write_whole(told.picture, curve(seen))
