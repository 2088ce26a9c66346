#!/bin/bash
# Seen with eclipse-sumo 1.28.0: with --mesosim, edgeData counts a vehicle twice as entered on the road on which it arrives,
# if it arrives at a place (arrivalPos) before the last stretch of that road. Whoever takes `entered` for a count of
# traffic, as routeSampler.py does, gets twice the cars on such roads. Without arrivalPos, and without --mesosim, each
# counts once. One would expect entered + departed to be left + arrived when all is over.
# Seen (of ten cars, edgeData of the last road, which is 500 m long):
#   sumo, at its end: entered 10, left 0, arrived 10
#   sumo, at 250 m: entered 10, left 0, arrived 10
#   meso, at its end: entered 10, left 0, arrived 10
#   meso, at 250 m: entered 20, left 0, arrived 10
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b"/><edge id="e2" from="b" to="c"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<additional><edgeData id="d" file="d.xml"/></additional>' > a.add.xml
tried() {  # what, place of arrival, options
  echo "<routes><route id='r' edges='e1 e2'/><flow id='f' route='r' begin='0' end='100' number='10' arrivalPos='$2'/></routes>" > a.rou.xml
  v/bin/sumo -n a.net.xml -r a.rou.xml -a a.add.xml -e 1000 --no-step-log "${@:3}" > /dev/null
  last=$(grep '<edge id="e2"' d.xml)
  echo "$1: $(for name in entered left arrived; do grep -oP " $name=\"\K[0-9]+" <<< "$last" | sed "s/^/$name /"; done | paste -sd, | sed 's/,/, /g')"
}
{
  tried 'sumo, at its end' max
  tried 'sumo, at 250 m' 250
  tried 'meso, at its end' max --mesosim
  tried 'meso, at 250 m' 250 --mesosim
} | tee seen.txt
diff - seen.txt << END
sumo, at its end: entered 10, left 0, arrived 10
sumo, at 250 m: entered 10, left 0, arrived 10
meso, at its end: entered 10, left 0, arrived 10
meso, at 250 m: entered 20, left 0, arrived 10
END
