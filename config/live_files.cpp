// SPDX-License-Identifier: Apache-2.0
#include "config/live_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/quote.hpp"
#include "ipc/base/rig_name.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::config {
namespace {

std::filesystem::path presets_of(const std::filesystem::path& rig_file) {
  return std::filesystem::path(rig_file).replace_extension(".presets");
}

}  // namespace

std::filesystem::path live_file_of(const std::filesystem::path& rig_file) {
  return std::filesystem::path(rig_file).replace_extension(".live.toml");
}

Result<std::filesystem::path> preset_file_of(const std::filesystem::path& rig_file,
                                             std::string_view name) {
  if (!is_rig_name(name))
    return fail(Errc::bad_config,
                fmt::format("{} cannot be the name of a preset; {}", quote(name), kRigNameRule));
  return presets_of(rig_file) / fmt::format("{}.toml", name);
}

std::vector<std::string> preset_names(const std::filesystem::path& rig_file) {
  std::vector<std::string> names;
  std::error_code absent;
  for (const auto& file : std::filesystem::directory_iterator(presets_of(rig_file), absent))
    if (file.path().extension() == ".toml") names.push_back(file.path().stem().string());
  std::ranges::sort(names);
  return names;
}

Result<void> write_values(const std::filesystem::path& file, std::string_view values) {
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  return write_whole(file, fmt::format("# Written by handcast: settings changed while the rig was "
                                       "up.\n{}",
                                       values));
}

}  // namespace handcast::config
