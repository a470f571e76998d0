// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>
#include <optional>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor::test {

inline constexpr std::int64_t kMs_ns = 1'000'000;
inline constexpr std::int64_t kSecond_ns = 1'000 * kMs_ns;
inline constexpr std::int64_t kStart_ns = 100 * kSecond_ns;

/// A mark between two times in ms after kStart_ns.
inline msg::StageMark mark(msg::Stage stage, double begin_ms, double end_ms) {
  return {stage, 0, kStart_ns + static_cast<std::int64_t>(begin_ms * 1e6),
          kStart_ns + static_cast<std::int64_t>(end_ms * 1e6)};
}

/// The marks of one frame as a service publishes them.
inline msg::StageMarks frame(std::uint64_t id, double origin_ms,
                             std::initializer_list<msg::StageMark> marks) {
  msg::StageMarks message;
  const auto last_ns = marks.size() > 0 ? (marks.end() - 1)->end_ns : kStart_ns;
  message.header = {id, kStart_ns + static_cast<std::int64_t>(origin_ms * 1e6), last_ns};
  for (const auto& each : marks) message.marks[message.count++] = each;
  return message;
}

/// The origins of a projector frame's inputs, in ms after kStart_ns; empty: it had none.
struct Inputs {
  std::uint64_t image_id = 0;
  std::optional<double> image_ms, pose_ms{}, landmarks_ms{};
};

/// The marks of a projector frame.
inline msg::StageMarks projector_frame(std::uint64_t id, const Inputs& inputs,
                                       std::initializer_list<msg::StageMark> marks) {
  auto message = frame(id, 0, marks);
  const auto at_ns = [](std::optional<double> ms) {
    return ms ? kStart_ns + static_cast<std::int64_t>(*ms * 1e6) : 0;
  };
  message.made_from = {inputs.image_id, at_ns(inputs.image_ms), at_ns(inputs.pose_ms),
                       at_ns(inputs.landmarks_ms)};
  message.header.origin_ns = message.made_from.image_ns;
  return message;
}

/// What a history gives back of itself.
inline HistorySnapshot everything_in(const History& history) {
  auto file = history.snapshot(0);
  if (!file) return {};
  return read_history(*file).value_or(HistorySnapshot{});
}

}  // namespace handcast::supervisor::test
