// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/choose_rig.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/join.hpp"
#include "ipc/control/choose_rig.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {
namespace {

/// The message if no rig is up but services live without their supervisor. Empty if none do.
std::string orphans_are_up() {
  const auto orphaned = orphaned_rigs();
  if (orphaned.empty()) return {};
  return fmt::format(
      "no supervisor is up, but services of {} are running; `handcast up RIG.toml` takes them "
      "over, `handcast down` stops them",
      join(orphaned, ", "));
}

}  // namespace

Result<std::string> choose_rig(const std::string& name) {
  auto rig = control::choose_rig(name);
  const auto living = control::living_rigs();
  if (rig) return rig;
  if (name.empty() && living.size() > 1) rig.error().what += "; choose one with --rig";
  if (!living.empty()) return rig;
  const auto sentence = orphans_are_up();
  return sentence.empty() ? rig : fail(Errc::unavailable, sentence);
}

Result<std::string> choose_rig_to_stop(const std::string& name) {
  auto rigs = orphaned_rigs();
  if (std::ranges::find(rigs, name) != rigs.end()) return name;
  const auto living = control::living_rigs();
  if (name.empty() && living.empty() && rigs.size() == 1) return rigs.front();
  return choose_rig(name);
}

}  // namespace handcast::supervisor
