// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

}  // namespace handcast::camera::v4l2
