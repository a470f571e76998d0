#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests that check_layers accepts the tree and reports breaches that are planted in a copy of it.
set -euo pipefail

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
for top in ipc config calib renderer services supervisor; do
  find "$top" \( -name '*.[ch]pp' -o -name CMakeLists.txt \) -exec cp --parents {} "$copy" \;
done
scripts/check_layers "$copy" >/dev/null

# must_catch WORDS FILE LINE [FILE LINE]...: adds each line to its file; check_layers must report it with these words.
must_catch() {
  local words=$1 said
  shift
  local planted=("$@") i
  for ((i = 0; i < ${#planted[@]}; i += 2)); do
    mkdir -p "$copy/$(dirname "${planted[i]}")"
    printf '\n%s\n' "${planted[i + 1]}" >>"$copy/${planted[i]}"
  done
  if said=$(scripts/check_layers "$copy"); then
    echo "check_layers did not report: ${planted[*]}"
    exit 1
  fi
  if ! grep -qF "$words" <<<"$said"; then
    printf 'check_layers reported the breach, but not as "%s":\n%s\n' "$words" "$said"
    exit 1
  fi
  for ((i = 0; i < ${#planted[@]}; i += 2)); do
    rm "$copy/${planted[i]}"
    [ ! -f "${planted[i]}" ] || cp "${planted[i]}" "$copy/${planted[i]}"
  done
}

# An include without a declaration, and a declaration without an include.
must_catch 'ipc/msg/header.hpp needs USES ipc/msg in ipc/base/CMakeLists.txt' \
  ipc/base/planted.hpp '#include "ipc/msg/header.hpp"'
must_catch 'renderer/skin/skinning.hpp needs USES renderer/skin in renderer/mask/CMakeLists.txt' \
  renderer/mask/planted.cpp '#include "renderer/skin/skinning.hpp"'
must_catch 'calib/CMakeLists.txt: USES renderer/base, but no file includes a header of it' \
  calib/CMakeLists.txt 'handcast_program(planted USES renderer/base)'

# A declaration of a module in a higher layer.
must_catch 'renderer/base must not use services/runtime' \
  renderer/base/CMakeLists.txt 'handcast_program(planted USES services/runtime)' \
  renderer/base/planted.cpp '#include "services/runtime/context.hpp"'
must_catch 'services/camera must not use services/pose' \
  services/camera/CMakeLists.txt 'handcast_program(planted USES services/pose)' \
  services/camera/planted.cpp '#include "services/pose/pose_source.hpp"'
must_catch 'supervisor must not use renderer/base' \
  supervisor/CMakeLists.txt 'handcast_program(planted USES renderer/base)' \
  supervisor/planted.cpp '#include "renderer/base/image.hpp"'

# The show, its tools and its laboratory.
must_catch 'the show must not include services/lab/twin/twin.hpp, which is of the lab' \
  services/camera/planted.cpp '#include "services/lab/twin/twin.hpp"'
must_catch 'the show must not include calib/solve/lens/lens_fit.hpp, which is of the tools' \
  renderer/base/planted.cpp '#include "calib/solve/lens/lens_fit.hpp"'
must_catch 'the tools must not include services/lab/twin/twin.hpp, which is of the lab' \
  services/tools/doctor/planted.cpp '#include "services/lab/twin/twin.hpp"'

# Cycles of two modules, and of two folders inside one module.
must_catch 'a cycle: renderer/predict -> renderer/filter -> renderer/predict' \
  renderer/predict/CMakeLists.txt 'handcast_program(planted USES renderer/filter)' \
  renderer/predict/planted.cpp '#include "renderer/filter/filters.hpp"'
must_catch 'a cycle: services/landmarks/inference/onednn -> services/landmarks/inference/onnx -> ' \
  services/landmarks/inference/onnx/planted.cpp '#include "services/landmarks/inference/onednn/builder.hpp"'

# The headers of other projects.
must_catch 'may only be included by config/settings/document.cpp' calib/planted.cpp '#include <toml++/toml.h>'
must_catch 'may only be included by calib/solve/board/, calib/solve/lens/, calib/solve/pair/, calib/solve/tracker/first_pose.cpp, renderer/content/lettering.cpp' services/camera/pictures.cpp '#include <opencv2/core.hpp>'

# Two types of one name, which the linker cannot tell apart.
must_catch 'handcast::calib::Pose is also defined in' \
  calib/solve/tracker/planted.hpp $'namespace handcast::calib {\nstruct Pose {};\n}  // namespace handcast::calib'
# The last one: its folder makes the copy a whole checkout.
must_catch 'tests/planted_test.cpp: EXPECT_THAT(...) needs #include <gmock/...>' \
  tests/planted_test.cpp 'TEST(Planted, Test) { EXPECT_THAT(1, Eq(1)); }'
echo "all planted breaches were caught"
