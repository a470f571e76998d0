// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/choose_rig.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/settings/join.hpp"
#include "supervisor/base/runtime_folder.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {
namespace {

/// The message if no rig is up. Services may live without their supervisor.
std::string no_rig_is_up() {
  const auto orphaned = orphaned_rigs();
  if (orphaned.empty()) return "no rig is up; `handcast up RIG.toml` starts one";
  return fmt::format(
      "no supervisor is up, but services of {} are running; `handcast up RIG.toml` takes them "
      "over, "
      "`handcast down` stops them",
      config::join(orphaned, ", "));
}

}  // namespace

Result<std::string> choose_rig(const std::string& name) {
  const auto rigs = living_rigs();
  if (!rigs) return tl::make_unexpected(rigs.error());
  if (rigs->empty()) return fail(Errc::unavailable, no_rig_is_up());
  if (name.empty() && rigs->size() == 1) return rigs->front();
  if (name.empty())
    return fail(Errc::unavailable, fmt::format("several rigs are up, choose one with --rig: {}",
                                               config::join(*rigs, ", ")));
  if (std::ranges::find(*rigs, name) == rigs->end())
    return fail(Errc::unavailable, fmt::format("no rig named '{}' is up; running: {}", name,
                                               config::join(*rigs, ", ")));
  return name;
}

}  // namespace handcast::supervisor
