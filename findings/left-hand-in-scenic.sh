#!/bin/bash
# Seen with scenic 3.1.1: its reader of OpenDRIVE does not read the rule of a road. On one with rule="LHT", where lanes with
# positive numbers are driven in the direction of the road, every lane heads the other way: cars are placed against the
# traffic, and "ahead of" is behind. Nothing is said, and the network's driveOnLeft is False. One would expect the heading that
# the standard gives a lane.
# Seen (heading of the lane to the left of a road from west to east, driveOnLeft):
#   RHT: west, False
#   LHT: west, False
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q scenic==3.1.1
lane() { echo "<lane id='$1' type='driving' level='false'><width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane>"; }
for rule in RHT LHT; do
  cat > $rule.xodr << END
<OpenDRIVE><header revMajor="1" revMinor="6"/><road name="m" length="200" id="1" junction="-1" rule="$rule"><planView>
<geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry></planView><lanes><laneSection s="0"><left>$(lane 1)</left>
<center><lane id="0" type="none" level="false"/></center><right>$(lane -1)</right></laneSection></lanes></road></OpenDRIVE>
END
done
cat > seen.py << 'P'
from scenic.core.vectors import Vector
from scenic.domains.driving.roads import Network

for rule in "RHT", "LHT":
    network = Network.fromFile(f"{rule}.xodr", useCache=False)
    print(f"{rule}: {'east' if network.roadDirection[Vector(100, 1.75)].yaw < 0 else 'west'}, {network.driveOnLeft}")
P
v/bin/python -W ignore seen.py 2> said.txt | tee seen.txt
printf '%s: west, False\n' RHT LHT | diff - seen.txt
