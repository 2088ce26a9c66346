"""Success against the seconds that each step takes, for each thing that hurries: a table, and a curve as SVG.

python -m benchmarks.latency runs/latency.jsonl docs/images/latency.svg

The oracle plays each half of the suite ``live`` from one hand-over with every latency, as in ``eval --clock fixed
--latency``. Halves that the file has already are not played again.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import closing
from math import log
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.episode.session import driven, playing
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.proof.hand_over import Ground
from automotive_cosim.tasking.task import Hurry, Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

LATENCIES_S = (0.5, 2.0, 5.0, 15.0, 40.0)
WIDTH, HEIGHT, EDGE = 520, 240, 44
COLOURS = {"all": "#333", Hurry.ROAD: "#0b63ce", Hurry.CALL: "#b06200", Hurry.WORDS: "#0e7a45"}
Rates = Mapping[str, Mapping[float, float]]
"""Share of episodes won, by what hurries and by the seconds of a step."""


def played(task: Task, half: str, simulations: Simulations) -> Mapping[float, bool]:
    """By the seconds of a step, whether the oracle wins the half with seed 0."""
    found = {}
    with closing(Ground.reach(task, half, 0, simulations)) as ground:
        for latency_s in LATENCIES_S:
            with closing(ground.episode.branch()) as episode:
                driven(playing(episode, ground.oracle(), thought_s=lambda at_s=latency_s: at_s))
                found[latency_s] = episode.verdict is not None and episode.verdict.success
    return found


def rows(file: Path) -> Iterator[Mapping[str, Json]]:
    """What the file has, and then each half of the suite that it lacks, once it is played."""
    known = [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.is_file() else []
    yield from known
    done = {(row["task"], row["half"]) for row in known}
    hurried = [task for task in CATALOGUE.values() if task.hurries]
    hurried.sort(key=lambda task: task.half("first").start.scenario)
    with closing(Simulations(count_limit=4)) as simulations, file.open("a", encoding="utf-8") as kept:
        for task in hurried:
            for half in task.halves:
                if (task.id, half) not in done:
                    won = {str(at_s): each for at_s, each in played(task, half, simulations).items()}
                    row = {"task": task.id, "half": half, "won": won}
                    print(json.dumps(row), file=kept, flush=True)
                    yield row


def rates(file: Path) -> Rates:
    """Share of halves won."""
    won: dict[str, dict[float, list[bool]]] = defaultdict(lambda: defaultdict(list))
    for row in rows(file):
        for name in ("all", str(CATALOGUE[row["task"]].hurries)):
            for at_s, each in row["won"].items():
                won[name][float(at_s)].append(each)
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
    parser.add_argument("rows", type=Path, help="JSON lines, one for each half that was played")
    parser.add_argument("picture", type=Path, help="SVG to write")
    told = parser.parse_args()
    seen = rates(told.rows)
    print(table(seen))
    write_whole(told.picture, curve(seen))
