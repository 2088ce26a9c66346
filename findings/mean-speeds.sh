#!/bin/bash
# Seen with eclipse-sumo 1.28.0: "speed" in the vehicleTripStatistics of statistic-output is neither distance over time of
# all trips nor routeLength / duration beside it: planned stops are taken out of each trip's time, though they are in
# duration, and trips count alike, however long they take. Of a fast and a slow car on one road, edgeData tells 8.0. One
# would expect the three to agree, as the two others do.
# Seen (speed, routeLength / duration, edgeData; m/s):
#   a stop of 200 s: 18.82 6.52 6.54
#   20 and 5 m/s: 12.47 8.00 8.01
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="2000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b" speed="20"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<additional><edgeData id="m" file="edges.xml"/></additional>' > a.add.xml
tried() {  # what, vehicles
  echo "<routes><vType id='t' sigma='0' speedDev='0'/><vType id='slow' maxSpeed='5' sigma='0' speedDev='0'/>
  <route id='r' edges='e'/>$2</routes>" > a.rou.xml
  v/bin/sumo -n a.net.xml -r a.rou.xml -a a.add.xml --statistic-output s.xml --duration-log.statistics --no-step-log > /dev/null
  told() { grep '<vehicleTripStatistics' s.xml | grep -oP " $1=\"\K[^\"]*"; }
  echo "$1:" $(told speed) $(echo $(told routeLength) $(told duration) | LC_ALL=C awk '{printf "%.2f", $1 / $2}') \
    $(grep -oP '<edge id="e".* speed="\K[^"]*' edges.xml)
}
{
  tried 'a stop of 200 s' '<vehicle id="v" type="t" route="r" depart="0" departSpeed="max"><stop lane="e_0" endPos="900" duration="200"/></vehicle>'
  tried '20 and 5 m/s' '<vehicle id="v" type="t" route="r" depart="0" departSpeed="max"/><vehicle id="w" type="slow" route="r" depart="9"/>'
} | tee seen.txt
printf '%s: %s\n' 'a stop of 200 s' '18.82 6.52 6.54' '20 and 5 m/s' '12.47 8.00 8.01' | diff - seen.txt
