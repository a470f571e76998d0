// SPDX-License-Identifier: Apache-2.0
// handcast-exporter: serves the metrics of a rig to Prometheus. It is a service of the rig and
// observes it in the same way as `handcast top`.
#include <cstdlib>

#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/scheduling.hpp"
#include "supervisor/look/metrics/metrics.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Opens the port. The exporter that this one replaces may still have it: tries for a while.
static Result<supervisor::MetricsServer> open_server(const config::Rig& rig,
                                                     supervisor::RigWatcher& watcher) {
  const auto until = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(rig.supervisor.stop_s)));
  for (;;) {
    auto server = supervisor::MetricsServer::open(rig.supervisor.metrics_port,
                                                  [&] { return watcher.observe(); });
    if (server || until.passed()) return server;
    sleep_until_ns(now_ns() + to_ns(20ms));
  }
}

/// At low priority: where cores are short, figures are late rather than the light.
static void run_exporter(service::Context& context) {
  service::give_way();
  if (context.rig().supervisor.metrics_port == 0)
    service::give_up(
        {Errc::bad_config, "supervisor.metrics_port is 0; set it to the port for the metrics"});
  supervisor::RigWatcher watcher(context.rig().name);
  context.stand_by();
  const auto server = must(open_server(context.rig(), watcher));
  context.ready();
  while (context.running()) sleep_until_ns(now_ns() + to_ns(50ms));
  // Without the destructor of the server, which waits 2 s for its threads: nothing is to be saved.
  log::info("stopped");
  std::_Exit(kExitDone);
}

int main(int argc, char** argv) {
  return service::run({.name = "exporter",
                       .summary = "Serves a rig's figures to Prometheus on this machine.",
                       .paced_by = "requests",
                       .settings = {"supervisor.metrics_port"}},
                      argc, argv, run_exporter);
}
