#!/bin/bash
# Seen with sumolib 1.28.0 and eclipse-sumo 1.28.0: getSpeed() of an edge is the speed of its leftmost lane, whoever drives there.
# Of a road for 20 m/s with a bus lane for 8 m/s on its left side it is 8, with the bus lane on its right 20; getFastestPath, told that it
# is for cars, takes it, and so sends cars round the road in the first case. One would expect the greatest speed among lanes
# that the class may use, as in SUMO's own router (duarouter goes straight on in both).
# Seen (bus lane: speed; fastest way by sumolib; by duarouter):
#   left: 8.0; in up over out; in road out
#   right: 20.0; in road out; in road out
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 sumolib==1.28.0
cat > a.nod.xml <<'E2'
<nodes><node id="o" x="-500" y="0"/><node id="a" x="0" y="0"/><node id="m" x="500" y="100"/><node id="b" x="1000" y="0"/><node id="c" x="1500" y="0"/></nodes>
E2
echo '<routes><trip id="t" depart="0" from="in" to="out"/></routes>' > a.trips.xml
for side in left right; do
  bus=$([ $side = left ] && echo 1 || echo 0)
  cat > a.edg.xml <<E2
<edges><edge id="in" from="o" to="a" speed="20"/><edge id="road" from="a" to="b" numLanes="2" speed="20"><lane index="$bus" speed="8" allow="bus"/></edge>
<edge id="up" from="a" to="m" speed="15"/><edge id="over" from="m" to="b" speed="15"/><edge id="out" from="b" to="c" speed="20"/></edges>
E2
  v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null 2>&1
  v/bin/duarouter -n a.net.xml -r a.trips.xml -o a.rou.xml > /dev/null 2>&1
  v/bin/python - <<'E2' 2> /dev/null > fast.txt
from sumolib.net import readNet
net = readNet("a.net.xml")
way, _ = net.getFastestPath(net.getEdge("in"), net.getEdge("out"), vClass="passenger")
print(net.getEdge("road").getSpeed(), "; ", " ".join(edge.getID() for edge in way), sep="")
E2
  echo "$side: $(cat fast.txt); $(grep -oP 'edges="\K[^"]*' a.rou.xml)"
done | tee seen.txt
printf '%s\n' 'left: 8.0; in up over out; in road out' 'right: 20.0; in road out; in road out' | diff - seen.txt
