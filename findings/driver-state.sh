#!/bin/bash
# Seen with libsumo 1.28.0: a driver's state (device.driverstate) with a longer maximalReactionTime makes the time between
# two decisions of its driver longer the MORE aware the driver is, and leaves it as it is at the least awareness. One
# would expect the reverse: less aware, later. At awareness 1 it is as without the device.
# Seen, with steps of 0.1 s and maximalReactionTime 1: time between decisions at awareness
#   1.0: 0.1   0.7: 0.7   0.4: 0.4   0.1: 0.1
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
cat > seen.py <<'P'
import libsumo, subprocess, sys
from pathlib import Path

Path("n.nod.xml").write_text('<nodes><node id="a" x="0" y="0"/><node id="b" x="5000" y="0"/></nodes>')
Path("n.edg.xml").write_text('<edges><edge id="e" from="a" to="b" speed="30"/></edges>')
Path("n.rou.xml").write_text("""<routes><vType id="t"><param key="has.driverstate.device" value="true"/>
<param key="device.driverstate.maximalReactionTime" value="1"/></vType>
<route id="r" edges="e"/><vehicle id="v" type="t" route="r" depart="0"/></routes>""")
tool = Path(sys.executable).with_name("netconvert")
subprocess.run([tool, "-n", "n.nod.xml", "-e", "n.edg.xml", "-o", "n.net.xml"], check=True, capture_output=True)
libsumo.start(["sumo", "-n", "n.net.xml", "-r", "n.rou.xml", "--step-length", "0.1", "--no-step-log"])
libsumo.simulationStep()
for awareness in ("1.0", "0.7", "0.4", "0.1"):
    libsumo.vehicle.setParameter("v", "device.driverstate.awareness", awareness)
    for _ in range(30):
        libsumo.simulationStep()
    print(f"{awareness}: {libsumo.vehicle.getActionStepLength('v'):.1f}")
P
v/bin/python -W ignore seen.py 2> log.txt | tee seen.txt
printf '1.0: 0.1\n0.7: 0.7\n0.4: 0.4\n0.1: 0.1\n' | diff - seen.txt
