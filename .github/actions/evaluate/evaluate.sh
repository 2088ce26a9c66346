#!/usr/bin/env bash
# Evaluates the agents of a checkout by a plan and compares them with an earlier evaluation. It needs automotive-cosim on
# the path and nothing of GitHub's, so any runner, or you, can call it.
#
#   evaluate.sh CHECKOUT PLAN OUT [BEFORE [THRESHOLD]]
#
#   CHECKOUT   folder from which the plan's package.module:Class are imported
#   PLAN       plan.toml
#   OUT        gets after/ (the evaluation), compare.xml (JUnit) and compare.md
#   BEFORE     an earlier evaluation of the same plan; without one, the new one is compared with itself
#   THRESHOLD  percentage points by which success may fall; 0 by default
#
# Exit code 1 if success fell by more than that, or something planned was not run; 2 or 3 as automotive-cosim's.
set -euo pipefail
[ $# -ge 3 ] && [ $# -le 5 ] || { sed -n '2,14s/^# \{0,1\}//p' "$0" >&2; exit 2; }
plan=$(realpath "$2")
mkdir -p "$3"
out=$(realpath "$3")
before=$(realpath -m "${4:-$out/after}")
cd "$1"
# With errors left the exit code is 3; compare names them.
automotive-cosim eval --plan "$plan" --workers 2 --out "$out/after" || test $? = 3
[ -f "$before/manifest.json" ] || before=$out/after
automotive-cosim compare "$before" "$out/after" --threshold "${5:-0}" --junit "$out/compare.xml" --markdown "$out/compare.md"
