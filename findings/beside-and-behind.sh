#!/bin/bash
# Seen with libsumo 1.28.0: addSubscriptionFilterLateralDistance measures ahead of the vehicle from its own path, and behind
# it from the leftmost lane of the road. With 2 m on a road of four lanes, the car right behind is left out, and the one
# behind it two lanes to the left, 6.4 m to the side, is given. One would expect the same distance both ways; whoever looks
# for what comes from behind before a change of lanes does not see it.
# Seen (who is given to a car on the second lane from the right; cars stand on each lane, 40 m ahead and behind):
#   2 m: ahead 0; behind +2
#   4 m: ahead -1 0 +1; behind +1 +2
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b" numLanes="4"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
cat > a.py << 'END'
import libsumo
from libsumo import constants

libsumo.start(["sumo", "-n", "a.net.xml", "--no-step-log"])
libsumo.route.add("r", ["e"])
places = {"ego": (200, 1)}
for lane, side in enumerate(("-1", "0", "+1", "+2")):
    places[f"ahead {side}"], places[f"behind {side}"] = (240, lane), (160, lane)
for name, (position, lane) in places.items():
    libsumo.vehicle.add(name, "r", departPos=str(position), departLane=str(lane), departSpeed="0")
libsumo.simulationStep()
for name in places:
    libsumo.vehicle.setSpeed(name, 0)
    libsumo.vehicle.setLaneChangeMode(name, 0)
for most in (2, 4):
    libsumo.vehicle.subscribeContext("ego", constants.CMD_GET_VEHICLE_VARIABLE, 100, [constants.VAR_SPEED])
    libsumo.vehicle.addSubscriptionFilterLateralDistance(most)
    libsumo.simulationStep()
    given = libsumo.vehicle.getContextSubscriptionResults("ego")
    told = (" ".join([where, *(name.split()[1] for name in places if name in given and where in name)]) for where in ("ahead", "behind"))
    print(f"{most} m: {'; '.join(told)}")
END
v/bin/python a.py | tee seen.txt
printf '%s\n' '2 m: ahead 0; behind +2' '4 m: ahead -1 0 +1; behind +1 +2' | diff - seen.txt
