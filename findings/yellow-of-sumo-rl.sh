#!/bin/bash
# Seen with sumo-rl 1.4.5 on libsumo 1.28.0: yellow_time and min_green are seconds by the page of its API, and are counted
# in steps of SUMO. With --step-length 0.1 through additional_sumo_cmd, a yellow of 3 is three tenths of a second, and a
# green of at least 10 may end at the agent's next decision; delta_time, the time between decisions, is in seconds, whatever
# the step. A policy looks better with finer steps because it loses nothing at changes. One would expect seconds.
# Seen (how long the first green, yellow, green and yellow last, in s, if the agent changes its mind each 5 s):
#   steps of 1 s: 15 3.0 12 3.0
#   steps of 0.1 s: 5 0.3 5 0.3
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q sumo-rl==1.4.5 gymnasium==1.4.0 pettingzoo==1.27.0 eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="c" x="0" y="0" type="traffic_light"/><node id="w" x="-500" y="0"/><node id="e" x="500" y="0"/>
<node id="n" x="0" y="500"/><node id="s" x="0" y="-500"/></nodes>' > a.nod.xml
{
  echo '<edges>'
  for i in w e n s; do echo "<edge id='${i}c' from='$i' to='c'/><edge id='c$i' from='c' to='$i'/>"; done
  echo '</edges>'
} > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<routes><flow id="f" from="wc" to="ce" begin="0" end="60" period="6"/></routes>' > a.rou.xml
echo '<additional><timedEvent type="SaveTLSStates" source="c" dest="t.xml"/></additional>' > a.add.xml
cat > a.py << 'END'
import itertools
import re
from pathlib import Path

import sumo_rl

for step in ("1", "0.1"):
    env = sumo_rl.SumoEnvironment(
        "a.net.xml",
        "a.rou.xml",
        single_agent=True,
        num_seconds=60,
        delta_time=5,
        yellow_time=3,
        min_green=10,
        sumo_seed=1,
        sumo_warnings=False,
        additional_sumo_cmd=f"--step-length {step} --additional-files a.add.xml",
    )
    env.reset()
    for action in (0, 1) * 6:
        env.step(action)
    env.close()
    rows = re.findall(r'time="([\d.]+)".*? state="(\w+)"', Path("t.xml").read_text())
    begins = [float(next(group)[0]) for _, group in itertools.groupby(rows, key=lambda row: row[1])]
    first, yellow, second, other = (later - earlier for earlier, later in itertools.pairwise(begins[:5]))
    print(f"steps of {step} s: {first:.0f} {yellow:.1f} {second:.0f} {other:.1f}")
END
env SUMO_HOME="$(echo v/lib/python3*/site-packages/sumo)" LIBSUMO_AS_TRACI=1 v/bin/python -W ignore a.py 2> /dev/null | grep ^steps | tee seen.txt
printf '%s\n' 'steps of 1 s: 15 3.0 12 3.0' 'steps of 0.1 s: 5 0.3 5 0.3' | diff - seen.txt
