// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "ipc/daemon/words.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/life/child.hpp"
#include "supervisor/life/log_tail.hpp"

namespace handcast::supervisor {

/// A child on the event loop. What it writes goes to the log and to the terminal; what it says and
/// how it ends is told. Destroying the object kills the child, as Child does.
class WatchedChild {
 public:
  struct Listener {
    std::function<void(daemon::Words)> on_words;
    std::function<void(Exit)> on_end;  ///< may destroy the object
  };
  /// `log` and `loop` must outlive the object.
  WatchedChild(Child child, LogTail& log, EventLoop& loop, Listener listener);
  ~WatchedChild();
  WatchedChild(const WatchedChild&) = delete;

  pid_t pid() const { return child_.pid(); }
  void signal(int number) { child_.signal(number); }
  /// Gives a spare its turn and hands it over; the object watches nothing any more.
  Child promote();
  /// Tells the end of an adopted process whose exit status was reported late.
  void check_end() {
    if (child_.is_adopted()) child_ended();
  }
  /// Reads the rest of what a child that has ended wrote.
  void read_last_words() { read_log(LogTail::kAllReads); }

 private:
  void read_log(int most_reads = LogTail::kReadsAtOnce);
  void hear();
  void child_ended();
  void forget();

  Child child_;
  LogTail& log_;
  EventLoop& loop_;
  Listener listener_;
};

}  // namespace handcast::supervisor
