#!/bin/bash
# Seen with eclipse-sumo 1.28.0: the plain XML of a network for left-hand traffic (netconvert --plain-output-prefix) does not
# say that it is one. Built again from all of its files, it drives on the right, and nothing is said; whoever edits nodes or
# edges this way has to know it. One would expect what was written to be read back, as offset and projection are.
# Seen (left-hand, and on which side of the line from west to east the lane lies):
#   before: left-hand true, lane to the left
#   after: left-hand false, lane to the right
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="200" y="0"/><node id="c" x="400" y="0"/><node id="d" x="200" y="200"/>
</nodes>' > a.nod.xml
for e in ab ba bc cb bd db; do echo "<edge id='$e' from='${e:0:1}' to='${e:1:1}'/>"; done > e.txt
{ echo '<edges>'; cat e.txt; echo '</edges>'; } > a.edg.xml
v/bin/netconvert --lefthand -n a.nod.xml -e a.edg.xml -o before.net.xml > /dev/null
v/bin/netconvert -s before.net.xml --plain-output-prefix p > /dev/null
v/bin/netconvert -n p.nod.xml -e p.edg.xml -x p.con.xml -i p.tll.xml -o after.net.xml 2>&1 | grep -i hand || true
for n in before after; do
  is=false; grep -q 'lefthand="true"' $n.net.xml && is=true
  side=right; grep -oP '<lane id="ab_0".* shape="\K[^"]*' $n.net.xml | grep -q ',1.60' && side=left
  echo "$n: left-hand $is, lane to the $side"
done | tee seen.txt
printf '%s: left-hand %s, lane to the %s\n' before true left after false right | diff - seen.txt
