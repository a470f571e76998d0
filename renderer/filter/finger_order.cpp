// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/finger_order.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

constexpr std::int64_t kOrderPatience_ns = 500'000'000;
/// Fingers closer to their expected places than this are left as they are.
constexpr float kFarFromOrder_px = 15;
/// Fingers are exchanged if this share of the distance remains with the fingers exchanged.
constexpr float kCloser = 0.3f;

/// Mean distance of the seen landmarks of `finger` from the expected ones of the finger `place`.
/// Empty if there is none to compare.
std::optional<float> order_distance_px(const msg::HandLandmarks& seen,
                                       const ExpectedPoints& expected, int finger, int place) {
  float sum = 0;
  int count = 0;
  for (int k = 0; k < kLandmarksOfFinger; ++k) {
    const int from = first_landmark(finger) + k, to = first_landmark(place) + k;
    if (!was_seen(seen.points[from]) || !expected.known[to]) continue;
    sum += glm::distance(position_px(seen.points[from]), expected.px[to]);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<float>(count);
}

/// What an exchange of two fingers leaves of their distance from the expected places, as a share.
/// Empty if they cannot be compared, or one of them is at its place.
std::optional<float> left_by_exchange(const msg::HandLandmarks& seen,
                                      const ExpectedPoints& expected, int a, int b) {
  const auto a_a = order_distance_px(seen, expected, a, a),
             b_b = order_distance_px(seen, expected, b, b);
  const auto a_b = order_distance_px(seen, expected, a, b),
             b_a = order_distance_px(seen, expected, b, a);
  if (!a_a || !b_b || !a_b || !b_a || std::min(*a_a, *b_b) <= kFarFromOrder_px) return std::nullopt;
  return (*a_b + *b_a) / (*a_a + *b_b);
}

}  // namespace

msg::HandLandmarks FingerOrder::mended(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                                       const ExpectedPoints& expected,
                                       const ExpectedPoints& by_tracker) {
  msg::HandLandmarks mended = seen;
  bool wrong = false, trackers_too = true;
  for (int a = 0; a < kFingers; ++a)
    for (int b = a + 1; b < kFingers; ++b) {
      if (left_by_exchange(mended, expected, a, b).value_or(1) >= kCloser) continue;
      trackers_too = trackers_too && left_by_exchange(mended, by_tracker, a, b).value_or(1) < 1;
      std::swap_ranges(&mended.points[first_landmark(a)],
                       &mended.points[first_landmark(a)] + kLandmarksOfFinger,
                       &mended.points[first_landmark(b)]);
      wrong = true;
    }
  if (!wrong) {
    wrong_since_ns_.reset();
    return seen;
  }
  if (!wrong_since_ns_) wrong_since_ns_ = origin_ns;
  return trackers_too || origin_ns - *wrong_since_ns_ < kOrderPatience_ns ? mended : seen;
}

}  // namespace handcast::renderer
