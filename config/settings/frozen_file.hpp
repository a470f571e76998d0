// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// A small file in the place of its path: a rig that is up must not see a file that was edited
/// after it was applied. The value of a setting is then kFrozen, the path, a line break, the text.
inline constexpr std::string_view kFrozen = "toml:";

/// A file by its path and content.
struct NamedText {
  std::string path, text;
};

/// The value that stands for the present content of a file. An empty value, and one that is frozen
/// already, stay as they are. Errors: those of read_text().
Result<std::string> freeze(const std::string& value);

/// What a value stands for: the frozen file, or the one at that path. Errors: those of read_text().
Result<NamedText> read_file_or_frozen(const std::string& value);

}  // namespace handcast::config
