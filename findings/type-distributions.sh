#!/bin/bash
# Seen with libsumo 1.28.0: vehicletype.getIDList() lists the names of vTypeDistributions among those of types, and
# every call with such a name is about another member, drawn at random. What one reads of one member is then set on
# another: "for each type, read the maximum speed and set it again" gave a car a truck's 25 m/s. One would expect the
# list to have types only, or a distribution to be refused.
# Seen:
#   listed: True
#   read twenty times: 25.0 70.0
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q libsumo==1.28.0 eclipse-sumo==1.28.0
v/bin/netgenerate --grid --grid.number 2 -o a.net.xml > /dev/null
cat > a.rou.xml <<X
<routes><vTypeDistribution id="mix"><vType id="car" maxSpeed="70" probability="0.5"/>
<vType id="truck" maxSpeed="25" probability="0.5"/></vTypeDistribution></routes>
X
v/bin/python - <<'P' | tee seen.txt
import libsumo
libsumo.start(["sumo", "-n", "a.net.xml", "-a", "a.rou.xml", "--no-step-log"])
kinds = libsumo.vehicletype
print("listed:", "mix" in kinds.getIDList())
print("read twenty times:", *sorted({kinds.getMaxSpeed("mix") for _ in range(20)}))
P
printf 'listed: True\nread twenty times: 25.0 70.0\n' | diff - <(grep -e listed -e twenty seen.txt)
