// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/choose_rig.hpp"

#include <fmt/format.h>

#include "ipc/base/join.hpp"
#include "ipc/control/choose_rig.hpp"
#include "ipc/control/runtime_folder.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {

Result<std::string> choose_rig(const std::string& name) {
  auto rig = control::choose_rig(name);
  const auto living = control::living_rigs();
  if (rig || !living) return rig;
  if (name.empty() && living->size() > 1) rig.error().what += "; choose one with --rig";
  if (!living->empty()) return rig;
  const auto orphaned = orphaned_rigs();
  if (orphaned.empty()) return rig;
  return fail(Errc::unavailable,
              fmt::format("no supervisor is up, but services of {} live; `handcast up RIG.toml` "
                          "takes them over, `handcast down` ends them",
                          join(orphaned, ", ")));
}

}  // namespace handcast::supervisor
