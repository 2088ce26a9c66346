#!/bin/bash
# Seen with libsumo 1.28.0: in a network for left-hand traffic, whatever says "left" about lanes is to the right:
# getLeftFollowers gives the vehicle on the right, changeSublane with a positive distance, and so
# changeLaneRelative(1), moves to the right, latAlignment "left" and a positive lateral position are right of the
# middle. "Left" is away from the kerb. The indicator alone says the true side. A warning of the blind spot made at
# home looks to the wrong side in London. One would expect the vehicle's left, as with right-hand traffic.
# Seen (an ego with a car on each side; in getSignals, 1 is the right indicator, 2 the left):
#   right-hand: getLeftFollowers gives the one on the left; +1 m moves left, signals 2; latAlignment left is left
#   left-hand: getLeftFollowers gives the one on the right; +1 m moves right, signals 1; latAlignment left is right
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b" numLanes="3"/></edges>' > a.edg.xml
echo '<routes><vType id="t" latAlignment="left"/><route id="r" edges="e"/></routes>' > a.rou.xml
cat > seen.py << 'P'
import sys
import libsumo as sumo

name = sys.argv[1]
sumo.start(f"sumo -n {name}.net.xml -r a.rou.xml --no-step-log --lateral-resolution 0.4".split())

def side(y, of):  # eastward, so that left is north
    return "left" if y > of else "right"

def y(vehicle):
    return sumo.vehicle.getPosition(vehicle)[1]

for vehicle, lane, place in ("ego", 1, 50), ("other0", 0, 40), ("other2", 2, 30), ("aligned", 1, 300):
    kind = "t" if vehicle == "aligned" else "DEFAULT_VEHTYPE"
    sumo.vehicle.add(vehicle, "r", kind, departLane=str(lane), departPos=str(place), departSpeed="10")
sumo.simulationStep(1)
(follower, _), before = sumo.vehicle.getLeftFollowers("ego")[0], y("ego")
told = f"{name}: getLeftFollowers gives the one on the {side(y(follower), before)}"
sumo.vehicle.setLaneChangeMode("ego", 0)
sumo.vehicle.changeSublane("ego", 1.0)
sumo.simulationStep(3)
told += f"; +1 m moves {side(y('ego'), before)}, signals {sumo.vehicle.getSignals('ego') & 3}"
sumo.simulationStep(8)
print(f"{told}; latAlignment left is {side(y('aligned'), sumo.lane.getShape('e_1')[0][1])}")
sumo.close()
P
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o right-hand.net.xml > /dev/null
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o left-hand.net.xml --lefthand > /dev/null
for name in right-hand left-hand; do v/bin/python seen.py $name; done | tee seen.txt
diff - seen.txt << END
right-hand: getLeftFollowers gives the one on the left; +1 m moves left, signals 2; latAlignment left is left
left-hand: getLeftFollowers gives the one on the right; +1 m moves right, signals 1; latAlignment left is right
END
