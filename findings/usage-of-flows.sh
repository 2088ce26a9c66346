#!/bin/bash
# Seen with eclipse-sumo 1.28.0: countEdgeUsage.py, which counts the vehicles that depart and arrive on each road, counts the
# routes that stand in the file, unless it is told otherwise (--elements). A flow of 100 is one vehicle, 100 trips are nobody,
# and a file with both beside vehicles, as from od2trips and flowrouter.py, has some of its traffic. Nothing is said. One would
# expect the vehicles that drive.
# Seen (departures on the first road, usually, with --elements vehicle,trip,flow, and by sumo):
#   a flow of 100: 1 100 100
#   100 trips: 0 100 100
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
export SUMO_HOME=$(echo "$PWD"/v/lib/python*/site-packages/sumo)
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b"/><edge id="e2" from="b" to="c"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
of() {
  echo "<routes>$2</routes>" > a.rou.xml
  for words in "" "--elements vehicle,trip,flow"; do
    v/bin/python "$SUMO_HOME/tools/countEdgeUsage.py" a.rou.xml -o a.xml $words > said.txt 2>&1
    ! grep -iE 'warning|error' said.txt >&2
    printf '%s ' "$(grep -oP 'id="e1" departed="\K[^"]*' a.xml || echo 0)"
  done > counts.txt
  v/bin/sumo -n a.net.xml -r a.rou.xml --duration-log.statistics --no-step-log > said.txt 2>&1
  echo "$1: $(cat counts.txt)$(grep -oP ' Inserted: \K[0-9]+' said.txt)"
}
trips=$(for i in $(seq 100); do echo "<trip id='t$i' depart='$((i * 10))' from='e1' to='e2'/>"; done)
{
  of 'a flow of 100' '<flow id="f" begin="0" end="1000" number="100"><route edges="e1 e2"/></flow>'
  of '100 trips' "$trips"
} | tee seen.txt
diff - seen.txt << END
a flow of 100: 1 100 100
100 trips: 0 100 100
END
