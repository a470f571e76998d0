#include "supervisor/rig/applied_rig.hpp"

#include <unistd.h>

#include "supervisor/control/runtime_folder.hpp"

namespace handcast::supervisor {
namespace {

Result<std::filesystem::path> applied_file(const std::string& rig) {
  auto path = socket_of(rig);
  if (path) path->replace_extension(".toml");
  return path;
}

}  // namespace

Result<std::filesystem::path> write_applied(const config::Rig& rig) {
  auto path = applied_file(rig.name);
  if (!path) return path;
  if (auto written = replace_file(*path, config::print_rig(rig)); !written) return tl::make_unexpected(written.error());
  return path;
}

void forget_applied(const std::string& rig) {
  if (const auto path = applied_file(rig)) unlink(path->c_str());
}

}  // namespace handcast::supervisor
