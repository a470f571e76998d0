// SPDX-License-Identifier: Apache-2.0
#include "services/content/looks_folder.hpp"

#include <algorithm>
#include <cstdlib>

namespace handcast::content {

std::filesystem::path looks_folder() {
  if (const char* assets = std::getenv("HANDCAST_ASSETS"); assets && *assets != '\0')
    return std::filesystem::path(assets) / "looks";
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../share/handcast/looks";
}

std::vector<std::string> look_names() {
  std::vector<std::string> names;
  std::error_code absent;
  for (const auto& file : std::filesystem::directory_iterator(looks_folder(), absent))
    if (file.path().extension() == ".fs") names.push_back(file.path().stem().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace handcast::content
