// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/next.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/base/clock.hpp"
#include "supervisor/life/transition.hpp"

namespace handcast::supervisor {
namespace {

/// When the worker became ready; empty if it never was.
std::optional<std::int64_t> ready_since(const Worker& worker) {
  if (const auto* ready = std::get_if<worker::Ready>(&worker)) return ready->ready_ns;
  if (const auto* killed = std::get_if<worker::Killed>(&worker)) return killed->ready_ns;
  return std::nullopt;
}

std::int64_t silence_of(const worker::Ready& ready, std::optional<std::int64_t> last_sign_ns,
                        std::int64_t now_ns) {
  return now_ns - std::max(last_sign_ns.value_or(0), ready.quiet_from_ns);
}

std::int64_t suspicious_ns(const Rules& rules) {
  return std::min(rules.silent_ns / 8, kLeastSilence_ns);
}

/// How long a worker that does this may be silent.
std::int64_t longest_silence_ns(Activity activity, const Rules& rules) {
  const auto part_ns = [&](double part) {
    const auto ns = static_cast<std::int64_t>(part * static_cast<double>(rules.silent_ns));
    return std::min(rules.silent_ns, std::max(ns, kLeastSilence_ns));
  };
  if (activity == Activity::stopped) return part_ns(kStoppedPart);
  if (activity == Activity::asleep) return part_ns(kAsleepPart);
  return rules.silent_ns;
}

const char* doing(Activity activity) {
  if (activity == Activity::stopped) return " and is stopped";
  return activity == Activity::asleep ? " and sleeps" : "";
}

}  // namespace

bool is_suspicious(const ServiceState& state, std::optional<std::int64_t> last_sign_ns,
                   std::int64_t now_ns, const Rules& rules) {
  const auto* ready = std::get_if<worker::Ready>(&state.worker);
  return ready && silence_of(*ready, last_sign_ns, now_ns) >= suspicious_ns(rules);
}

Step next(ServiceState state, const Event& event, std::int64_t now_ns, const Rules& rules) {
  Transition transition(std::move(state), now_ns, rules);
  std::visit(transition, event);
  return std::move(transition).take();
}

// Start.

void Transition::operator()(const event::Hold&) {
  if (std::holds_alternative<worker::Stopped>(worker_)) worker_ = worker::Held{};
}

void Transition::operator()(const event::Start&) {
  if (!life_of(worker_)) start();
}

void Transition::operator()(const event::Inherited& event) {
  past_.restarts = event.restarts;
  if (event.state == State::failed)
    worker_ = worker::Failed{};
  else if (event.state == State::stopped)
    worker_ = worker::Stopped{};
  else
    return;
  past_.first_start_ns = now_;
}

void Transition::operator()(const event::Adopted& event) {
  past_.first_start_ns = now_;
  became_ready({.started_ns = event.started_ns, .origin = Origin::adopted});
}

void Transition::start(bool on_trial) {
  if (can_fail_over()) return promote(on_trial);
  begin(Origin::spawned, on_trial);
  act(action::Spawn{});
}

void Transition::begin(Origin origin, bool on_trial) {
  if (!past_.first_start_ns) past_.first_start_ns = now_;
  worker_ = worker::Starting{.life = {now_, origin, on_trial}, .late_ns = now_ + rules_.ready_ns};
}

void Transition::restart_after_death() {
  ++past_.restarts;
  start();
}

// Readiness.

void Transition::operator()(const event::SaidReady& event) {
  const auto* starting = std::get_if<worker::Starting>(&worker_);
  if (!starting) return;
  if (!rules_.publishes || event.published) return became_ready(starting->life);
  worker_ = worker::AwaitingMessage{.life = starting->life, .looked_ns = now_};
}

void Transition::became_ready(Life life) {
  life.on_trial = false;
  worker_ = worker::Ready{.life = life, .ready_ns = now_, .quiet_from_ns = now_};
  past_.was_ready = true;
  if (std::exchange(past_.waits, false))
    act(action::Warn{fmt::format("{} can start now", rules_.name)});
  want_standby(life);
  act(action::Tell{Notice::ready});
}

// Stop.

void Transition::operator()(const event::Stop&) {
  dismiss_standby();
  if (life_of(worker_)) return ask_to_stop(worker::Stopping::Then::stay);
  became_stopped();
}

void Transition::operator()(const event::Restart& event) {
  using Then = worker::Stopping::Then;
  dismiss_standby();
  if (life_of(worker_)) return ask_to_stop(event.on_trial ? Then::start_on_trial : Then::start);
  start(event.on_trial);
}

void Transition::ask_to_stop(worker::Stopping::Then then) {
  if (auto* stopping = std::get_if<worker::Stopping>(&worker_)) {
    stopping->then = then;
    return;
  }
  worker_ =
      worker::Stopping{.life = *life_of(worker_), .kill_ns = now_ + rules_.stop_ns, .then = then};
  act(action::AskToStop{.for_good = then == worker::Stopping::Then::stay});
}

void Transition::operator()(const event::Hurry&) {
  auto* stopping = std::get_if<worker::Stopping>(&worker_);
  if (stopping) {
    stopping->kill_ns.reset();
    act(action::Kill{});
  }
  if ((stopping || std::holds_alternative<worker::AwaitingStandby>(worker_)) &&
      is_running(standby_))
    act(action::KillStandby{});
}

/// A service has stopped when both of its processes have ended.
void Transition::became_stopped() {
  if (is_running(standby_)) {
    worker_ = worker::AwaitingStandby{};
    return;
  }
  worker_ = worker::Stopped{};
  act(action::Tell{Notice::stopped});
}

// End of the worker.

void Transition::operator()(const event::Ended& event) {
  using Then = worker::Stopping::Then;
  if (!life_of(worker_)) return;
  past_.last_exit = event.exit;
  const auto* stopping = std::get_if<worker::Stopping>(&worker_);
  if (!stopping) return died(event.exit, true);
  act(action::ReadLastWords{});
  if (stopping->then == Then::stay) return became_stopped();
  if (stopping->then == Then::hand_over && replacement_ && standby_is_prepared())
    return promote(replacement_->on_trial);
  start(stopping->then == Then::start_on_trial);
}

void Transition::operator()(const event::NotStarted& event) {
  if (!life_of(worker_)) return;
  past_.last_exit = event.exit;
  died(event.exit, false);
}

/// Handles an unexpected death, or a start that failed. The next process is started first, because
/// the outage lasts until it is ready.
void Transition::died(Exit exit, bool may_start_at_once) {
  using What = Decision::Action;
  const bool on_trial = life_of(worker_)->on_trial;
  const bool lacks_something = exit.asks_to_retry() && !ready_since(worker_);
  const bool is_said = std::exchange(past_.waits, lacks_something);
  auto decision =
      decide(std::move(past_.deaths), {now_, ready_since(worker_), exit}, jitter_at(now_));
  past_.deaths = std::move(decision.record);
  if (on_trial || decision.action == What::fail)
    return give_up(exit, worker::Failed{}, Notice::failed);
  if (decision.action == What::retire) return give_up(exit, worker::Stopped{}, Notice::stopped);

  const bool is_quick =
      decision.action == What::restart && (decision.wait_ns == 0 || can_fail_over());
  if (is_quick && may_start_at_once)
    restart_after_death();
  else
    worker_ = worker::Waiting{.due_ns = now_ + decision.wait_ns,
                              .degraded = decision.action == What::degrade};
  act(action::ReadLastWords{});
  const auto* life = life_of(worker_);
  const bool has_standby = life && life->origin == Origin::promoted;
  if (!lacks_something || has_standby)
    warn_of_death(exit, decision);
  else if (!is_said)
    warn_of_wait();
}

void Transition::warn_of_wait() {
  act(action::Warn{
      fmt::format("{0} cannot start, and is tried again until it can, at least every "
                  "{1:g} s; `handcast devices` lists what is attached",
                  rules_.name, std::ceil((1 + kMostJitter) * ns_to_seconds(kLongestWait_ns)))});
}

/// A replacement, which may have other settings, still takes over.
void Transition::give_up(Exit exit, const Worker& end, Notice notice) {
  worker_ = end;
  if (!replacement_) dismiss_standby();
  act(action::ReadLastWords{});
  act(action::Warn{
      fmt::format("{} ended ({}) and is not started again", rules_.name, exit.describe())});
  act(action::Tell{notice});
}

void Transition::warn_of_death(Exit exit, const Decision& decision) {
  const auto* life = life_of(worker_);
  if (life && life->origin == Origin::promoted)
    return act(action::Warn{
        fmt::format("{} died ({}); its standby goes on", rules_.name, exit.describe())});
  const bool degraded = decision.action == Decision::Action::degrade;
  act(action::Warn{fmt::format("{} died ({}){}; started again after {:.0f} ms", rules_.name,
                               exit.describe(), degraded ? ", too often" : "",
                               ns_to_ms(decision.wait_ns))});
}

// Time.

void Transition::operator()(const event::Tick& event) {
  tick_standby();
  std::visit([&](auto state) { tick(state, event); }, worker_);  // a copy: worker_ may change
}

void Transition::tick(const worker::Waiting& waiting, const event::Tick&) {
  if (now_ >= waiting.due_ns) restart_after_death();
}

void Transition::tick(const worker::Starting& starting, const event::Tick&) {
  if (now_ < starting.late_ns) return;
  kill_worker(fmt::format("{} was not ready within {:g} s; killed", rules_.name,
                          ns_to_seconds(now_ - starting.life.started_ns)));
}

/// The time during which its needs were not ready does not count: a service may need their messages
/// for its first own one.
void Transition::tick(const worker::AwaitingMessage& awaiting, const event::Tick& event) {
  if (event.published) return became_ready(awaiting.life);
  const auto dry_ns = awaiting.dry_ns + (event.needs_are_ready ? now_ - awaiting.looked_ns : 0);
  worker_ = worker::AwaitingMessage{.life = awaiting.life, .looked_ns = now_, .dry_ns = dry_ns};
  if (dry_ns < rules_.ready_ns) return;
  kill_worker(fmt::format("{} reported ready, but published nothing for {:g} s; killed",
                          rules_.name, ns_to_seconds(rules_.ready_ns)));
}

/// The watchdog: see next.hpp.
void Transition::tick(worker::Ready ready, const event::Tick& event) {
  const bool inert = event.activity == Activity::stopped || event.activity == Activity::asleep;
  const auto silence_ns = silence_of(ready, event.last_sign_ns, now_);
  ready.inert_from_ns = inert ? std::optional(ready.inert_from_ns.value_or(now_)) : std::nullopt;
  ready.held_up_ns = silence_ns < suspicious_ns(rules_) ? 0 : ready.held_up_ns + event.held_up_ns;
  worker_ = ready;
  const auto limit_ns = longest_silence_ns(event.activity, rules_);
  if (silence_ns < limit_ns) return;
  const auto inert_ns = static_cast<double>(limit_ns) * kInertPart;
  const bool is_hung =
      ready.inert_from_ns && static_cast<double>(now_ - *ready.inert_from_ns) >= inert_ns;
  const auto excused_ns =
      std::clamp<std::int64_t>(rules_.ready_ns - rules_.silent_ns, 0, ready.held_up_ns);
  if (silence_ns - excused_ns < rules_.silent_ns && !is_hung) return;
  kill_worker(fmt::format("{} has given no sign of life for {:.1f} s{}; killed", rules_.name,
                          ns_to_seconds(silence_ns), doing(event.activity)));
}

void Transition::tick(const worker::Stopping& stopping, const event::Tick&) {
  if (!stopping.kill_ns || now_ < *stopping.kill_ns) return;
  std::get<worker::Stopping>(worker_).kill_ns.reset();
  act(action::Warn{fmt::format("{} does not stop; killed", rules_.name)});
  act(action::Kill{});
}

void Transition::kill_worker(std::string why) {
  worker_ = worker::Killed{.life = *life_of(worker_), .ready_ns = ready_since(worker_)};
  act(action::Warn{std::move(why)});
  act(action::Kill{});
}

/// Shifts all deadlines. The time of a pending restart does not change.
void Transition::operator()(const event::StoodStill& event) {
  if (auto* starting = std::get_if<worker::Starting>(&worker_))
    starting->late_ns += event.span_ns;
  else if (auto* awaiting = std::get_if<worker::AwaitingMessage>(&worker_))
    awaiting->looked_ns += event.span_ns;
  else if (auto* ready = std::get_if<worker::Ready>(&worker_))
    ready->quiet_from_ns = now_, ready->inert_from_ns.reset();
  else if (auto* stopping = std::get_if<worker::Stopping>(&worker_); stopping && stopping->kill_ns)
    *stopping->kill_ns += event.span_ns;
  shift_standby(event.span_ns);
}

void Transition::operator()(const event::SettingsChanged&) {
  if (replacement_) return;
  if (!rules_.wants_standby) return dismiss_standby();
  if (const auto* ready = std::get_if<worker::Ready>(&worker_)) want_standby(ready->life);
}

}  // namespace handcast::supervisor
