#!/bin/bash
# Seen with eclipse-sumo 1.28.0: netconvert does not read the limit of an OpenDRIVE road, which stands in its <type>
# and holds for every lane that states none of its own: all such roads become 50 km/h, motorways and play streets
# alike, and nothing is said. That is where most files have it; on a lane, the same <speed> is read, units included.
# One would expect the road's limit, as by the standard.
# Seen (m/s):
#   type motorway, 130 km/h: 13.89
#   type rural, 60 mph: 13.89
#   type lowSpeed, 2 m/s: 13.89
#   lane, 130 km/h: 36.11
#   lane, 60 mph: 26.82
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
tried() {  # name, the road's type, what the lane says
  cat > a.xodr << END
<OpenDRIVE><header revMajor="1" revMinor="7"/><road name="" length="200" id="1" junction="-1">$2
<planView><geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry></planView><lanes><laneSection s="0">
<center><lane id="0" type="none"/></center><right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/>$3
</lane></right></laneSection></lanes></road></OpenDRIVE>
END
  v/bin/netconvert --opendrive-files a.xodr -o a.net.xml > /dev/null 2> said.txt
  [ ! -s said.txt ]
  echo "$1: $(grep -oP '<lane id="-1_0".* speed="\K[^"]*' a.net.xml)"
}
{
  tried 'type motorway, 130 km/h' '<type s="0" type="motorway"><speed max="130" unit="km/h"/></type>' ''
  tried 'type rural, 60 mph' '<type s="0" type="rural"><speed max="60" unit="mph"/></type>' ''
  tried 'type lowSpeed, 2 m/s' '<type s="0" type="lowSpeed"><speed max="2" unit="m/s"/></type>' ''
  tried 'lane, 130 km/h' '<type s="0" type="motorway"/>' '<speed sOffset="0" max="130" unit="km/h"/>'
  tried 'lane, 60 mph' '<type s="0" type="rural"/>' '<speed sOffset="0" max="60" unit="mph"/>'
} | tee seen.txt
diff - seen.txt << END
type motorway, 130 km/h: 13.89
type rural, 60 mph: 13.89
type lowSpeed, 2 m/s: 13.89
lane, 130 km/h: 36.11
lane, 60 mph: 26.82
END
