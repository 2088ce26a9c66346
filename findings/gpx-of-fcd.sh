#!/bin/bash
# Seen with eclipse-sumo 1.28.0: traceExporter.py --gpx-output writes seconds of the simulation where GPX has date and
# time, with or without --base-date, and gpxpy 1.6.2 drops them without a word: a track without times or duration. And
# of an fcd-output without fcd-output.geo, metres become degrees: a car's longitude is 491. One would expect times
# from the base date, and metres to be refused or converted.
# Seen (first and last longitude, first and last time; the first time and the duration that gpxpy reads):
#   fcd-output: 5.08 to 491.2, 0.0 to 35.0; None, None
#   fcd-output.geo: 2.100069 to 2.106689, 0.0 to 35.0; None, None
#   fcd-output.geo, base date: 2.100069 to 2.106689, 0.0 to 35.0; None, None
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0 gpxpy==1.6.2
export SUMO_HOME=$(v/bin/python -c 'import sumo; print(sumo.SUMO_HOME)')
echo '<nodes><node id="a" x="2.1" y="48.8"/><node id="b" x="2.1067" y="48.8"/></nodes>' > a.nod.xml
echo '<edges><edge id="e" from="a" to="b"/></edges>' > a.edg.xml
echo '<routes><vType id="t" sigma="0" speedFactor="1" speedDev="0"/>
<vehicle id="v" type="t" depart="0"><route edges="e"/></vehicle></routes>' > a.rou.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml --proj.utm -o a.net.xml > /dev/null 2>&1
cat > seen.py << 'P'
import re
import sys
import gpxpy
text = open("a.gpx").read()
longitudes, times = re.findall('lon="([^"]*)"', text), re.findall("<time>([^<]*)", text)
(track,) = gpxpy.parse(text).tracks
read = track.segments[0].points[0].time, track.get_duration()
print(f"{sys.argv[1]}: {longitudes[0]} to {longitudes[-1]}, {times[0]} to {times[-1]}; {read[0]}, {read[1]}")
P
tried() {  # name, options of sumo, options of traceExporter
  v/bin/sumo -n a.net.xml -r a.rou.xml --no-step-log --fcd-output a.fcd.xml $2 > /dev/null 2>&1
  v/bin/python "$SUMO_HOME"/tools/traceExporter.py -i a.fcd.xml --gpx-output a.gpx $3 > /dev/null 2>&1
  v/bin/python seen.py "$1"
}
{
  tried fcd-output '' ''
  tried fcd-output.geo --fcd-output.geo ''
  tried 'fcd-output.geo, base date' --fcd-output.geo '--base-date 1781604000'
} | tee seen.txt
diff - seen.txt << END
fcd-output: 5.08 to 491.2, 0.0 to 35.0; None, None
fcd-output.geo: 2.100069 to 2.106689, 0.0 to 35.0; None, None
fcd-output.geo, base date: 2.100069 to 2.106689, 0.0 to 35.0; None, None
END
