// SPDX-License-Identifier: Apache-2.0
#include "config/settings/frozen_file.hpp"

#include <algorithm>
#include <utility>

#include "config/settings/files.hpp"

namespace handcast::config {

Result<std::string> freeze(const std::string& value) {
  if (value.empty() || value.starts_with(kFrozen)) return value;
  const auto text = read_text(value);
  if (!text) return tl::make_unexpected(text.error());
  return std::string(kFrozen) + value + '\n' + *text;
}

Result<NamedText> read_file_or_frozen(const std::string& value) {
  if (!value.starts_with(kFrozen)) {
    auto text = read_text(value);
    if (!text) return tl::make_unexpected(text.error());
    return NamedText{value, std::move(*text)};
  }
  const auto path_end = std::min(value.find('\n'), value.size());
  return NamedText{value.substr(kFrozen.size(), path_end - kFrozen.size()),
                   value.substr(std::min(path_end + 1, value.size()))};
}

}  // namespace handcast::config
