// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "services/pose/pair/handover.hpp"
#include "services/pose/watched_source.hpp"

namespace handcast::pose {

/// A sample of one source of a pair.
struct PairSample {
  From from = From::first;
  msg::HandPoses poses;
  std::int64_t arrival_ns = 0;  ///< CLOCK_MONOTONIC
  bool is_usable = false;       ///< see WatchedSource::is_usable()
  bool depends_on_calibration = false;
  msg::TrackerFaults faults;
};

/// Where the threads of a pair leave their samples. Any thread.
class PairInbox {
 public:
  /// Adds a sample. The oldest one is dropped if 64 are waiting.
  void put(const PairSample& sample);
  /// The oldest sample, as soon as there is one; empty at the deadline.
  std::optional<PairSample> take(Deadline deadline);

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<PairSample> samples_;
};

/// Samples one source of a pair on a thread of its own, and opens it again when it is lost.
class SourceRunner {
 public:
  /// Opens the source.
  using Open = std::function<Result<std::unique_ptr<WatchedSource>>()>;

  /// `source`: open, or null if it must be opened later. `inbox` must outlive the runner.
  SourceRunner(From from, Open open, std::unique_ptr<WatchedSource> source, PairInbox& inbox);

  /// Passes the landmarks of a view to the source, if it takes them. Any thread.
  void see(const msg::Landmarks& landmarks, int view);
  /// Why there are no samples now; empty if there are. Any thread.
  std::string trouble() const;

 private:
  void run(const std::stop_token& stop);
  void reopen(const std::stop_token& stop);
  void sample_once();
  bool show_landmarks(const std::stop_token& stop);
  void say(std::string trouble);

  From from_;
  Open open_;
  std::unique_ptr<WatchedSource> source_;
  PairInbox& inbox_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;                         ///< new landmarks, or the end
  std::array<std::optional<msg::Landmarks>, kMostViews> seen_;  ///< by view
  std::string trouble_;
  std::jthread thread_;
};

}  // namespace handcast::pose
