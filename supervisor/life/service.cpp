// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/service.hpp"

#include <fcntl.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "supervisor/base/console.hpp"
#include "supervisor/base/process.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kSpareAfterPromotion_ns = 1'000'000'000;

/// The ring of this stream, to look at; empty where there is none.
std::optional<ipc::RingView> look_at(std::string_view stream,
                                     const std::vector<std::pair<std::string, int>>& rings) {
  const auto found =
      std::ranges::find_if(rings, [&](const auto& ring) { return ring.first == stream; });
  if (found == rings.end()) return std::nullopt;
  auto view = ipc::RingView::open(UniqueFd(fcntl(found->second, F_DUPFD_CLOEXEC, 3)));
  if (view) return std::move(*view);
  log::warning("{} cannot be watched: {}", stream, view.error().what);
  return std::nullopt;
}

/// When a process started. Its ticks count the time that the machine was asleep, now_ns() does not.
std::int64_t start_of(std::uint64_t ticks) {
  timespec since_boot{};
  clock_gettime(CLOCK_BOOTTIME, &since_boot);
  const auto started_ns = static_cast<std::int64_t>(ticks) * (1'000'000'000 / sysconf(_SC_CLK_TCK));
  return now_ns() - (since_boot.tv_sec * 1'000'000'000 + since_boot.tv_nsec - started_ns);
}

/// Good enough to keep services that died together apart.
double any_jitter() { return static_cast<double>(now_ns() % 1009) / 1009; }

}  // namespace

Service::Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnEvent on_event)
    : spec_(std::move(spec)),
      launch_(launch),
      loop_(loop),
      on_event_(std::move(on_event)),
      stream_(look_at(spec_.stream, launch.rings)),
      standby_({.name = spec_.name,
                .spawn = [this] { return spawn(true); },
                .on_line = print_line,
                .on_gone =
                    [this] {
                      if (state_ == State::stopping && !child_) stopped();
                    }},
               loop) {}

Service::~Service() {
  if (child_) let_go(*child_);
}

std::vector<std::string> Service::arguments() const {
  std::vector<std::string> arguments{"--config", launch_.rig_file.string()};
  if (!backend_override_.empty())
    arguments.insert(arguments.end(), {"--set", spec_.name + ".backend=" + backend_override_});
  return arguments;
}

Result<Child> Service::spawn(bool spare) const {
  return Child::spawn({launch_.program_folder / ("handcast-" + spec_.name), arguments(),
                       launch_.rings, launch_.epoch_ns, spare});
}

void Service::hold() { state_ = State::starting; }

void Service::start() {
  begin_life();
  if (auto spare = standby_.promote()) {
    promoted_ = true;
    return take(std::move(*spare));
  }
  auto child = spawn(false);
  if (!child) return note_failed_start(child.error());
  take(std::move(*child));
}

void Service::begin_life() {
  before_ = stream_mark();
  started_ns_ = now_ns();
  ready_ns_.reset();
  said_ready_ = adopted_ = promoted_ = false;
  dry_ns_ = 0;
  last_tick_ns_ = started_ns_;
  state_ = State::starting;
  due_ns_ = started_ns_ + seconds_to_ns(launch_.ready_s);
  if (first_start_)
    ++restarts_;
  else
    first_start_ = started_ns_;
  ++revision_;
}

void Service::take(Child child) {
  child_.emplace(std::move(child));
  loop_.watch(child_->pidfd(), [this] { child_ended(); });
  loop_.watch(child_->log_fd(), [this] { read_log(*child_); });
  if (child_->ready_fd() >= 0) loop_.watch(child_->ready_fd(), [this] { read_ready(); });
}

void Service::inherit(const SavedService& saved) {
  restarts_ = saved.restarts;
  if (!saved.swapped.empty()) spec_.backend = backend_override_ = saved.swapped;
  spec_.fingerprint = saved.fingerprint;  // what it runs with, whatever the file says by now
  if (saved.state != State::failed && saved.state != State::stopped) return;
  state_ = saved.state;
  first_start_ = now_ns();
}

void Service::adopt(AdoptedProcess process) {
  const auto saved = process.saved;
  begin_life();
  started_ns_ = start_of(saved.started_ticks);
  adopted_ = true;
  take(Child::adopt(std::move(process), *launch_.reports));
  said_ready_ = true;  // whether it did is not known: its pipe went with the earlier supervisor
  due_ns_ = kNever;
  if (saved.state == State::ready || !stream_) became_ready();
}

void Service::stop() {
  start_when_stopped_ = false;
  standby_.dismiss(launch_.stop_s);
  if (!is_running()) return stopped();
  if (state_ == State::stopping) return;
  state_ = State::stopping;
  due_ns_ = now_ns() + seconds_to_ns(launch_.stop_s);
  if (child_) child_->signal(SIGTERM);
}

void Service::kill() {
  killed_ns_ = now_ns();
  if (child_) child_->signal(SIGKILL);
  if (state_ == State::stopping) standby_.kill();
}

void Service::restart() {
  if (child_) {
    stop();
    start_when_stopped_ = true;
    return;
  }
  standby_.dismiss(launch_.stop_s);
  start();
}

void Service::use_backend(std::string backend, bool on_trial) {
  spec_.backend = backend_override_ = std::move(backend);
  on_trial_ = on_trial;
  restart();
}

void Service::update(ServiceSpec spec) {
  if (spec.backend != backend_override_) backend_override_.clear();
  spec_ = std::move(spec);
  ++revision_;
  if (!spec_.process.standby) standby_.dismiss(launch_.stop_s);
  if (state_ == State::ready) prepare_spare();
}

SavedService Service::saved() const {
  return {.name = spec_.name,
          .pid = pid(),
          .started_ticks = child_ ? start_ticks_of(child_->pid()).value_or(0) : 0,
          .state = state_,
          .swapped = backend_override_,
          .fingerprint = spec_.fingerprint,
          .restarts = restarts_};
}

void Service::tick(std::int64_t now, bool needs_are_ready) {
  standby_.tick(now, launch_.ready_s, launch_.silent_s);
  if (child_ && adopted_) child_ended();  // its end may have been reported late
  if (child_ && said_ready_ && state_ == State::starting)
    expect_first_message(now, needs_are_ready);
  last_tick_ns_ = now;
  if (now < due_ns_) return;
  due_ns_ = kNever;
  if (!child_) return state_ == State::stopping ? standby_.kill() : start();
  if (state_ == State::stopping)
    log::warning("{} does not stop; killed", spec_.name);
  else
    log::warning("{} was not ready within {:g} s; killed", spec_.name,
                 ns_to_seconds(now - started_ns_));
  kill();
}

std::optional<double> Service::retry_s(std::int64_t now) const {
  const bool waits =
      !child_ && (state_ == State::starting || state_ == State::degraded) && due_ns_ != kNever;
  return waits ? std::optional(ns_to_seconds(std::max<std::int64_t>(due_ns_ - now, 0)))
               : std::nullopt;
}

void Service::forgive(std::int64_t span_ns) {
  standby_.forgive(span_ns);
  if (child_ && due_ns_ != kNever) due_ns_ += span_ns;
  last_tick_ns_ += span_ns;
}

void Service::read_log(const Child& child, int most_reads) {
  if (!log_.read_from(child.log_fd(), print_line, most_reads)) loop_.forget(child.log_fd());
}

void Service::read_ready() {
  std::array<char, 64> bytes;  // what it said as a spare may be in front
  const auto count = ::read(child_->ready_fd(), bytes.data(), bytes.size());
  if (count < 0) return;
  const bool newline = std::find(bytes.data(), bytes.data() + count, '\n') != bytes.data() + count;
  if (count > 0 && !newline) return;
  loop_.forget(child_->ready_fd());
  if (!newline || state_ != State::starting) return;
  said_ready_ = true;
  due_ns_ = kNever;
  last_tick_ns_ = now_ns();
  if (!stream_ || has_published()) became_ready();
}

Service::StreamMark Service::stream_mark() const {
  return stream_ ? StreamMark{stream_->epoch(), stream_->sequence()} : StreamMark{};
}

// An adopted service may have published before, in the same epoch.
bool Service::has_published() const {
  const auto now = stream_mark();
  return adopted_ ? now.sequence != before_.sequence : now.epoch != before_.epoch;
}

void Service::expect_first_message(std::int64_t now, bool needs_are_ready) {
  if (has_published()) return became_ready();
  if (!needs_are_ready) return;
  dry_ns_ += now - last_tick_ns_;
  if (dry_ns_ < seconds_to_ns(launch_.ready_s)) return;
  log::warning("{} said it was ready and has published nothing for {:g} s; killed", spec_.name,
               launch_.ready_s);
  dry_ns_ = 0;
  kill();
}

void Service::became_ready() {
  state_ = State::ready;
  ready_ns_ = now_ns();
  due_ns_ = kNever;
  on_trial_ = false;
  ever_ready_ = true;
  ++revision_;
  prepare_spare();
  on_event_(*this, Event::ready);
}

void Service::prepare_spare() {
  if (spec_.process.standby) standby_.want(now_ns() + (promoted_ ? kSpareAfterPromotion_ns : 0));
}

void Service::let_go(const Child& child) {
  for (const int fd : {child.pidfd(), child.log_fd(), child.ready_fd()}) loop_.forget(fd);
}

// The successor comes first; everything else can wait.
void Service::child_ended() {
  const auto exit = child_->try_reap();
  if (!exit) {
    if (adopted_ && child_->has_ended())
      loop_.forget(child_->pidfd());  // tick() asks again: how it ended will be reported
    return;
  }
  const Child dead = std::move(*child_);
  child_.reset();
  ++revision_;
  last_exit_ = exit;
  if (state_ == State::stopping) {
    read_log(dead, LogTail::kAllReads);
    let_go(dead);
    if (start_when_stopped_) return start();
    return is_running() ? void() : stopped();
  }
  const auto decision = judge(*exit);
  const bool at_once =
      state_ == State::starting && (decision.wait_ns == 0 || standby_.is_prepared());
  if (at_once) start();
  read_log(dead, LogTail::kAllReads);
  let_go(dead);
  if (at_once) return log_death(*exit, decision);
  tell(*exit, decision);
}

void Service::stopped() {
  state_ = State::stopped;
  due_ns_ = kNever;
  ++revision_;
  if (std::exchange(start_when_stopped_, false)) return start();
  on_event_(*this, Event::stopped);
}

/// What follows from a death that nobody asked for.
Decision Service::judge(Exit exit) {
  using Action = Decision::Action;
  auto decision = decide(std::move(deaths_), {now_ns(), ready_ns_, exit}, any_jitter());
  deaths_ = decision.record;
  due_ns_ = kNever;
  if (on_trial_ || decision.action == Action::fail)
    state_ = State::failed;
  else if (decision.action == Action::retire)
    state_ = State::stopped;
  else {
    state_ = decision.action == Action::degrade ? State::degraded : State::starting;
    due_ns_ = now_ns() + decision.wait_ns;
  }
  return decision;
}

void Service::tell(Exit exit, const Decision& decision) {
  if (state_ != State::failed && state_ != State::stopped) return log_death(exit, decision);
  on_trial_ = false;
  standby_.dismiss(launch_.stop_s);
  log::warning("{} ended ({}) and is not started again", spec_.name, exit.describe());
  on_event_(*this, state_ == State::failed ? Event::failed : Event::stopped);
}

void Service::log_death(Exit exit, const Decision& decision) const {
  if (promoted_ && child_)
    log::warning("{} died ({}); its spare goes on", spec_.name, exit.describe());
  else
    log::warning("{} died ({}){}; started again after {:g} ms", spec_.name, exit.describe(),
                 decision.action == Decision::Action::degrade ? ", too often" : "",
                 ns_to_ms(decision.wait_ns));
}

void Service::note_failed_start(const Error& error) {
  log_.append(error.what + "\n", print_line);
  const Exit exit{.code = exit_code_of(error)};
  last_exit_ = exit;
  tell(exit, judge(exit));
}

}  // namespace handcast::supervisor
