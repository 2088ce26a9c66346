#!/bin/bash
# Seen with scenariogeneration 0.16.7: the second argument of xosc.Precipitation is written as it is, as a share of 1 in
# OpenSCENARIO 1.0 (intensity), and as mm/h from 1.1 on (precipitationIntensity). Rain of 0.9, nearly the heaviest in the one,
# is a drizzle in the other, and 30 mm/h is a share of 30, which 1.0 does not have. Nothing is said, though the package checks
# by version elsewhere (clouds, the sun). One would expect the amount to stay, or a question which one is meant.
# Seen (Precipitation(rain, 0.9), and 30, by version):
#   1.0: intensity 0.9, 30.0
#   1.1: precipitationIntensity 0.9, 30.0
#   1.3: precipitationIntensity 0.9, 30.0
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q scenariogeneration==0.16.7
cat > seen.py << 'P'
from scenariogeneration import xosc

for minor in 0, 1, 3:
    found = []
    for amount in 0.9, 30:
        rain = xosc.Precipitation(xosc.PrecipitationType.rain, amount)
        rain.setVersion(minor=minor)
        found.append({key: value for key, value in rain.get_attributes().items() if "ntensity" in key})
    (name,) = found[0]
    print(f"1.{minor}: {name} {', '.join(each[name] for each in found)}")
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
1.0: intensity 0.9, 30.0
1.1: precipitationIntensity 0.9, 30.0
1.3: precipitationIntensity 0.9, 30.0
END
