// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::pose {

/// The poses of one hand over the last quarter of a second. One thread.
class RecentPoses {
 public:
  /// Adds a pose; ignored if it is not newer than the newest one.
  void add(std::int64_t origin_ns, const msg::HandPose& pose);
  /// The pose at `time_ns`: interpolated; the nearest one up to 20 ms beside the samples. Empty if
  /// there is none.
  std::optional<msg::HandPose> at(std::int64_t time_ns) const;
  /// Time of the newest pose, 0 if there is none.
  std::int64_t newest_ns() const { return poses_.empty() ? 0 : poses_.back().origin_ns; }
  /// Forgets all poses.
  void clear() { poses_.clear(); }

 private:
  struct Timed {
    std::int64_t origin_ns;
    msg::HandPose pose;
  };
  std::deque<Timed> poses_;  ///< oldest first
};

}  // namespace handcast::pose
