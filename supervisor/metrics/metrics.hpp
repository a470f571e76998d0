// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/top/top_look.hpp"

namespace handcast::supervisor {

/// A rig's figures as Prometheus reads them (text format 0.0.4). All are counts since a start or
/// states of now: rates are Prometheus's.
std::string metrics_text(const RigLook& look);

/// Serves them at http://127.0.0.1:PORT/metrics, to this machine alone, as long as the object
/// lives.
class MetricsServer {
 public:
  /// `look` is called for each scrape, from another thread, never twice at the same time.
  /// Errors: bad_config (the port is taken, or not ours to take).
  static Result<MetricsServer> listen(int port, std::function<RigLook()> look);
  MetricsServer(MetricsServer&&) noexcept;
  ~MetricsServer();

 private:
  struct Parts;
  explicit MetricsServer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace handcast::supervisor
