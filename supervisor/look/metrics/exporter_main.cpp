// SPDX-License-Identifier: Apache-2.0
// handcast-exporter: serves the metrics of a rig to Prometheus. It is a service of the rig and
// observes it in the same way as `handcast top`.
#include <fmt/format.h>

#include <optional>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/version.hpp"
#include "ipc/daemon/check_word.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/daemon/description.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "ipc/daemon/supervision.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/writer.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/look/metrics/metrics.hpp"

namespace handcast::supervisor {
namespace {

using Heart = std::optional<ipc::Writer<msg::StageMarks>>;

constexpr std::string_view kName = "exporter";
constexpr std::string_view kHelp =
    "handcast-exporter — Serves the metrics of a rig to Prometheus on this machine.\n\n"
    "usage: handcast-exporter --config RIG.toml [--set path=value]...\n\n"
    "`handcast up RIG.toml` starts it if supervisor.metrics_port is not 0.\n";

daemon::ServiceDescription describe() {
  return {.name = std::string(kName),
          .summary = "Serves a rig's figures to Prometheus on this machine.",
          .paced_by = "requests",
          .settings = {"supervisor.metrics_port"}};
}

/// The ring for heartbeats. Empty if there is no supervisor.
Heart open_heart(const daemon::Supervision& supervision, Deadline until) {
  auto fd = supervision.ring(daemon::marks_stream_of(kName));
  if (!fd) return std::nullopt;
  auto segment = ipc::Segment::open(std::move(*fd));
  if (!segment) return std::nullopt;
  auto heart = ipc::Writer<msg::StageMarks>::attach(std::move(*segment), until);
  if (!heart) {
    log::warning("heartbeats cannot be published: {}", heart.error().what);
    return std::nullopt;
  }
  return std::move(*heart);
}

void beat_until_stopped(Heart heart) {
  while (!daemon::stop_requested()) {
    const auto now = now_ns();
    if (heart) heart->publish(msg::StageMarks{.header = {.origin_ns = now}});
    sleep_until_ns(now + daemon::kBeatEvery_ns);
  }
  log::info("stopped");
}

/// Opens the port. The exporter that this one replaces may still have it: tries until the deadline.
Result<HttpServer> open_server(int port, RigWatcher& watcher, Deadline until) {
  for (;;) {
    auto server = serve_metrics(port, [&] { return watcher.observe(); });
    if (server || until.passed() || daemon::stop_requested()) return server;
    sleep_until_ns(now_ns() + ms_to_ns(20));
  }
}

int give_up(const Error& error) {
  log::error("{}", error.what);
  return exit_code_of(error);
}

int serve(const Options& options) {
  daemon::install_stop_signals();
  auto supervision = daemon::Supervision::from_environment(std::string(kName));
  const auto rig = config::load_rig(options.value("--config"), options.all("--set"));
  if (!rig) return give_up(rig.error());
  if (rig->supervisor.metrics_port == 0)
    return give_up(
        {Errc::bad_config, "supervisor.metrics_port is 0; set it to the port for the metrics"});
  RigWatcher watcher(rig->name);
  supervision.await_turn();
  const auto until = supervision.predecessor_leaves_by(rig->supervisor.stop_s);
  auto heart = open_heart(supervision, until);
  const auto server = open_server(rig->supervisor.metrics_port, watcher, until);
  if (!server) return give_up(server.error());
  supervision.tell_ready();
  beat_until_stopped(std::move(heart));
  return kExitDone;
}

int run_exporter(int argc, char** argv) {
  const auto options =
      sort_options({argv + 1, argv + argc},
                   {.with_value = {"--config", "--set"},
                    .flags = {"--help", "--version", "--backends", "--describe", "--check"}});
  if (!options) {
    log::error("{}", options.error().what);
    return kExitUsage;
  }
  if (options->has("--backends")) return kExitDone;  // it has no back ends
  if (options->has("--describe")) fmt::print("{}", daemon::print_description(describe()));
  if (options->has("--help")) fmt::print("{}", kHelp);
  if (options->has("--version")) fmt::print("handcast-exporter {}\n", version());
  if (options->has("--help") || options->has("--version") || options->has("--describe"))
    return kExitDone;
  if (options->has("--config") && options->has("--check")) {  // it opens nothing
    fmt::print("{}", daemon::kCheckedWord);
    return kExitDone;
  }
  if (options->has("--config")) return serve(*options);
  log::error("--config FILE, the rig file, is needed");
  return kExitUsage;
}

}  // namespace
}  // namespace handcast::supervisor

int main(int argc, char** argv) {
  handcast::log::set_program(handcast::supervisor::kName);
  return handcast::run_program("handcast-exporter", argc, argv, handcast::supervisor::run_exporter);
}
