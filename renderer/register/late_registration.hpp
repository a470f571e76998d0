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
  LandmarkPoints moved_then{},
      moved_now{};  ///< what registration moved them by, at the exposure and at the target time
};

/// What the newest images know of the hands' motion that the tracker does not know yet. Each
/// image's outline is kept for a while; the one that is as old as the tracker's newest sample,
/// where the tracker's pose is not predicted, is found again in the newest image. That says where
/// the tracker would have put the hand then, and so by how much its prediction is wrong.
class LateRegistration {
 public:
  /// One hand that is to be registered.
  struct Hand {
    msg::Side side;
    const HandTrack* track;
    LandmarkPoints tracker;    ///< P at the target time
    LandmarkPoints offset_px;  ///< Q̂ - P
    bool is_alone = false;     ///< the tracker is silent: only its blends are used
  };

  LateRegistration(const config::Registration& settings, const config::Filter& filter,
                   const calib::Calibration& calibration);

  bool on() const { return settings_.method == config::RegisterMethod::mask; }

  bool is_new(const TimedImage& image) const { return image.origin_ns > newest_ns_; }
  /// Takes in an image, once; an image that is not newer than the last is not looked at.
  void look(const Silhouette& newest, std::span<const Hand> hands);

  /// The landmarks of one frame, moved by what the newest image knows of the motion, and without
  /// the jumps of new inputs: once a frame. (The filter is not to blend these: it would hold back
  /// what registration already knows.) `share` of it: a switch between rungs is blended in.
  RegisteredHand correct(const Hand& hand, std::int64_t target_ns, float share = 1);
  /// In its place for a hand that follows its landmarks alone, which nothing registers: they are
  /// blended on, without a jump between the two. `has_news`: an input arrived since the last frame.
  LandmarkPoints follow(const Hand& hand, std::int64_t target_ns, bool has_news);

  /// What the newest image said of a hand; for tests.
  const Registered& last(msg::Side side) const { return last_[static_cast<std::size_t>(side)]; }

 private:
  static constexpr std::size_t kOutlines = 32;
  struct Outline {
    std::int64_t time_ns = 0;
    Contour contour;
  };
  /// Where the tracker would have put a hand's landmarks at an exposure.
  struct Seen {
    std::int64_t time_ns = 0;
    std::int64_t anchor_ns = 0;  ///< when the outline was taken that was found again
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
  std::int64_t newest_ns_ = 0;
  std::vector<Outline> outlines_;  ///< a ring
  std::size_t next_outline_ = 0;
  std::array<Seen, msg::kMaxHands> seen_{};  ///< by side
  std::array<Registered, msg::kMaxHands> last_{};
  std::array<JumpBlend, msg::kMaxHands> blends_;
};

}  // namespace handcast::renderer
