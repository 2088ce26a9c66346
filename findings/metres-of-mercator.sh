#!/bin/bash
# Seen with eclipse-sumo 1.28.0: netconvert takes any projection for one in true metres. With --proj EPSG:3857, that of web maps,
# a road of 1000 m at 52 degrees north is 1621 m long, and a car takes 62 % longer for it at the same speed. Nothing is said,
# and places come out right, so that no map beside it shows it. One would expect lengths on the ground, or a warning.
# Seen (length of a road of 1000 m, seconds at 50 km/h):
#   --proj.utm: 1000, 72
#   --proj EPSG:25832: 1000, 72
#   --proj EPSG:3857: 1621, 117
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
cat > a.osm << 'END'
<osm version="0.6"><node id="1" lat="52" lon="9" version="1"/><node id="2" lat="52" lon="9.014567" version="1"/>
<way id="1" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="secondary"/><tag k="oneway" v="yes"/>
<tag k="maxspeed" v="50"/></way></osm>
END
for words in '--proj.utm' '--proj EPSG:25832' '--proj EPSG:3857'; do
  v/bin/netconvert --osm-files a.osm $words -o a.net.xml > said.txt 2>&1
  ! grep -i warning said.txt
  m=$(grep -oP '<lane id="1_0".* length="\K[0-9]+' a.net.xml)
  echo "$words: $m, $(awk "BEGIN {printf \"%.0f\", $m / 13.89}")"
done | tee seen.txt
diff - seen.txt << END
--proj.utm: 1000, 72
--proj EPSG:25832: 1000, 72
--proj EPSG:3857: 1621, 117
END
