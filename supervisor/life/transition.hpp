// SPDX-License-Identifier: Apache-2.0
// Only for next.cpp and next_standby.cpp.
#pragma once
#include <utility>

#include "supervisor/life/next.hpp"

namespace handcast::supervisor {

/// The implementation of next(): changes a copy of a service's state by one event and collects the
/// actions.
class Transition {
 public:
  /// Stores the arguments of next(). `rules` must outlive the object.
  Transition(ServiceState state, std::int64_t now_ns, const Rules& rules)
      : worker_(state.worker),
        standby_(std::move(state.standby)),
        replacement_(state.replacement),
        past_(std::move(state.past)),
        now_(now_ns),
        rules_(rules) {}
  /// The result.
  Step take() && {
    return {{worker_, std::move(standby_), replacement_, std::move(past_)}, std::move(actions_)};
  }

  /// Handles an event.
  /// @{
  void operator()(const event::Hold&);
  void operator()(const event::Start&);
  void operator()(const event::Stop&);
  void operator()(const event::Hurry&);
  void operator()(const event::Prepare&);
  void operator()(const event::HandOver&);
  void operator()(const event::Abandon&);
  void operator()(const event::Restart&);
  void operator()(const event::SettingsChanged&);
  void operator()(const event::Inherited&);
  void operator()(const event::Adopted&);
  void operator()(const event::StoodStill&);
  void operator()(const event::SaidReady&);
  void operator()(const event::Ended&);
  void operator()(const event::NotStarted&);
  void operator()(const event::StandbySpoke&);
  void operator()(const event::StandbyEnded&);
  void operator()(const event::StandbyNotStarted&);
  void operator()(const event::Tick&);
  /// @}

 private:
  void act(Action action) { actions_.push_back(std::move(action)); }

  // The worker (next.cpp).
  void start(bool on_trial = false);
  void restart_after_death();
  void begin(Origin origin, bool on_trial);
  void ask_to_stop(worker::Stopping::Then then);
  void became_stopped();
  void became_ready(Life life);
  void died(Exit exit, bool may_start_at_once);
  void give_up(Exit exit, const Worker& end, Notice notice);
  void warn_of_death(Exit exit, const Decision& decision);
  void warn_of_wait();
  void kill_worker(std::string why);
  void tick(const worker::Waiting& waiting, const event::Tick& event);
  void tick(const worker::Starting& starting, const event::Tick& event);
  void tick(const worker::AwaitingMessage& awaiting, const event::Tick& event);
  void tick(worker::Ready ready, const event::Tick& event);
  void tick(const worker::Stopping& stopping, const event::Tick& event);
  void tick(const auto& /*other*/, const event::Tick&) {}  // these states have no time limit

  // The standby (next_standby.cpp).
  bool standby_is_prepared() const { return std::holds_alternative<standby::Prepared>(standby_); }
  bool can_fail_over() const { return standby_is_prepared() && !replacement_; }
  void promote(bool on_trial);
  void lose_replacement(std::string why, bool by_itself);
  void want_standby(const Life& life);
  void dismiss_standby();
  void tick_standby();
  void kill_standby(const std::string& why);
  void replace_standby(const Death& death);
  void shift_standby(std::int64_t span_ns);

  Worker worker_;
  Standby standby_;
  std::optional<Replacement> replacement_;
  Past past_;
  std::int64_t now_;
  const Rules& rules_;
  std::vector<Action> actions_;
};

}  // namespace handcast::supervisor
