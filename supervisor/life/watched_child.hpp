// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "ipc/daemon/words.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/life/child.hpp"
#include "supervisor/life/log_tail.hpp"

namespace handcast::supervisor {

/// A child on the event loop. Its output goes to the log and to the terminal; its words and its end
/// are reported to a listener. Destroying the object kills the child.
class WatchedChild {
 public:
  /// The callbacks, called by the event loop.
  struct Listener {
    std::function<void(daemon::Words)> on_words;  ///< the child wrote to its ready descriptor
    std::function<void(Exit)> on_end;             ///< the child ended; may destroy the object
  };
  /// `log` and `loop` must outlive the object.
  WatchedChild(Child child, LogTail& log, EventLoop& loop, Listener listener);
  ~WatchedChild();
  WatchedChild(const WatchedChild&) = delete;

  /// Child::pid().
  pid_t pid() const { return child_.pid(); }
  /// Child::log_fd().
  int log_fd() const { return child_.log_fd(); }
  /// Child::signal().
  void signal(int number) { child_.signal(number); }
  /// Returns the child. Afterwards the object watches none.
  Child release();
  /// Gives a standby its turn and returns it: see release().
  Child promote();
  /// Reports the end of an adopted process whose exit status arrived late.
  void check_end() {
    if (child_.is_adopted()) child_ended();
  }
  /// Reads the rest of the output of a child that has ended.
  void read_last_words() { read_log(LogTail::kAllReads); }

 private:
  void read_log(int most_reads = LogTail::kReadsAtOnce);
  void read_words();
  void child_ended();
  void forget();

  Child child_;
  LogTail& log_;
  EventLoop& loop_;
  Listener listener_;
};

}  // namespace handcast::supervisor
