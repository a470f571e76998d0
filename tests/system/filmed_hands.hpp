// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::system_test {

/// A film of the twin's hands before both eyes of a Leap Motion Controller, which is played forth
/// and back.
class FilmedHands {
 public:
  static constexpr int kWidth_px = 640, kHeight_px = 240;  ///< of one eye's sensor

  /// Draws `images` images, `period_ns` apart. `calibration`: of both eyes, for images of 640x480.
  FilmedHands(const config::Rig& rig, const calib::Calibration& calibration, int images,
              std::int64_t period_ns);

  /// Writes image `number` of both eyes as the controller sends it.
  void write(std::uint32_t number, std::span<std::uint8_t> both) const;
  /// The true joints in tracker space, `since_ns` after the middle of the exposure of image 0.
  std::optional<renderer::JointFrames> joints(msg::Side side, std::int64_t since_ns) const;

 private:
  std::unique_ptr<twin::Twin> twin_;
  std::int64_t period_ns_;
  std::vector<std::vector<std::uint8_t>> images_;
};

}  // namespace handcast::system_test
