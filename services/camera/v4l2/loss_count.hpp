// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <utility>

#include "ipc/msg/camera_frame.hpp"

namespace handcast::camera::v4l2 {

/// Numbers the images of a stream, and counts those that are not delivered.
class LossCount {
 public:
  /// `first`: the number of the first image.
  explicit LossCount(std::uint64_t first) : number_(first) {}

  /// The next image has arrived. `sequence`: the driver's number, which may wrap. Returns the
  /// image's number.
  std::uint64_t arrived(std::uint32_t sequence) {
    const std::uint32_t ahead = sequence - sequence_;
    // Some drivers do not count.
    const std::uint32_t steps = ahead == 0 || ahead > UINT32_MAX / 2 ? 1 : ahead;
    if (has_begun_) {
      number_ += steps;
      (were_all_full_ ? lost_.underrun : lost_.missing) += steps - 1;
    }
    has_begun_ = true;
    were_all_full_ = false;
    sequence_ = sequence;
    return number_;
  }
  /// No buffer was free when the last image arrived: the driver dropped those after it.
  void all_were_full() { were_all_full_ = true; }
  /// An image that arrived is not delivered.
  /// @{
  void skipped() { ++lost_.skipped; }
  void incomplete() { ++lost_.incomplete; }
  /// @}

  /// What was lost since the last call.
  msg::FrameLosses take() { return std::exchange(lost_, {}); }

 private:
  std::uint64_t number_;
  std::uint32_t sequence_ = 0;
  bool has_begun_ = false, were_all_full_ = false;
  msg::FrameLosses lost_;
};

}  // namespace handcast::camera::v4l2
