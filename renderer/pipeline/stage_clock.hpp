// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <tuple>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/msg/stage_mark.hpp"

namespace handcast::renderer {

/// Marks the stages of one frame, each of which begins when the one before ends. CLOCK_MONOTONIC.
/// One thread.
class StageClock {
 public:
  StageClock() { marks_.reserve(std::tuple_size_v<decltype(msg::StageMarks::marks)>); }

  /// Begins a frame and drops the marks of the last one.
  void start() {
    marks_.clear();
    start_ns_ = last_ns_ = now_ns();
  }
  /// Ends the stage that runs. `detail`: see msg::StageMark.
  void mark(msg::Stage stage, std::uint32_t detail = 0) {
    const std::int64_t end_ns = now_ns();
    marks_.push_back({stage, detail, last_ns_, end_ns});
    last_ns_ = end_ns;
  }
  /// Adds what another processor did for `took_ns` within the stages marked so far.
  void add(msg::Stage stage, std::int64_t took_ns) {
    marks_.push_back({stage, 0, last_ns_ - took_ns, last_ns_});
  }
  /// Adds the mark of the whole frame, from start() to now.
  void finish() { marks_.push_back({msg::Stage::frame, 0, start_ns_, now_ns()}); }

  /// The marks of the frame, in the order of their ends.
  const std::vector<msg::StageMark>& marks() const { return marks_; }

 private:
  std::vector<msg::StageMark> marks_;
  std::int64_t start_ns_ = 0, last_ns_ = 0;
};

}  // namespace handcast::renderer
