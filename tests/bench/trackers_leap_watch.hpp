// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "services/camera/camera.hpp"
#include "tests/services/camera/leap/emulated_leap.hpp"

namespace handcast::bench {

/// A controller that streams both eyes, and what has come of its images.
class WatchedLeap {
 public:
  static constexpr int kWidth = 640, kHeight = 240;

  WatchedLeap();
  /// Opens the camera. False, with a sentence printed, if it cannot be opened.
  bool open();
  /// Captures once, and checks and counts what came.
  void capture();

  /// What was seen since the beginning.
  struct Seen {
    std::uint64_t images = 0, counted = 0;  ///< delivered; counted as lost
    std::uint64_t uncounted = 0;            ///< lost, but not counted (or counted twice)
    std::uint64_t damaged = 0;              ///< delivered, but not whole
    msg::FrameLosses lost;
    /// The latest return after a deadline: all of it, and without the time during which the thread
    /// was ready and other work had the processors (0 if the kernel does not count it).
    /// @{
    double latest_ms = 0, latest_own_ms = 0;
    /// @}
    std::vector<double>
        late_ms;  ///< from an image's last byte, as it should be sent, to its capture
  };
  const Seen& seen() const { return seen_; }
  test::EmulatedLeap& device() { return device_; }

 private:
  bool is_whole(std::uint32_t number) const;

  test::EmulatedLeap device_;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::vector<std::byte> first_, second_;
  std::unique_ptr<camera::Camera> camera_;
  Seen seen_;
  bool has_last_ = false;
  std::uint32_t last_ = 0;
};

}  // namespace handcast::bench
