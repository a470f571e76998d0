#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# results_table_test.sh CHECKOUT: scripts/results_table.py reports means, intervals and lost cells, and refuses what it cannot use.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
table=$1/scripts/results_table.py

fail() {
  printf 'results_table_test: %s\n' "$1" >&2
  cat "$work/document.md" >&2
  exit 1
}

document() { printf 'before\n<!-- installation: begin -->\nold\n<!-- installation: end -->\nafter\n' >"$work/document.md"; }

# results MM_OF_SEED_1 MM_OF_SEED_2: a sweep of one motion, with these errors of handcast and 10 mm of the others.
results() {
  local seed=1 mm variant
  echo "variant,twin.motion,twin.seed,interior_mm_mean,interior_mm_p95,lit_mm_mean,lit_mm_p95,missing,detector_px_mean"
  for mm in "$@"; do
    for variant in baseline paper handcast handcast_as_detected; do
      [ "$variant" = handcast ] || local other=10
      echo "$variant,builtin:wave,$seed,${other:-$mm},20,5,9,0.01,7"
      unset other
    done
    seed=$((seed + 1))
  done
}

document
results 5 7 >"$work/results.csv"
"$table" "$work/results.csv" "$work/document.md"
grep -q '^| wave | 10.0 / 20.0 | 10.0 / 20.0 | 6.0 / 20.0 |.*| 1.0, 1.0 | 7.0 | 0.60 ± 1.27 |' "$work/document.md" || fail "the row is wrong"
grep -q 'goal of 0.45 is missed. Ours is worse than the paper.s in 0 of 2 cells' "$work/document.md" || fail "the summary is wrong"
grep -qx before "$work/document.md" && grep -qx after "$work/document.md" || fail "the text around the table is lost"
! grep -qx old "$work/document.md" || fail "the old table is still there"

results 3 11 >"$work/results.csv"
"$table" "$work/results.csv" "$work/document.md"
grep -q 'in 1 of 2 cells of motion and seed; the largest ratio is 1.10' "$work/document.md" || fail "a lost cell is not reported"

results 5 7 "" >"$work/results.csv"
"$table" "$work/results.csv" "$work/document.md"
grep -q 'runs failed: the seeds 3' "$work/document.md" || fail "a failed run is not reported"

results 5 >"$work/results.csv"
! "$table" "$work/results.csv" "$work/document.md" 2>/dev/null || fail "one seed has no interval"
echo "no marks" >"$work/document.md"
results 5 7 >"$work/results.csv"
! "$table" "$work/results.csv" "$work/document.md" 2>/dev/null || fail "a document without the marks is not refused"
