// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/camera/v4l2/device.hpp"
#include "services/camera/v4l2/format.hpp"

namespace handcast::camera::v4l2 {

/// A size in pixels.
struct Size {
  int width_px = 0, height_px = 0;
  bool operator==(const Size&) const = default;
};

/// One size of a camera, or a range of them.
struct Sizes {
  Size least, most;  ///< the same for a single size
  Size step{1, 1};   ///< from `least` to `most`
  /// The highest rate in the size `most`; 0 if the driver does not say.
  double rate_hz = 0;

  bool contains(Size size) const;
};

/// A format of a camera with its sizes.
struct FormatSizes {
  std::uint32_t code = 0;    ///< the kernel's four-character code
  std::string name;          ///< the code as text: "YUYV"; as in a rig file if handcast reads it
  bool is_readable = false;  ///< handcast reads this format
  std::vector<Sizes> sizes;  ///< empty if the driver does not say
};

/// Asks a device for its formats and sizes. `fd`: an open video device.
std::vector<FormatSizes> formats_of(int fd);

/// Asks for the highest rate of a format in a size; 0 if the driver does not say.
double highest_rate_hz(int fd, std::uint32_t code, Size size);

/// E.g. "640x480 at 30 Hz" or "16x16 to 1920x1080".
std::string describe(const Sizes& sizes);
/// E.g. "YUYV in 640x480 at 30 Hz, 1280x720 at 10 Hz; MJPEG in 1280x720 at 30 Hz".
std::string describe(std::span<const FormatSizes> formats);

/// What a camera delivers.
struct Mode {
  Layout layout;
  double rate_hz = 0;  ///< what the driver says that it holds; 0 if it does not say
};

/// Sets format, size and rate. `format`: automatic chooses the first of kFormats that the camera
/// has in this size. A camera that has no such rate holds another one (Mode::rate_hz). Errors:
/// bad_config, with the formats and sizes that the camera has (it lacks format or size, or sends
/// half-images), unavailable (in use), disconnected.
Result<Mode> set_mode(const Device& device, config::WebcamFormat format, Size size, double rate_hz);

}  // namespace handcast::camera::v4l2
