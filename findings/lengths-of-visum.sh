#!/bin/bash
# Seen with eclipse-sumo 1.28.0: netconvert reads a VISUM network and drops the length of its links (LAENGE), by which
# VISUM itself reckons distances and times. A link of 1.5 km between nodes that lie 1 km apart, as planners draw a winding
# road, is 1 km long in SUMO, and so is what any vehicle drives there. Nothing is said. The lane count and speed beside it
# are read. One would expect the link's length, which a network of SUMO's can have apart from its shape.
# Seen (m):
#   LAENGE 1.500: 1000.00
#   LAENGE 1.500km: 1000.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
for length in 1.500 1.500km; do
  printf '%s\n' '$VISION' '$VERSION:VERSNR;FILETYPE;LANGUAGE;UNIT' '8.10;Net;DEU;KM' '' \
    '$KNOTEN:NR;NAME;TYP;XKOORD;YKOORD' '1;a;0;0.0;0.0' '2;b;0;1000.0;0.0' '' \
    '$STRECKE:NR;VONKNOTNR;NACHKNOTNR;NAME;TYPNR;LAENGE;ANZFAHRSTREIFEN;KAPIV;V0IV;VSYSSET' \
    "1;1;2;a;1;$length;2;1000;50;P" "1;2;1;a;1;$length;2;1000;50;P" '' > a.net
  v/bin/netconvert --visum-file a.net -o a.net.xml > said.txt 2>&1
  ! grep -i 'warning\|error' said.txt
  echo "LAENGE $length: $(grep -oP 'lane id="1_0".* speed="13.89" length="\K[^"]*' a.net.xml)"
done | tee seen.txt
diff - seen.txt << END
LAENGE 1.500: 1000.00
LAENGE 1.500km: 1000.00
END
