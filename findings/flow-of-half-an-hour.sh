#!/bin/bash
# Seen with eclipse-sumo 1.28.0: marouter's flowCapacityRatio is vehicles over the capacity of an hour, however long the
# interval is. 1200 vehicles in half an hour, which are 2400 an hour, are told as 60 % of capacity, though the travel time
# beside it is that of 2400. And in two hours as 60 % again. One would expect 120 % and 30 %.
# Seen (1200 vehicles in so many hours; travel time of the road in s):
#   0.30: 60.00 %, 71.2 s
#   1.00: 60.00 %, 48.1 s
#   2.00: 60.00 %, 36.5 s
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b" speed="20"/><edge id="e2" from="b" to="c" speed="20"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<additional><taz id="A" edges="e1"/><taz id="Z" edges="e2"/></additional>' > taz.xml
for h in 0.30 1.00 2.00; do  # hours.minutes
  printf '$OR;D2\n0.00 %s\n1.00\nA Z 1200\n' $h > od.txt
  v/bin/marouter -n a.net.xml -a taz.xml -m od.txt -o a.rou.xml --netload-output load.xml > /dev/null 2>&1
  ratio=$(grep -oP '<edge id="e1".* flowCapacityRatio="\K[^"]*' load.xml); s=$(grep -oP '<edge id="e1".* traveltime="\K[^"]*' load.xml)
  LC_ALL=C printf '%s: %s %%, %.1f s\n' $h $ratio $s
done | tee seen.txt
printf '%s: 60.00 %%, %s s\n' 0.30 71.2 1.00 48.1 2.00 36.5 | diff - seen.txt
