#include "supervisor/service.hpp"

#include <signal.h>

#include <array>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "supervisor/console.hpp"

namespace handcast::supervisor {

std::string_view name_of(State state) {
  constexpr std::array<std::string_view, 6> kNames{"stopped", "starting", "ready", "stopping", "degraded", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

Service::Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnEvent on_event)
    : spec_(std::move(spec)), launch_(launch), loop_(loop), on_event_(std::move(on_event)) {}

Service::~Service() {
  if (!child_) return;
  for (const int fd : {child_->pidfd(), child_->log_fd(), child_->ready_fd()}) loop_.forget(fd);
}

std::vector<std::string> Service::arguments() const {
  std::vector<std::string> arguments{"--config", launch_.rig_file.string()};
  auto settings = launch_.settings;
  if (!backend_override_.empty()) settings.push_back(spec_.name + ".backend=" + backend_override_);
  for (const auto& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

void Service::start() {
  started_ns_ = now_ns();
  ready_ns_.reset();
  state_ = State::starting;
  due_ns_ = started_ns_ + seconds_to_ns(launch_.ready_s);
  if (std::exchange(ever_started_, true)) ++restarts_;

  auto child = Child::spawn({launch_.program_folder / ("handcast-" + spec_.name), arguments(), launch_.rings, launch_.epoch_ns});
  if (!child) {
    log_.append(child.error().what + "\n", print_line);
    life_ended({.code = child.error().code == Errc::bad_config ? kExitConfig : kExitFailure});
    return;
  }
  child_.emplace(std::move(*child));
  loop_.watch(child_->pidfd(), [this] { child_ended(); });
  loop_.watch(child_->log_fd(), [this] { read_log(); });
  loop_.watch(child_->ready_fd(), [this] { read_ready(); });
}

void Service::stop() {
  start_when_stopped_ = false;
  if (!child_) {
    state_ = State::stopped;
    due_ns_ = kNever;
    on_event_(*this, Event::stopped);
    return;
  }
  if (state_ == State::stopping) return;
  state_ = State::stopping;
  due_ns_ = now_ns() + seconds_to_ns(launch_.stop_s);
  child_->signal(SIGTERM);
}

void Service::kill() {
  if (child_) child_->signal(SIGKILL);
}

void Service::restart() {
  if (!child_) return start();
  stop();
  start_when_stopped_ = true;
}

void Service::use_backend(std::string backend, bool on_trial) {
  spec_.backend = backend_override_ = std::move(backend);
  on_trial_ = on_trial;
  restart();
}

void Service::tick(std::int64_t now) {
  if (now < due_ns_) return;
  due_ns_ = kNever;
  if (!child_) return start();
  if (state_ == State::stopping)
    log::warning("{} does not stop; killed", spec_.name);
  else
    log::warning("{} was not ready within {:g} s; killed", spec_.name, launch_.ready_s);
  kill();
}

void Service::read_log() {
  std::array<char, 4096> bytes;
  ssize_t count = 0;
  while ((count = ::read(child_->log_fd(), bytes.data(), bytes.size())) > 0)
    log_.append({bytes.data(), static_cast<std::size_t>(count)}, print_line);
  if (count == 0) loop_.forget(child_->log_fd());
}

void Service::read_ready() {
  char byte = 0;
  const auto count = ::read(child_->ready_fd(), &byte, 1);
  if (count < 0) return;
  loop_.forget(child_->ready_fd());
  if (count == 0 || byte != '\n' || state_ != State::starting) return;
  state_ = State::ready;
  ready_ns_ = now_ns();
  due_ns_ = kNever;
  on_trial_ = false;
  ever_ready_ = true;
  on_event_(*this, Event::ready);
}

void Service::child_ended() {
  const auto exit = child_->try_reap();
  if (!exit) return;
  read_log();  // its last words are in the pipe
  for (const int fd : {child_->pidfd(), child_->log_fd(), child_->ready_fd()}) loop_.forget(fd);
  child_.reset();
  life_ended(*exit);
}

void Service::life_ended(Exit exit) {
  last_exit_ = exit;
  if (state_ != State::stopping) return bury(exit);
  state_ = State::stopped;
  due_ns_ = kNever;
  if (std::exchange(start_when_stopped_, false)) return start();
  on_event_(*this, Event::stopped);
}

/// After a death that nobody asked for.
void Service::bury(Exit exit) {
  using Action = Decision::Action;
  auto decision = decide(std::move(deaths_), {now_ns(), ready_ns_, exit});
  deaths_ = std::move(decision.record);
  due_ns_ = kNever;
  if (on_trial_ || decision.action == Action::fail || decision.action == Action::retire) {
    const bool done = !on_trial_ && decision.action == Action::retire;
    on_trial_ = false;
    state_ = done ? State::stopped : State::failed;
    log::warning("{} ended ({}) and is not started again", spec_.name, exit.describe());
    on_event_(*this, done ? Event::stopped : Event::failed);
    return;
  }
  const bool storm = decision.action == Action::degrade;
  state_ = storm ? State::degraded : State::starting;
  log::warning("{} died ({}){}; started again after {:g} ms", spec_.name, exit.describe(), storm ? ", too often" : "",
               ns_to_ms(decision.wait_ns));
  if (decision.wait_ns == 0) return start();
  due_ns_ = now_ns() + decision.wait_ns;
}

}  // namespace handcast::supervisor
