#!/bin/bash
# Seen with eclipse-sumo 1.28.0: a network that netconvert writes as OpenDRIVE and reads back has lost who may use a lane.
# A lane for buses and taxis is closed to everyone; a lane closed to trucks is open to them. One would expect
# OpenDRIVE's <access restriction="..."> to carry both; none is written. The limits by lane come back as they were.
# Seen (lanes of each road from the right: classes of bus, passenger and truck that may use it; m/s):
#   before ab: bus 13.89 | bus passenger truck 8.33
#   before bc: bus passenger 25.00
#   after  ab: 13.89 | bus passenger truck 8.33
#   after  bc: bus passenger truck 25.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 sumolib==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="ab" from="a" to="b" numLanes="2" speed="13.89"><lane index="0" allow="bus taxi"/>
<lane index="1" speed="8.33"/></edge><edge id="bc" from="b" to="c" speed="25" disallow="truck"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
v/bin/netconvert -s a.net.xml --opendrive-output a.xodr > /dev/null
v/bin/netconvert --opendrive a.xodr -o b.net.xml > /dev/null
! grep -q '<access' a.xodr
cat > lanes.py << 'END'
import sumolib
for when, file in (("before", "a.net.xml"), ("after ", "b.net.xml")):
    edges = sorted(sumolib.net.readNet(file).getEdges(), key=lambda edge: edge.getFromNode().getCoord())
    for name, edge in zip(("ab", "bc"), edges, strict=True):
        lanes = []
        for lane in edge.getLanes():
            allowed = [kind for kind in ("bus", "passenger", "truck") if lane.allows(kind)]
            lanes.append(" ".join([*allowed, f"{lane.getSpeed():.2f}"]))
        print(when, f"{name}:", " | ".join(lanes))
END
v/bin/python lanes.py | tee seen.txt
diff - seen.txt << END
before ab: bus 13.89 | bus passenger truck 8.33
before bc: bus passenger 25.00
after  ab: 13.89 | bus passenger truck 8.33
after  bc: bus passenger truck 25.00
END
