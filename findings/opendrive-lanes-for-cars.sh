#!/bin/bash
# Seen with eclipse-sumo 1.28.0: netconvert reads the type of an OpenDRIVE lane so that hard shoulders (stop) and
# parking spaces become lanes on which all cars drive, and ramps between motorways (connectingRamp), slip lanes and
# lanes for buses vanish with all roads that have no others. And a lane that is for buses alone is open to everyone
# from the place on where its limit changes. Nothing is said. One would expect the types to mean what the standard
# says, and access to hold to the end of the section.
# Seen (who may use the lane of 200 m: bus, passenger car):
#   driving: bus passenger
#   stop: bus passenger
#   parking: bus passenger
#   connectingRamp: no lane
#   slipLane: no lane
#   bus: no lane
#   driving, for buses, 50 km/h, then 30: bus | bus passenger
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
cat > seen.py << 'P'
import sumolib  # of eclipse-sumo's tools
edges = sorted(sumolib.net.readNet("a.net.xml").getEdges(), key=lambda each: each.getShape())
lanes = [lane for edge in edges for lane in edge.getLanes() if lane.getWidth() == 3]
print(" | ".join(" ".join(filter(lane.allows, ("bus", "passenger"))) for lane in lanes) or "no lane")
P
tried() {  # name, type of the lane, what is in it
  cat > a.xodr << END
<OpenDRIVE><header revMajor="1" revMinor="7"/><road name="" length="200" id="1" junction="-1"><planView>
<geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry></planView><lanes><laneSection s="0"><center>
<lane id="0" type="none"/></center><right><lane id="-1" type="driving"><width sOffset="0" a="4" b="0" c="0" d="0"/></lane>
<lane id="-2" type="$2"><width sOffset="0" a="3" b="0" c="0" d="0"/>$3</lane></right></laneSection></lanes></road></OpenDRIVE>
END
  SUMO_HOME=$home v/bin/netconvert --opendrive-files a.xodr -o a.net.xml > /dev/null 2> said.txt
  [ ! -s said.txt ]
  echo "$1: $(PYTHONPATH=$home/tools v/bin/python seen.py)"
}
home=$(v/bin/python -c 'import sumo; print(sumo.SUMO_HOME)')
for_buses='<access sOffset="0" rule="allow" restriction="bus"/>'
limits='<speed sOffset="0" max="50" unit="km/h"/><speed sOffset="100" max="30" unit="km/h"/>'
{
  for kind in driving stop parking connectingRamp slipLane bus; do tried $kind $kind ''; done
  tried 'driving, for buses, 50 km/h, then 30' driving "$for_buses$limits"
} | tee seen.txt
diff - seen.txt << END
driving: bus passenger
stop: bus passenger
parking: bus passenger
connectingRamp: no lane
slipLane: no lane
bus: no lane
driving, for buses, 50 km/h, then 30: bus | bus passenger
END
