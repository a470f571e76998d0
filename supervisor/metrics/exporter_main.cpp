// SPDX-License-Identifier: Apache-2.0
// handcast-exporter: a rig's figures for Prometheus. A service of the rig like the others, but it
// looks on as `handcast top` does. It keeps the services' contract (services/runtime/context.hpp)
// by hand: this room must not include that one.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <optional>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/version.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/writer.hpp"
#include "supervisor/exit.hpp"
#include "supervisor/metrics/metrics.hpp"
#include "supervisor/options.hpp"

namespace handcast::supervisor {
namespace {

using Heart = std::optional<ipc::Writer<msg::StageMarks>>;

constexpr std::int64_t kBeatEvery_ns = 100'000'000;
constexpr std::string_view kHelp =
    "handcast-exporter — Serves a rig's figures to Prometheus on this machine.\n\n"
    "usage: handcast-exporter --config RIG.toml [--set path=value]...\n\n"
    "`handcast up RIG.toml` starts it where supervisor.metrics_port is not 0.\n";

volatile sig_atomic_t stop_asked = 0;

void ask_to_stop(int) { stop_asked = 1; }

void install_signals() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  for (const int number : {SIGTERM, SIGINT}) sigaction(number, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

/// The descriptor of a stream in HANDCAST_RINGS ("camera.frames=5,…"), or the number in another
/// variable; empty where there is none.
std::optional<int> descriptor_in(const char* variable, const std::string& stream = "") {
  const char* value = std::getenv(variable);
  if (value == nullptr) return std::nullopt;
  const auto text = fmt::format(",{}", value);
  const auto key = stream.empty() ? "," : fmt::format(",{}=", stream);
  const auto found = text.find(key);
  if (found == std::string::npos) return std::nullopt;
  int fd = -1;
  const char* digits = text.data() + found + key.size();
  if (std::from_chars(digits, text.data() + text.size(), fd).ec != std::errc{}) return std::nullopt;
  return fd;
}

/// Where the supervisor sees that this process lives. Without one (started by hand) it lives
/// unseen.
Heart open_heart() {
  const auto fd = descriptor_in("HANDCAST_RINGS", "marks.exporter");
  if (!fd) return std::nullopt;
  auto segment = ipc::Segment::open(UniqueFd(fcntl(*fd, F_DUPFD_CLOEXEC, 3)));
  if (!segment) return std::nullopt;
  auto heart = ipc::Writer<msg::StageMarks>::attach(std::move(*segment));
  if (!heart) {
    log::warning("the supervisor will not see that this process lives: {}", heart.error().what);
    return std::nullopt;
  }
  return std::move(*heart);
}

void tell_ready() {
  log::info("ready");
  const UniqueFd ready(descriptor_in("HANDCAST_READY_FD").value_or(-1));
  if (ready && ::write(ready.get(), "\n", 1) != 1) log::warning("the supervisor could not be told");
}

void beat_until_stopped(Heart heart) {
  while (stop_asked == 0) {
    const auto now = now_ns();
    if (heart) heart->publish(msg::StageMarks{.header = {.origin_ns = now}});
    sleep_until_ns(now + kBeatEvery_ns);
  }
  log::info("stopped");
}

int give_up(const Error& error) {
  log::error("{}", error.what);
  return error.code == Errc::bad_config ? kExitConfig : kExitFailure;
}

int serve(const Options& options) {
  install_signals();
  const auto rig = config::load_rig(options.value("--config"), options.all("--set"));
  if (!rig) return give_up(rig.error());
  if (rig->supervisor.metrics_port == 0)
    return give_up({Errc::bad_config, "supervisor.metrics_port is 0: there is nowhere to serve"});
  RigWatcher watcher(rig->name);
  const auto server =
      MetricsServer::listen(rig->supervisor.metrics_port, [&] { return watcher.look(); });
  if (!server) return give_up(server.error());
  auto heart = open_heart();
  tell_ready();
  beat_until_stopped(std::move(heart));
  return 0;
}

}  // namespace
}  // namespace handcast::supervisor

int main(int argc, char** argv) {
  using namespace handcast::supervisor;
  handcast::log::set_program("exporter");
  const auto options = sort_options(
      {argv + 1, argv + argc},
      {.with_value = {"--config", "--set"}, .flags = {"--help", "--version", "--backends"}});
  if (!options) return give_up({handcast::Errc::bad_config, options.error().what});
  if (options->has("--backends")) return 0;  // it has none to choose from
  if (options->has("--help")) fmt::print("{}", kHelp);
  if (options->has("--version")) fmt::print("handcast-exporter {}\n", handcast::version());
  if (options->has("--help") || options->has("--version")) return 0;
  if (!options->has("--config"))
    return give_up({handcast::Errc::bad_config, "--config FILE is needed: the rig"});
  return serve(*options);
}
