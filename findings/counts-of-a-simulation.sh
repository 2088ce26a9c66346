#!/bin/bash
# Seen with eclipse-sumo 1.28.0: routeSampler.py, given the edgeData of a simulation as its counts, and the very routes that
# were driven, finds no vehicle at all. edgeData counts who sets out on a road as departed, not as entered; routeSampler
# reads entered="0" there as "counted, nobody", and no route over that road is allowed. One would expect what was driven
# to be found again. Without that road in the file it is.
# Seen:
#   driven 60, found 0
#   without the first road: found 60
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 numpy==2.3.5
export SUMO_HOME=$(v/bin/python -c 'import sumo; print(sumo.SUMO_HOME)')
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b"/><edge id="e2" from="b" to="c"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<routes><route id="r" edges="e1 e2"/></routes>' > routes.xml
echo '<routes><route id="r" edges="e1 e2"/><flow id="f" route="r" begin="0" end="3000" number="60"/></routes>' > a.rou.xml
echo '<additional><edgeData id="m" file="edges.xml" begin="0" end="3600"/></additional>' > a.add.xml
v/bin/sumo -n a.net.xml -r a.rou.xml -a a.add.xml -e 3600 --no-step-log > /dev/null
found() {
  v/bin/python "$SUMO_HOME"/tools/routeSampler.py -r routes.xml --edgedata-files "$1" -o s.xml --seed 1 > /dev/null 2>&1
  grep -c '<vehicle ' s.xml || true
}
{
  echo "driven 60, found $(found edges.xml)"
  grep -v '"e1"' edges.xml > later.xml
  echo "without the first road: found $(found later.xml)"
} | tee seen.txt
printf 'driven 60, found 0\nwithout the first road: found 60\n' | diff - seen.txt
