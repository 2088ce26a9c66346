#!/bin/bash
# Seen with libsumo 1.28.0: getLastStepMeanSpeed leaves out a car that stands at a stop, if the road has another lane, and
# takes an empty lane for one car at the limit. A lane that is blocked by its only car tells the limit, and getTraveltime
# that of an empty road, while the car is counted as halting; with somebody waiting behind, the road drives 6.67 m/s. On a
# road of one lane both are 0, and so is edgeData each time. One would expect the mean over the vehicles, as the page says.
# Seen (mean speed of the lane, of the road, travel time of the road, halting; speed in edgeData):
#   one lane, one stopped: 0.00, 0.00, 500000, 1; 0.00
#   two lanes, one stopped: 20.00, 20.00, 25, 1; 0.00
#   two lanes, one waits behind it: 0.00, 6.67, 75, 2; 0.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/></nodes>' > a.nod.xml
for lanes in 1 2; do
  echo "<edges><edge id='e' from='a' to='b' numLanes='$lanes' speed='20'/></edges>" > a.edg.xml
  v/bin/netconvert -n a.nod.xml -e a.edg.xml -o $lanes.net.xml > /dev/null
done
echo '<additional><edgeData id="d" begin="40" end="60" file="d.xml"/></additional>' > a.add.xml
cat > a.py << 'END'
import re
from pathlib import Path

import libsumo

for what, lanes, count in (("one lane, one stopped", 1, 1), ("two lanes, one stopped", 2, 1), ("two lanes, one waits behind it", 2, 2)):
    libsumo.start(["sumo", "-n", f"{lanes}.net.xml", "-a", "a.add.xml", "--no-step-log"])
    libsumo.route.add("r", ["e"])
    for number in range(count):
        name = str(number)
        libsumo.vehicle.add(name, "r", departPos=str(200 - 30 * number), departLane="0", departSpeed="0")
    libsumo.simulationStep()
    for name in libsumo.vehicle.getIDList():
        libsumo.vehicle.setLaneChangeMode(name, 0)
    libsumo.vehicle.setStop("0", "e", 300, 0, 100)
    for _ in range(50):
        libsumo.simulationStep()
    speeds = libsumo.lane.getLastStepMeanSpeed("e_0"), libsumo.edge.getLastStepMeanSpeed("e")
    told = f"{speeds[0]:.2f}, {speeds[1]:.2f}, {libsumo.edge.getTraveltime('e'):.0f}, {libsumo.edge.getLastStepHaltingNumber('e')}"
    for _ in range(20):
        libsumo.simulationStep()
    libsumo.close()
    (speed,) = re.findall(' speed="([^"]*)"', Path("d.xml").read_text())
    print(f"{what}: {told}; {speed}")
END
v/bin/python a.py | tee seen.txt
diff - seen.txt << END
one lane, one stopped: 0.00, 0.00, 500000, 1; 0.00
two lanes, one stopped: 20.00, 20.00, 25, 1; 0.00
two lanes, one waits behind it: 0.00, 6.67, 75, 2; 0.00
END
