"""A network of URB as a scenario. python urb.py URB/networks/ingolstadt_custom runs/urb/ingolstadt_custom"""

import ast
import csv
import shutil
import sys
from pathlib import Path

source, out = Path(sys.argv[1]), Path(sys.argv[2])
name = source.name
out.mkdir(parents=True, exist_ok=True)
shutil.copy(source / f"{name}.net.xml", out)
places = ast.literal_eval((source / f"od_{name}.txt").read_text(encoding="utf-8"))
with (source / "agents.csv").open(encoding="utf-8") as file:
    agents = sorted(csv.DictReader(file), key=lambda agent: int(agent["start_time"]))
trips = "".join(
    f'    <trip id="{agent["id"]}" depart="{agent["start_time"]}" departLane="best" '
    f'from="{places["origins"][int(agent["origin"])]}" to="{places["destinations"][int(agent["destination"])]}"/>\n'
    for agent in agents
)
(out / "trips.rou.xml").write_text(f"<routes>\n{trips}</routes>\n", encoding="utf-8")
files = f'<net-file value="{name}.net.xml"/><route-files value="trips.rou.xml"/><step-length value="1"/>'
(out / f"{name}.sumocfg").write_text(f"<configuration>{files}</configuration>\n", encoding="utf-8")
print(f"{out / name}.sumocfg: {len(agents)} trips")
