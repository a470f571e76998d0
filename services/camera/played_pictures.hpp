// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/recording/playback.hpp"

namespace handcast::camera {

/// The images of a recording. One thread, which need not be the one that opened it.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// Reads the image of this index: exposure and losses to `frame`, the pixels, rows without
  /// padding, to `pixels`, which has the size of the calibration's image. Errors: bad_data (it is
  /// damaged).
  virtual Result<void> read(std::size_t index, msg::CameraFrame& frame,
                            std::span<std::uint8_t> pixels) = 0;
};

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
