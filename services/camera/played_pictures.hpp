// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "services/camera/picture_source.hpp"
#include "services/recording/playback.hpp"

namespace handcast::camera {

/// Images and when they are due.
struct PlayedPictures {
  std::unique_ptr<PictureSource> source;
  recording::Schedule schedule;
};

/// How a recording is to be played.
struct PlayedAs {
  std::string stream;               ///< of a recording that has several: "camera2.frames"
  int width_px = 0, height_px = 0;  ///< of the calibration's image
  std::uint32_t calibration = 0;    ///< its id
  std::int64_t exposure_ns = 0;     ///< if the recording does not say it
  double rate_hz = 0;               ///< likewise
  std::int64_t epoch_ns = 0;        ///< time zero of the rig
  bool loop = true;                 ///< over and over
};

}  // namespace handcast::camera
