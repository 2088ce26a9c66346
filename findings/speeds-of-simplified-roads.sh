#!/bin/bash
# Seen with osmnx 2.1.1: simplify_graph makes one edge of the ways between two crossings and keeps their maxspeed as a set
# without lengths; add_edge_speeds takes the mean of it. A road of which 1336 m are for 30 km/h and 301 m for 130 is one for
# 80, and takes 74 s in place of 169. Nothing is said; a graph is simplified unless one asks otherwise. With speeds added
# before, simplified with edge_attr_aggs, the time is right. One would expect the mean by length, or the sum of the times.
# Seen (km/h of the edges, s along the road):
#   as the ways are: 30 130 130, 168.6
#   simplified: 80, 73.6
#   times added first: 168.6
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q osmnx==2.1.1
cat > seen.py << 'P'
import networkx as nx
import osmnx as ox

lons, limits = (0, 0.012, 0.0134, 0.0147), ("30", "130", "130")
G = nx.MultiDiGraph(crs="EPSG:4326")
for node, lon in enumerate(lons):
    G.add_node(node, x=lon, y=0.0, street_count=2 if 0 < node < 3 else 1)
for node, limit in enumerate(limits):
    length = (lons[node + 1] - lons[node]) * 111320
    G.add_edge(node, node + 1, 0, osmid=node, highway="primary", maxspeed=limit, oneway=True, length=length)

def timed(graph):
    return ox.add_edge_travel_times(ox.add_edge_speeds(graph))

def told(name, graph):
    edges = [data for *_, data in graph.edges(data=True)]
    speeds = " ".join(f"{edge['speed_kph']:.0f}" for edge in edges) + ", " if "speed_kph" in edges[0] else ""
    print(f"{name}: {speeds}{sum(edge['travel_time'] for edge in edges):.1f}")

told("as the ways are", timed(G.copy()))
told("simplified", timed(ox.simplify_graph(G.copy())))
first = timed(G.copy())
for *_, edge in first.edges(data=True):
    del edge["speed_kph"], edge["maxspeed"]
told("times added first", ox.simplify_graph(first, edge_attr_aggs={"length": sum, "travel_time": sum}))
P
v/bin/python -W ignore seen.py | tee seen.txt
diff - seen.txt << END
as the ways are: 30 130 130, 168.6
simplified: 80, 73.6
times added first: 168.6
END
