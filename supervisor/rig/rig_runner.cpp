// SPDX-License-Identifier: Apache-2.0
// The functions are in the order in which a rig is opened, runs and stops.
#include "supervisor/rig/rig_runner.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <limits>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/daemon/contract.hpp"
#include "supervisor/base/console.hpp"
#include "supervisor/rig/safe_state.hpp"
#include "supervisor/rig/takeover.hpp"
#include "supervisor/succession/process_discovery.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kTick_ns = 50'000'000;
/// If a tick is this late, the supervisor, or the machine, was stopped.
constexpr std::int64_t kStoodStill_ns = 1'000'000'000;

std::int64_t progress_period_ns() { return has_terminal() ? 200'000'000 : Diary::kLook_ns; }

Result<void> write_report(const std::filesystem::path& folder, const nlohmann::json& report) {
  return write_whole(folder / "live.json", report.dump(2) + "\n");
}

}  // namespace

RigRunner::RigRunner(const config::Rig& rig, RunOptions options, EventLoop loop)
    : options_(std::move(options)),
      loop_(std::move(loop)),
      rig_(rig, loop_, [this](Service& service, Notice notice) { on_notice(service, notice); }),
      requests_(
          rig_,
          {.read_file = [this] { return load_rig_to_apply(options_.rig_file, options_.settings); },
           .stop = [this] { begin_stop(kExitDone); },
           .rig_file = std::filesystem::absolute(options_.rig_file)}) {
  rig_.launch.program_folder = options_.program_folder;
  if (const auto address = control::address_of(rig.name)) rig_.launch.rig = address->text;
  rig_.launch.keeper = &keeper_;
  rig_.catalogue = read_catalogue(catalogue_folder(options_.program_folder));
}

Result<std::unique_ptr<RigRunner>> RigRunner::open(const config::Rig& rig, RunOptions options) {
  auto loop = EventLoop::open();
  if (!loop) return tl::make_unexpected(loop.error());
  std::unique_ptr<RigRunner> runner(new RigRunner(rig, std::move(options), std::move(*loop)));
  auto opened = runner->claim_name();
  if (opened) opened = runner->watch_signals_and_time();
  if (opened) opened = runner->make_parts();
  if (!opened) return tl::make_unexpected(opened.error());
  return runner;
}

/// The process that listens at the control socket is the rig's supervisor.
Result<void> RigRunner::claim_name() {
  auto control = ControlServer::listen(
      rig_.name, loop_, [this](const control::Request& request, ControlServer::Reply reply) {
        requests_.answer(request, std::move(reply));
      });
  if (!control) return tl::make_unexpected(control.error());
  control_ = std::move(*control);
  return {};
}

Result<void> RigRunner::watch_signals_and_time() {
  std::signal(SIGPIPE, SIG_IGN);
  auto signals = open_stop_signals();
  if (!signals) return tl::make_unexpected(signals.error());
  auto timer = open_timer(kTick_ns);
  if (!timer) return tl::make_unexpected(timer.error());
  signals_ = std::move(*signals);
  timer_ = std::move(*timer);

  if (keeper_.fd() >= 0) {
    loop_.watch(keeper_.fd(), [this] {
      keeper_.read();
      if (keeper_.fd() >= 0) return tick();
      log::warning("the keeper has died; `handcast up` with the same arguments starts another one");
    });
  }
  loop_.watch(timer_.get(), [this] {
    drain(timer_.get());
    tick();
  });
  loop_.watch(signals_.get(), [this] {
    drain(signals_.get());
    if (rig_.stops()) return hurry();  // the second signal
    begin_stop(kExitDone);
  });
  return {};
}

/// Creates rings, applied rig and services, or takes over those of a supervisor that died. Starts
/// no service.
Result<void> RigRunner::make_parts() {
  auto adopted = adopt(rig_.name);
  if (!adopted) return tl::make_unexpected(adopted.error());
  keeper_.read();

  const auto specs = services_of(rig_.config, rig_.catalogue);
  auto made = make_rings_and_files(*adopted, specs);
  if (!made && *adopted && (*adopted)->services.empty()) {
    rig_.rings.adopt({});  // systemd stored them; they are of another version or another size
    adopted->reset();
    made = make_rings_and_files(*adopted, specs);
  }
  if (!made && !*adopted) return made;
  if (!made)
    return fail(made.error().code,
                fmt::format("the running services of rig '{0}' cannot be taken over: {1}; "
                            "`handcast down --rig {0}` stops them",
                            rig_.name, made.error().what));
  for (const auto& spec : specs) rig_.services.add(spec);
  if (*adopted) {
    continue_run((*adopted)->saved);
    take_services(std::move(**adopted), rig_);
  }
  store_with_systemd(rig_.launch.rings);
  store_with_systemd({{kStateName, rig_.launch.state_fd}});
  return {};
}

Result<void> RigRunner::make_rings_and_files(std::optional<AdoptedRig>& adopted,
                                             const std::vector<ServiceSpec>& specs) {
  if (adopted)
    if (auto taken = take_rings(*adopted, rig_, specs); !taken) return taken;
  if (const auto made = rig_.make_rings(specs); !made) return tl::make_unexpected(made.error());
  auto state = adopted ? Result<StateMemory>(std::move(adopted->state)) : StateMemory::create();
  if (!state) return tl::make_unexpected(state.error());
  state_ = std::move(*state);
  rig_.launch.state_fd = state_->fd();
  auto applied = make_applied(rig_.config);
  if (!applied) return tl::make_unexpected(applied.error());
  rig_.use(std::move(*applied));
  return {};
}

/// Restores the start of the rig, which is the epoch of its services. --seconds counts from there
/// for a successor, and from now if a person has started this supervisor.
void RigRunner::continue_run(const SavedRig& saved) {
  inherited_ = true;
  rig_.launch.epoch_ns = rig_.started_ns = saved.epoch_ns;
  if (!options_.is_successor && options_.seconds)
    *options_.seconds += ns_to_seconds(now_ns() - rig_.started_ns);
  if (options_.out || saved.out.empty()) return;
  options_.out = saved.out;
  setenv(daemon::kOutVariable, saved.out.c_str(), 1);
}

int RigRunner::run() {
  try {
    return supervise();
  } catch (const std::exception& problem) {
    if (keeper_.fd() < 0 && !std::getenv("NOTIFY_SOCKET")) throw;
    // Ends here, because the destructors further up end the services, which a successor takes over.
    log::error("the supervisor cannot go on: {}", problem.what());
    std::abort();
  }
}

int RigRunner::supervise() {
  for (const auto& service : rig_.services.all())
    if (!service->first_start_ns()) service->hold();
  last_tick_ns_ = now_ns();
  // Applies the settings to the adopted services: a reload may have been interrupted, or `handcast
  // up` has other settings.
  if (inherited_)
    requests_.reload(rig_.config, false, ControlServer::Reply([](const auto&, const auto&) {}));
  for (follow_up(); rig_.phase != Phase::done; follow_up()) loop_.turn();
  return exit_code_;
}

void RigRunner::tick() {
  const auto now = now_ns();
  watchdog_.tick(now);
  if (store_.has_ended()) keep_descriptors();
  beat(now);
  forgive_a_standstill(now);
  rig_.recorder.poll();
  rig_.rings.repair_headers();
  for (const auto& service : rig_.services.all()) service->tick(now, rig_.look_at(*service, now));
  if (rig_.stops()) return hurry_when_late(now);
  if (options_.seconds && now - rig_.started_ns >= seconds_to_ns(*options_.seconds))
    return begin_stop(kExitDone);
  requests_.tick(now);
  show_progress_now_and_then(now);
}

void RigRunner::beat(std::int64_t now) {
  if (now < next_beat_ns_) return;
  next_beat_ns_ = now + kBeatToKeeper_ns;
  keeper_.beat(rig_.name, rig_.stops());
}

/// Does the work after each turn of the event loop that is less urgent than replacing a service
/// that died.
void RigRunner::follow_up() {
  come_up();
  begin_what_may();
  const auto revision = rig_.services.revision();
  if (revision == std::exchange(revision_, revision) || rig_.phase == Phase::done) return;
  rig_.rings.sweep_dead_rows();
  save();
  keep_descriptors();
}

/// Keeps what a successor could not get from services whose descriptors the kernel hides.
void RigRunner::keep_descriptors() {
  if (rig_.stops()) return;
  ChildSpec spec{.program = rig_.launch.program_folder / "handcast",
                 .arguments = {},
                 .rings = rig_.launch.rings,
                 .epoch_ns = rig_.launch.epoch_ns,
                 .rig = rig_.launch.rig,
                 .state_fd = rig_.launch.state_fd};
  std::vector<pid_t> pids;
  for (const auto& service : rig_.services.all()) {
    if (!service->is_running()) continue;
    if (service->pid() > 0) pids.push_back(service->pid());
    if (service->log_fd() >= 0) spec.kept_open.push_back(service->log_fd());
  }
  store_.keep(std::move(spec), pids);
}

/// Enters Phase::up when all services have been ready or have exceeded their time. A rig that was
/// taken over is up at once.
void RigRunner::come_up() {
  if (rig_.phase != Phase::starting) return;
  if (!inherited_ && !rig_.services.has_come_up(now_ns())) return;
  rig_.phase = Phase::up;
  log::info("rig '{}' is up", rig_.name);
  if (has_terminal())
    print_line(
        "In another terminal, `handcast preview` shows it and `handcast status` its rates and "
        "times. Ctrl-C stops it.");
  notify_systemd(fmt::format("READY=1\nSTATUS=rig '{}' is up", rig_.name));
}

/// Starts the services whose needs are met. If one cannot start, this may stop the rig.
void RigRunner::begin_what_may() {
  while (!rig_.stops()) {
    auto* service = rig_.services.next_to_begin(now_ns());
    if (!service) return;
    service->start();
  }
}

void RigRunner::forgive_a_standstill(std::int64_t now) {
  const auto late_ns = now - std::exchange(last_tick_ns_, now) - kTick_ns;
  if (late_ns < kStoodStill_ns) return;
  log::warning("the supervisor stood still for {:.1f} s; all time limits are extended by this time",
               ns_to_seconds(late_ns));
  for (const auto& service : rig_.services.all()) service->forgive(late_ns);
}

void RigRunner::show_progress_now_and_then(std::int64_t now) {
  if (now < next_progress_ns_ || rig_.phase != Phase::up) return;
  if (next_progress_ns_ > 0) show_progress(now);
  next_progress_ns_ = now + progress_period_ns();
}

void RigRunner::show_progress(std::int64_t now) {
  const auto view = rig_.view();
  if (has_terminal()) return supervisor::show_progress(progress_line(view));
  for (const auto& entry : diary_.look(now, figures_of(view), progress_line(view)))
    log::write(entry.level, entry.text);
}

void RigRunner::on_notice(Service& service, Notice notice) {
  if (rig_.stops()) {
    if (notice != Notice::ready) stop_next();
    return;
  }
  switch (notice) {
    case Notice::ready:
      return requests_.on_ready(service);
    case Notice::stopped:
      return requests_.on_stopped(service);
    case Notice::failed:
      return on_failed(service);
  }
}

/// Stops the rig if it is not up yet and the service has never been ready.
void RigRunner::on_failed(Service& service) {
  if (requests_.on_failed(service)) return;
  if (rig_.phase != Phase::starting || service.was_ready()) return;
  print_line(fmt::format("handcast: {} cannot start: {}", service.spec().name,
                         service.log().last_sentence()));
  begin_stop(kExitConfig);
}

/// Saves the rig for a successor, but not while the rig stops: a successor would not start the
/// services again that have already stopped.
void RigRunner::save() {
  if (rig_.stops()) return;
  SavedRig saved{.name = rig_.name,
                 .rig_file = options_.rig_file,
                 .settings = options_.settings,
                 .out = options_.out ? options_.out->string() : "",
                 .applied = rig_.applied.toml,
                 .epoch_ns = rig_.launch.epoch_ns,
                 .rings = rig_.rings.saved(),
                 .services = {}};
  for (const auto& service : rig_.services.all()) saved.services.push_back(service->saved());
  const auto written = state_->save(saved);
  if (!written && !std::exchange(save_failed_, true))
    log::warning("a successor of the supervisor could not take over the rig: {}",
                 written.error().what);
}

void RigRunner::begin_stop(int exit_code) {
  if (rig_.stops()) return;
  exit_code_ = exit_code;
  rig_.phase = Phase::stopping;
  stop_by_ns_ = now_ns() + seconds_to_ns(rig_.launch.stop_s);
  keeper_.beat(rig_.name, true);
  notify_systemd("STOPPING=1");
  requests_.on_stopping();
  for (const auto& service : rig_.services.all())
    if (!service->is_running()) service->stop();  // cancels a restart that is due
  stop_next();
}

/// Stops the next service, in the reverse order of the table, guests last.
void RigRunner::stop_next() {
  if (auto* last = rig_.services.next_to_stop()) return last->stop();
  finish();
}

/// supervisor.stop_s is the time for the whole rig: the services stop one after the other, and
/// those that are left then are killed.
void RigRunner::hurry_when_late(std::int64_t now) {
  if (rig_.phase != Phase::stopping || now < stop_by_ns_) return;
  stop_by_ns_ = std::numeric_limits<std::int64_t>::max();
  log::warning("rig '{}' has not stopped within {:g} s; its services are killed", rig_.name,
               rig_.launch.stop_s);
  hurry();
}

/// Stops all services at once, without waiting for them.
void RigRunner::hurry() {
  for (const auto& service : rig_.services.all()) {
    service->stop();
    service->hurry();
  }
}

void RigRunner::finish() {
  if (rig_.phase == Phase::done) return;
  rig_.phase = Phase::done;
  rig_.recorder.poll();
  if (options_.out && exit_code_ == kExitDone) {
    if (const auto written = write_report(*options_.out, live_report(rig_.view())); !written) {
      log::error("{}", written.error().what);
      exit_code_ = kExitConfig;  // kExitRetry would start the rig again
    }
  }
  store_.close();
  state_->forget();
  if (const int left = end_services(rig_.name, 0, now_ns()); left > 0)
    log::warning("services of rig '{}' that this supervisor did not start were killed: {}",
                 rig_.name, left);
  for (const auto& service : rig_.services.all())
    leave_safe(*service, rig_.launch, [this] { keeper_.beat(rig_.name, true); });
  log::info("rig '{}' has stopped", rig_.name);
  control_->stop_accepting();
  requests_.on_done();
}

}  // namespace handcast::supervisor
