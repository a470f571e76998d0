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

# A program that fails is named at the end, after the others and their goals.
mkdir -p "$folder/tree/scripts" "$folder/tree/build/bin" "$folder/tree/tests/bench"
echo "handcast_bench(bench_thing)" >"$folder/tree/tests/bench/CMakeLists.txt"
cp "$root"/scripts/{bench,lib.sh,goals.py} "$folder/tree/scripts/"
for stub in setup build; do printf '#!/bin/sh\n' >"$folder/tree/scripts/$stub"; done
printf '#!/bin/sh\nexit 1\n' >"$folder/tree/build/bin/bench_thing"
printf '#!/bin/sh\ncp "%s" "$2"\n' "$folder/met.json" >"$folder/tree/build/bin/bench_thing_too"
chmod +x "$folder"/tree/scripts/* "$folder"/tree/build/bin/*
code=0
"$folder/tree/scripts/bench" thing >"$folder/out" 2>&1 || code=$?
[ $code = 2 ] || fail "a benchmark that failed does not fail scripts/bench"
grep -q 'failed: bench_thing$' "$folder/out" || fail "a benchmark that failed is not named"
grep -q 'fast .*met' "$folder/out" || fail "a benchmark that failed hides the goals of the others"
