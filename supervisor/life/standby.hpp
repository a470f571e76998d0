// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "supervisor/base/event_loop.hpp"
#include "supervisor/life/child.hpp"
#include "supervisor/life/log_tail.hpp"
#include "supervisor/life/restart_policy.hpp"

namespace handcast::supervisor {

/// The spare of a service: a second process that has prepared everything and waits for its turn. It
/// is kept alive by the restart policy's waits; its deaths are its own and never count against the
/// service.
class Standby {
 public:
  struct Host {
    std::string name;                               ///< of the service
    std::function<Result<Child>()> spawn;           ///< starts a spare
    std::function<void(std::string_view)> on_line;  ///< what it writes
    std::function<void()> on_gone;                  ///< a spare that was dismissed has ended
  };

  Standby(Host host, EventLoop& loop);
  ~Standby();
  Standby(const Standby&) = delete;

  /// There is to be one, started not before `from_ns`. Does nothing where there is one already.
  void want(std::int64_t from_ns);
  /// None is to be: asks the one that is there to end.
  void dismiss(double stop_s);
  /// Gives the spare its turn and hands it over; empty where none is prepared.
  std::optional<Child> promote();
  void kill();
  /// Acts on what is due: starts, replaces one that is late or has not said a word for `silent_s`.
  void tick(std::int64_t now_ns, double ready_s, double silent_s);
  /// The clocks stood still for this long.
  void forgive(std::int64_t span_ns);

  bool is_prepared() const { return prepared_ns_.has_value() && !leaving_; }
  bool is_running() const { return child_.has_value(); }
  pid_t pid() const { return child_ ? child_->pid() : 0; }

 private:
  static constexpr auto kNever = std::numeric_limits<std::int64_t>::max();

  void start(std::int64_t now_ns);
  void read_log(int most_reads = LogTail::kReadsAtOnce);
  void read_signs();
  void child_ended();
  void let_go();
  void replace_after(const Death& death);

  Host host_;
  EventLoop& loop_;
  std::optional<Child> child_;
  LogTail log_;
  DeathRecord deaths_;
  std::optional<std::int64_t> prepared_ns_;
  std::int64_t started_ns_ = 0, sign_ns_ = 0;
  std::int64_t start_ns_ = kNever;  ///< when the next one is due
  std::int64_t kill_ns_ = kNever;   ///< leaving: when it is killed
  bool leaving_ = false;
};

}  // namespace handcast::supervisor
