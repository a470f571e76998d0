// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/applied_rig.hpp"

#include <unistd.h>

#include "ipc/base/log.hpp"
#include "ipc/control/runtime_folder.hpp"
#include "supervisor/base/replace_file.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {
namespace {

Result<std::filesystem::path> file_of(const std::string& rig, const char* extension) {
  auto path = control::socket_of(rig);
  if (path) path->replace_extension(extension);
  return path;
}

Result<std::filesystem::path> applied_file(const std::string& rig) { return file_of(rig, ".toml"); }

Result<std::filesystem::path> candidate_file(const std::string& rig) {
  return file_of(rig, ".next.toml");
}

Result<std::filesystem::path> write_to(Result<std::filesystem::path> path, const config::Rig& rig) {
  if (!path) return path;
  if (auto written = replace_file(*path, config::print_rig(rig)); !written)
    return tl::make_unexpected(written.error());
  return path;
}

}  // namespace

Result<std::filesystem::path> write_applied(const config::Rig& rig) {
  return write_to(applied_file(rig.name), rig);
}

Result<std::filesystem::path> write_candidate(const config::Rig& rig) {
  return write_to(candidate_file(rig.name), rig);
}

void forget_candidate(const std::string& rig) {
  if (const auto path = candidate_file(rig)) unlink(path->c_str());
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
  forget_candidate(rig);
}

}  // namespace handcast::supervisor
