"""Who pays for the ego's gain? python who_pays.py runs/jam"""

import sys

import pandas as pd

frame = pd.read_csv(f"{sys.argv[1]}/futures.csv")
branches = frame[frame.branch.notna()]
for name, chosen in {"gains": branches.gain_time_s > 0, "loses": branches.gain_time_s < 0}.items():
    rows = branches[chosen]
    if rows.empty:
        continue
    print(
        f"the ego {name}: {len(rows)} futures, mean {rows.gain_time_s.mean():+.1f} s; the others together "
        f"{rows.others_gain_s.mean():+.1f} s, of whom {rows.others_changed.mean():.0f} arrive at another time"
    )
