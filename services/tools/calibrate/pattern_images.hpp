// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "calib/solve/latency/light_delay.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// What the camera sees of the test pictures. One thread.
class PatternImages {
 public:
  using Image = std::vector<std::uint8_t>;  ///< row by row, of the size of the camera's images

  /// Errors: those of client::open_stream().
  static Result<PatternImages> open(Desk& desk);

  /// Measures by a light that toggles how much later than reported it comes, which image() needs.
  /// Takes 4 to 15 s: until the interval is narrow, or enough was seen; up to 19 s on a computer
  /// that is too busy to see each change. Errors: those of calib::fit_light_delay(), and of the
  /// streams.
  Result<calib::LightDelay> measure_delay();
  /// The same for image() alone: in 4 s, or up to 19 s on a busy computer.
  Result<calib::LightDelay> measure_delay_roughly();
  /// Shows a picture and returns the first image that was exposed in its light only. Errors:
  /// timeout, and those of the streams.
  Result<Image> image(const std::function<void(std::uint8_t* levels)>& draw);
  /// image() of one grey level for the whole picture.
  Result<Image> image_of_level(std::uint8_t level);

 private:
  /// A light that toggles, and the images of it.
  struct Watched {
    std::vector<calib::Toggle> toggles;
    std::vector<calib::Brightness> images;
  };

  PatternImages(Desk& desk, client::Stream<msg::CameraFrame> frames)
      : desk_(desk), frames_(std::move(frames)) {}
  Result<Image> image_after(const std::function<void()>& show);
  Result<void> toggle(int count, double hold_s, Watched& watched);
  double hold_s_of(const calib::LightDelay& delay) const;
  Result<calib::LightDelay> measure_delay(std::size_t most_toggles);

  Desk& desk_;
  client::Stream<msg::CameraFrame> frames_;
  std::int64_t period_ns_ = 0;             ///< of the projector's frames
  std::int64_t settled_ns_ = 100'000'000;  ///< from a reported light to one that is there
};

}  // namespace handcast::calibrate
