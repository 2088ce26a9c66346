#!/bin/bash
# Seen with osmium 4.3.2 (pyosmium) and eclipse-sumo 1.28.0: a map that was edited in JOSM keeps what was deleted,
# marked action="delete", until it is uploaded. pyosmium reads such roads and turn restrictions as any others, visible
# and not deleted by its own flags; netconvert leaves them out. So a script that counts or routes over a file sees a
# road that the network built from the same file has not, as if netconvert had lost it. One would expect both to read
# one map.
# Seen (roads present, and whether the turn from 1 into 2 is forbidden by a restriction that was deleted):
#   pyosmium: roads 1 2 3, forbidden True
#   netconvert: roads 1 2, forbidden False
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q osmium==4.3.2 eclipse-sumo==1.28.0
cat > a.osm << END
<osm version="0.6" generator="JOSM"><node id="1" lat="48.80" lon="2.300" version="1"/><node id="2" lat="48.80" lon="2.305" version="1"/>
<node id="3" lat="48.80" lon="2.310" version="1"/><node id="4" lat="48.81" lon="2.305" version="1"/>
<way id="1" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/><tag k="oneway" v="yes"/></way>
<way id="2" version="1"><nd ref="2"/><nd ref="3"/><tag k="highway" v="primary"/><tag k="oneway" v="yes"/></way>
<way id="3" version="1" action="delete"><nd ref="2"/><nd ref="4"/><tag k="highway" v="primary"/><tag k="oneway" v="yes"/></way>
<relation id="9" version="1" action="delete"><member type="way" ref="1" role="from"/><member type="node" ref="2" role="via"/>
<member type="way" ref="2" role="to"/><tag k="type" v="restriction"/><tag k="restriction" v="no_straight_on"/></relation></osm>
END
v/bin/netconvert --osm a.osm -o a.net.xml > /dev/null 2>&1
cat > seen.py << 'P'
import xml.etree.ElementTree as ET
import osmium

roads, forbidden = [], False
for each in osmium.FileProcessor("a.osm"):
    if each.visible and not each.deleted:
        roads += [each.id] if "highway" in each.tags else []
        forbidden |= "restriction" in each.tags
print("pyosmium: roads", *roads, end=f", forbidden {forbidden}\n")
net = ET.parse("a.net.xml").getroot()
roads = sorted(each.get("id") for each in net.iter("edge") if not each.get("id").startswith(":"))
turns = [(each.get("from"), each.get("to")) for each in net.iter("connection")]
print("netconvert: roads", *roads, end=f", forbidden {('1', '2') not in turns}\n")
P
v/bin/python seen.py | tee seen.txt
printf '%s, forbidden %s\n' 'pyosmium: roads 1 2 3' True 'netconvert: roads 1 2' False | diff - seen.txt
