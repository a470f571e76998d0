// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"
#include "services/evaluation/report/page.hpp"

namespace handcast::report {

/// Makes metrics.json, preview.mp4 (where there are pictures) and report.html from what the folder
/// holds; returns the page's path. Errors: bad_config (nothing to report), unavailable (a file
/// cannot be written).
Result<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                           const Imprint& imprint);

}  // namespace handcast::report
