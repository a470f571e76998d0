// SPDX-License-Identifier: Apache-2.0
#include "services/recording/arrays/sensor_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::recording {
namespace {

constexpr const char* kSides[] = {"left", "right"};
constexpr std::size_t kColumns = 3;  ///< per landmark: x, y, sigma (px)
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
template <class Message>
std::int64_t origin_us(const Message& message) {
  return to_us(message.header.origin_ns);
}

/// One bit per side: 1 left, 2 right. 0 if a side occurs twice.
template <class Message>
unsigned sides_of(const Message& message) {
  unsigned sides = 0;
  for (std::uint32_t i = 0; i < message.count; ++i) {
    const unsigned side = 1u << static_cast<unsigned>(message.hands[i].side);
    if (sides & side) return 0;
    sides |= side;
  }
  return sides;
}

/// The messages that one recording can hold: those with the most frequent set of hands, in the
/// order of their times, without repeated times.
template <class Message>
std::vector<Message> recordable(std::vector<Message> messages) {
  std::array<std::size_t, 4> of_sides{};
  for (const auto& message : messages) ++of_sides[sides_of(message)];
  const auto most = std::max_element(of_sides.begin() + 1, of_sides.end()) - of_sides.begin();
  std::erase_if(messages, [&](const Message& message) { return sides_of(message) != most; });
  std::ranges::stable_sort(messages, {}, origin_us<Message>);
  const auto same_time = [](const Message& a, const Message& b) {
    return origin_us(a) == origin_us(b);
  };
  messages.erase(std::unique(messages.begin(), messages.end(), same_time), messages.end());
  return messages;
}

Result<void> write_landmarks(const std::filesystem::path& folder,
                             const std::vector<msg::Landmarks>& landmarks) {
  std::vector<std::int64_t> times_us;
  std::array<std::vector<float>, 2> points;
  for (const auto& seen : recordable(landmarks)) {
    times_us.push_back(origin_us(seen));
    for (std::uint32_t i = 0; i < seen.count; ++i)
      for (const auto& point : seen.hands[i].points) {
        auto& side = points[static_cast<std::size_t>(seen.hands[i].side)];
        const bool was_seen = point.confidence > 0;
        side.insert(side.end(), {was_seen ? point.x_px : kUnseen, was_seen ? point.y_px : kUnseen,
                                 point.sigma_px});
      }
  }
  for (std::size_t side = 0; side < points.size(); ++side) {
    if (points[side].empty()) continue;
    const auto file = folder / fmt::format("landmarks_{}.npy", kSides[side]);
    if (auto saved = write_npy_f32(
            file, {points[side].size() / (kColumns * msg::kLandmarks), msg::kLandmarks, kColumns},
            points[side]);
        !saved)
      return saved;
  }
  return write_npy_i64(folder / "landmarks_timestamps.npy", times_us);
}

}  // namespace

Result<void> write_messages(const std::filesystem::path& folder, const SensorMessages& messages) {
  std::error_code ignored;  // a folder that cannot be made is an error of the first file
  std::filesystem::create_directories(folder, ignored);
  if (auto saved = write_npy_i64(folder / "camera_timestamps.npy", messages.image_times_us); !saved)
    return saved;
  RecordedHands recording;
  for (const auto& poses : recordable(messages.poses)) {
    recording.time_ns.push_back(poses.header.origin_ns);
    for (std::uint32_t i = 0; i < poses.count; ++i)
      recording.hands[static_cast<std::size_t>(poses.hands[i].side)].push_back(poses.hands[i]);
  }
  if (recording.time_ns.size() < 2)
    return fail(Errc::bad_data,
                fmt::format("{}: there is no recording, for there were fewer than two samples of a "
                            "hand",
                            folder.string()));
  recording.first_ns = recording.time_ns.front();
  for (auto& time_ns : recording.time_ns) time_ns -= recording.first_ns;
  if (auto saved = write_recording(folder, recording); !saved) return saved;
  return write_landmarks(folder, messages.landmarks);
}

}  // namespace handcast::recording
