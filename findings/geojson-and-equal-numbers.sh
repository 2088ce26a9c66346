#!/bin/bash
# Seen with osm2geojson 0.3.2: a road, or a multipolygon, is left out of the GeoJSON if its number is also that of a
# node that some way of the file passes. OpenStreetMap counts nodes, ways and relations each for themselves, so that
# equal numbers mean nothing: a file whose maker numbers nodes and ways from 1 loses most of its roads, a large
# extract some by chance. Nothing is said. One would expect every road.
# Seen (what is in the GeoJSON of road 4, which passes nodes 1 and 2, and lake 5, whose shore is way 9):
#   nodes 1 2 3: way/4 relation/5
#   nodes 1 2 4: relation/5
#   nodes 1 2 5: way/4
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q osm2geojson==0.3.2
cat > seen.py << 'P'
import osm2geojson

def element(kind, number, tags, **more):
    return {"type": kind, "id": number, "tags": tags, **more}

for last in 3, 4, 5:
    nodes = [{"type": "node", "id": each, "lat": 48.8 + each / 1000, "lon": 2.3 + each % 2 / 1000} for each in (1, 2, last)]
    road = element("way", 4, {"highway": "primary"}, nodes=[1, 2])
    shore = {"type": "way", "id": 9, "nodes": [1, 2, last, 1]}
    member = {"type": "way", "ref": 9, "role": "outer"}
    lake = element("relation", 5, {"type": "multipolygon", "natural": "water"}, members=[member])
    found = osm2geojson.json2geojson({"elements": [*nodes, road, shore, lake]})["features"]
    print("nodes 1 2", f"{last}:", *(f"{each['properties']['type']}/{each['properties']['id']}" for each in found))
P
v/bin/python seen.py | tee seen.txt
printf 'nodes 1 2 %s\n' '3: way/4 relation/5' '4: relation/5' '5: way/4' | diff - seen.txt
