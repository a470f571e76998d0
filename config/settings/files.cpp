// SPDX-License-Identifier: Apache-2.0
#include "config/settings/files.hpp"

#include "ipc/base/input_file.hpp"

namespace handcast::config {

Result<std::string> read_text(const std::filesystem::path& file) {
  return read_input(file, kMostText);
}

}  // namespace handcast::config
