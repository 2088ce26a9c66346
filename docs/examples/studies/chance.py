"""How much of a gain is chance? Needs --replicates. python chance.py runs/jam"""

import sys

import pandas as pd

frame = pd.read_csv(f"{sys.argv[1]}/futures.csv")
branches = frame[frame.branch.notna()].groupby(["id", "branch"]).gain_time_s.agg(["mean", "std", "count"])
branches = branches[branches["count"] > 1]
print(f"{len(branches)} branches, each driven {branches['count'].min()} to {branches['count'].max()} times")
print(f"standard deviation of a gain within a decision: {(branches['std'] ** 2).mean() ** 0.5:.1f} s")
print(f"of the mean gains between decisions: {branches['mean'].std():.1f} s")
