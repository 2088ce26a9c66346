"""Time and memory of an import by the size of the map, on street grids written by this script.

    python benchmarks/large_imports.py --edges 2000 10000 20000 50000

A grid has blocks of 120 m: residential streets, every fifth street a secondary road, every tenth a primary road
with signals where two of them cross, one street in four with one direction. Each import is a process of its own,
with ``--quick``; the memory is the largest resident set of that process or of one of its children (netconvert,
duarouter, sumo).
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

ORIGIN = (8.0, 49.0)
"""Longitude and latitude of the corner."""

BLOCK_M = 120.0
EDGES_PER_CROSSING = 3.5
"""Two streets meet at each crossing; a quarter of them has one direction."""


def grid(edges: int) -> Iterator[str]:
    """The lines of an OSM file with about so many edges for cars."""
    side = max(2, round(math.sqrt(edges / EDGES_PER_CROSSING)))
    east = BLOCK_M / (111_200 * math.cos(math.radians(ORIGIN[1])))
    north = BLOCK_M / 111_200
    yield '<?xml version="1.0" encoding="UTF-8"?>\n<osm version="0.6" generator="large_imports.py">\n'
    for row in range(side):
        for column in range(side):
            place = f'lat="{ORIGIN[1] + row * north:.7f}" lon="{ORIGIN[0] + column * east:.7f}"'
            number = 1 + row * side + column
            if row % 10 == column % 10 == 0:
                yield f'<node id="{number}" {place}><tag k="highway" v="traffic_signals"/></node>\n'
            else:
                yield f'<node id="{number}" {place}/>\n'
    way = 0
    for along in (0, 1):
        for line in range(side):
            kind = "primary" if line % 10 == 0 else "secondary" if line % 5 == 0 else "residential"
            one_way = ("yes", "-1")[line % 8 // 4] if line % 4 == 2 else ""
            for first in range(0, side - 1, 8):
                way += 1
                last = min(first + 8, side - 1)
                numbers = (
                    1 + (line * side + place if along == 0 else place * side + line)
                    for place in range(first, last + 1)
                )
                yield f'<way id="{way}">' + "".join(f'<nd ref="{number}"/>' for number in numbers)
                yield f'<tag k="highway" v="{kind}"/><tag k="name" v="Street {along}-{line}"/>'
                yield f'<tag k="oneway" v="{one_way}"/>' if one_way else ""
                yield "</way>\n"
    yield "</osm>\n"


def measured(edges: int, folder: Path) -> dict[str, float]:
    """One import: edges built, seconds of this core's time and of the wall, and megabytes."""
    source, out = folder / f"grid{edges}.osm", folder / f"grid{edges}"
    with source.open("w", encoding="utf-8") as file:
        file.writelines(grid(edges))
    started_s = time.monotonic()
    code = "from automotive_cosim.cli.main import main; main()"
    command = [sys.executable, "-c", code, "scenarios", "import", str(source), "--quick", "--out", str(out)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"the import of {edges} edges ended with status {status}")
    report = json.loads((out / "import.json").read_text(encoding="utf-8"))
    return {
        "edges": report["edges"],
        "wall_s": round(time.monotonic() - started_s, 1),
        "processor_s": round(used.ru_utime + used.ru_stime, 1),
        "memory_mb": round(used.ru_maxrss / 1024),
        "map_mb": round(source.stat().st_size / 1e6, 1),
    }


def main() -> None:
    """Prints one row for each size."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--edges", type=int, nargs="+", default=[2000, 10_000, 20_000])
    parser.add_argument("--write", type=Path, help="only write the map with the first number of edges")
    options = parser.parse_args()
    if options.write:
        with options.write.open("w", encoding="utf-8") as file:
            file.writelines(grid(options.edges[0]))
        return
    print("| edges | wall, s | processor, s | ms per edge | memory, MB |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        for edges in options.edges:
            row = measured(edges, Path(scratch))
            each_ms = 1000 * row["processor_s"] / row["edges"]
            print(
                f"| {row['edges']:,} | {row['wall_s']:.0f} | {row['processor_s']:.0f} | {each_ms:.1f} |"
                f" {row['memory_mb']:,.0f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
