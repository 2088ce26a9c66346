#!/bin/bash
# Seen with libsumo 1.28.0: getLastStepOccupancy has one name and two units. Of a lane and of an edge it is a share of 1, of
# a lane area and of an induction loop per cent, and edgeData has per cent again. A threshold such as "busy above 0.5",
# tuned on the lane, is met by the detector on the same lane as soon as one car comes. One would expect one unit.
# Seen, one car of 5 m standing on 500 m, over the loop:
#   lane 0.01, edge 0.01, lanearea 1.0, inductionloop 100.0, edgeData 1.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<routes><vehicle id="v" depart="0"><route edges="e"/><stop lane="e_0" endPos="250" duration="200"/></vehicle></routes>' > a.rou.xml
echo '<additional><inductionLoop id="l" lane="e_0" pos="248" file="l.xml"/><edgeData id="m" file="edges.xml" begin="100" end="110"/>
<laneAreaDetector id="a" lane="e_0" pos="0" endPos="500" file="a.xml"/></additional>' > a.add.xml
cat > seen.py << 'P'
import libsumo as sumo
sumo.start("sumo -n a.net.xml -r a.rou.xml -a a.add.xml --no-step-log".split())
sumo.simulationStep(120)
asked = {"lane": "e_0", "edge": "e", "lanearea": "a", "inductionloop": "l"}
print(*(f"{name} {getattr(sumo, name).getLastStepOccupancy(which)}," for name, which in asked.items()), end=" ")
sumo.close()
P
{ v/bin/python seen.py; echo edgeData $(grep -oP '<edge .*occupancy="\K[^"]*' edges.xml); } | tee seen.txt
echo "lane 0.01, edge 0.01, lanearea 1.0, inductionloop 100.0, edgeData 1.00" | diff - seen.txt
