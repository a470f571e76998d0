// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <span>

#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

/// Whether what a program outside the rig sends can be used. The library of that program checks it,
/// so that the program is told; the service that reads it checks it again, because the memory
/// between them may hold anything. All errors are bad_data.
namespace handcast::msg {

/// A sample may be of the future (a tracker that predicts) or the past by at most so much.
/// @{
inline constexpr std::int64_t kGuestAhead_ns = 50'000'000;
inline constexpr std::int64_t kGuestBehind_ns = 1'000'000'000;
/// @}

/// Whether a sample of `origin_ns` can follow one of `last_ns` at `time_ns`. Any values.
inline Result<void> check_guest_time(std::int64_t origin_ns, std::int64_t last_ns,
                                     std::int64_t time_ns) {
  const double ahead_s =
      (static_cast<double>(origin_ns) - static_cast<double>(time_ns)) / 1'000'000'000.0;
  if (origin_ns > time_ns + kGuestAhead_ns)
    return fail(Errc::bad_data, fmt::format("its time is {:.3g} s in the future; times are those "
                                            "of CLOCK_MONOTONIC in ns",
                                            ahead_s));
  if (origin_ns < time_ns - kGuestBehind_ns)
    return fail(Errc::bad_data, fmt::format("its time is {:.3g} s ago; times are those of "
                                            "CLOCK_MONOTONIC in ns",
                                            -ahead_s));
  if (origin_ns <= last_ns)
    return fail(Errc::bad_data, "its time is not later than that of the one before");
  return {};
}

namespace guest {

/// Whether all are numbers of at most this size.
inline bool are_within(std::span<const float> values, float largest) {
  for (const float value : values)
    if (!(std::abs(value) <= largest)) return false;  // NaN, too
  return true;
}

inline Result<void> check_sides(Side first, Side second, std::uint32_t count) {
  if (count > kMaxHands)
    return fail(Errc::bad_data,
                fmt::format("it has {} hands; it may have 0 to {}", count, kMaxHands));
  const auto is_side = [](Side side) { return side == Side::left || side == Side::right; };
  if ((count > 0 && !is_side(first)) || (count > 1 && !is_side(second)))
    return fail(Errc::bad_data, "a hand is neither the left nor the right one");
  if (count > 1 && first == second) return fail(Errc::bad_data, "both hands are of the same side");
  return {};
}

inline Result<void> check_joint(const Joint& joint, int number) {
  constexpr float kFarthest_m = 10, kThickest_m = 0.1f, kSlack = 0.05f;
  if (!are_within(joint.position_m, kFarthest_m))
    return fail(Errc::bad_data, fmt::format("the position of joint {} is not within {} m of the "
                                            "tracker; lengths are in metres",
                                            number, kFarthest_m));
  if (!(joint.radius_m >= 0 && joint.radius_m <= kThickest_m))
    return fail(Errc::bad_data,
                fmt::format("the radius of joint {} is not 0 to {} m", number, kThickest_m));
  float square = 0;
  for (const float part : joint.orientation_xyzw) square += part * part;
  if (!(std::abs(square - 1) <= kSlack))
    return fail(Errc::bad_data,
                fmt::format("the orientation of joint {} is not a unit quaternion", number));
  return {};
}

inline Result<void> check_point(const Landmark& point, int number) {
  constexpr float kFarthest_px = 10'000;
  const std::array place{point.x_px, point.y_px};
  if (!are_within(place, kFarthest_px))
    return fail(Errc::bad_data,
                fmt::format("landmark {} is not within {} px of the image", number, kFarthest_px));
  if (!(point.sigma_px >= 0 && point.sigma_px <= kFarthest_px))
    return fail(Errc::bad_data,
                fmt::format("the sigma of landmark {} is not 0 to {} px", number, kFarthest_px));
  if (!(point.confidence >= 0 && point.confidence <= 1))
    return fail(Errc::bad_data, fmt::format("the confidence of landmark {} is not 0 to 1", number));
  return {};
}

}  // namespace guest

/// Whether this is an image. Its size was compared with its ring.
inline Result<void> check_guest(const CameraFrame& frame) {
  constexpr std::int64_t kLongest_ns = 1'000'000'000;
  if (frame.width_px == 0 || frame.height_px == 0)
    return fail(Errc::bad_data, "an image has no pixels");
  if (frame.exposure_ns < 0 || frame.exposure_ns > kLongest_ns)
    return fail(Errc::bad_data, "an exposure is not 0 to 1 s");
  return {};
}

/// Whether these are hands, as far as their numbers show.
/// @{
inline Result<void> check_guest(const HandPoses& poses) {
  if (auto sides = guest::check_sides(poses.hands[0].side, poses.hands[1].side, poses.count);
      !sides)
    return sides;
  for (std::uint32_t hand = 0; hand < poses.count; ++hand) {
    if (!(poses.hands[hand].confidence >= 0 && poses.hands[hand].confidence <= 1))
      return fail(Errc::bad_data, "the confidence of a hand is not 0 to 1");
    for (int i = 0; i < kJoints; ++i)
      if (auto joint = guest::check_joint(poses.hands[hand].joints[static_cast<std::size_t>(i)], i);
          !joint)
        return joint;
  }
  return {};
}
inline Result<void> check_guest(const Landmarks& landmarks) {
  const auto& hands = landmarks.hands;
  if (auto sides = guest::check_sides(hands[0].side, hands[1].side, landmarks.count); !sides)
    return sides;
  for (std::uint32_t hand = 0; hand < landmarks.count; ++hand) {
    if (!(hands[hand].presence >= 0 && hands[hand].presence <= 1))
      return fail(Errc::bad_data, "the presence of a hand is not 0 to 1");
    for (int i = 0; i < kLandmarks; ++i)
      if (auto point = guest::check_point(hands[hand].points[static_cast<std::size_t>(i)], i);
          !point)
        return point;
  }
  return {};
}
/// @}

}  // namespace handcast::msg
