// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/watched_frames.hpp"

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {

using namespace std::chrono_literals;

Frames watch_frames(double seconds, double refresh_hz) {
  auto marks = client::open_stream<msg::StageMarks>("twin", "marks.projector");
  if (!marks) give_up(marks.error().what);
  Frames frames;
  const std::int64_t begin_ns = now_ns();
  std::int64_t last_ns = 0;
  for (const auto until = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(seconds)));
       !until.passed();) {
    const auto sample = marks->next(Deadline::in(100ms));
    if (!sample) continue;
    const auto& message = **sample;
    for (std::uint32_t i = 0; i < message.count; ++i) {
      const auto& mark = message.marks[i];
      if (mark.stage != msg::Stage::frame || mark.begin_ns < begin_ns) continue;
      frames.frame_us.push_back(ns_to_us(mark.end_ns - mark.begin_ns));
      const double periods = ns_to_seconds(mark.begin_ns - last_ns) * refresh_hz;
      if (last_ns != 0 && periods > 1.5) frames.missed += static_cast<int>(periods - 0.5);
      last_ns = mark.begin_ns;
    }
  }
  return frames;
}

}  // namespace handcast::bench
