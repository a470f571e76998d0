#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A missed goal fails with --strict and only then; scripts/bench passes --strict on.
set -euo pipefail
root=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
goals() { python3 "$root/scripts/goals.py" "$@" >"$folder/out"; }
echo '{"goals": [{"name": "fast", "value": 1, "limit": 2}]}' >"$folder/met.json"
echo '{"goals": [{"name": "exact", "value": 3, "limit": 2}]}' >"$folder/missed.json"
fail() {
  echo "$*"
  exit 1
}

goals "$folder/met.json" "$folder/missed.json" || fail "a missed goal failed without --strict"
grep -q 'exact .*missed' "$folder/out" || fail "a missed goal is not named"
goals --strict "$folder/met.json" || fail "goals that are met failed"
! goals --strict "$folder/met.json" "$folder/missed.json" || fail "a missed goal did not fail with --strict"
"$root/scripts/bench" --help | grep -q -- --strict || fail "scripts/bench has no --strict"
