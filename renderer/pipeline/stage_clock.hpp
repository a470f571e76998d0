// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/msg/stage_mark.hpp"

namespace handcast::renderer {

/// Marks the stages of one frame as they end; each begins where the one before ended.
class StageClock {
 public:
  void start() {
    marks_.clear();
    start_ns_ = last_ns_ = now_ns();
  }
  void mark(msg::Stage stage, std::uint32_t detail = 0) {
    const std::int64_t end_ns = now_ns();
    marks_.push_back({stage, detail, last_ns_, end_ns});
    last_ns_ = end_ns;
  }
  /// The whole frame, from start() to here.
  void finish() { marks_.push_back({msg::Stage::frame, 0, start_ns_, now_ns()}); }

  const std::vector<msg::StageMark>& marks() const { return marks_; }

 private:
  std::vector<msg::StageMark> marks_;
  std::int64_t start_ns_ = 0, last_ns_ = 0;
};

}  // namespace handcast::renderer
