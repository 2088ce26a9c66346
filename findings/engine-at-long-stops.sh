#!/bin/bash
# Seen with eclipse-sumo 1.28.0: a car whose planned stop lasts more than 300 s has its engine off, and that from the first
# second of the stop, wherever it stands. So the stop of 301 s emits nothing and costs less than one of 30 s; a delivery
# or a dwell of five minutes counts as idling throughout, one that is a second longer not at all. The limit is a
# parameter of types, shutOffStopDuration. One would expect CO2 to grow with the length of the stop.
# Seen (stop, CO2 of the same trip in g):
#   0 s: 140   30 s: 238   300 s: 649   301 s: 189   3000 s: 189
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b" speed="20"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
for s in 0 30 300 301 3000; do
  stop="<stop lane='e_0' endPos='500' duration='$s'/>"; [ $s = 0 ] && stop=
  echo "<routes><vType id='t' sigma='0' speedDev='0'/><vehicle id='v' type='t' depart='0' departSpeed='max'><route edges='e'/>
  $stop</vehicle></routes>" > a.rou.xml
  v/bin/sumo -n a.net.xml -r a.rou.xml --device.emissions.probability 1 --tripinfo-output trips.xml --no-step-log > /dev/null
  printf '%s s: %.0f\n' $s "$(grep -oP 'CO2_abs="\K[^"]*' trips.xml | awk '{print $1 / 1000}')"
done | tee seen.txt
printf '%s s: %s\n' 0 140 30 238 300 649 301 189 3000 189 | diff - seen.txt
