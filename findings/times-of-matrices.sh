#!/bin/bash
# Seen with eclipse-sumo 1.28.0: the times of matrices in the formats V and O (VISUM) are hours and minutes with a point
# between, and od2trips reads the digits behind it as a number. 7.30 is half past seven, 7.3 three minutes past, 7.5 five past.
# A matrix that went through a spreadsheet, or through pandas, has lost its last nought: 1000 trips of half an hour depart
# within three minutes. Nothing is said, nor of a minute 75. One would expect 7.3 to be 7.30, or to be refused.
# Seen (of 1000 trips, the first and the last departure, in minutes after the hour, by what stands in the matrix):
#   7.00 to 7.30: 0 to 30
#   7.0 to 7.3: 0 to 3
#   7.00 to 7.5: 0 to 5
#   7.00 to 7.75: 0 to 75
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
echo '<tazs><taz id="1" edges="e1"/><taz id="2" edges="e2"/></tazs>' > taz.xml
of() {
  printf '$O;D2\n%s %s\n1.00\n1 2 1000\n' "$1" "$2" > m.od
  v/bin/od2trips -n taz.xml -d m.od -o m.xml > said.txt 2>&1
  ! grep -iE 'warning|error' said.txt
  grep -oP 'depart="\K[^"]*' m.xml | sort -n | sed -n '1p;$p' | tr '\n' ' ' |
    awk -v name="$1 to $2" '{printf "%s: %.0f to %.0f\n", name, $1 / 60 - 420, $2 / 60 - 420}'
}
{ of 7.00 7.30; of 7.0 7.3; of 7.00 7.5; of 7.00 7.75; } | tee seen.txt
diff - seen.txt << END
7.00 to 7.30: 0 to 30
7.0 to 7.3: 0 to 3
7.00 to 7.5: 0 to 5
7.00 to 7.75: 0 to 75
END
