// SPDX-License-Identifier: Apache-2.0
// The transitions of a service's spare.
#include <fmt/format.h>

#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "supervisor/life/transition.hpp"

namespace handcast::supervisor {
namespace {

/// The wait for the next spare after a promotion: its start would slow down the new worker.
constexpr std::int64_t kSpareAfterPromotion_ns = 1'000'000'000;

/// When the spare became prepared; empty if it never was.
std::optional<std::int64_t> prepared_since(const Spare& spare) {
  if (const auto* prepared = std::get_if<spare::Prepared>(&spare)) return prepared->prepared_ns;
  if (const auto* killed = std::get_if<spare::Killed>(&spare)) return killed->prepared_ns;
  return std::nullopt;
}

}  // namespace

/// Schedules a standby for a worker with this life. Does not change an existing spare.
void Transition::want_spare(const Life& life) {
  if (!rules_.wants_standby || replacement_) return;
  const auto from_ns = now_ + (life.origin == Origin::promoted ? kSpareAfterPromotion_ns : 0);
  if (auto* leaving = std::get_if<spare::Leaving>(&spare_))
    leaving->start_ns = from_ns;
  else if (!is_running(spare_))
    spare_ = spare::Due{from_ns};
}

void Transition::dismiss_spare() {
  past_.spare_deaths = {};
  replacement_.reset();
  if (!is_running(spare_)) {
    spare_ = spare::None{};
    return;
  }
  if (auto* leaving = std::get_if<spare::Leaving>(&spare_)) {
    leaving->start_ns.reset();
    return;
  }
  spare_ = spare::Leaving{.kill_ns = now_ + rules_.stop_ns};
  act(action::AskSpareToStop{});
}

void Transition::operator()(const event::SpareSpoke&) {
  if (std::holds_alternative<spare::Preparing>(spare_))
    spare_ = spare::Prepared{.prepared_ns = now_, .sign_ns = now_};
  else if (auto* prepared = std::get_if<spare::Prepared>(&spare_))
    prepared->sign_ns = now_;
}

// Replacement.

void Transition::operator()(const event::Prepare& event) {
  const bool has_standby = !replacement_ && (std::holds_alternative<spare::Preparing>(spare_) ||
                                             std::holds_alternative<spare::Prepared>(spare_));
  if (!has_standby || !event.may_use_spare) dismiss_spare();
  replacement_ = event.how;
  if (auto* leaving = std::get_if<spare::Leaving>(&spare_))
    leaving->start_ns = now_;
  else if (!is_running(spare_))
    spare_ = spare::Due{now_};
}

/// The worker and its replacement change places, so that the stream goes on as soon as the worker
/// has left it.
void Transition::operator()(const event::HandOver&) {
  if (!replacement_ || !spare_is_prepared()) return;
  const auto [on_trial, alone] = *replacement_;
  if (!life_of(worker_)) return promote(on_trial);
  if (alone) return ask_to_stop(worker::Stopping::Then::hand_over);
  begin(Origin::promoted, on_trial);
  spare_ = spare::Leaving{.kill_ns = now_ + rules_.stop_ns};
  replacement_.reset();
  act(action::HandOver{});
}

void Transition::operator()(const event::Abandon&) {
  if (!replacement_) return;
  dismiss_spare();
  if (const auto* ready = std::get_if<worker::Ready>(&worker_)) want_spare(ready->life);
}

void Transition::promote(bool on_trial) {
  begin(Origin::promoted, on_trial);
  spare_ = spare::None{};
  replacement_.reset();
  act(action::Promote{});
}

void Transition::lose_replacement(std::string why, bool by_itself) {
  replacement_.reset();
  spare_ = spare::None{};
  act(action::Warn{fmt::format("the replacement of {} failed ({})", rules_.name, why)});
  act(action::ReplacementFailed{std::move(why), by_itself});
  if (const auto* ready = std::get_if<worker::Ready>(&worker_)) want_spare(ready->life);
}

// End.

void Transition::operator()(const event::SpareEnded& event) {
  if (const auto* leaving = std::get_if<spare::Leaving>(&spare_)) {
    spare_ = leaving->start_ns ? Spare(spare::Due{*leaving->start_ns}) : Spare(spare::None{});
    if (std::holds_alternative<worker::AwaitingSpare>(worker_)) became_stopped();
    return;
  }
  if (!is_running(spare_)) return;
  if (const auto* killed = std::get_if<spare::Killed>(&spare_); killed && replacement_)
    return lose_replacement(killed->why, false);
  if (replacement_) return lose_replacement(event.exit.describe(), true);
  replace_spare({now_, prepared_since(spare_), event.exit});
}

void Transition::operator()(const event::SpareNotStarted& event) {
  if (replacement_) return lose_replacement(event.why, false);
  act(action::Warn{
      fmt::format("the spare of {} could not be started: {}", rules_.name, event.why)});
  replace_spare({now_, std::nullopt, {.code = kExitRetry}});
}

/// Schedules the next spare by the restart policy. After too many deaths, or after exit 0, it waits
/// for kLongestWait_ns.
void Transition::replace_spare(const Death& death) {
  using What = Decision::Action;
  auto decision = decide(std::move(past_.spare_deaths), death);
  past_.spare_deaths = std::move(decision.record);
  if (decision.action == What::fail) {
    spare_ = spare::None{};
    return act(
        action::Warn{fmt::format("the spare of {0} ended ({1}); {0} has none until it is started "
                                 "again",
                                 rules_.name, death.exit.describe())});
  }
  const auto wait_ns = decision.action == What::restart ? decision.wait_ns : kLongestWait_ns;
  spare_ = spare::Due{now_ + wait_ns};
  act(action::Warn{fmt::format("the spare of {} ended ({}); another one in {:.0f} ms", rules_.name,
                               death.exit.describe(), ns_to_ms(wait_ns))});
}

void Transition::tick_spare() {
  if (const auto* due = std::get_if<spare::Due>(&spare_); due && now_ >= due->start_ns) {
    spare_ = spare::Preparing{.late_ns = now_ + rules_.ready_ns};
    act(action::SpawnSpare{});
  } else if (const auto* preparing = std::get_if<spare::Preparing>(&spare_)) {
    if (now_ >= preparing->late_ns)
      kill_spare(fmt::format("was not prepared within {:g} s", ns_to_seconds(rules_.ready_ns)));
  } else if (const auto* prepared = std::get_if<spare::Prepared>(&spare_)) {
    if (now_ - prepared->sign_ns >= rules_.silent_ns)
      kill_spare(
          fmt::format("has given no sign of life for {:g} s", ns_to_seconds(rules_.silent_ns)));
  } else if (auto* leaving = std::get_if<spare::Leaving>(&spare_)) {
    if (!leaving->kill_ns || now_ < *leaving->kill_ns) return;
    leaving->kill_ns.reset();
    act(action::KillSpare{});
  }
}

void Transition::kill_spare(const std::string& why) {
  spare_ = spare::Killed{prepared_since(spare_), why};
  act(action::Warn{fmt::format("the spare of {} {}; killed", rules_.name, why)});
  act(action::KillSpare{});
}

void Transition::shift_spare(std::int64_t span_ns) {
  if (auto* preparing = std::get_if<spare::Preparing>(&spare_))
    preparing->late_ns += span_ns;
  else if (auto* prepared = std::get_if<spare::Prepared>(&spare_))
    prepared->sign_ns += span_ns;
  else if (auto* leaving = std::get_if<spare::Leaving>(&spare_); leaving && leaving->kill_ns)
    *leaving->kill_ns += span_ns;
}

}  // namespace handcast::supervisor
