#!/bin/bash
# Seen with eclipse-sumo 1.28.0: a <rerouter file="..."> is accepted, and its file is never opened, whatever is in it,
# not even if it is missing: nothing is said, and no road is closed. A <variableSpeedSign file="..."> and a
# <calibrator file="..."> read theirs, and stop at one that is missing. One would expect the same of all three: SUMO's
# page on rerouters describes the attribute, as the path to a file that has the intervals instead.
# Seen (which way the car takes, or how fast it drives):
#   rerouter inside: e1 q1 q2 e3
#   rerouter file: e1 e2 e3
#   rerouter missing: e1 e2 e3
#   sign file: 8.00
#   sign missing: stops
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="800" y="0"/><node id="c" x="2000" y="0"/>
<node id="d" x="2800" y="0"/><node id="q" x="1400" y="300"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b" speed="25"/><edge id="e2" from="b" to="c" speed="25"/>
<edge id="e3" from="c" to="d" speed="25"/><edge id="q1" from="b" to="q" speed="20"/>
<edge id="q2" from="q" to="c" speed="20"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo "<routes><vType id='t' sigma='0' speedDev='0'/><vehicle id='v' type='t' depart='0'><route edges='e1 e2 e3'/></vehicle>
</routes>" > a.rou.xml
closes='<interval begin="0" end="9999"><closingReroute id="e2"/></interval>'
echo "<rerouter id='r' edges='e1'>$closes</rerouter>" > r.xml
echo '<vss><step time="0" speed="8"/></vss>' > s.xml
tried() {  # name, element
  echo "<additional>$2<edgeData id='m' file='m.xml'/></additional>" > a.add.xml
  rm -f w.xml m.xml
  if ! v/bin/sumo -n a.net.xml -r a.rou.xml -a a.add.xml --vehroute-output w.xml --no-step-log > /dev/null 2>&1; then
    echo "$1: stops"
  elif [[ $1 == sign* ]]; then
    echo "$1: $(grep '<edge id="e2"' m.xml | grep -o ' speed="[^"]*"' | cut -d '"' -f 2)"
  else
    echo "$1: $(grep -o 'edges="[^"]*"' w.xml | tail -1 | cut -d '"' -f 2)"
  fi
}
{
  tried 'rerouter inside' "<rerouter id='r' edges='e1'>$closes</rerouter>"
  tried 'rerouter file' "<rerouter id='r' edges='e1' file='r.xml'/>"
  tried 'rerouter missing' "<rerouter id='r' edges='e1' file='none.xml'/>"
  tried 'sign file' "<variableSpeedSign id='s' lanes='e2_0' file='s.xml'/>"
  tried 'sign missing' "<variableSpeedSign id='s' lanes='e2_0' file='none.xml'/>"
} | tee seen.txt
diff - seen.txt << END
rerouter inside: e1 q1 q2 e3
rerouter file: e1 e2 e3
rerouter missing: e1 e2 e3
sign file: 8.00
sign missing: stops
END
