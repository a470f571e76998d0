// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/window/window.hpp"
#include "services/studies/jnd/stimulus.hpp"

namespace handcast::study {

/// A frame of an interval, as it was shown.
struct ShownFrame {
  /// Times of the motion: of the hand, and of its light.
  /// @{
  double hand_s = 0, light_s = 0;
  /// @}
  std::int64_t shown_ns = 0;  ///< CLOCK_MONOTONIC
  double error_ms = 0;        ///< how much later it was shown than it was drawn for
};

/// An interval as it was shown.
struct ShownInterval {
  std::vector<ShownFrame> frames;
  int missed = 0;  ///< frames that were not shown in the refresh that they were drawn for
  double worst_error_ms = 0;  ///< the farthest from the refresh that a frame was drawn for
  bool is_left = false;       ///< Escape was pressed meanwhile
};

/// Whether pictures that were shown one after another, at these times, waited for the refreshes of
/// a monitor: they came no faster, and at the same phase of a refresh. A slow computer without
/// vsync is not faster, either, but has no phase.
bool has_waited(std::span<const std::int64_t> shown_ns, std::int64_t refresh_ns);

/// Keys that end what waits for them.
inline constexpr std::string_view kEscape = "Escape", kGoOn = " ";

/// The screen in front of the subject. The main thread.
class StudyScreen {
 public:
  /// Opens the window and finds out whether it waits for the refreshes of the monitor. If it does
  /// not, a warning is in the log, and `rate_hz` pictures a second are shown by the clock of the
  /// computer. Errors: those of renderer::Window::open() and show().
  static Result<std::unique_ptr<StudyScreen>> open(renderer::WindowSettings settings,
                                                   double rate_hz);

  /// Keys that were pressed since the last call.
  using TakeKeys = std::function<std::vector<std::string>()>;

  /// Shows lines of text, the first one larger, until one of the keys is pressed, on the keyboard
  /// or on something else that has keys. Returns the key. Errors: those of Window::show();
  /// disconnected (the window was closed).
  Result<std::string> ask(const std::vector<std::string>& lines,
                          const std::vector<std::string_view>& keys,
                          const TakeKeys& take_others = {});
  /// Shows the same for a time. Returns false if Escape was pressed meanwhile.
  Result<bool> tell(const std::vector<std::string>& lines, double seconds);
  /// Shows an interval of the motion. Every frame is drawn for the refresh that will show it.
  Result<ShownInterval> play(Stimulus& stimulus, double from_s, double seconds, double delay_ms,
                             Condition condition);
  /// Lets the subject paint on a picture with the mouse, until the key kGoOn. Returns where, 255,
  /// else 0.
  Result<renderer::Image<std::uint8_t>> paint(renderer::View<const std::uint32_t> picture,
                                              const std::string& sentence);
  /// Time from one refresh to the next.
  double period_ms() const;

 private:
  StudyScreen(std::unique_ptr<renderer::Window> window, int width_px, int height_px, double rate_hz)
      : window_(std::move(window)), width_px_(width_px), height_px_(height_px), rate_hz_(rate_hz) {}
  Result<renderer::Shown> show(renderer::View<const std::uint32_t> picture,
                               const renderer::Rect& region);
  Result<void> find_rhythm();
  bool is_escape_pressed();
  renderer::Texture page(const std::vector<std::string>& lines) const;

  std::unique_ptr<renderer::Window> window_;
  int width_px_, height_px_;
  double rate_hz_;
  bool waits_ = false;        ///< show() returns with the refresh
  std::int64_t last_ns_ = 0;  ///< when the last picture was shown
};

}  // namespace handcast::study
