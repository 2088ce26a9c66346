#!/bin/bash
# Seen with eclipse-sumo 1.28.0: a rerouter takes vTypes, the types that it is for, and leaves others alone. A
# <variableSpeedSign vTypes="lorry"> slows everybody. SUMO's schema has the attribute for signs, so that no check complains;
# its page on signs does not. One would expect the sign to be for its types, or a warning: a limit for lorries alone would
# need a maxSpeed of their type.
# Seen (how fast a car drives on the middle road, where only lorries are sent round, or slowed down to 5 m/s):
#   nothing: 20
#   rerouter: 20
#   sign: 5
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1500" y="0"/><node id="d" x="2000" y="0"/>
<node id="q" x="1000" y="500"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b" speed="20"/><edge id="e2" from="b" to="c" speed="20"/>
<edge id="e3" from="c" to="d" speed="20"/><edge id="q1" from="b" to="q" speed="20"/><edge id="q2" from="q" to="c" speed="20"/>
</edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
tried() {  # what, of the additional file
  echo "<additional><edgeData id='d' file='d.xml'/>$2</additional>" > a.add.xml
  echo '<routes><vType id="lorry" vClass="truck"/><vType id="car" sigma="0" speedDev="0"/>
  <vehicle id="x" type="car" depart="0"><route edges="e1 e2 e3"/></vehicle></routes>' > a.rou.xml
  v/bin/sumo -n a.net.xml -r a.rou.xml -a a.add.xml -e 600 --no-step-log > /dev/null
  echo "$1:" $(grep -oP '<edge id="e2".* speed="\K[0-9.]+' d.xml | awk '{printf "%.0f", $1}')
}
{
  tried nothing ''
  tried rerouter '<rerouter id="r" edges="e1" vTypes="lorry"><interval begin="0" end="600"><closingReroute id="e2"/></interval></rerouter>'
  tried sign '<variableSpeedSign id="s" lanes="e2_0" vTypes="lorry"><step time="0" speed="5"/></variableSpeedSign>'
} | tee seen.txt
printf '%s: %s\n' nothing 20 rerouter 20 sign 5 | diff - seen.txt
