#!/bin/bash
# Seen with vss-tools 6.1.0: "vspec export protobuf" numbers fields by their place in the file, anew with each export.
# An overlay that takes out one signal, as makers do with what a car has not, moves all after it up: a receiver built
# from the catalogue reads the right door as the left one, of the same type, and nobody notices. Signals that an
# overlay adds come last and move none. One would expect a signal to keep its number. What nobody has set is, in
# proto3, the first of the allowed values: the lock reads LOCKED, though its default is UNLOCKED.
# Seen:
#   catalogue: IsLeftOpen = 1 IsRightOpen = 2 LOCKED = 0 UNLOCKED = 1 Lock = 3
#   one added: IsLeftOpen = 1 IsRightOpen = 2 LOCKED = 0 UNLOCKED = 1 Lock = 3 IsRearOpen = 4
#   one taken out: IsRightOpen = 1 LOCKED = 0 UNLOCKED = 1 Lock = 2
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q vss-tools==6.1.0
echo '{}' > none.yaml
sensor() { printf 'Vehicle.Doors.%s:\n  type: sensor\n  datatype: boolean\n  description: Whether it is open.\n' "$1"; }
{
  printf 'Vehicle:\n  type: branch\n  description: Car.\nVehicle.Doors:\n  type: branch\n  description: Doors.\n'
  sensor IsLeftOpen
  sensor IsRightOpen
  printf 'Vehicle.Doors.Lock:\n  type: actuator\n  datatype: string\n  allowed: ["LOCKED", "UNLOCKED"]\n'
  printf '  default: "UNLOCKED"\n  description: Lock.\n'
} > catalogue.vspec
sensor IsRearOpen > added.vspec
{ sensor IsLeftOpen; echo '  delete: true'; } > out.vspec
told() {  # name, overlay
  v/bin/vspec export protobuf -s catalogue.vspec -u none.yaml -q none.yaml -o a.proto "${@:2}" > /dev/null 2>&1
  echo "$1:" $(sed -n '/message VehicleDoors/,$p' a.proto | grep -o '[A-Za-z]* = [0-9]*')
}
{
  told catalogue
  told 'one added' -l added.vspec
  told 'one taken out' -l out.vspec
} | tee seen.txt
diff - seen.txt << END
catalogue: IsLeftOpen = 1 IsRightOpen = 2 LOCKED = 0 UNLOCKED = 1 Lock = 3
one added: IsLeftOpen = 1 IsRightOpen = 2 LOCKED = 0 UNLOCKED = 1 Lock = 3 IsRearOpen = 4
one taken out: IsRightOpen = 1 LOCKED = 0 UNLOCKED = 1 Lock = 2
END
