#!/bin/bash
# Seen with routerl 2.0.0 on eclipse-sumo 1.28.0: the travel time that it gives a driver, from which rewards and
# figures are made, is that of SUMO's tripinfo (duration and departDelay) plus 2 s: it asks who has arrived before the
# next step is made and counts that step too. On the two-route network, with trips of half a minute, that is 6 %.
# Seen: 10 trips, each 2.0 s longer than duration + departDelay
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q routerl==2.0.0 eclipse-sumo==1.28.0
cat > seen.py <<'X'
import re
from routerl import TrafficEnvironment

env = TrafficEnvironment(
    seed=1,
    agent_parameters={"num_agents": 10, "new_machines_after_mutation": 0},
    simulator_parameters={"network_name": "two_route_yield", "simulation_timesteps": 180},
    path_generation_parameters={"number_of_paths": 2, "visualize_paths": False},
    plotter_parameters={"plot_choices": "none"},
)
env.start()
env.step()
told = {str(each["id"]): 60 * each["travel_time"] for each in env.last_episode_travel_times}
env.stop_simulation()
text = open("training_records/SUMO_output/detailed_sumo_stats_1.xml").read()
rows = [dict(re.findall(r'(\w+)="([^"]*)"', row)) for row in re.findall(r"<tripinfo [^>]*>", text)]
more = {round(told[row["id"]] - float(row["duration"]) - float(row["departDelay"]), 3) for row in rows}
print(f"{len(rows)} trips, each {' or '.join(map(str, more))} s longer than duration + departDelay")
X
export SUMO_HOME=$(echo "$t"/v/lib/python3*/site-packages/sumo)
PATH="$SUMO_HOME/bin:$PATH" v/bin/python seen.py 2> errors.txt | grep '^[0-9]* trips' | tee seen.txt
echo "10 trips, each 2.0 s longer than duration + departDelay" | diff - seen.txt
