#!/bin/bash
# Seen with json-repair 0.64.6, through which agents' answers are often read: a time of day that a model leaves without
# quotes loses its minutes, and a figure its unit; both come back as whole numbers that any schema takes. A decimal
# comma becomes a string instead. And of two objects, one after the other, the first is dropped if both have the same
# keys, while two with other keys come back as a list. One would expect text for what is no number, and both objects.
# Seen:
#   {"alarm": 17:45} -> {'alarm': 17}
#   {"speed": 50 mph} -> {'speed': 50}
#   {"temperature": 21,5} -> {'temperature': '21,5'}
#   {"do": 1} {"do": 2} -> {'do': 2}
#   {"do": 1} {"say": 2} -> [{'do': 1}, {'say': 2}]
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q json-repair==0.64.6
cat > seen.py << 'P'
import json_repair

for line in open(0).read().splitlines():
    print(line, "->", json_repair.loads(line))
P
v/bin/python seen.py << 'END' | tee seen.txt
{"alarm": 17:45}
{"speed": 50 mph}
{"temperature": 21,5}
{"do": 1} {"do": 2}
{"do": 1} {"say": 2}
END
diff - seen.txt << 'END'
{"alarm": 17:45} -> {'alarm': 17}
{"speed": 50 mph} -> {'speed': 50}
{"temperature": 21,5} -> {'temperature': '21,5'}
{"do": 1} {"do": 2} -> {'do': 2}
{"do": 1} {"say": 2} -> [{'do': 1}, {'say': 2}]
END
