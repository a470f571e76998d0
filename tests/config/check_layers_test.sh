#!/usr/bin/env bash
# check_layers passes on the tree as it is and catches breaches that are planted in a copy of it.
set -euo pipefail

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
for room in ipc config calib renderer services supervisor; do
  [ ! -d "$room" ] || find "$room" -name '*.[ch]pp' -exec cp --parents {} "$copy" \;
done
scripts/check_layers "$copy" >/dev/null

# must_catch FILE INCLUDE WORDS: planting the include in the file is reported with these words.
must_catch() {
  local file=$copy/$1 said
  mkdir -p "$(dirname "$file")"
  printf '\n#include %s\n' "$2" >>"$file"
  if said=$(scripts/check_layers "$copy"); then
    echo "not caught: $1 includes $2"
    exit 1
  fi
  if ! grep -qF "$1:" <<<"$said" || ! grep -qF "$3" <<<"$said"; then
    printf 'reported, but not with the file and "%s":\n%s\n' "$3" "$said"
    exit 1
  fi
  rm "$file"
  [ ! -f "$1" ] || cp "$1" "$file"
}

must_catch ipc/base/planted.hpp '"ipc/msg/header.hpp"' 'ipc/base must not include ipc/msg/header.hpp'
must_catch config/rig.cpp '"calib/calibration.hpp"' 'config must not include calib/calibration.hpp'
must_catch renderer/planted.cpp '"ipc/ring/reader.hpp"' 'renderer must not include ipc/ring/reader.hpp'
must_catch services/camera/main.cpp '"services/pose/pose_source.hpp"' 'services/camera must not include services/pose/pose_source.hpp'
must_catch services/twin/planted.cpp '"services/runtime/context.hpp"' 'services/twin must not include services/runtime/context.hpp'
must_catch supervisor/planted.cpp '"renderer/image.hpp"' 'supervisor must not include renderer/image.hpp'
must_catch calib/planted.cpp '<toml++/toml.h>' 'is kept in config/document.cpp'
must_catch services/camera/pictures.cpp '<opencv2/core.hpp>' 'is kept in renderer/content/'
echo "all planted breaches were caught"
