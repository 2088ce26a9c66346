"""Where do the futures of the first decision part? Needs --trajectories. python ways.py runs/jam"""

import sys
from pathlib import Path

import pandas as pd

track = pd.read_csv(sorted(Path(sys.argv[1], "trajectories").glob("*.csv.gz"))[0])
track = track[(track.id == track.id.iloc[0]) & (track.draw == 0) & ~track.is_placebo]
for branch, rows in track.groupby("branch", dropna=False):
    ways = rows.edge[~rows.edge.str.startswith(":")].drop_duplicates()
    name = "kept route" if pd.isna(branch) else f"branch {branch:.0f}"
    print(f"{name}: {len(rows)} steps, mean {rows.speed_mps.mean():.1f} m/s, by {', '.join(ways)}")
