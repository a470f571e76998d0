#include "supervisor/rig_runner.hpp"

#include <fmt/format.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <ranges>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "supervisor/console.hpp"
#include "supervisor/streams.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kTick_ns = 50'000'000;
constexpr double kSilentTooLong_ms = 3000;  ///< a daemon beats its heart every 100 ms

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
    : name_(rig.name), options_(std::move(options)), loop_(std::move(loop)), started_ns_(now_ns()) {
  launch_.program_folder = options_.program_folder;
  launch_.rig_file = options_.rig_file;
  launch_.settings = options_.settings;
  launch_.epoch_ns = started_ns_;
  launch_.ready_s = rig.supervisor.ready_s;
  launch_.stop_s = rig.supervisor.stop_s;
}

Result<std::unique_ptr<RigRunner>> RigRunner::open(const config::Rig& rig, RunOptions options) {
  auto loop = EventLoop::open();
  if (!loop) return tl::make_unexpected(loop.error());
  std::unique_ptr<RigRunner> runner(new RigRunner(rig, std::move(options), std::move(*loop)));

  auto control = ControlServer::listen(
      rig.name, runner->loop_,
      [runner = runner.get()](const Request& request, ControlServer::Reply reply) { runner->on_request(request, std::move(reply)); });
  if (!control) return tl::make_unexpected(control.error());
  runner->control_ = std::move(*control);
  if (const auto opened = runner->open_descriptors(); !opened) return tl::make_unexpected(opened.error());
  if (const auto made = runner->make_rings(rig); !made) return tl::make_unexpected(made.error());
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

  loop_.watch(timer_.get(), [this] {
    drain(timer_.get());
    tick();
  });
  loop_.watch(signals_.get(), [this] {
    drain(signals_.get());
    if (phase_ != Phase::stopping) return begin_stop(0);
    for (const auto& service : services_) service->kill();  // asked twice: in a hurry
  });
  return {};
}

Result<void> RigRunner::make_rings(const config::Rig& rig) {
  const auto specs = services_of(rig);
  for (const auto& ring : rings_of(specs)) {
    auto segment = ipc::Segment::create(ring);
    if (!segment) return fail_in(fmt::format("ring {}", ring.stream), segment.error());
    launch_.rings.emplace_back(ring.stream, segment->fd());
    rings_.push_back(std::move(*segment));
  }
  for (const auto& spec : specs) {
    services_.push_back(
        std::make_unique<Service>(spec, launch_, loop_, [this](Service& service, Service::Event event) { on_event(service, event); }));
    for (const auto& [stream, fd] : launch_.rings) {
      if (stream != "marks." + spec.name) continue;
      if (const auto followed = recorder_.follow(spec.name, fd); !followed) return fail_in("the recorder", followed.error());
    }
  }
  return {};
}

int RigRunner::run() {
  for (const auto& service : services_)
    if (phase_ == Phase::starting) service->start();
  while (phase_ != Phase::done) loop_.turn();
  return exit_code_;
}

void RigRunner::tick() {
  const auto now = now_ns();
  recorder_.poll();
  for (const auto& service : services_) service->tick(now);
  if (phase_ == Phase::stopping || phase_ == Phase::done) return;
  if (options_.seconds && now - started_ns_ >= seconds_to_ns(*options_.seconds)) return begin_stop(0);
  replace_the_silent(now);
  progress(now);
}

void RigRunner::replace_the_silent(std::int64_t now) {
  for (const auto& service : services_) {
    const auto silence_ms = recorder_.silence_ms(service->spec().name, now).value_or(0);
    if (service->state() != State::ready || service->uptime_s(now) * 1e3 < kSilentTooLong_ms || silence_ms < kSilentTooLong_ms) continue;
    log::warning("{} has given no sign of life for {:.1f} s; killed", service->spec().name, silence_ms * 1e-3);
    service->kill();
  }
}

void RigRunner::progress(std::int64_t now) {
  if (now < next_progress_ns_ || phase_ != Phase::up) return;
  if (next_progress_ns_ > 0) show_progress(progress_line(view()));
  next_progress_ns_ = now + progress_period_ns();
}

void RigRunner::on_event(Service& service, Service::Event event) {
  if (phase_ == Phase::stopping) {
    if (event != Service::Event::ready) stop_next();
    return;
  }
  switch (event) {
    case Service::Event::ready:
      return on_ready(service);
    case Service::Event::failed:
      return on_failed(service);
    case Service::Event::stopped:
      if (const auto pending = pending_.extract(service.spec().name))
        pending.mapped().reply(failure(service.spec().name + " ended by itself"));
  }
}

void RigRunner::on_ready(Service& service) {
  if (const auto pending = pending_.extract(service.spec().name)) {
    const auto& [reply, wanted, before, reason] = pending.mapped();
    reply(reason.empty()
              ? success()
              : failure(fmt::format("{} did not start with '{}', '{}' goes on: {}", service.spec().name, wanted, before, reason)));
  }
  const auto ever_ready = [](const auto& each) { return each->ever_ready(); };
  if (phase_ != Phase::starting || !std::ranges::all_of(services_, ever_ready)) return;
  phase_ = Phase::up;
  log::info("rig '{}' is up", name_);
}

void RigRunner::on_failed(Service& service) {
  const auto& name = service.spec().name;
  const auto sentence = service.log().last_sentence();
  const auto pending = pending_.find(name);
  if (pending != pending_.end() && !pending->second.wanted.empty() && pending->second.reason.empty()) {
    pending->second.reason = sentence;
    return service.use_backend(pending->second.before, false);
  }
  if (pending != pending_.end()) pending_.extract(pending).mapped().reply(failure(fmt::format("{} failed: {}", name, sentence)));
  if (phase_ != Phase::starting || service.ever_ready()) return;
  print_line(fmt::format("handcast: {} cannot start: {}", name, sentence));
  begin_stop(kExitConfig);
}

void RigRunner::begin_stop(int exit_code) {
  exit_code_ = exit_code;
  phase_ = Phase::stopping;
  for (const auto& [name, pending] : std::exchange(pending_, {})) pending.reply(failure("the rig stops"));
  for (const auto& service : services_)
    if (service->pid() == 0) service->stop();  // takes back a start that was due
  stop_next();
}

void RigRunner::stop_next() {
  for (const auto& service : services_ | std::views::reverse)
    if (service->pid() != 0) return service->stop();
  finish();
}

void RigRunner::finish() {
  if (phase_ == Phase::done) return;
  phase_ = Phase::done;
  recorder_.poll();
  if (options_.out && exit_code_ == 0) {
    if (const auto written = write_report(*options_.out, live_report(view())); !written) {
      log::error("{}", written.error().what);
      exit_code_ = kExitFailure;
    }
  }
  log::info("rig '{}' has stopped", name_);
  control_->close_door();
  for (const auto& reply : waiting_for_stop_) reply(success());
}

}  // namespace handcast::supervisor
