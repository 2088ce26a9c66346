#!/bin/bash
# Seen with libsumo 1.28.0: with --collision.action warn, one vehicle that drives into another and through it is one
# collision in collision-output, and is in simulation.getCollisions() after every step in which the two overlap. Who adds
# up that call counts steps: the figure doubles when the step is halved. getCollidingVehiclesNumber(), beside it, is 2
# after the first of these steps and 0 after the others. One would expect the two calls to be about the same.
# Seen (step in s: collisions in the file; added up, getCollisions and getCollidingVehiclesNumber):
#   1.0: 1; 87, 2
#   0.5: 1; 173, 2
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="2000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b" speed="20"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<routes><vType id="t" sigma="0" speedDev="0"/><route id="r" edges="e"/><vehicle id="front" type="t" route="r" depart="0"/>
<vehicle id="back" type="t" route="r" depart="4"/></routes>' > a.rou.xml
cat > seen.py << 'P'
import libsumo as sumo
from pathlib import Path

for step in "1.0", "0.5":
    sumo.start(f"sumo -n a.net.xml -r a.rou.xml --no-step-log --no-warnings --collision.action warn --step-length {step} "
               "--collision-output c.xml".split())
    sumo.simulationStep(20)
    sumo.vehicle.setSpeedMode("back", 0)
    sumo.vehicle.setSpeed("back", 15)
    sumo.vehicle.setSpeed("front", 12)
    listed = numbered = 0
    while sumo.simulation.getMinExpectedNumber():
        sumo.simulationStep()
        listed += len(sumo.simulation.getCollisions())
        numbered += sumo.simulation.getCollidingVehiclesNumber()
    sumo.close()
    print(f"{step}: {Path('c.xml').read_text().count('<collision ')}; {listed}, {numbered}")
P
v/bin/python seen.py | tee seen.txt
printf '%s: 1; %s, 2\n' 1.0 87 0.5 173 | diff - seen.txt
