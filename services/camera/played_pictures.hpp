// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

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

/// The images of a recording of `handcast record`, at the times at which they were published.
/// Errors: those of StreamReader, bad_config (an image has another size).
Result<PlayedPictures> open_recorded_pictures(const std::filesystem::path& folder,
                                              const PlayedAs& as);

/// The frames of a film, at its own times. Errors: those of open_film(), bad_config (it has another
/// size, or does not say its times).
Result<PlayedPictures> open_film_pictures(const std::filesystem::path& file, const PlayedAs& as);

/// The PNG images of a folder, or of `camera` in it, as renderer::read_camera_picture() reads them,
/// in the order of the numbers in their names, at the times of camera_timestamps.npy; if there is
/// no such file, at the rate of the settings. They are decoded here, so they may take at most
/// 1 GiB. Errors: bad_config (the folder is missing or has
/// no images, a file is not an image or has another size, the images take more than 1 GiB, the
/// times are wrong or not as many).
Result<PlayedPictures> open_png_pictures(const std::filesystem::path& folder, const PlayedAs& as);

/// The images of a .npy file, (n, height, width) of bytes, read from the disk; at the times of
/// camera_timestamps.npy beside it or, if there is no such file, at the rate of the settings.
/// Errors: bad_config (no such file, images of another size, other times than images), bad_data (a
/// malformed file).
Result<PlayedPictures> open_npy_pictures(const std::filesystem::path& file, const PlayedAs& as);

/// The times of `count` images beside a file or in a folder: those of camera_timestamps.npy or, if
/// there is no such file, from `first_ns` on at `rate_hz`. Errors: bad_config (it has another
/// number of times), those of the file.
Result<std::vector<std::int64_t>> picture_times_ns(const std::filesystem::path& folder,
                                                   std::size_t count, double rate_hz,
                                                   std::int64_t first_ns);

}  // namespace handcast::camera
