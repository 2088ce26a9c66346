"""What is a policy worth from departure to destination? Needs --whole-drives. python policy.py runs/jam"""

import sys

import pandas as pd

frame = pd.read_csv(f"{sys.argv[1]}/whole_drives.csv", keep_default_na=False)
counted = frame[frame.excluded == ""]
figures = ["reroutings", "gain_time_s", "gain_distance_m"]
print(counted.groupby(["policy", "compliance"])[figures].mean().round(1).to_string())
