#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The options of the scripts: "--name=value" is "--name value".
set -euo pipefail
source scripts/lib.sh
expect() {
  local wanted=$1
  shift
  split_values "$@"
  [ "${words[*]@Q}" = "$wanted" ] || { echo "$*: ${words[*]@Q}, not $wanted"; exit 1; }
}
expect "'--seconds' '2'" --seconds=2
expect "'--out' 'a b' 'x=y'" "--out=a b" x=y
expect "'--a' 'b=c' '--' '--d=e'" --a=b=c -- --d=e
expect ""
need_value --out dir
for words in --out "--out="; do
  [[ $(scripts/package "$words" 2>&1) == *"--out needs a value"* ]] || { echo "scripts/package $words: not refused"; exit 1; }
done
for script in demo bench package results get-models night train-landmarks; do
  [[ $("scripts/$script" -h) == "scripts/$script"* ]] || { echo "scripts/$script -h: no help"; exit 1; }
done
# refused SENTENCE SCRIPT...: a wrong argument is refused before anything is installed or built.
refused() {
  local sentence=$1 status=0 said
  shift
  said=$("$@" 2>&1) || status=$?
  [[ $status = 2 && $said == *"$sentence"* && $said != *"==>"* ]] || { echo "$*: exit code $status, '$said'"; exit 1; }
}
refused "there is no area 'frmae', but bridge calib" scripts/bench frmae
refused "unknown option --jsn" scripts/bench --jsn=x
refused "'ten' is no number" scripts/soak --minutes ten
refused "there is no file 'none.toml'" scripts/soak --rig none.toml
refused "--evry" scripts/soak --evry 2
refused "'0' is no number" scripts/storm --minutes 0
refused "'-1' is no number" scripts/night --minutes=-1
refused "'0.0' is no number above 0" scripts/demo --seconds 0.0
refused "there is no 'builtin:waves'" scripts/demo --motion builtin:waves
