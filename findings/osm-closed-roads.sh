#!/bin/bash
# Seen with eclipse-sumo 1.28.0: of OpenStreetMap's keys for who may use a road, netconvert obeys access=no alone, and that
# without its exceptions. A road with motor_vehicle=no, vehicle=no or access=private stays open to cars; one with
# access=no and motor_vehicle=yes is closed to them. One would expect the more special key to win, as the map's own rule
# has it. By lanes it is the other way round: with --osm.lane-access, vehicle:lanes closes a lane, and access:lanes and
# motor_vehicle:lanes close none.
# Seen (may a passenger car use the road, or its right lane):
#   motor_vehicle=no: open
#   vehicle=no: open
#   access=private: open
#   access=no: closed
#   access=no motor_vehicle=yes: closed
#   vehicle:lanes=yes|no: closed
#   access:lanes=yes|no: open
#   motor_vehicle:lanes=yes|no: open
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 sumolib==1.28.0
cat > open.py << 'END'
import sumolib
lane = sumolib.net.readNet("a.net.xml").getEdge("7").getLanes()[0]
print("open" if lane.allows("passenger") else "closed")
END
tried() {  # tags
  {
    echo '<osm version="0.6"><node id="1" lat="48.80" lon="2.300" version="1"/><node id="2" lat="48.80" lon="2.305" version="1"/>'
    echo '<way id="7" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="secondary"/><tag k="lanes" v="2"/>'
    echo '<tag k="oneway" v="yes"/>'
    for tag in "$@"; do echo "<tag k=\"${tag%%=*}\" v=\"${tag#*=}\"/>"; done
    echo '</way></osm>'
  } > a.osm
  v/bin/netconvert --osm a.osm --osm.lane-access -o a.net.xml > /dev/null 2>&1
  echo "$*: $(v/bin/python open.py)"
}
{
  tried motor_vehicle=no
  tried vehicle=no
  tried access=private
  tried access=no
  tried access=no motor_vehicle=yes
  tried 'vehicle:lanes=yes|no'
  tried 'access:lanes=yes|no'
  tried 'motor_vehicle:lanes=yes|no'
} | tee seen.txt
diff - seen.txt << END
motor_vehicle=no: open
vehicle=no: open
access=private: open
access=no: closed
access=no motor_vehicle=yes: closed
vehicle:lanes=yes|no: closed
access:lanes=yes|no: open
motor_vehicle:lanes=yes|no: open
END
