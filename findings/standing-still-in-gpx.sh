#!/bin/bash
# Seen with gpxpy 1.6.2: get_moving_data() counts the time of a car that stands still as neither moving nor stopped,
# if its position stays exactly the same, as in tracks of simulations and of receivers that hold the position at rest.
# A minute at a red light is then in no figure; with a tenth of a metre of noise it is 60 s stopped. Who takes the two
# for the whole trip gets a quicker one. One would expect moving and stopped time to add up to the duration.
# Seen (10 s of driving, then 60 s at a light):
#   position held: duration 70, moving 10, stopped 0
#   0.1 m of noise: duration 70, moving 10, stopped 60
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q gpxpy==1.6.2
cat > seen.py << 'P'
from datetime import datetime, timedelta, timezone
from gpxpy.gpx import GPXTrackPoint, GPXTrackSegment

begin = datetime(2026, 6, 16, 10, tzinfo=timezone.utc)
for name, noise in ("position held", 0.0), ("0.1 m of noise", 1e-6):
    track = GPXTrackSegment()
    for second in range(71):
        latitude = 48.8 + min(second, 10) * 1e-4 + (noise * (second % 2) if second > 10 else 0.0)
        track.points.append(GPXTrackPoint(latitude, 2.3, time=begin + timedelta(seconds=second)))
    told = track.get_moving_data()
    print(f"{name}: duration {track.get_duration():.0f}, moving {told.moving_time:.0f}, stopped {told.stopped_time:.0f}")
P
v/bin/python seen.py | tee seen.txt
printf '%s: duration 70, moving 10, stopped %s\n' 'position held' 0 '0.1 m of noise' 60 | diff - seen.txt
