#!/usr/bin/env bash
# Evaluates the agents of a checkout by a plan and compares them with an earlier evaluation. It needs automotive-cosim on
# the path and nothing of GitHub's, so any runner, or you, can call it.
#
#   evaluate.sh CHECKOUT PLAN OUT [BEFORE [THRESHOLD]]
#
#   CHECKOUT   folder from which the plan's package.module:Class are imported
#   PLAN       plan.toml
#   OUT        gets after/ (the evaluation), compare.xml (JUnit) and compare.md; a folder of its own for each state of
#              the agent, as a second start resumes the first
#   BEFORE     an earlier evaluation; without one, as where the base has no such agent yet, the new one is compared with
#              itself, and something must have succeeded
#   THRESHOLD  percentage points by which success may fall, or points of the score of drives; 0 by default
#
# Exit code 1 if success fell by more than that, nothing ever succeeded, or something planned was not run; 2 if the plan or the agent cannot be
# used, 3 if something failed that is no fault of the agent's: automotive-cosim's own codes.
set -euo pipefail
[ $# -ge 3 ] && [ $# -le 5 ] || { sed -n '2,17s/^# \{0,1\}//p' "$0" >&2; exit 2; }
[ -f "$2" ] || { echo "there is no plan $2" >&2; exit 2; }
plan=$(realpath "$2")
mkdir -p "$3"
out=$(realpath "$3")
before=$(realpath -m "${4:-$out/after}")
cd "$1"
least=0
if [ ! -f "$before/manifest.json" ] || [ "$before" = "$out/after" ]; then
    echo "There is no earlier evaluation: this one is compared with itself."
    before=$out/after
    least=0.0001
fi
# It ends with 1 below the least, and with 3 if errors are left, which compare names.
code=0
automotive-cosim eval --plan "$plan" --workers 2 --out "$out/after" --at-least $least || code=$?
case $code in
    0 | 1 | 3) ;;
    *) echo "evaluate.sh: nothing was compared; its --out is OUT/after, with OUT $3, the third argument" >&2; exit $code ;;
esac
rm -f "$out/compare.xml" "$out/compare.md"
automotive-cosim compare "$before" "$out/after" --threshold "${5:-0}" --junit "$out/compare.xml" --markdown "$out/compare.md"
[ $code != 1 ]
