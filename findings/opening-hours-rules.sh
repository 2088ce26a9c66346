#!/bin/sh
# opening_hours.js 3.15.0 and opening-hours-py 2.1.4 read the same valid hours otherwise. Of "Sa; 12:00-14:00" the
# second rule names no day: to the one it adds hours and Saturday stays open all day, to the other it replaces the
# first on every day. And of "15:00-04:00; Th 11:30-10:15" the other, on Friday morning, looks at Friday's rule alone.
set -e
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT
python3 -m venv "$t/v" && "$t/v/bin/pip" -q install opening-hours-py==2.1.4
(cd "$t" && npm install --silent --no-save opening_hours@3.15.0 > /dev/null 2>&1)
ask() { # hours, an instant
    one=$(cd "$t" && node -e 'const O = require("opening_hours"); const [hours, at] = process.argv.slice(1);
        console.log(new O(hours).getState(new Date(at)) ? "open" : "closed")' "$1" "$2")
    other=$("$t/v/bin/python" -c 'import sys; from datetime import datetime; from opening_hours import OpeningHours
print("open" if OpeningHours(sys.argv[1]).is_open(datetime.fromisoformat(sys.argv[2])) else "closed")' "$1" "$2")
    echo "$1 at $2: opening_hours.js $one, opening-hours-py $other"
    [ "$one $other" = "$3" ] || { echo "changed: expected $3"; exit 1; }
}
ask "Sa; 12:00-14:00" 2026-06-13T10:00 "open closed"
ask "15:00-04:00; Th 11:30-10:15" 2026-06-19T05:00 "open closed"
ask "Mo-Fr 07:00-09:00; Mo 10:00-11:00" 2026-06-15T08:00 "closed closed"
