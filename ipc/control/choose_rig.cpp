// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/choose_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ipc/base/join.hpp"
#include "ipc/control/rig_address.hpp"

namespace handcast::control {

namespace {

/// The rig that has started this program ($HANDCAST_RIG, see ipc/daemon/contract.hpp); "" if none.
std::string rig_around() {
  const char* const address = std::getenv("HANDCAST_RIG");
  return address ? name_in(address) : "";
}

}  // namespace

Result<std::string> choose_rig(const std::string& wanted) {
  const auto name = wanted.empty() ? rig_around() : wanted;
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
