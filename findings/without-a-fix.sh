#!/bin/bash
# Seen with pynmea2 1.19.0: what a receiver says in a tunnel, with empty fields for the position, reads as latitude 0
# and longitude 0, numbers like any others: a place in the Gulf of Guinea. Speed and altitude beside them, as empty,
# are None. A log that is averaged, or matched to a map, is 5,000 km off. One would expect None for all; only is_valid
# tells.
# Seen (latitude, longitude):
#   RMC with a fix: 48.85 2.35; speed 10.0, is_valid True
#   RMC without: 0.0 0.0; speed None, is_valid False
#   GGA without: 0.0 0.0; altitude None, is_valid False
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q pynmea2==1.19.0
cat > seen.py << 'P'
import pynmea2

def read(body):
    total = 0
    for each in body.encode():
        total ^= each
    return pynmea2.parse(f"${body}*{total:02X}", check=True)

for name, body in (
    ("RMC with a fix", "GPRMC,101500.00,A,4851.0000,N,00221.0000,E,10.0,90.0,160626,,,A"),
    ("RMC without", "GPRMC,101501.00,V,,,,,,,160626,,,N"),
):
    said = read(body)
    print(f"{name}: {said.latitude:.4} {said.longitude:.4}; speed {said.spd_over_grnd}, is_valid {said.is_valid}")
said = read("GPGGA,101501.00,,,,,0,00,99.99,,M,,M,,")
print(f"GGA without: {said.latitude:.4} {said.longitude:.4}; altitude {said.altitude}, is_valid {said.is_valid}")
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
RMC with a fix: 48.85 2.35; speed 10.0, is_valid True
RMC without: 0.0 0.0; speed None, is_valid False
GGA without: 0.0 0.0; altitude None, is_valid False
END
