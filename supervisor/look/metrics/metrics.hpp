// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/look/top/top_look.hpp"

namespace handcast::supervisor {

/// The metrics of a rig in Prometheus's text format 0.0.4. All are counters or present states;
/// rates are computed by Prometheus.
std::string metrics_text(const RigLook& look);

/// Serves the metrics at http://127.0.0.1:PORT/metrics, to this machine only, during the lifetime
/// of the object. A client that sends or reads nothing is left after kPatience_ms.
class MetricsServer {
 public:
  static constexpr int kThreads = 4;  ///< how many clients are served at a time
  static constexpr int kPatience_ms = 1000;

  /// `port` 0: any that is free. `look` is called for each scrape, by one thread at a time. Errors:
  /// bad_config (the port is in use or not permitted).
  static Result<MetricsServer> open(int port, std::function<RigLook()> look);
  MetricsServer(MetricsServer&&) noexcept;
  ~MetricsServer();

  /// The port.
  int port() const;

 private:
  class Parts;
  explicit MetricsServer(std::shared_ptr<Parts> parts);
  std::shared_ptr<Parts> parts_;
};

}  // namespace handcast::supervisor
