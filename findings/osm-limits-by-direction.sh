#!/bin/bash
# Seen with eclipse-sumo 1.28.0: of OpenStreetMap's maxspeed and maxspeed:forward, netconvert takes whichever stands first
# in the way, and gives it to both directions. 50 with 30 forward is 50 both ways, or 30 both ways, by the order of two
# tags that OpenStreetMap leaves without an order; alphabetical order loses the forward limit. maxspeed:backward has no
# such trouble. One would expect 30 forward and 50 backward each time. Nothing is said.
# Seen (m/s forward, m/s backward):
#   maxspeed=50 maxspeed:forward=30: 13.89 13.89
#   maxspeed:forward=30 maxspeed=50: 8.33 8.33
#   maxspeed=50 maxspeed:backward=30: 13.89 8.33
#   maxspeed:backward=30 maxspeed=50: 13.89 8.33
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
tried() {  # tags in the order of the file
  {
    echo '<osm version="0.6"><node id="1" lat="48.80" lon="2.300" version="1"/><node id="2" lat="48.80" lon="2.305" version="1"/>'
    echo '<way id="7" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="secondary"/>'
    for tag in "$@"; do echo "<tag k=\"${tag%=*}\" v=\"${tag#*=}\"/>"; done
    echo '</way></osm>'
  } > a.osm
  v/bin/netconvert --osm a.osm -o a.net.xml > /dev/null 2> said.txt
  [ ! -s said.txt ]
  echo "$*:" $(for edge in 7 -7; do grep -o "id=\"${edge}_0\" .* speed=\"[0-9.]*\"" a.net.xml | grep -o '[0-9.]*"$' | tr -d '"'; done)
}
{
  tried maxspeed=50 maxspeed:forward=30
  tried maxspeed:forward=30 maxspeed=50
  tried maxspeed=50 maxspeed:backward=30
  tried maxspeed:backward=30 maxspeed=50
} | tee seen.txt
diff - seen.txt << END
maxspeed=50 maxspeed:forward=30: 13.89 13.89
maxspeed:forward=30 maxspeed=50: 8.33 8.33
maxspeed=50 maxspeed:backward=30: 13.89 8.33
maxspeed:backward=30 maxspeed=50: 13.89 8.33
END
