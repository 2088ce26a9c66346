#!/bin/bash
# Seen with eclipse-sumo 1.28.0: an offset is as many seconds as it says for a static program, and for an actuated one not.
# With phases of 30 s and 20 s and offset 10, the static program begins its first phase at 10, the actuated one, whose
# phases have neither minDur nor maxDur and so are as fixed, at 20: it lets the second phase, in which the program begins,
# last in full. It stays 10 s late for ever, and a green wave is none. One would expect the same instants.
# Seen (begins of the first phase):
#   static: 10 60 110
#   actuated: 20 70 120
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="200" y="0" type="traffic_light"/><node id="c" x="400" y="0"/>
<node id="d" x="200" y="200"/></nodes>' > a.nod.xml
echo '<edges><edge id="ab" from="a" to="b"/><edge id="db" from="d" to="b"/><edge id="bc" from="b" to="c"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
for type in static actuated; do
  echo "<additional><tlLogic id='b' type='$type' programID='x' offset='10'><phase duration='30' state='Gr'/>
  <phase duration='20' state='rG'/></tlLogic><timedEvent type='SaveTLSStates' source='b' dest='states.xml'/></additional>" > a.add.xml
  v/bin/sumo -n a.net.xml -a a.add.xml -e 150 --no-step-log > /dev/null 2>&1
  echo "$type:" $(grep -oP 'time="\K[^."]*|phase="\K.' states.xml | paste - - | awk '$2 == 0 && was == 1 {print $1} {was = $2}')
done | tee seen.txt
printf '%s: %s\n' static '10 60 110' actuated '20 70 120' | diff - seen.txt
