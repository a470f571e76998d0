// SPDX-License-Identifier: Apache-2.0
#pragma once
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

/// One source of a pair.
struct PairPart {
  std::string name;  ///< for people: "pose 'openxr'"
  std::function<Result<std::unique_ptr<WatchedSource>>()> open;
};

/// How long a source may take, ns. One that takes longer hangs.
struct Patience {
  std::int64_t call_ns = 2'000'000'000;   ///< to sample, which should take 50 ms, or to be closed
  std::int64_t open_ns = 10'000'000'000;  ///< to be opened
};

/// What is known of a source that has been opened.
struct SourceFacts {
  int views = 0;
  joints::Conventions conventions;
};

/// Opens and samples one source of a pair on a thread of its own, and opens it again when it is
/// lost. A call that never returns holds up this thread and nothing else.
class SourceRunner {
 public:
  SourceRunner(From from, PairPart part, const Patience& patience,
               std::shared_ptr<PairInbox> inbox);
  /// Waits for the call that runs, but not for one that hangs: its thread is left behind.
  ~SourceRunner();
  SourceRunner(const SourceRunner&) = delete;

  /// How the first attempt to open the source ended; empty if it has not by the deadline. Any
  /// thread.
  std::optional<Result<SourceFacts>> opened(Deadline deadline) const;
  /// Passes the landmarks of a view to the source, if it takes them. Any thread.
  void see(const msg::Landmarks& landmarks, int view);
  /// Passes other settings to the source, also when it is opened again. Any thread.
  void adjust(const config::Rig& rig);
  /// Why there are no samples now; empty if there are. Any thread.
  std::string trouble() const;
  /// How long the source has hung; 0: it does not. Any thread.
  std::int64_t hung_ns() const;

 private:
  class Work;

  std::shared_ptr<Work> work_;  ///< outlives the runner if the thread hangs
  std::jthread thread_;
};

}  // namespace handcast::pose
