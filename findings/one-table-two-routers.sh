#!/bin/bash
# Seen with eclipse-sumo 1.28.0: dfrouter and flowrouter.py read the same table of counts (Detector;Time;qPKW;qLKW), and make
# other traffic of it. dfrouter takes cars and lorries together, flowrouter.py the column of cars alone, unless told
# otherwise (--flow-column). And dfrouter, which takes a row for a minute unless it is told (--time-step), sends all
# vehicles of a quarter of an hour out in its first minute; flowrouter.py spreads them to the next row. Neither says so.
# One would expect both to agree: the table has both columns, and all its times.
# Seen (of four quarters with 90 cars and 30 lorries each: vehicles, and those that depart in the first minute of a quarter):
#   dfrouter: 480, 480
#   dfrouter --time-step 900: 480, 32
#   flowrouter.py: 360, 24
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/><node id="c" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="e1" from="a" to="b"/><edge id="e2" from="b" to="c"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml -o a.net.xml > /dev/null
echo '<additional><detectorDefinition id="d1" lane="e1_0" pos="50"/><detectorDefinition id="d2" lane="e2_0" pos="400"/>
</additional>' > d.xml
{
  echo 'Detector;Time;qPKW;qLKW;vPKW;vLKW'
  for minute in 0 15 30 45; do for d in d1 d2; do echo "$d;$minute;90;30;50;50"; done; done
} > a.csv
cat > a.py << 'END'
import re
import sys
from pathlib import Path

text = Path(sys.argv[1]).read_text()
departs = [float(time) for time in re.findall(r'<vehicle [^>]*depart="([\d.]+)"', text)]
for number, begin, end in re.findall(r'<flow [^>]*number="(\d+)" begin="([\d.]+)" end="([\d.]+)"', text):
    departs += [float(begin) + (float(end) - float(begin)) / int(number) * each for each in range(int(number))]
print(f"{len(departs)}, {sum(time % 900 < 60 for time in departs)}")
END
df() { v/bin/dfrouter -n a.net.xml -d d.xml -f a.csv -o r.xml --emitters-output o.xml -b 0 -e 3600 "$@" > /dev/null && v/bin/python a.py o.xml; }
{
  echo "dfrouter: $(df)"
  echo "dfrouter --time-step 900: $(df --time-step 900)"
  env SUMO_HOME="$(echo v/lib/python3*/site-packages/sumo)" v/bin/python v/lib/python3*/site-packages/sumo/tools/detector/flowrouter.py \
    -n a.net.xml -d d.xml -f a.csv -o r.xml -e f.xml -b 0 -i 15 > /dev/null 2>&1
  echo "flowrouter.py: $(v/bin/python a.py f.xml)"
} | tee seen.txt
printf '%s\n' 'dfrouter: 480, 480' 'dfrouter --time-step 900: 480, 32' 'flowrouter.py: 360, 24' | diff - seen.txt
