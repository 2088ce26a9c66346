#!/bin/bash
# Seen with vss-tools 6.1.0: a JSON Schema of "vspec export jsonschema" takes values that VSS does not. What a catalogue says by
# pattern and arraysize is not in it, nor that uint64 begins at 0, though min, max, allowed and the bounds of the smaller types
# are; and a signal that the catalogue does not have is welcome. Nothing is said. Whoever checks messages by it lets a plate
# in small letters and three wheels through. One would expect the schema to refuse them, or a warning.
# Seen (value: what the schema says):
#   Door 256: refused
#   Plate abc: taken
#   Wheels [1, 2, 3]: taken
#   Driven -1: taken
#   Dor 1: taken
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q vss-tools==6.1.0 jsonschema==4.26.0
signal() { printf '%s:\n  type: attribute\n  datatype: %s\n  description: It.\n%b' "Vehicle.$1" "$2" "${3:-}"; }
{
  printf 'Vehicle:\n  type: branch\n  description: It.\n'
  signal Door uint8
  signal Plate string "  pattern: '^[A-Z]+$'\n"
  signal Wheels 'uint8[]' '  arraysize: 4\n'
  signal Driven uint64
} > car.vspec
echo '{}' > none.yaml
v/bin/vspec export jsonschema -s car.vspec -u none.yaml -q none.yaml -o car.json > said.txt 2>&1
cat > seen.py << 'P'
import json

import jsonschema

check = jsonschema.Draft202012Validator(json.load(open("car.json"))).is_valid
for name, value in ("Door", 256), ("Plate", "abc"), ("Wheels", [1, 2, 3]), ("Driven", -1), ("Dor", 1):
    print(f"{name} {value}: {'taken' if check({name: value}) else 'refused'}")
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
Door 256: refused
Plate abc: taken
Wheels [1, 2, 3]: taken
Driven -1: taken
Dor 1: taken
END
