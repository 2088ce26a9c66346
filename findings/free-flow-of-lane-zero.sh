#!/bin/bash
# Seen with eclipse-sumo and libsumo 1.28.0: while it simulates, SUMO takes a road's free travel time from its
# rightmost lane alone, even one that the car may not use: a cycle lane with a limit of its own of 4 m/s makes a
# kilometre of road take four minutes. So getTraveltime, findRoute and trips that get their route on departure go
# round such a road. duarouter takes the quickest lane, and drives through. One would expect both to choose alike, by
# lanes that are open to the car.
# Seen (straight on 1000 m at 25 m/s, or round by 1200 m at 15; limits of the lanes from the right):
#   25 25: getTraveltime 39, sumo straight on, duarouter straight on
#   cycles 4, cars 25: getTraveltime 246, sumo round, duarouter straight on
#   cars 8, cars 25: getTraveltime 123, sumo round, duarouter straight on
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="300" y="0"/><node id="c" x="1300" y="0"/><node id="d" x="1600" y="0"/>
<node id="n" x="800" y="330"/></nodes>' > a.nod.xml
echo '<routes><trip id="t" depart="0" from="ab" to="cd"/></routes>' > a.rou.xml
cat > seen.py << 'P'
import libsumo as sumo
sumo.start("sumo -n a.net.xml --no-step-log".split())
print(f"{sumo.edge.getTraveltime('bc'):.0f}")
P
way() { grep -o 'edges="ab b[cn]' "$1" | sed 's/.*bc/straight on/; s/.*bn/round/'; }
tried() {  # name, limit and class of the right lane
  cat > a.edg.xml << END
<edges><edge id="ab" from="a" to="b"/><edge id="cd" from="c" to="d"/><edge id="bn" from="b" to="n" speed="15"/>
<edge id="nc" from="n" to="c" speed="15"/><edge id="bc" from="b" to="c" speed="25" numLanes="2"><lane index="0" $2/></edge></edges>
END
  v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
  v/bin/sumo -n a.net.xml -r a.rou.xml --vehroute-output sumo.xml --no-step-log > /dev/null
  v/bin/duarouter -n a.net.xml -r a.rou.xml -o duarouter.xml > /dev/null
  echo "$1: getTraveltime $(v/bin/python seen.py), sumo $(way sumo.xml), duarouter $(way duarouter.xml)"
}
{
  tried '25 25' 'speed="25"'
  tried 'cycles 4, cars 25' 'speed="4" allow="bicycle"'
  tried 'cars 8, cars 25' 'speed="8"'
} | tee seen.txt
diff - seen.txt << END
25 25: getTraveltime 39, sumo straight on, duarouter straight on
cycles 4, cars 25: getTraveltime 246, sumo round, duarouter straight on
cars 8, cars 25: getTraveltime 123, sumo round, duarouter straight on
END
