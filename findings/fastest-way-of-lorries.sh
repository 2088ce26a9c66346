#!/bin/bash
# Seen with eclipse-sumo 1.28.0: sumolib's getFastestPath takes a class of vehicles, and finds its way by the speeds of cars. Of
# a limit for that class alone, which a type in the network states (<restriction>), it knows nothing: it sends lorries over
# 500 m at 5 m/s. duarouter and SUMO itself reckon with that limit and take the 820 m round it. No attribute of sumolib's
# networks has it. One would expect the fastest way of the class that was given.
# Seen (way and seconds by duarouter; by getFastestPath):
#   passenger: e1 short e2, 75; e1 short e2, 74
#   truck: e1 l1 l2 e2, 102; e1 short e2, 74
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 sumolib==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/><node id="d" x="1500" y="0"/>
<node id="k" x="750" y="400"/></nodes>' > a.nod.xml
echo '<types><type id="street" speed="20"/>
<type id="slow" speed="20"><restriction vClass="truck" speed="5"/></type></types>' > a.typ.xml
echo '<edges><edge id="e1" from="a" to="b" type="street"/><edge id="short" from="b" to="c" type="slow"/>
<edge id="l1" from="b" to="k" type="street"/><edge id="l2" from="k" to="c" type="street"/>
<edge id="e2" from="c" to="d" type="street"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -t a.typ.xml -o a.net.xml > said.txt 2>&1
for class in passenger truck; do
  echo "<routes><vType id='t' vClass='$class' maxSpeed='30' sigma='0' speedDev='0'/>
<trip id='v' type='t' depart='0' from='e1' to='e2'/></routes>" > a.trips.xml
  v/bin/duarouter -n a.net.xml -r a.trips.xml -o a.rou.xml --write-costs > said.txt 2>&1
  v/bin/python - "$class" << 'P'
import re
import sys
import sumolib
cost, edges = re.search('<route cost="([^"]*)" edges="([^"]*)"', open("a.rou.xml").read()).groups()
net = sumolib.net.readNet("a.net.xml")
way, seconds = net.getFastestPath(net.getEdge("e1"), net.getEdge("e2"), vClass=sys.argv[1])
found = " ".join(edge.getID() for edge in way)
print(f"{sys.argv[1]}: {edges}, {float(cost):.0f}; {found}, {seconds:.0f}")
P
done | tee seen.txt
diff - seen.txt << END
passenger: e1 short e2, 75; e1 short e2, 74
truck: e1 l1 l2 e2, 102; e1 short e2, 74
END
