// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/watched_child.hpp"

#include "supervisor/base/console.hpp"

namespace handcast::supervisor {

WatchedChild::WatchedChild(Child child, LogTail& log, EventLoop& loop, Listener listener)
    : child_(std::move(child)), log_(log), loop_(loop), listener_(std::move(listener)) {
  const auto watch = [&](int fd, auto on_readable) {
    if (fd >= 0) loop_.watch(fd, on_readable);
  };
  watch(child_.pidfd(), [this] { child_ended(); });
  watch(child_.log_fd(), [this] { read_log(); });
  watch(child_.ready_fd(), [this] { read_words(); });
}

WatchedChild::~WatchedChild() { forget(); }

void WatchedChild::forget() {
  for (const int fd : {child_.pidfd(), child_.log_fd(), child_.ready_fd()}) loop_.forget(fd);
}

Child WatchedChild::release() {
  forget();
  return std::move(child_);
}

Child WatchedChild::promote() {
  child_.give_turn();
  return release();
}

void WatchedChild::read_log(int most_reads) {
  if (!log_.read_from(child_.log_fd(), print_line, most_reads)) loop_.forget(child_.log_fd());
}

void WatchedChild::read_words() {
  const auto words = daemon::read_words(child_.ready_fd());
  if (words.closed || words.ready) loop_.forget(child_.ready_fd());
  const auto on_words = listener_.on_words;  // a copy: it may destroy this object
  if (words.any) on_words(words);
}

void WatchedChild::child_ended() {
  const auto exit = child_.try_reap();
  if (!exit) {
    if (child_.is_adopted() && child_.has_ended())
      loop_.forget(child_.pidfd());  // its exit status has not been reported yet: see check_end()
    return;
  }
  const auto on_end = listener_.on_end;
  on_end(*exit);
}

}  // namespace handcast::supervisor
