#!/bin/bash
# Seen with eclipse-sumo 1.28.0: two of its outputs mean two things by timeLoss. A car that stops for a minute, as
# planned, on an otherwise empty road takes 8 s more than the minute to brake and to set off again. In tripinfo its
# timeLoss is 0.00, in edgeData that of the road is 7.52. One would expect the sum over roads to be the sum over trips.
# Seen:
#   tripinfo duration="112.00" timeLoss="0.00", edgeData timeLoss="0.00"
#   tripinfo duration="180.00" timeLoss="0.00", edgeData timeLoss="7.52"
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="800" y="0"/><node id="c" x="2000" y="0"/>
<node id="d" x="2800" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b" speed="25"/><edge id="e2" from="b" to="c" speed="25"/>
<edge id="e3" from="c" to="d" speed="25"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<additional><edgeData id="m" file="edges.xml"/></additional>' > a.add.xml
for stop in '' '<stop lane="e2_0" endPos="600" duration="60"/>'; do
  echo "<routes><vType id='t' sigma='0' speedDev='0'/><vehicle id='v' type='t' depart='0' departSpeed='max'>
  <route edges='e1 e2 e3'/>$stop</vehicle></routes>" > a.rou.xml
  v/bin/sumo -n a.net.xml -r a.rou.xml -a a.add.xml --tripinfo-output trips.xml --no-step-log > /dev/null
  echo tripinfo $(grep -oE ' (duration|timeLoss)="[^"]*"' trips.xml), edgeData $(grep '<edge id="e2"' edges.xml | grep -o 'timeLoss="[^"]*"')
done | tee seen.txt
printf 'tripinfo duration="%s" timeLoss="0.00", edgeData timeLoss="%s"\n' 112.00 0.00 180.00 7.52 | diff - seen.txt
