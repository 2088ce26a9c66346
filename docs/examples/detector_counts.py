"""Counts of SUMO's induction loops, for `scenarios calibrate`.

python detector_counts.py DETECTORS.add.xml OUTPUT.xml > counts.csv

Prints one row per edge and hour: the vehicles of all lanes, of one loop on each lane.
"""

import sys
import xml.etree.ElementTree as ET
from collections import Counter, defaultdict

lanes = {each.get("id"): each.get("lane") for each in ET.parse(sys.argv[1]).iter("e1Detector")}
loops = defaultdict(list)  # by edge and position; two loops one behind the other count the same vehicles
for loop, lane in sorted(lanes.items()):
    loops[lane].append(loop)
first = {names[0]: lane.rpartition("_")[0] for lane, names in loops.items()}
counts = Counter()
for interval in ET.parse(sys.argv[2]).iter("interval"):
    if interval.get("id") in first:
        hour = int(float(interval.get("begin")) // 3600)
        counts[first[interval.get("id")], hour] += int(interval.get("nVehContrib"))
print("site,edge,hour,vehicles_per_hour")
for (edge, hour), count in sorted(counts.items()):
    print(f"{edge},{edge},{hour},{count}")
