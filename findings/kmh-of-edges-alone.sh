#!/bin/bash
# Seen with eclipse-sumo 1.28.0: netconvert --speed-in-kmh reads the speeds of edges and types as km/h, and those of lanes,
# of connections, and of classes of vehicles within a type as m/s, in the same files. A lane for 30 km/h beside one for 50
# becomes one for 108, and lorries that may drive 36 km/h drive 130. Nothing is said; the network is loaded. One would expect
# all speeds in one unit.
# Seen (km/h as written: m/s in the network):
#   type 72: 20.00
#   edge 50: 13.89
#   lane 30: 30.00
#   connection 20: 20.00
#   lorries in a type 36: 36.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<types><type id="t" speed="72" numLanes="2"><restriction vClass="truck" speed="36"/></type></types>' > a.typ.xml
echo '<edges><edge id="e1" from="a" to="b" type="t"/>
<edge id="e2" from="b" to="c" numLanes="2" speed="50"><lane index="0" speed="30"/></edge></edges>' > a.edg.xml
echo '<connections><connection from="e1" to="e2" fromLane="0" toLane="0" speed="20"/>
<connection from="e1" to="e2" fromLane="1" toLane="1"/></connections>' > a.con.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -t a.typ.xml -x a.con.xml --speed-in-kmh -o a.net.xml > said.txt 2>&1
! grep -i warning said.txt
of() { echo "$1: $(grep "$2" a.net.xml | grep -oP ' speed="\K[^"]*')"; }
{
  of 'type 72' 'lane id="e1_0"'
  of 'edge 50' 'lane id="e2_1"'
  of 'lane 30' 'lane id="e2_0"'
  of 'connection 20' 'lane id=":b_0_0"'
  of 'lorries in a type 36' '<restriction'
} | tee seen.txt
diff - seen.txt << END
type 72: 20.00
edge 50: 13.89
lane 30: 30.00
connection 20: 20.00
lorries in a type 36: 36.00
END
