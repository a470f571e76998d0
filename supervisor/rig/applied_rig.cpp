// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/applied_rig.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "config/settings/file_kind.hpp"
#include "config/settings/frozen_file.hpp"
#include "ipc/base/inherited.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {

Result<config::Rig> load_rig_to_apply(const std::filesystem::path& rig_file,
                                      const std::vector<std::string>& settings) {
  auto rig = config::load_rig(rig_file, settings);
  if (!rig) return rig;
  for (auto* file : {&rig->calibration, &rig->projector2.calibration}) {
    auto frozen = config::freeze(*file);
    if (!frozen) return fail_in("calibration", frozen.error());
    *file = std::move(*frozen);
  }
  return rig;
}

Result<AppliedRig> make_applied(const config::Rig& rig) {
  auto toml = config::print_rig(rig);
  if (auto why = config::why_unreadable(toml); !why.empty())
    return fail(Errc::bad_config, std::move(why));
  UniqueFd file(memfd_create("handcast-rig", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  const bool written =
      file && ::write(file.get(), toml.data(), toml.size()) == static_cast<ssize_t>(toml.size());
  constexpr int kReadOnly = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;
  if (written && fcntl(file.get(), F_ADD_SEALS, kReadOnly) == 0)
    return AppliedRig{std::move(toml), std::move(file)};
  return fail(Errc::unavailable, fmt::format("the applied rig cannot be stored in memory: {}",
                                             inherited::reason_of(errno)));
}

std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings) {
  for (const auto& name : rigs_with_services()) {
    const auto saved = state_of(name);
    if (!saved || saved->rig_file != rig_file || saved->settings != settings) continue;
    const auto rig = config::parse_rig(saved->applied, rig_file);
    if (rig && rig->name == name) return *rig;
  }
  return std::nullopt;
}

}  // namespace handcast::supervisor
