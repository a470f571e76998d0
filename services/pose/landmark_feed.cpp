// SPDX-License-Identifier: Apache-2.0
#include "services/pose/landmark_feed.hpp"

#include "ipc/msg/same_calibration.hpp"

namespace handcast::pose {

using namespace std::chrono_literals;

Result<void> LandmarkFeed::pass_on(PoseSource& source) {
  if (source.views() == 1)
    return pass_on(source, 0, source.needs_landmarks() ? Deadline::in(50ms) : Deadline::now());
  // The landmarks of the other view are taken at most so late.
  constexpr auto kOtherView = 2ms;
  const int awaited = source.awaited_view();
  auto first = pass_on(source, awaited,
                       source.needs_landmarks() ? Deadline::in(kOtherView) : Deadline::now());
  if (!first && first.error().code != Errc::timeout) return first;
  auto other = pass_on(source, 1 - awaited, Deadline::now());
  if (!other && other.error().code != Errc::timeout) return other;
  return {};
}

Result<void> LandmarkFeed::pass_on(PoseSource& source, int view, Deadline deadline) {
  auto& ring = rings_[static_cast<std::size_t>(view)];
  if (!ring) return tl::make_unexpected(ring.error());
  const auto seen = ring->latest(deadline);
  if (!seen) return tl::make_unexpected(seen.error());
  if (auto ours = msg::check_calibration(**seen, calibration_); !ours) return ours;
  source.see(**seen, view);
  return {};
}

std::optional<msg::Landmarks> LandmarkFeed::next() {
  if (!rings_.front()) return std::nullopt;
  const auto seen = rings_.front()->next(Deadline::now());
  return seen ? std::optional(**seen) : std::nullopt;
}

}  // namespace handcast::pose
