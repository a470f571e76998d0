// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::desk::cues {

/// Where a cue list was when it was last written down.
struct KeptPlace {
  std::string list;      ///< its file
  std::string cue;       ///< the name of the cue that was started last
  double started_s = 0;  ///< when, in seconds since 1970
  bool is_faded = true;  ///< its fades were over

  bool operator==(const KeptPlace&) const = default;
};

/// Errors: unavailable (the file cannot be written).
Result<void> write_place(const std::filesystem::path& file, const KeptPlace& place);
/// Empty if there is no such file. Errors: bad_data (it is none of write_place()).
Result<std::optional<KeptPlace>> read_place(const std::filesystem::path& file);

}  // namespace handcast::desk::cues
