// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/choose_rig.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/join.hpp"
#include "ipc/control/rig_address.hpp"

namespace handcast::control {

Result<std::string> choose_rig(const std::string& name) {
  const auto rigs = living_rigs();
  if (rigs.empty()) {
    const auto others = join(rigs_of_others(), "; ");
    return fail(Errc::unavailable, others.empty()
                                       ? "no rig is up; `handcast up RIG.toml` starts one"
                                       : "no rig of this user is up, but " + others);
  }
  if (name.empty() && rigs.size() == 1) return rigs.front();
  if (name.empty())
    return fail(Errc::unavailable, fmt::format("several rigs are up: {}", join(rigs, ", ")));
  if (std::ranges::find(rigs, name) == rigs.end())
    return fail(Errc::unavailable,
                fmt::format("no rig named '{}' is up; there is: {}", name, join(rigs, ", ")));
  return name;
}

}  // namespace handcast::control
