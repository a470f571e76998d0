// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/applied_rig.hpp"

#include <unistd.h>

#include "ipc/base/log.hpp"
#include "ipc/control/runtime_folder.hpp"
#include "supervisor/base/replace_file.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {
namespace {

Result<std::filesystem::path> applied_file(const std::string& rig) {
  auto path = control::socket_of(rig);
  if (path) path->replace_extension(".toml");
  return path;
}

}  // namespace

Result<std::filesystem::path> write_applied(const config::Rig& rig) {
  auto path = applied_file(rig.name);
  if (!path) return path;
  if (auto written = replace_file(*path, config::print_rig(rig)); !written)
    return tl::make_unexpected(written.error());
  return path;
}

std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings) {
  for (const auto& name : orphaned_rigs()) {
    const auto saved = load_saved(name);
    if (!saved || !*saved || (*saved)->rig_file != rig_file || (*saved)->settings != settings)
      continue;
    const auto rig =
        applied_file(name).and_then([](const auto& file) { return config::load_rig(file); });
    if (!rig || rig->name != name) continue;
    log::info("rig '{}' continues with its applied settings; `handcast reload` reads {}", name,
              rig_file.string());
    return *rig;
  }
  return std::nullopt;
}

void forget_applied(const std::string& rig) {
  if (const auto path = applied_file(rig)) unlink(path->c_str());
}

}  // namespace handcast::supervisor
