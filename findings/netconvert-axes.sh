#!/bin/bash
# Seen with eclipse-sumo 1.28.0 (its PROJ looks codes up in the EPSG registry): of a code that counts northings first,
# such as EPSG:31468 (Gauss-Krueger), netconvert writes northings as x. The road to the east leads north, so that the
# network is its own mirror image: what turns left in it turns right on earth. One would expect x to be the easting,
# as for EPSG:25832, whatever the registry's order. `+proj=` strings have no such order and are not affected.
# Seen:
#   EPSG:25832 east leads along x
#   EPSG:31468 east leads along y
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="11.5755" y="48.1374"/><node id="b" x="11.5855" y="48.1374"/></nodes>' > a.nod.xml
echo '<edges><edge id="east" from="a" to="b" numLanes="1" speed="13.89"/></edges>' > a.edg.xml
for code in EPSG:25832 EPSG:31468; do
  v/bin/netconvert -n a.nod.xml -e a.edg.xml --proj "$code" -o a.net.xml > /dev/null
  grep -o '<lane id="east_0".*' a.net.xml | sed 's/.*shape="\([^"]*\)".*/\1/' | tr ' ,' '  ' | awk -v code="$code" \
    '{dx = $3 - $1; dy = $4 - $2; print code, "east leads along", (dx * dx > dy * dy ? "x" : "y")}'
done | tee seen.txt
printf 'EPSG:25832 east leads along x\nEPSG:31468 east leads along y\n' | diff - seen.txt
