// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "renderer/base/image.hpp"
#include "renderer/kms/buffer.hpp"
#include "renderer/kms/display.hpp"
#include "renderer/kms/pipe.hpp"

namespace handcast::renderer::kms {

/// Notices within a quarter of a second that a display is unplugged or plugged in again. It asks on
/// a thread of its own, because the kernel lets the question wait while another program asks a
/// display for its modes.
class PlugWatch {
 public:
  /// `card` must stay open while this object lives.
  PlugWatch(int card, std::uint32_t connector_id);

  /// Any thread.
  bool is_plugged() const { return is_plugged_; }

 private:
  std::atomic<bool> is_plugged_ = true;
  std::jthread thread_;
};

/// What a screen is opened with.
struct ScreenSettings {
  std::string card;       ///< see find_display()
  std::string connector;  ///< see choose_display()
  std::string mode;       ///< see choose_mode()
  /// Size of the picture, and the rate that is wanted of a mode.
  /// @{
  int width_px = 0, height_px = 0;
  double rate_hz = 0;
  /// @}
  bool may_scale = true;  ///< a mode of another size than the picture's may be taken
};

/// A picture that a display shows. Times are CLOCK_MONOTONIC.
struct Flip {
  std::int64_t handed_ns = 0;  ///< when the card got it
  std::int64_t flip_ns = 0;    ///< the refresh at which it appeared, as the kernel reports it
  /// Number of refreshes since the picture before, which was shown for so long; 0: unknown.
  std::uint32_t refreshes = 0;
};

/// A display without a window system, by the kernel's atomic mode setting. It is black until the
/// first picture, and has its former picture and mode again when the screen is destroyed. One
/// thread.
class Screen {
 public:
  /// Takes over the display. Errors: those of find_display(), choose_mode(), take_control() and
  /// find_pipe(); unavailable (the card refuses the mode).
  static Result<std::unique_ptr<Screen>> open(ScreenSettings settings);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Shows a picture of RGBA8, black outside of `region`, at the next refresh, and waits for it.
  /// Errors: timeout (the deadline, or the display is unplugged; it is dark then, and show() comes
  /// back to it when it is there again), disconnected (the card is gone or hangs).
  Result<Flip> show(View<const std::uint32_t> picture, Rect region, Deadline deadline);

  /// The display, as it was found last.
  const Display& display() const { return display_; }
  /// Time from one refresh to the next.
  std::int64_t refresh_ns() const { return refresh_ns_; }

 private:
  Screen(ScreenSettings settings, UniqueFd card, Display display);
  Result<void> prepare();
  Result<void> choose_mode();
  bool is_scaled() const {
    return mode_.width_px != settings_.width_px || mode_.height_px != settings_.height_px;
  }
  void add_light(Request& request) const;
  Error why_not_lit(int number) const;
  Result<void> light_up();
  void go_dark();
  Result<void> come_back();
  Result<void> await_flip(Deadline deadline);
  Result<void> commit_flip();

  ScreenSettings settings_;
  UniqueFd card_;
  Display display_;
  Mode mode_;
  std::int64_t refresh_ns_ = 0;
  Pipe pipe_;
  Former former_;
  Blob mode_blob_;
  std::array<std::unique_ptr<Buffer>, 2> buffers_;
  std::size_t front_ = 0;     ///< the buffer that is shown
  bool has_changed_ = false;  ///< the card is no longer in its former state
  bool is_on_ = false;
  std::int64_t retry_ns_ = 0;   ///< when to come back to the display again, after a failure
  bool is_flipping_ = false;    ///< the event of a flip has not arrived yet
  std::int64_t handed_ns_ = 0;  ///< when the card got the last picture
  struct Event {
    std::int64_t time_ns = 0;
    std::uint32_t sequence = 0;  ///< the number of the refresh
  };
  std::optional<Event> last_;  ///< of the last flip since the display was lit
  std::unique_ptr<PlugWatch> watch_;
};

}  // namespace handcast::renderer::kms
