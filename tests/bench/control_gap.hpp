// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>

#include "ipc/ring/ring_view.hpp"

namespace handcast::bench {

/// The longest time between two messages of a stream, by their publish times, while the object
/// lives. A thread looks at the ring every 0.2 ms, so a gap is too long by at most the messages
/// that it missed.
class GapWatch {
 public:
  explicit GapWatch(ipc::RingView view);
  ~GapWatch();
  GapWatch(const GapWatch&) = delete;

  /// The longest gap so far. The time since the last message counts, too.
  double longest_ms() const;
  /// The longest gap so far between the last message of a writer and the first one of the next.
  double pause_ms() const;
  /// The epoch of the newest message.
  std::uint64_t epoch() const { return epoch_; }

 private:
  void look();

  ipc::RingView view_;
  std::atomic<bool> ends_{false};
  std::atomic<std::int64_t> longest_ns_{0}, pause_ns_{0}, newest_ns_{0};
  std::atomic<std::uint64_t> epoch_{0};
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace handcast::bench
