// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "services/projector/dlp/dlp_controller.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/options.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Below half of the shortest useful supervisor.silent_s, so that a slow controller is not taken
/// for a service that hangs.
static constexpr auto kPatience = 700ms;

/// Ends the process if the projector may be lit.
static void darken(dlp::DlpController& controller) {
  if (auto dark = controller.darken(Deadline::in(kPatience)); !dark) service::give_up(dark.error());
}

/// Logs what has changed since the last look.
static void log_changes(const dlp::Health& before, const dlp::Health& now) {
  const auto has = [](const std::vector<std::string>& faults, const std::string& fault) {
    return std::ranges::find(faults, fault) != faults.end();
  };
  for (const auto& fault : now.faults)
    if (!has(before.faults, fault)) log::warning("the projector reports: {}", fault);
  for (const auto& fault : before.faults)
    if (!has(now.faults, fault)) log::info("the projector no longer reports: {}", fault);
  for (const auto& event : now.events) log::info("the projector: {}", event);
  if (!now.waits_for.empty() && now.waits_for != before.waits_for)
    log::info("the projector waits for {}", now.waits_for);
}

/// A device that does not answer gets one command more.
static void darken_after(const Error& error, dlp::DlpController& controller) {
  if (error.code == Errc::bad_data) return;
  const auto patience = error.code == Errc::disconnected ? 200ms : kPatience;
  if (auto dark = controller.darken(Deadline::in(patience)); !dark)
    log::warning("the projector may be lit: {}", dark.error().what);
}

/// Errors of a look are counted; after others, the process ends in darkness and is started again.
static void look_after(dlp::DlpController& controller, dlp::Health& health,
                       service::Context& context) {
  auto now = controller.tend(Deadline::in(kPatience));
  if (!now) {
    darken_after(now.error(), controller);
    return context.tolerate(now.error());
  }
  log_changes(health, *now);
  health = std::move(*now);
}

/// Keeps the projector's controller in the state that the rig asks for. Whatever it did before, it
/// is dark first, and dark at the end.
static void run_dlp(service::Context& context) {
  context.stand_by();
  const auto controller = must(dlp::open_dlp(context.rig()));
  darken(*controller);
  log::info("{}", must(controller->identify(Deadline::in(kPatience))));

  dlp::Health health;
  std::int64_t look_ns = now_ns();
  context.ready();
  while (context.running()) {
    sleep_until_ns(std::min(look_ns, now_ns() + to_ns(50ms)));
    if (now_ns() < look_ns) continue;
    look_after(*controller, health, context);
    look_ns = now_ns() + to_ns(health.waits_for.empty() ? 1s : 200ms);
  }
  darken(*controller);
}

/// `handcast-dlp --safe`: darkens the projector after a crash that left nobody to do so.
static int make_safe(const service::Options& options) {
  const auto rig = must(config::load_rig(options.config_file, options.settings));
  auto controller = must(dlp::open_dlp(rig));
  if (auto dark = controller->darken(Deadline::in(kPatience)); !dark) {
    log::warning("{}; once more", dark.error().what);  // nobody else will try
    controller.reset();
    controller = must(dlp::open_dlp(rig));
    darken(*controller);
  }
  log::info("{} is dark", must(controller->identify(Deadline::in(kPatience))));
  return kExitDone;
}

static Result<void> check(const config::Rig& rig, const calib::Calibration&) {
  return dlp::check_dlp(rig);
}

/// The arguments without --safe; nothing if it is not among them.
static std::vector<const char*> without_safe(int argc, char** argv) {
  std::vector<const char*> words(argv, argv + argc);
  const auto is_safe = [](const char* word) { return std::strcmp(word, "--safe") == 0; };
  return std::erase_if(words, is_safe) == 0 ? std::vector<const char*>() : words;
}

int main(int argc, char** argv) {
  const service::Instance dlp[]{
      {.description = {.name = "dlp",
                       .summary =
                           "Commands the controller of a DLP projector: LEDs, mode, patterns.",
                       .paced_by = "a clock, once a second",
                       .backends = service::describe_rows(dlp::dlp_backends())},
       .body = run_dlp,
       .check = check}};
  if (const auto words = without_safe(argc, argv); !words.empty()) {
    log::set_program("dlp");
    return run_program("handcast-dlp", argc, argv, [&](int, char**) {
      return make_safe(
          must(service::parse_options(dlp, static_cast<int>(words.size()), words.data())));
    });
  }
  return service::run(dlp, argc, argv);
}
