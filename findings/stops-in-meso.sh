#!/bin/bash
# Seen with eclipse-sumo 1.28.0: with --mesosim, tripinfo counts planned stops as time lost; without, it leaves them out. A bus
# that stops for a minute on an empty road loses nothing in one model and a minute in the other, and totals of delay follow.
# stopTime, beside it, is 60 s both times. SUMO's page on tripinfo says that intended stops do not count. One would expect
# that of both.
# Seen (duration, stopTime, timeLoss):
#   sumo: 136.00, 60.00, 0.00
#   meso: 132.00, 60.00, 60.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b"/><edge id="e2" from="b" to="c"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > said.txt 2>&1
echo '<routes><vType id="t" sigma="0" speedFactor="1" speedDev="0"/><vehicle id="v" type="t" depart="0">
<route edges="e1 e2"/><stop lane="e2_0" endPos="300" duration="60"/></vehicle></routes>' > a.rou.xml
of() { grep -oP " $1=\"\K[^\"]*" a.xml; }
for how in sumo meso; do
  v/bin/sumo -n a.net.xml -r a.rou.xml --tripinfo-output a.xml --no-step-log $([ $how = sumo ] || echo --mesosim) > said.txt 2>&1
  echo "$how: $(of duration), $(of stopTime), $(of timeLoss)"
done | tee seen.txt
diff - seen.txt << END
sumo: 136.00, 60.00, 0.00
meso: 132.00, 60.00, 60.00
END
