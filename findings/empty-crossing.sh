#!/bin/bash
# Seen with eclipse-sumo 1.28.0: without one vehicle on the road, netconvert's actuated signals go round as fast as they may
# (each green as long as minDur, 5 s), and its delay_based ones as slowly (each green as long as maxDur, 50 s). The same
# phases with the same bounds, both "by demand". One would expect both to do the same, or to rest in one green until
# somebody comes. A program's cycle at night is thus no property of its phases.
# Seen (the first three greens in s):
#   actuated: 5 5 5
#   delay_based: 50 50 50
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="200" y="0" type="traffic_light"/><node id="c" x="400" y="0"/>
<node id="d" x="200" y="200"/><node id="e" x="200" y="-200"/></nodes>' > a.nod.xml
for e in ab ba bc cb bd db be eb; do echo "<edge id='$e' from='${e:0:1}' to='${e:1:1}'/>"; done > e.txt
{ echo '<edges>'; cat e.txt; echo '</edges>'; } > a.edg.xml
echo '<additional><timedEvent type="SaveTLSStates" source="b" dest="states.xml"/></additional>' > a.add.xml
for type in actuated delay_based; do
  v/bin/netconvert --tls.default-type $type -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
  v/bin/sumo -n a.net.xml -a a.add.xml -e 180 --no-step-log > /dev/null 2>&1
  echo "$type:" $(grep -oP ' state="\K[^"]*' states.xml | uniq -c | awk '$2 ~ /G/ && ++n < 4 {print $1}')
done | tee seen.txt
printf '%s: %s\n' actuated '5 5 5' delay_based '50 50 50' | diff - seen.txt
