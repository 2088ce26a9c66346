#!/bin/bash
# Seen with eclipse-sumo 1.28.0: W99 follows as near with tau 3 as with tau 1 and gains speed alike with accel 1 and 3: it
# has cc1, cc8 and cc9 for these. So it is with decel in ACC and with sigma in IDM, EIDM, W99, ACC and CACC. SUMO
# takes such attributes of a type without a word, and a study of drivers who keep longer headways compares equals. One
# would expect a warning.
# Seen (metres behind a leader at 10 m/s with tau 1 and 3; seconds to 20 m/s with accel 1 and 3):
#   Krauss 12.5 32.5; 20.0 7.0
#   IDM 12.7 32.9; 23.0 8.0
#   W99 20.0 20.0; 10.0 10.0
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 libsumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="3000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b" speed="25"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
cat > seen.py << 'P'
import libsumo as sumo
from pathlib import Path

def driven(model, more, leads):
    leader = '<vehicle id="s" type="s" depart="0"><route edges="e"/></vehicle>' if leads else ""
    Path("a.rou.xml").write_text(f'''<routes><vType id="s" maxSpeed="10" speedDev="0" sigma="0"/>
    <vType id="t" carFollowModel="{model}" speedDev="0" sigma="0" {more}/>{leader}
    <vehicle id="v" type="t" depart="5" departSpeed="0"><route edges="e"/></vehicle></routes>''')
    sumo.start("sumo -n a.net.xml -r a.rou.xml --no-step-log --no-warnings".split())
    sumo.simulationStep(6)
    while sumo.simulation.getTime() < 200 if leads else sumo.vehicle.getSpeed("v") < 20:
        sumo.simulationStep()
    seen = sumo.vehicle.getPosition("s")[0] - 5 - sumo.vehicle.getPosition("v")[0] if leads else sumo.simulation.getTime() - 6
    sumo.close()
    return f"{seen:.1f}"

for model in "Krauss", "IDM", "W99":
    gaps = " ".join(driven(model, f'tau="{tau}"', True) for tau in (1, 3))
    print(model, gaps + ";", " ".join(driven(model, f'accel="{accel}"', False) for accel in (1, 3)))
P
v/bin/python seen.py | tee seen.txt
printf '%s\n' 'Krauss 12.5 32.5; 20.0 7.0' 'IDM 12.7 32.9; 23.0 8.0' 'W99 20.0 20.0; 10.0 10.0' | diff - seen.txt
