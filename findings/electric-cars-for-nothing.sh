#!/bin/bash
# Seen with eclipse-sumo 1.28.0: a type whose vClass is evehicle drives on nothing: no fuel, no CO2, and no
# electricity, for its emission class is Zero/default, as those of trams and scooters are. A study that changes half
# of the cars from passenger to evehicle reports half of the energy as saved. With Energy/default the same trip needs
# electricity. One would expect an electric car to be one in tripinfo's emissions, too.
# Seen (g of CO2, Wh, of the same trip of 1 km):
#   vClass passenger: 179, 0
#   vClass evehicle: 0, 0
#   vClass evehicle, emissionClass Energy/default: 0, 133
#   vClass tram: 0, 0
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
tried() {
  echo "<routes><vType id=\"t\" vClass=\"$1\" ${2:+emissionClass=\"$2\"} sigma=\"0\" speedFactor=\"1\" speedDev=\"0\"/>
<vehicle id=\"v\" type=\"t\" depart=\"0\" departSpeed=\"0\"><route edges=\"e\"/></vehicle></routes>" > a.rou.xml
  v/bin/sumo -n a.net.xml -r a.rou.xml --device.emissions.probability 1 --tripinfo-output a.xml --no-step-log > said.txt 2>&1
  of() { grep -oP "$1_abs=\"\K[^\"]*" a.xml; }
  echo "vClass $1${2:+, emissionClass $2}: $(awk "BEGIN { printf \"%.0f, %.0f\", $(of CO2) / 1000, $(of electricity) }")"
}
{
  tried passenger
  tried evehicle
  tried evehicle Energy/default
  tried tram
} | tee seen.txt
diff - seen.txt << END
vClass passenger: 179, 0
vClass evehicle: 0, 0
vClass evehicle, emissionClass Energy/default: 0, 133
vClass tram: 0, 0
END
