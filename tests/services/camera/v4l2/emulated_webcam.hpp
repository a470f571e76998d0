// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <linux/videodev2.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace handcast::test {

/// A format of an emulated webcam.
struct EmulatedFormat {
  std::uint32_t code = V4L2_PIX_FMT_GREY;
  struct Size {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> rates_hz{30};
  };
  std::vector<Size> sizes;
  std::uint32_t padding = 0;  ///< bytes after each row
};

/// A control of an emulated webcam.
struct EmulatedControl {
  std::uint32_t id = 0;
  v4l2_ctrl_type type = V4L2_CTRL_TYPE_INTEGER;
  std::string title;
  std::int64_t least = 0, most = 0, step = 1, value = 0;
  std::uint32_t flags = 0;
  std::map<std::uint32_t, std::string> menu{};
};

/// A webcam as this process sees it. It stands in for the kernel: while this object lives, open(),
/// stat(), ioctl(), mmap(), poll() and close() of this process that concern /dev/videoN are
/// answered by it, with the kernel's structs, checks and errors, those of its buffer queue
/// (videobuf2) included. Without one, there is no /dev/videoN. There may be several.
class EmulatedWebcam {
 public:
  struct Description {
    std::string path = "/dev/video0", card = "Emulated Webcam", bus = "usb-0000:00:14.0-1";
    std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    std::vector<EmulatedFormat> formats;
    std::vector<EmulatedControl> controls;
    /// Of each buffer. Stamps are the beginning of the exposure (SOE) or the arrival (EOF).
    std::uint32_t stamps = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    std::int64_t transfer_ns = 2'000'000;  ///< from the end of an exposure to its arrival
    std::uint32_t field = V4L2_FIELD_NONE;
    bool says_its_rate = true;
  };
  explicit EmulatedWebcam(Description description);
  ~EmulatedWebcam();
  EmulatedWebcam(const EmulatedWebcam&) = delete;
  EmulatedWebcam& operator=(const EmulatedWebcam&) = delete;

  /// What a driver, an administrator or another program may do to us.
  struct Faults {
    int open_fails = 0, stream_fails = 0;  ///< an errno
    bool has_no_group = false;             ///< only root may open it
    bool is_silent = false;                ///< it sends no images
    bool stops = false;                    ///< the driver ends the stream with an error
    bool does_not_count = false;           ///< all images have the sequence 0
    std::int64_t stamps_late_ns = 0;       ///< added to the time stamps
  };
  void set(const Faults& faults);
  /// The next images are flagged as broken, and half of them is there.
  void break_images(int count);
  /// The next images never come, but are counted.
  void lose_images(int count);
  void unplug();
  void plug_in();

  /// What the camera sees: the bytes of image number `sequence`. By default, all grey values of an
  /// uncompressed image are 10 + sequence % 100, and all other bytes 0xee.
  void show(std::function<std::vector<std::uint8_t>(std::uint32_t sequence)> image);

  /// An image that was sent.
  struct Sent {
    std::uint32_t sequence = 0;
    std::int64_t exposed_ns = 0;  ///< the beginning of the exposure, CLOCK_MONOTONIC
    std::int64_t arrived_ns = 0;
  };
  std::vector<Sent> sent() const;
  std::int64_t value_of(std::uint32_t control) const;
  int buffers() const;  ///< that are shared now
  bool streams() const;
  int misuses() const;  ///< calls that videobuf2 refused as wrong (EINVAL)

  class Kernel;

 private:
  std::shared_ptr<Kernel> kernel_;
};

/// The usual controls of a webcam: automatic exposure (on), exposure, gain, power line frequency.
std::vector<EmulatedControl> webcam_controls();

}  // namespace handcast::test
