// SPDX-License-Identifier: Apache-2.0
// The transitions of a service's standby.
#include <fmt/format.h>

#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "supervisor/life/transition.hpp"

namespace handcast::supervisor {
namespace {

/// The wait for the next standby after a promotion: its start would slow down the new worker.
constexpr std::int64_t kStandbyAfterPromotion_ns = 1'000'000'000;

/// When the standby became prepared; empty if it never was.
std::optional<std::int64_t> prepared_since(const Standby& standby) {
  if (const auto* prepared = std::get_if<standby::Prepared>(&standby)) return prepared->prepared_ns;
  if (const auto* killed = std::get_if<standby::Killed>(&standby)) return killed->prepared_ns;
  return std::nullopt;
}

}  // namespace

/// Schedules a standby for a worker with this life. Does not change an existing standby.
void Transition::want_standby(const Life& life) {
  if (!rules_.wants_standby || replacement_) return;
  const auto from_ns = now_ + (life.origin == Origin::promoted ? kStandbyAfterPromotion_ns : 0);
  if (auto* leaving = std::get_if<standby::Leaving>(&standby_))
    leaving->start_ns = from_ns;
  else if (!is_running(standby_))
    standby_ = standby::Due{from_ns};
}

void Transition::dismiss_standby() {
  past_.standby_deaths = {};
  replacement_.reset();
  if (!is_running(standby_)) {
    standby_ = standby::None{};
    return;
  }
  if (auto* leaving = std::get_if<standby::Leaving>(&standby_)) {
    leaving->start_ns.reset();
    return;
  }
  standby_ = standby::Leaving{.kill_ns = now_ + rules_.stop_ns};
  act(action::AskStandbyToStop{});
}

void Transition::operator()(const event::StandbySpoke&) {
  if (std::holds_alternative<standby::Preparing>(standby_))
    standby_ = standby::Prepared{.prepared_ns = now_, .sign_ns = now_};
  else if (auto* prepared = std::get_if<standby::Prepared>(&standby_))
    prepared->sign_ns = now_;
}

// Replacement.

void Transition::operator()(const event::Prepare& event) {
  const bool has_standby = !replacement_ && (std::holds_alternative<standby::Preparing>(standby_) ||
                                             std::holds_alternative<standby::Prepared>(standby_));
  if (!has_standby || !event.may_use_standby) dismiss_standby();
  replacement_ = event.how;
  if (auto* leaving = std::get_if<standby::Leaving>(&standby_))
    leaving->start_ns = now_;
  else if (!is_running(standby_))
    standby_ = standby::Due{now_};
}

/// The worker and its replacement change places, so that the stream goes on as soon as the worker
/// has left it.
void Transition::operator()(const event::HandOver&) {
  if (!replacement_ || !standby_is_prepared()) return;
  const auto [on_trial, alone] = *replacement_;
  if (!life_of(worker_)) return promote(on_trial);
  if (alone) return ask_to_stop(worker::Stopping::Then::hand_over);
  begin(Origin::promoted, on_trial);
  standby_ = standby::Leaving{.kill_ns = now_ + rules_.stop_ns};
  replacement_.reset();
  act(action::HandOver{});
}

void Transition::operator()(const event::Abandon&) {
  if (!replacement_) return;
  dismiss_standby();
  if (const auto* ready = std::get_if<worker::Ready>(&worker_)) want_standby(ready->life);
}

void Transition::promote(bool on_trial) {
  begin(Origin::promoted, on_trial);
  standby_ = standby::None{};
  replacement_.reset();
  act(action::Promote{});
}

void Transition::lose_replacement(std::string why, bool by_itself) {
  replacement_.reset();
  standby_ = standby::None{};
  act(action::Warn{fmt::format("the replacement of {} failed ({})", rules_.name, why)});
  act(action::ReplacementFailed{std::move(why), by_itself});
  if (const auto* ready = std::get_if<worker::Ready>(&worker_)) want_standby(ready->life);
}

// End.

void Transition::operator()(const event::StandbyEnded& event) {
  if (const auto* leaving = std::get_if<standby::Leaving>(&standby_)) {
    standby_ =
        leaving->start_ns ? Standby(standby::Due{*leaving->start_ns}) : Standby(standby::None{});
    if (std::holds_alternative<worker::AwaitingStandby>(worker_)) became_stopped();
    return;
  }
  if (!is_running(standby_)) return;
  if (const auto* killed = std::get_if<standby::Killed>(&standby_); killed && replacement_)
    return lose_replacement(killed->why, false);
  if (replacement_) return lose_replacement(event.exit.describe(), true);
  replace_standby({now_, prepared_since(standby_), event.exit});
}

void Transition::operator()(const event::StandbyNotStarted& event) {
  if (replacement_) return lose_replacement(event.why, false);
  act(action::Warn{
      fmt::format("the standby of {} could not be started: {}", rules_.name, event.why)});
  replace_standby({now_, std::nullopt, {.code = kExitRetry}});
}

/// Schedules the next standby by the restart policy. After too many deaths, or after exit 0, it
/// waits for kLongestWait_ns.
void Transition::replace_standby(const Death& death) {
  using What = Decision::Action;
  auto decision = decide(std::move(past_.standby_deaths), death);
  past_.standby_deaths = std::move(decision.record);
  if (decision.action == What::fail) {
    standby_ = standby::None{};
    return act(
        action::Warn{fmt::format("the standby of {0} ended ({1}); {0} has none until it is started "
                                 "again",
                                 rules_.name, death.exit.describe())});
  }
  const auto wait_ns = decision.action == What::restart ? decision.wait_ns : kLongestWait_ns;
  standby_ = standby::Due{now_ + wait_ns};
  act(action::Warn{fmt::format("the standby of {} ended ({}); another one in {:.0f} ms",
                               rules_.name, death.exit.describe(), ns_to_ms(wait_ns))});
}

void Transition::tick_standby() {
  if (const auto* due = std::get_if<standby::Due>(&standby_); due && now_ >= due->start_ns) {
    standby_ = standby::Preparing{.late_ns = now_ + rules_.ready_ns};
    act(action::SpawnStandby{});
  } else if (const auto* preparing = std::get_if<standby::Preparing>(&standby_)) {
    if (now_ >= preparing->late_ns)
      kill_standby(fmt::format("was not prepared within {:g} s", ns_to_seconds(rules_.ready_ns)));
  } else if (const auto* prepared = std::get_if<standby::Prepared>(&standby_)) {
    if (now_ - prepared->sign_ns >= rules_.silent_ns)
      kill_standby(
          fmt::format("has given no sign of life for {:g} s", ns_to_seconds(rules_.silent_ns)));
  } else if (auto* leaving = std::get_if<standby::Leaving>(&standby_)) {
    if (!leaving->kill_ns || now_ < *leaving->kill_ns) return;
    leaving->kill_ns.reset();
    act(action::KillStandby{});
  }
}

void Transition::kill_standby(const std::string& why) {
  standby_ = standby::Killed{prepared_since(standby_), why};
  act(action::Warn{fmt::format("the standby of {} {}; killed", rules_.name, why)});
  act(action::KillStandby{});
}

void Transition::shift_standby(std::int64_t span_ns) {
  if (auto* preparing = std::get_if<standby::Preparing>(&standby_))
    preparing->late_ns += span_ns;
  else if (auto* prepared = std::get_if<standby::Prepared>(&standby_))
    prepared->sign_ns += span_ns;
  else if (auto* leaving = std::get_if<standby::Leaving>(&standby_); leaving && leaving->kill_ns)
    *leaving->kill_ns += span_ns;
}

}  // namespace handcast::supervisor
