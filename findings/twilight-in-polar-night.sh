#!/bin/bash
# Seen with astral 3.2: where there is no dawn or dusk on a day, the error is the same in midsummer, when it never
# gets dark, and in polar night, when it never gets light: the sun "never reaches 6 degrees below the horizon". In
# Longyearbyen in December the sun is lower than that all day. Who takes the error for a bright night, as its words
# say, drives without lamps in the dark. sunrise() and sunset() tell the two apart. One would expect dawn() and dusk()
# to do so too.
# Seen (dusk, sunset, and the sun's highest and lowest place on that day in degrees):
#   2026-06-16: dusk never reaches 6 degrees below, sunset always above; 35 to 12
#   2026-12-16: dusk never reaches 6 degrees below, sunset always below; -11 to -35
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q astral==3.2
cat > seen.py << 'P'
import re
from datetime import date, datetime, timedelta, timezone
from astral import Observer
from astral.sun import dusk, elevation, sunset

here = Observer(78.2, 15.6)

def refusal(of, day):
    try:
        return of(here, day)
    except ValueError as error:
        return re.search(r"never reaches 6 degrees (below|above)|always (above|below)", str(error))[0]

for day in date(2026, 6, 16), date(2026, 12, 16):
    midnight = datetime(day.year, day.month, day.day, tzinfo=timezone.utc)
    places = [elevation(here, midnight + timedelta(minutes=each)) for each in range(0, 1440, 10)]
    print(f"{day}: dusk {refusal(dusk, day)}, sunset {refusal(sunset, day)}; {max(places):.0f} to {min(places):.0f}")
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
2026-06-16: dusk never reaches 6 degrees below, sunset always above; 35 to 12
2026-12-16: dusk never reaches 6 degrees below, sunset always below; -11 to -35
END
