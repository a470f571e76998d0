// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/look/metrics/http_server.hpp"
#include "supervisor/look/top/top_look.hpp"

namespace handcast::supervisor {

/// The metrics of a rig in Prometheus's text format 0.0.4. All are counters or present states;
/// rates are computed by Prometheus.
std::string metrics_text(const RigLook& look);

/// Serves the metrics at http://127.0.0.1:PORT/metrics. `look` is called for each scrape, on the
/// thread of the server. Errors: bad_config (the port is in use or not permitted).
Result<HttpServer> serve_metrics(int port, std::function<RigLook()> look);

}  // namespace handcast::supervisor
