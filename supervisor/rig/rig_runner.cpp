// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/rig_runner.hpp"

#include <fmt/format.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/ring/row_owner.hpp"
#include "supervisor/base/console.hpp"
#include "supervisor/rig/applied_rig.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kTick_ns = 50'000'000;
constexpr std::int64_t kStoodStill_ns =
    1'000'000'000;  ///< a tick this late: the supervisor, or the machine, was stopped

std::int64_t progress_period_ns() { return has_terminal() ? 200'000'000 : 5'000'000'000; }

Result<void> write_report(const std::filesystem::path& folder, const nlohmann::json& report) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto file = folder / "live.json";
  std::ofstream out(file);
  out << report.dump(2) << "\n";
  out.close();
  if (!out) return fail(Errc::unavailable, fmt::format("{} cannot be written", file.string()));
  return {};
}

}  // namespace

RigRunner::RigRunner(const config::Rig& rig, RunOptions options, EventLoop loop)
    : name_(rig.name),
      rig_(rig),
      options_(std::move(options)),
      loop_(std::move(loop)),
      recorder_(rig.supervisor.history_s),
      started_ns_(now_ns()) {
  launch_.program_folder = options_.program_folder;
  launch_.epoch_ns = started_ns_;
  launch_.ready_s = rig.supervisor.ready_s;
  launch_.stop_s = rig.supervisor.stop_s;
  launch_.silent_s = rig.supervisor.silent_s;
  launch_.reports = &reports_;
}

Result<std::unique_ptr<RigRunner>> RigRunner::open(const config::Rig& rig, RunOptions options) {
  auto loop = EventLoop::open();
  if (!loop) return tl::make_unexpected(loop.error());
  std::unique_ptr<RigRunner> runner(new RigRunner(rig, std::move(options), std::move(*loop)));

  auto control = ControlServer::listen(
      rig.name, runner->loop_,
      [runner = runner.get()](const Request& request, ControlServer::Reply reply) {
        runner->on_request(request, std::move(reply));
      });
  if (!control) return tl::make_unexpected(control.error());
  runner->control_ = std::move(*control);
  if (const auto opened = runner->open_descriptors(); !opened)
    return tl::make_unexpected(opened.error());
  auto applied = write_applied(rig);
  if (!applied) return tl::make_unexpected(applied.error());
  runner->launch_.rig_file = std::move(*applied);
  if (const auto made = runner->inherit_or_make(rig); !made)
    return tl::make_unexpected(made.error());
  store_with_systemd(runner->launch_.rings);
  return runner;
}

Result<void> RigRunner::open_descriptors() {
  std::signal(SIGPIPE, SIG_IGN);
  auto signals = open_stop_signals();
  if (!signals) return tl::make_unexpected(signals.error());
  auto timer = open_timer(kTick_ns);
  if (!timer) return tl::make_unexpected(timer.error());
  signals_ = std::move(*signals);
  timer_ = std::move(*timer);

  if (reports_.fd() >= 0) {
    loop_.watch(reports_.fd(), [this] {
      reports_.read();
      if (reports_.fd() >= 0) tick();
    });
  }
  loop_.watch(timer_.get(), [this] {
    drain(timer_.get());
    tick();
  });
  loop_.watch(signals_.get(), [this] {
    drain(signals_.get());
    if (phase_ != Phase::stopping) return begin_stop(0);
    for (const auto& service : services_) service->hurry();  // asked twice
  });
  return {};
}

Result<void> RigRunner::make_rings(const config::Rig& rig) {
  const auto specs = services_of(rig);
  if (auto added = add_rings(specs); !added) return added;
  for (const auto& spec : specs) add_service(spec, services_.size());
  return {};
}

int RigRunner::run() {
  for (const auto& service : services_)
    if (!service->first_start_ns()) service->hold();
  last_tick_ns_ = now_ns();
  // A reload was cut short, or `handcast up` came with other settings.
  if (inherited_) reload(rig_, false, ControlServer::Reply([](const auto&, const auto&) {}));
  follow_up();
  while (phase_ != Phase::done) {
    loop_.turn();
    follow_up();
  }
  return exit_code_;
}

void RigRunner::tick() {
  const auto now = now_ns();
  watchdog_.tick(now);
  forgive_a_standstill(now);
  recorder_.poll();
  for (const auto& service : services_) service->tick(now, look_at(*service, now));
  if (phase_ == Phase::stopping || phase_ == Phase::done) return;
  if (options_.seconds && now - started_ns_ >= seconds_to_ns(*options_.seconds))
    return begin_stop(0);
  continue_reload(now);
  progress(now);
}

/// After each turn of the event loop: what can wait until those who died have successors.
void RigRunner::follow_up() {
  come_up();
  if (phase_ == Phase::starting || phase_ == Phase::up) start_those_held();
  std::uint64_t revision = 0;
  for (const auto& service : services_) revision += service->revision();
  if (revision == std::exchange(revision_, revision) || phase_ == Phase::done) return;
  for (const auto& ring : rings_) ipc::sweep_dead_rows(ring);
  save();
}

bool RigRunner::needs_are_ready(const Service& service) const {
  return std::ranges::all_of(service.spec().needs, [this](const auto& name) {
    const auto* need = find(name);
    return !need || need->state() == State::ready;
  });
}

/// Whether nothing is to be waited for: each need is ready, has given up, or has had its time.
bool RigRunner::may_begin(const Service& service, std::int64_t now) const {
  return std::ranges::all_of(service.spec().needs, [&](const auto& name) {
    const auto* need = find(name);
    return !need || need_not_be_waited_for(*need, now);
  });
}

bool RigRunner::need_not_be_waited_for(const Service& service, std::int64_t now) const {
  if (service.state() != State::starting && service.state() != State::stopping) return true;
  return service.first_start_ns() &&
         now - *service.first_start_ns() > seconds_to_ns(launch_.ready_s);
}

void RigRunner::start_those_held() {
  const auto now = now_ns();
  for (std::size_t i = 0; i < services_.size(); ++i) {
    const bool held = services_[i]->state() == State::starting && !services_[i]->first_start_ns();
    if (held && may_begin(*services_[i], now)) services_[i]->start();
    if (phase_ != Phase::starting && phase_ != Phase::up)
      return;  // one that cannot start stops the rig
  }
}

void RigRunner::forgive_a_standstill(std::int64_t now) {
  const auto late_ns = now - std::exchange(last_tick_ns_, now) - kTick_ns;
  if (late_ns < kStoodStill_ns) return;
  log::warning("everything stood still for {:.1f} s; nobody is late for it",
               ns_to_seconds(late_ns));
  for (const auto& service : services_) service->forgive(late_ns);
}

/// While the rig stops, nobody is replaced for being silent.
Service::Look RigRunner::look_at(const Service& service, std::int64_t now) const {
  Service::Look look{.needs_are_ready = needs_are_ready(service)};
  if (phase_ == Phase::stopping || phase_ == Phase::done)
    look.heard_ns = now;
  else if (const auto silence_ms = recorder_.silence_ms(service.spec().name, now))
    look.heard_ns = now - ms_to_ns(*silence_ms);
  return look;
}

void RigRunner::progress(std::int64_t now) {
  if (now < next_progress_ns_ || phase_ != Phase::up) return;
  if (next_progress_ns_ > 0) show_progress(progress_line(view()));
  next_progress_ns_ = now + progress_period_ns();
}

void RigRunner::on_notice(Service& service, Notice notice) {
  if (phase_ == Phase::stopping) {
    if (notice != Notice::ready) stop_next();
    return;
  }
  switch (notice) {
    case Notice::ready:
      return on_ready(service);
    case Notice::failed:
      return on_failed(service);
    case Notice::stopped:
      if (const auto pending = pending_.extract(service.spec().name))
        pending.mapped().reply(failure(service.spec().name + " ended by itself"));
  }
}

void RigRunner::on_ready(Service& service) {
  if (const auto pending = pending_.extract(service.spec().name)) {
    const auto& [reply, wanted, before, reason] = pending.mapped();
    reply(reason.empty() ? success()
                         : failure(fmt::format("{} did not start with '{}', '{}' goes on: {}",
                                               service.spec().name, wanted, before, reason)));
  }
}

/// A service that is no good does not keep the rig from being up; one that was taken over is.
void RigRunner::come_up() {
  const auto now = now_ns();
  const auto has_begun = [&](const auto& service) {
    return service->was_ready() || need_not_be_waited_for(*service, now);
  };
  if (phase_ != Phase::starting || !(inherited_ || std::ranges::all_of(services_, has_begun)))
    return;
  phase_ = Phase::up;
  log::info("rig '{}' is up", name_);
  notify_systemd(fmt::format("READY=1\nSTATUS=rig '{}' is up", name_));
}

void RigRunner::on_failed(Service& service) {
  const auto& name = service.spec().name;
  const auto sentence = service.log().last_sentence();
  const auto pending = pending_.find(name);
  if (pending != pending_.end() && !pending->second.wanted.empty() &&
      pending->second.reason.empty()) {
    pending->second.reason = sentence;
    return give_backend(service, pending->second.before, false);
  }
  if (pending != pending_.end())
    pending_.extract(pending).mapped().reply(failure(fmt::format("{} failed: {}", name, sentence)));
  const bool reloaded = reload_ && reload_->begun.contains(name);  // the rig was there before
  if (phase_ != Phase::starting || service.was_ready() || reloaded) return;
  print_line(fmt::format("handcast: {} cannot start: {}", name, sentence));
  begin_stop(kExitConfig);
}

void RigRunner::begin_stop(int exit_code) {
  exit_code_ = exit_code;
  phase_ = Phase::stopping;
  notify_systemd("STOPPING=1");
  for (const auto& [name, pending] : std::exchange(pending_, {}))
    pending.reply(failure("the rig stops"));
  if (const auto reload = std::exchange(reload_, {})) reload->reply(failure("the rig stops"));
  for (const auto& service : services_)
    if (!service->is_running()) service->stop();  // takes back a start that was due
  stop_next();
}

void RigRunner::stop_next() {
  const auto last = std::find_if(services_.rbegin(), services_.rend(),
                                 [](const auto& service) { return service->is_running(); });
  if (last != services_.rend()) return (*last)->stop();
  finish();
}

void RigRunner::finish() {
  if (phase_ == Phase::done) return;
  phase_ = Phase::done;
  recorder_.poll();
  if (options_.out && exit_code_ == 0) {
    if (const auto written = write_report(*options_.out, live_report(view())); !written) {
      log::error("{}", written.error().what);
      exit_code_ = kExitConfig;  // not kExitFailure: the rig is not to be started again
    }
  }
  forget_saved(name_);
  forget_applied(name_);
  log::info("rig '{}' has stopped", name_);
  control_->close_door();
  for (const auto& reply : waiting_for_stop_) reply(success());
}

void RigRunner::save() const {
  if (phase_ == Phase::stopping)
    return;  // one who takes over here shall not take the services that were stopped for idle ones
  SavedRig saved{.name = name_,
                 .rig_file = options_.rig_file,
                 .settings = options_.settings,
                 .out = options_.out ? options_.out->string() : "",
                 .epoch_ns = launch_.epoch_ns,
                 .rings = {},
                 .services = {}};
  for (const auto& ring : rings_) {
    struct stat status {};
    if (fstat(ring.fd(), &status) == 0)
      saved.rings.push_back({ring.stream(), status.st_ino, ring.fd()});
  }
  for (const auto& service : services_) saved.services.push_back(service->saved());
  const auto written = supervisor::save(saved);
  if (!written && !std::exchange(save_failed_, true))
    log::warning("no successor could take over: {}", written.error().what);
}

}  // namespace handcast::supervisor
