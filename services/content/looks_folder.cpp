// SPDX-License-Identifier: Apache-2.0
#include "services/content/looks_folder.hpp"

#include <algorithm>

#include "ipc/base/program.hpp"

namespace handcast::content {

std::filesystem::path looks_folder() { return assets_folder() / "looks"; }

std::vector<std::string> look_names() {
  std::vector<std::string> names;
  std::error_code absent;
  for (const auto& file : std::filesystem::directory_iterator(looks_folder(), absent))
    if (file.path().extension() == ".fs") names.push_back(file.path().stem().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace handcast::content
