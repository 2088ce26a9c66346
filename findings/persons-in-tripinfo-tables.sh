#!/bin/bash
# Seen with eclipse-sumo 1.28.0: in a table (--tripinfo-output t.csv) of a run with emissions, persons are written into the
# columns of vehicles, from the left on. A person's type stands under departLane, how long it was on its way under departSpeed,
# and again under waitingTime, so that who walks counts as one who waited all the time. Without emissions they have columns of their own.
# SUMO warns that such tables are experimental and for rows of one kind; one would expect empty fields, as in fcd-output.
# Seen (fields of the person's row, by the names above them):
#   departLane DEFAULT_PEDTYPE
#   departSpeed 854.00
#   waitingTime 854.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<nodes><node id="a" x="0" y="0"/><node id="b" x="1000" y="0"/></nodes>' > a.nod.xml
echo '<edges><edge id="ab" from="a" to="b" speed="13.89"/></edges>' > a.edg.xml
v/bin/netconvert -n a.nod.xml -e a.edg.xml --sidewalks.guess -o a.net.xml > /dev/null
cat > a.rou.xml <<'E2'
<routes><trip id="c" depart="0" from="ab" to="ab"/><person id="p" depart="1"><walk edges="ab" arrivalPos="1000"/></person></routes>
E2
v/bin/sumo -n a.net.xml -r a.rou.xml --device.emissions.probability 1 --tripinfo-output t.csv --no-step-log > /dev/null 2>&1
v/bin/python - <<'E2' | tee seen.txt
import csv
person = next(row for row in csv.DictReader(open("t.csv"), delimiter=";") if "p" in row["tripinfo_id"])
for name in "departLane", "departSpeed", "waitingTime":
    print(name, person["tripinfo_" + name])
E2
printf '%s\n' 'departLane DEFAULT_PEDTYPE' 'departSpeed 854.00' 'waitingTime 854.00' | diff - seen.txt
