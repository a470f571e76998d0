// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "calib/latency/light_delay.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/calibrate/desk.hpp"

namespace handcast::calibrate {

/// What the camera sees of the test pictures. One thread.
class PatternImages {
 public:
  using Image = std::vector<std::uint8_t>;  ///< row by row, of the size of the camera's images

  /// Errors: those of client::open_stream().
  static Result<PatternImages> open(Desk& desk);

  /// Measures by a light that toggles how much later than reported it comes, which image() needs.
  /// Takes about 6 s. Errors: those of calib::fit_light_delay(), and of the streams.
  Result<calib::LightDelay> measure_delay();
  /// Shows a picture and returns the first image that was exposed in its light only. Errors:
  /// timeout, and those of the streams.
  Result<Image> image(const std::function<void(std::uint8_t* levels)>& draw);

 private:
  PatternImages(Desk& desk, client::Stream<msg::CameraFrame> frames)
      : desk_(desk), frames_(std::move(frames)) {}
  void show_level(std::uint8_t level);

  Desk& desk_;
  client::Stream<msg::CameraFrame> frames_;
  std::int64_t settled_ns_ = 100'000'000;  ///< from a reported light to one that is there
};

}  // namespace handcast::calibrate
