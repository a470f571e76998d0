// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/lab/report/page.hpp"

namespace handcast::report {

/// What was written.
struct Written {
  std::filesystem::path page;       ///< report.html
  std::vector<std::string> faults;  ///< files that are there and cannot be used, a sentence each
};

/// Writes metrics.json, preview.mp4 (if there are pictures) and report.html from the files of a
/// folder into the same folder. Errors: bad_config (there is nothing
/// to report), unavailable (a file cannot be written).
Result<Written> write_report(const std::filesystem::path& folder, const Imprint& imprint);

}  // namespace handcast::report
