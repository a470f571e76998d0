// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/top/top_look.hpp"

namespace handcast::supervisor {

/// The metrics of a rig in Prometheus's text format 0.0.4. All are counters or present states;
/// rates are computed by Prometheus.
std::string metrics_text(const RigLook& look);

/// Serves the metrics at http://127.0.0.1:PORT/metrics, to this machine only, during the lifetime
/// of the object.
class MetricsServer {
 public:
  /// `look` is called for each scrape, from another thread, but never concurrently. Errors:
  /// bad_config (the port is in use or not permitted).
  static Result<MetricsServer> listen(int port, std::function<RigLook()> look);
  /// `other` serves nothing afterwards.
  MetricsServer(MetricsServer&& other) noexcept;
  ~MetricsServer();

 private:
  struct Parts;
  explicit MetricsServer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace handcast::supervisor
