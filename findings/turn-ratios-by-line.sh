#!/bin/bash
# Seen with eclipse-sumo 1.28.0: generateTurnRatios.py reads route files line by line. Of vehicles that stand on one line
# each, route inside, as scripts write them, the first counts for nothing, and every other route goes to the vehicle before
# it; of a file without line breaks, nothing is left, and the turn ratios are empty. Nothing is said, and SUMO drives all
# three alike. One would expect an XML file to mean the same however its lines are broken.
# Seen (turns of ten vehicles, six to b and four to c):
#   as SUMO writes it: b 6, c 4
#   a vehicle on a line: b 5, c 4
#   all on one line: none
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
export SUMO_HOME=$(v/bin/python -c 'import sumo; print(sumo.SUMO_HOME)')
tried() {  # what, between the vehicles, within a vehicle
  v/bin/python - "$2" "$3" << 'P'
import sys
between, within = (text.encode().decode("unicode_escape") for text in sys.argv[1:])
each = '<vehicle id="v{0}" depart="{0}">{2}<route edges="a {1}"/>{2}</vehicle>{3}'
text = "".join(each.format(n, "b" if n < 6 else "c", within, between) for n in range(10))
open("a.rou.xml", "w").write(f"<routes>{between}{text}</routes>\n")
P
  v/bin/python "$SUMO_HOME"/tools/turn-defs/generateTurnRatios.py -r a.rou.xml -o a.xml
  seen=$(sed -nE 's/.* to="([^"]*)" count="([^"]*)".*/\1 \2/p' a.xml | paste -sd, | sed 's/,/, /g')
  echo "$1: ${seen:-none}"
}
{
  tried 'as SUMO writes it' '\n' '\n'
  tried 'a vehicle on a line' '\n' ''
  tried 'all on one line' '' ''
} | tee seen.txt
diff - seen.txt << END
as SUMO writes it: b 6, c 4
a vehicle on a line: b 5, c 4
all on one line: none
END
