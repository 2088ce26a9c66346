#!/bin/bash
# Seen with eclipse-sumo 1.28.0: <walk duration="900"> takes 1000 s, on an empty and straight footway, alone. SUMO makes a speed of
# the duration, and its usual model of pedestrians (striping) slows everybody down at random by a tenth on average
# (pedestrian.striping.dawdling 0.2), so that no walk ends when it is said to; tripinfo counts the rest as time lost, at
# waitingTime 0. A walk with speed="2" is at 1.8 m/s. One would expect 900 s. With dawdling 0 it is 900.
# Seen (duration and timeLoss of the walk in s):
#   as it comes: duration="1000.00" timeLoss="100.00"
#   dawdling 0: duration="900.00" timeLoss="0.00"
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="ab" from="a" to="b" speed="13.89"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml --sidewalks.guess -o a.net.xml > /dev/null
echo '<routes><person id="p" depart="0"><walk edges="ab" duration="900" arrivalPos="1000"/></person></routes>' > a.rou.xml
{
  for dawdling in '' 0; do
    v/bin/sumo -n a.net.xml -r a.rou.xml --tripinfo-output t.xml --no-step-log ${dawdling:+--pedestrian.striping.dawdling $dawdling} > /dev/null
    echo "${dawdling:+dawdling }${dawdling:-as it comes}: $(grep -oP '<walk .*\Kduration="[^"]*"' t.xml) $(grep -oP '<walk .*\KtimeLoss="[^"]*"' t.xml)"
  done
} | tee seen.txt
printf '%s\n' 'as it comes: duration="1000.00" timeLoss="100.00"' 'dawdling 0: duration="900.00" timeLoss="0.00"' | diff - seen.txt
