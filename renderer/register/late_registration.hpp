// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/predict/hand_track.hpp"
#include "renderer/predict/jump_blend.hpp"
#include "renderer/register/registration.hpp"

namespace handcast::renderer {

/// The landmarks of one hand after late registration.
struct RegisteredHand {
  LandmarkPoints landmarks{};  ///< Q̂ at the target time
  /// Displacement by registration, at the exposure and at the target time.
  /// @{
  LandmarkPoints moved_then{}, moved_now{};
  /// @}
};

/// Step "register" and its state: corrects the predicted motion of the hands by the newest image.
/// The contours of recent images are kept. The newest one that is not later than the tracker's
/// newest sample is the anchor: at its time the tracker's pose is interpolated, not predicted. The
/// anchor is found again in the newest image, which shows where the tracker would have placed the
/// hand at that exposure, and so the error of its prediction. See `docs/method.md#register`. One
/// thread.
class LateRegistration {
 public:
  /// One hand to be registered.
  struct Hand {
    msg::Side side;            ///< which hand it is
    const HandTrack* track;    ///< its tracker samples; borrowed
    LandmarkPoints tracker;    ///< P at the target time
    LandmarkPoints offset_px;  ///< Q̂ - P
    bool is_alone = false;     ///< see Corrected::is_alone; such a hand is not registered
  };

  /// Without images. Uses limit_px and method of `settings`, blend_ms and blend_px of `filter`.
  LateRegistration(const config::Registration& settings, const config::Filter& filter,
                   const calib::Calibration& calibration);
  /// Uses other settings from now on, with the same images.
  void adjust(const config::Registration& settings, const config::Filter& filter);

  /// True if the settings switch late registration on.
  bool on() const { return settings_.method == config::RegisterMethod::mask; }

  /// True if `image` is newer than the image of the last look().
  bool is_new(const TimedImage& image) const { return image.origin_ns > newest_ns_; }
  /// Registers the hands in an image and keeps its contour. Ignores an image that is not newer than
  /// the last one.
  void look(const Silhouette& newest, std::span<const Hand> hands);

  /// The landmarks of one frame, corrected by the newest image and without the jumps of new inputs.
  /// The filter must not smooth the jumps as well: it would hold back motion that registration
  /// already shows. Call correct() or follow() once per frame and hand.
  RegisteredHand correct(const Hand& hand, std::int64_t target_ns);
  /// The same for a hand that is_alone: its landmarks are only smoothed, also when the hand changes
  /// between correct() and follow(). `has_news`: an input arrived since the last frame.
  LandmarkPoints follow(const Hand& hand, std::int64_t target_ns, bool has_news);

  /// How a hand was registered by the last look(); for tests.
  const Registered& last(msg::Side side) const { return last_[static_cast<std::size_t>(side)]; }

 private:
  static constexpr std::size_t kOutlines = 32;
  struct Outline {
    std::int64_t time_ns = 0;
    Contour contour;
  };
  /// Where the tracker would have placed the landmarks of a hand at an exposure.
  struct Seen {
    std::int64_t time_ns = 0;
    std::int64_t anchor_ns = 0;  ///< time of the anchor
    LandmarkPoints points{};
  };

  void find_hand(const Silhouette& newest, std::span<const Hand> hands, std::size_t index);
  const Outline* anchor_before(std::int64_t time_ns) const;
  LandmarkPoints missed(const Hand& hand, std::int64_t target_ns) const;
  std::optional<HandMotion> motion_of(const Hand& hand, std::int64_t then_ns,
                                      std::int64_t now_ns) const;

  config::Registration settings_;
  calib::Calibration calibration_;
  Registration registration_;
  std::int64_t newest_ns_ = 0, interval_ns_ = 0;  ///< of the images
  std::vector<Outline> outlines_;                 ///< ring buffer
  std::size_t next_outline_ = 0;
  std::array<Seen, msg::kMaxHands> seen_{};  ///< by side
  std::array<Registered, msg::kMaxHands> last_{};
  std::pair<double, double> blend_;  ///< ms and px of the blends
  std::array<JumpBlend, msg::kMaxHands> blends_;
};

}  // namespace handcast::renderer
