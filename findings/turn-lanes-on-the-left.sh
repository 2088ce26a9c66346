#!/bin/sh
# netconvert 1.28.0 (eclipse-sumo): with --lefthand, turn:lanes of OpenStreetMap is applied mirrored. The network is
# built in a mirror and turned back; lane access (bus:lanes) is turned with it, turn arrows are not: of two lanes
# "left|", the left one goes straight on and the right one turns right.
set -e
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT
python3 -m venv "$t/v" && "$t/v/bin/pip" -q install eclipse-sumo==1.28.0
cat > "$t/m.osm" <<'X'
<osm version="0.6">
<node id="1" lat="51.500" lon="0.10"/><node id="2" lat="51.502" lon="0.10"/><node id="3" lat="51.504" lon="0.10"/>
<node id="4" lat="51.502" lon="0.097"/><node id="5" lat="51.502" lon="0.103"/>
<way id="10"><nd ref="1"/><nd ref="2"/><tag k="highway" v="tertiary"/><tag k="oneway" v="yes"/><tag k="lanes" v="2"/>
<tag k="turn:lanes" v="left|"/></way>
<way id="11"><nd ref="2"/><nd ref="3"/><tag k="highway" v="tertiary"/></way>
<way id="12"><nd ref="4"/><nd ref="2"/><nd ref="5"/><tag k="highway" v="tertiary"/></way>
</osm>
X
for side in false true; do
    PROJ_DATA="$("$t/v/bin/python" -c 'import sumo; print(sumo.SUMO_HOME)')/data/proj" "$t/v/bin/netconvert" \
        --osm-files "$t/m.osm" -o "$t/n.xml" --osm.turn-lanes --lefthand $side --no-turnarounds > /dev/null 2>&1
    # lane 1 is the left one where traffic keeps right, lane 0 where it keeps left
    left=$([ $side = true ] && echo 0 || echo 1)
    seen=$(sed -n 's/.*from="10" to="[^"]*" fromLane="'$left'".* dir="\(.\)".*/\1/p' "$t/n.xml" | sort | tr -d '\n')
    echo "lefthand $side: the left lane, with turn:lanes=left|, leads $seen (l left, s straight on, r right)"
    [ $side = false ] && want=l || want=s
    [ "$seen" = "$want" ] || { echo "changed: expected $want"; exit 1; }
done
