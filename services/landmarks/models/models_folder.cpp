// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/models_folder.hpp"

#include <cstdlib>

#include "ipc/base/program.hpp"

namespace handcast::landmarks {
namespace fs = std::filesystem;
namespace {

fs::path from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

fs::path users_folder() {
  fs::path data = from_environment("XDG_DATA_HOME");
  if (data.empty()) data = from_environment("HOME") / ".local" / "share";
  return data / "handcast" / "models";
}

}  // namespace

Result<fs::path> models_folder(const std::string& configured) {
  std::error_code ignored;
  if (!configured.empty() && !fs::is_directory(configured, ignored))
    return fail(Errc::bad_config, configured + ": there is no such folder of models");
  if (!configured.empty()) return configured;
  if (auto named = from_environment("HANDCAST_MODELS"); !named.empty()) return named;
  const auto installed = share_folder() / "models";
  return fs::is_directory(installed, ignored) ? installed : users_folder();
}

}  // namespace handcast::landmarks
