// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/standby.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::supervisor {

Standby::Standby(Host host, EventLoop& loop) : host_(std::move(host)), loop_(loop) {}

Standby::~Standby() { let_go(); }

void Standby::let_go() {
  if (!child_) return;
  for (const int fd : {child_->pidfd(), child_->log_fd(), child_->ready_fd()}) loop_.forget(fd);
}

void Standby::want(std::int64_t from_ns) {
  if (child_ && !leaving_) return;
  start_ns_ = from_ns;
}

void Standby::dismiss(double stop_s) {
  start_ns_ = kNever;
  deaths_ = {};
  if (!child_ || leaving_) return;
  leaving_ = true;
  kill_ns_ = now_ns() + seconds_to_ns(stop_s);
  child_->signal(SIGTERM);
}

void Standby::kill() {
  if (child_) child_->signal(SIGKILL);
}

std::optional<Child> Standby::promote() {
  if (!child_ || !is_prepared()) return std::nullopt;
  child_->give_turn();
  let_go();
  auto child = std::move(child_);
  child_.reset();
  prepared_ns_.reset();
  return child;
}

void Standby::start(std::int64_t now) {
  start_ns_ = kNever;
  started_ns_ = sign_ns_ = now;
  auto child = host_.spawn();
  if (!child) {
    log::warning("the spare of {} could not be started: {}", host_.name, child.error().what);
    return replace_after({now, std::nullopt, {.code = kExitRetry}});
  }
  child_.emplace(std::move(*child));
  loop_.watch(child_->pidfd(), [this] { child_ended(); });
  loop_.watch(child_->log_fd(), [this] { read_log(); });
  loop_.watch(child_->ready_fd(), [this] { read_signs(); });
}

void Standby::tick(std::int64_t now, double ready_s, double silent_s) {
  if (!child_) {
    if (now >= start_ns_) start(now);
    return;
  }
  if (leaving_) {
    if (now < kill_ns_) return;
  } else if (!prepared_ns_) {
    if (now - started_ns_ < seconds_to_ns(ready_s)) return;
    log::warning("the spare of {} was not prepared within {:g} s; killed", host_.name, ready_s);
  } else {
    if (now - sign_ns_ < seconds_to_ns(silent_s)) return;
    log::warning("the spare of {} has given no sign of life for {:g} s; killed", host_.name,
                 silent_s);
  }
  kill();
  kill_ns_ = started_ns_ = sign_ns_ = now;  // that is said once, then again only if it survives
}

void Standby::forgive(std::int64_t span_ns) {
  for (auto* time_ns : {&started_ns_, &sign_ns_, &kill_ns_})
    if (*time_ns < kNever - span_ns) *time_ns += span_ns;
}

void Standby::read_log(int most_reads) {
  if (!log_.read_from(child_->log_fd(), host_.on_line, most_reads)) loop_.forget(child_->log_fd());
}

void Standby::read_signs() {
  std::array<char, 64> bytes;
  const auto count = ::read(child_->ready_fd(), bytes.data(), bytes.size());
  if (count == 0) loop_.forget(child_->ready_fd());
  if (count <= 0) return;
  sign_ns_ = now_ns();
  if (!prepared_ns_) prepared_ns_ = sign_ns_;
}

void Standby::child_ended() {
  const auto exit = child_->try_reap();
  if (!exit) return;
  const Death death{now_ns(), prepared_ns_, *exit};
  read_log(LogTail::kAllReads);
  let_go();
  child_.reset();
  prepared_ns_.reset();
  if (!std::exchange(leaving_, false)) return replace_after(death);
  host_.on_gone();
}

void Standby::replace_after(const Death& death) {
  auto decision = decide(std::move(deaths_), death);
  deaths_ = std::move(decision.record);
  if (decision.action == Decision::Action::fail) {
    log::warning("the spare of {} ended ({}); {} has none until it is started again", host_.name,
                 death.exit.describe(), host_.name);
    return;
  }
  const auto wait_ns =
      decision.action == Decision::Action::restart ? decision.wait_ns : kLongestWait_ns;
  log::warning("the spare of {} ended ({}); another one in {:g} ms", host_.name,
               death.exit.describe(), ns_to_ms(wait_ns));
  start_ns_ = death.died_ns + wait_ns;
}

}  // namespace handcast::supervisor
