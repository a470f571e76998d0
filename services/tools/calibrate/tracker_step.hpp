// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/tools/calibrate/desk.hpp"

/// What the step `tracker` shares with its way by a reflector.
namespace handcast::calibrate {

/// Distances from the camera between which a hand should move.
/// @{
inline constexpr double kNear_m = 0.55, kFar_m = 0.9;
/// @}

/// How much of the volume was seen, and whether the hand still finds new places in it.
class Harvest {
 public:
  /// False if all was seen, or enough and the hand was at no new place for kNothingNew_s.
  bool goes_on(double share, bool sees_hand) {
    const auto now = now_ns();
    if (sees_hand) waited_ns_ += now - looked_ns_;
    looked_ns_ = now;
    if (share > share_) waited_ns_ = 0;
    share_ = share;
    return share < 1 && (share < kEnough || waited_ns_ < seconds_to_ns(kNothingNew_s));
  }
  /// What to do next, and when it ends. `place`: where the hand was not yet.
  std::string advice(const std::string& place) const {
    if (share_ < kEnough) return place;
    const double left_s = std::max(0.0, kNothingNew_s - ns_to_seconds(waited_ns_));
    return fmt::format("Enough was seen; it ends in {:.0f} s. Better still: {}", std::ceil(left_s),
                       place);
  }

 private:
  static constexpr double kEnough = 0.5, kNothingNew_s = 20;

  double share_ = 0;
  std::int64_t looked_ns_ = now_ns(), waited_ns_ = 0;
};

/// The hands of a message of poses or landmarks; damaged ones are left out.
template <class Message>
auto hands_of(const Message& message) {
  const auto count = std::min<std::size_t>(message.count, msg::kMaxHands);
  std::vector hands(message.hands.begin(), message.hands.begin() + count);
  std::erase_if(hands, [](const auto& hand) { return hand.side > msg::Side::right; });
  return hands;
}

/// Where the tracker is by a retro-reflector on an index finger tip (options.reflector_mm across)
/// that moves through the working volume: its place in the camera's images, and the tips by the
/// tracker. Errors: bad_data (it was not seen, with the reason; or the two do not fit), and those
/// of the streams.
Result<calib::TrackerFit> fit_by_reflector(Desk& desk);

}  // namespace handcast::calibrate
