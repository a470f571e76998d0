// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <xf86drmMode.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::test {

/// A timing as kernels list it, of `width` x `height` pixels with usual blanks.
drmModeModeInfo timing(int width, int height, double rate_hz, std::uint32_t type = 0);

/// The graphics card /dev/dri/card0 as this process sees it. It stands in for the kernel, below
/// libdrm: while this object lives, open(), ioctl(), mmap() and close() of this process that
/// concern the card are answered by it, with the kernel's structs, checks and errors. Without one,
/// there is no card. It has the connectors HDMI-A-1 and DP-1, a CRTC and a primary plane for each,
/// and a cursor on the first CRTC. HDMI-A-1 shows a text screen of 640x480 at first. One at a time.
class EmulatedCard {
 public:
  EmulatedCard();
  ~EmulatedCard();
  EmulatedCard(const EmulatedCard&) = delete;
  EmulatedCard& operator=(const EmulatedCard&) = delete;

  /// What a driver, an administrator or another program may do to us. Set before the card is used.
  struct Faults {
    int open_fails = 0;  ///< an errno
    bool has_other_master = false;
    bool has_atomic = true, has_dumb_buffers = true, has_monotonic_times = true;
    bool has_displays = true;
    bool has_red_first = true;  ///< DRM_FORMAT_XBGR8888
    bool can_scale = false;
    std::uint32_t most_clock_khz = 600'000;
    int flip_fails = 0;  ///< an errno of each flip
    bool never_flips = false;
  };
  void set(const Faults& faults);

  void plug_in(const std::string& connector, const std::string& model,
               std::vector<drmModeModeInfo> modes);
  void unplug(const std::string& connector);

  /// The picture that a display gets now (RGBA8); without pixels if it gets none.
  renderer::Image<std::uint32_t> scanned(const std::string& connector) const;
  /// The mode it is lit in, e.g. "1024x768"; empty if it is dark.
  std::string lit_mode(const std::string& connector) const;

  /// A change of the picture.
  struct Flip {
    std::int64_t time_ns = 0;  ///< its time stamp, CLOCK_MONOTONIC
    std::uint32_t sequence = 0;
  };
  std::vector<Flip> flips() const;
  int modesets() const;      ///< commits that changed a mode or a connector
  int torn() const;          ///< refreshes at which the picture that was shown had been written to
  int probes() const;        ///< how often displays were asked for their modes
  int framebuffers() const;  ///< besides that of the text screen
  /// Writes a pixel into every framebuffer.
  void scribble(int x, int y, std::uint32_t value);
  /// The first pixel of each framebuffer at this place.
  std::vector<std::uint32_t> pixels_at(int x, int y) const;

  /// All properties of connectors, CRTCs and planes by name, blobs as their contents.
  std::map<std::string, std::string> state() const;
  /// Gives a CRTC a colour table, as a program that dims the screen at night.
  void set_colour_table();
  bool shows_cursor() const;

  class Kernel;

 private:
  std::shared_ptr<Kernel> kernel_;
};

}  // namespace handcast::test
