"""What does each policy gain, and how sure is that? python gain.py runs/jam"""

import sys

import numpy as np
from scipy import stats

from automotive_cosim.studies import load_study

frame = load_study(sys.argv[1])
for policy, rows in frame.groupby("policy"):
    means = rows.groupby("seed").gain_time_s.mean()  # decisions of one seed are not independent
    reach = stats.t.ppf(0.975, len(means) - 1) * means.std() / np.sqrt(len(means)) if len(means) > 1 else np.nan
    print(f"{policy:20} {means.mean():+7.1f} s ± {reach:.1f}, {len(rows)} decisions of {len(means)} seeds")
