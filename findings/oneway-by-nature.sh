#!/bin/bash
# Seen with osmnx 2.1.0 and eclipse-sumo 1.28.0: a map that osmnx reads and saves again, with all_oneway as its page says, has
# oneway="no" on every roundabout and motorway whose direction the map leaves to what they are, as OpenStreetMap's rules allow,
# if any other road of the map has the tag. Before, netconvert builds them in one direction; afterwards, cars drive them
# both ways. Nothing is said. One would expect no tag, or yes.
# Seen (oneway in the file; directions in the network):
#   the map: motorway none, 1; roundabout none, 1; street none, 2
#   saved by osmnx: motorway no, 2; roundabout no, 2; street no, 2
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q osmnx==2.1.0 eclipse-sumo==1.28.0
way() { echo "<way id=\"$1\" version=\"1\">$(printf '<nd ref="%s"/>' $2)<tag k=\"highway\" v=\"$3\"/>${4:-}</way>"; }
node() { echo "<node id=\"$1\" version=\"1\" lat=\"$2\" lon=\"$3\"/>"; }
{
  echo '<osm version="0.6">'
  node 1 48.000 11.000; node 2 48.000 11.010; node 3 48.001 11.011; node 4 48.000 11.012; node 5 47.999 11.011
  node 6 48.000 11.020; node 7 48.000 11.030
  way 10 '1 2' motorway
  way 11 '2 5 4 3 2' tertiary '<tag k="junction" v="roundabout"/>'
  way 12 '4 6' tertiary
  way 13 '6 7' tertiary '<tag k="oneway" v="yes"/>'
  echo '</osm>'
} > before.osm
cat > save.py << 'P'
import osmnx
osmnx.settings.all_oneway = True
graph = osmnx.graph_from_xml("before.osm", simplify=False, retain_all=True)
osmnx.io.save_graph_xml(graph, "after.osm")
P
v/bin/python save.py > said.txt 2>&1
cat > seen.py << 'P'
import re
import sys
import xml.etree.ElementTree as ET
name, osm, net = sys.argv[1:]
told = []
for way, what in ("10", "motorway"), ("11", "roundabout"), ("12", "street"):
    tags = {tag.get("k"): tag.get("v") for tag in ET.parse(osm).getroot().iterfind(f"way[@id='{way}']/tag")}
    ways = {found[0] for found in re.findall(f'<edge id="(-?){way}[#"]()', open(net).read())}
    told.append(f"{what} {tags.get('oneway', 'none')}, {len(ways)}")
print(f"{name}: {'; '.join(told)}")
P
{
  for each in before after; do v/bin/netconvert --osm-files $each.osm -o $each.net.xml > said.txt 2>&1; done
  v/bin/python seen.py 'the map' before.osm before.net.xml
  v/bin/python seen.py 'saved by osmnx' after.osm after.net.xml
} | tee seen.txt
diff - seen.txt << END
the map: motorway none, 1; roundabout none, 1; street none, 2
saved by osmnx: motorway no, 2; roundabout no, 2; street no, 2
END
