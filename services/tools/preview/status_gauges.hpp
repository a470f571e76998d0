// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "services/tools/preview/layout/gauges.hpp"

namespace handcast::preview {

/// Sets uptime, troubles and stages from the output of `handcast status --json`. What has another
/// form than expected is left out.
void read_status(const nlohmann::json& status, Gauges& gauges);
/// The configured rate of a stream; empty if there is none.
std::optional<double> wanted_hz(const nlohmann::json& status, std::string_view stream);

}  // namespace handcast::preview
