#!/bin/bash
# Seen with gtfs_kit 13.0.1 and eclipse-sumo 1.28.0: neither reads GTFS's frequencies.txt, by which feeds tell of lines that come
# every so many minutes. Of a bus every ten minutes from 6 to 22 h gtfs_kit reckons one trip a day, and SUMO's gtfs2fcd.py, the
# first half of gtfs2pt.py, makes one bus. Nothing is said. Of the same buses as trips of their own, both count all. One would
# expect the same of both forms, or a warning that there is a table which is not read.
# Seen (trips a day by gtfs_kit, buses by gtfs2fcd.py):
#   as 96 trips: 96 trips, 96 buses
#   by frequency: 1 trips, 1 buses
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q gtfs_kit==13.0.1 eclipse-sumo==1.28.0
export SUMO_HOME=$(echo "$PWD"/v/lib/python*/site-packages/sumo)
cat > seen.py << 'P'
import subprocess
import sys
import zipfile

import gtfs_kit

def clock(minute):
    return f"{minute // 60:02}:{minute % 60:02}:00"

def feed(name, starts, more):
    trips, times = ["route_id,service_id,trip_id"], ["trip_id,arrival_time,departure_time,stop_id,stop_sequence"]
    for at in starts:
        trips.append(f"r,w,t{at}")
        times += [f"t{at},{clock(at + 5 * n)},{clock(at + 5 * n)},s{n},{n}" for n in (1, 2, 3)]
    tables = {
        "agency": "agency_id,agency_name,agency_url,agency_timezone\na,A,http://a.example,Europe/Paris",
        "stops": "stop_id,stop_name,stop_lat,stop_lon\n" + "\n".join(f"s{n},S{n},48.0,2.0{n}" for n in (1, 2, 3)),
        "routes": "route_id,agency_id,route_short_name,route_type\nr,a,1,3",
        "calendar": "service_id,monday,tuesday,wednesday,thursday,friday,saturday,sunday,start_date,end_date\n"
        "w,1,1,1,1,1,0,0,20260101,20261231",
        "calendar_dates": "service_id,date,exception_type",
        "trips": "\n".join(trips), "stop_times": "\n".join(times), **more,
    }
    with zipfile.ZipFile(f"{name}.zip", "w") as file:
        for table, text in tables.items():
            file.writestr(f"{table}.txt", text + "\n")
    stats = gtfs_kit.read_feed(f"{name}.zip", dist_units="km").compute_route_stats(["20260105"]).iloc[0]
    tool = [sys.executable, sys.argv[1], "--gtfs", f"{name}.zip", "--date", "20260105", "--fcd", name]
    subprocess.run([*tool, "--gpsdat", name, "--modes", "bus"], check=True, capture_output=True)
    return f"{stats['num_trips']} trips, {open(f'{name}/bus.rou.xml').read().count('depart=')} buses"

every = range(360, 1320, 10)
print("as 96 trips:", feed("trips", every, {}))
often = {"frequencies": "trip_id,start_time,end_time,headway_secs\nt360,06:00:00,22:00:00,600"}
print("by frequency:", feed("often", every[:1], often))
P
v/bin/python -W ignore seen.py "$SUMO_HOME/tools/import/gtfs/gtfs2fcd.py" | tee seen.txt
diff - seen.txt << END
as 96 trips: 96 trips, 96 buses
by frequency: 1 trips, 1 buses
END
