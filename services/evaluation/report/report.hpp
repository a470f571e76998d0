// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"
#include "services/evaluation/report/page.hpp"

namespace handcast::report {

/// Writes metrics.json, preview.mp4 (if there are pictures) and report.html from the files of a
/// folder into the same folder. Returns the path of the page. Errors: bad_config (there is nothing
/// to report), unavailable (a file cannot be written).
Result<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                           const Imprint& imprint);

}  // namespace handcast::report
