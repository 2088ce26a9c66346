#!/bin/bash
# Seen with eclipse-sumo 1.28.0: netconvert reads the modes of a MATSim link as one word. A link for "car" is open to cars;
# one for "car,bus", "car,ride" or "car,bike" is closed to everybody, and so is most of a real network. Nothing is said.
# And links keep the length of the line between their nodes, where MATSim states one (--matsim.keep-length takes it). One
# would expect a list of modes to open the link to each, as lists of VISUM do.
# Seen (modes: who may use the lane of a link of 1500 m whose nodes are 1000 m apart, and its length):
#   car: passenger, 1000.00
#   car,bus: nobody, 1000.00
#   car,bike: nobody, 1000.00
#   bike: bicycle, 1000.00
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q eclipse-sumo==1.28.0
tried() {  # modes
  echo "<network><nodes><node id='1' x='0' y='0'/><node id='2' x='1000' y='0'/></nodes><links capperiod='01:00:00'>
  <link id='a' from='1' to='2' length='1500' freespeed='13.9' capacity='1800' permlanes='1' oneway='1' modes='$1'/></links>
  </network>" > a.xml
  v/bin/netconvert --matsim-files a.xml -o a.net.xml 2>&1 | grep -v Success || true
  lane=$(grep '<lane id="a_0"' a.net.xml)
  may=$(grep -oP ' allow="\K[^"]*' <<< "$lane" || true)
  if grep -q 'disallow="all"' <<< "$lane"; then may=nobody; fi
  echo "$1: $may, $(grep -oP 'length="\K[^"]*' <<< "$lane")"
}
for modes in car car,bus car,bike bike; do tried $modes; done | tee seen.txt
printf '%s\n' 'car: passenger, 1000.00' 'car,bus: nobody, 1000.00' 'car,bike: nobody, 1000.00' 'bike: bicycle, 1000.00' | diff - seen.txt
