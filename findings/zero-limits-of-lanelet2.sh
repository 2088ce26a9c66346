#!/bin/bash
# Seen with lanelet2 1.2.3, rules of Germany for vehicles: roads on which cars may drive have a limit of 0 km/h, and a mandatory
# one. So it is where OpenStreetMap's words stand in speed_limit, as in maps made from it: "none" is no limit there, and
# "DE:urban" is 50. And so it is on the exit of a motorway (subtype "exit") without a limit of its own. One would expect none
# (inf), 50, and that of the motorway, or an error; a planner that keeps the limit stops on the road. Units are read well.
# Seen (may a car drive there; limit in km/h):
#   road, nonurban, 30 mph: True 48.28
#   road, nonurban, none: True 0.0
#   road, nonurban, DE:urban: True 0.0
#   exit, nonurban: True 0.0
#   highway, nonurban: True 130.0
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q lanelet2==1.2.3
v/bin/python - <<'E2' | tee seen.txt
from lanelet2.core import Lanelet, LineString3d, Point3d, getId
from lanelet2.traffic_rules import Locations, Participants, create

rules = create(Locations.Germany, Participants.Vehicle)
for subtype, limit in ("road", "30 mph"), ("road", "none"), ("road", "DE:urban"), ("exit", ""), ("highway", ""):
    sides = [LineString3d(getId(), [Point3d(getId(), x, y, 0) for x in (0, 100)]) for y in (0, -3)]
    road = Lanelet(getId(), *sides)
    road.attributes["subtype"], road.attributes["location"] = subtype, "nonurban"
    if limit:
        road.attributes["speed_limit"] = limit
    name = ", ".join(filter(None, (subtype, "nonurban", limit)))
    print(f"{name}: {rules.canPass(road)} {round(rules.speedLimit(road).speedLimit, 2)}")
E2
diff - seen.txt <<'E2'
road, nonurban, 30 mph: True 48.28
road, nonurban, none: True 0.0
road, nonurban, DE:urban: True 0.0
exit, nonurban: True 0.0
highway, nonurban: True 130.0
E2
