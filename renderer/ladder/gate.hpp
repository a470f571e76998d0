// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "config/sections/cascade.hpp"
#include "renderer/ladder/rung.hpp"

namespace handcast::renderer {

/// What is known of one hand in one frame, to judge the rungs by. Squares are means over the
/// landmarks, undistorted camera px^2.
struct Evidence {
  float hold_px2 = 0;      ///< the newest sample was off by, because the hand moved (hindsight.hpp)
  float predict_px2 = 0;   ///< its prediction was off by
  float register_px2 = 0;  ///< and is, registered to the newest image
  std::array<float, kRungs> left_px2{};  ///< of the field from P to Q̂ a rung's model does not reach
  float landmark_px2 = 0;  ///< Q̂ itself is off by: detector noise that its filter let through,
                           ///< drift since the detection
  std::optional<float>
      lag_px2;  ///< where Q̂ does not move with P: it is off by, because the hand moved
  bool has_landmarks = false;  ///< else Q̂ is P
  bool can_register = false;   ///< there is an image
};

/// The error to expect of each rung, camera px RMS:
///
///     E(r)^2 = floor^2 + model(r)^2 + motion(r)^2
///
/// | rung       | model(r)^2: the part of Q̂ - P not followed, and Q̂'s error | motion(r)^2 |
/// |            | followed                                                  |             |
/// |------------|-----------------------------------------------------------|-------------|
/// | hold       | left(0 dof) - landmark^2, at least 0                      | hold^2      |
/// | predict    | the same                                                  | predict^2   |
/// | shift      | left(r) - landmark^2 (1 - 2 dof / 42),                    | predict^2   |
/// |            | at least landmark^2 dof / 42                              |             |
/// | similarity | likewise                                                  | predict^2   |
/// | fingers    | likewise                                                  | predict^2   |
/// | landmarks  | landmark^2                                                | predict^2   |
/// | register   | landmark^2                                                | register^2  |
///
/// Where Q̂ does not move with P (filters naive, kalman, ideal) it has no part in the prediction's
/// error but lags by itself: lag^2 is the motion's term of shift to landmarks.
///
/// The model's term is Mallows's C_p (Mallows 1973): with fewer free numbers a rung follows less of
/// the truth, and less of the noise.
std::array<float, kRungs> expected_errors_px(const Evidence& evidence);

/// Chooses the rung of one hand, frame by frame: the cheapest whose expected error is within
/// `margin_percent` of the least. A dearer one is taken at once where the present one is no longer
/// enough; a cheaper one when it has been enough for `dwell_ms`.
class Gate {
 public:
  explicit Gate(const config::Ladder& settings) : settings_(settings) {}

  Rung choose(std::int64_t target_ns, const Evidence& evidence);

 private:
  config::Ladder settings_;
  Rung rung_ = Rung::hold;
  std::array<std::int64_t, kRungs> enough_since_ns_{};  ///< kNever where it is not
  bool started_ = false;
};

/// How much of each rung is in the light: a switch is blended in with exp(-t / blend_ms), and no
/// frame moves further than that share of the step between two rungs.
class RungBlend {
 public:
  /// Towards `rung`; at once where `blend_ms` is 0 or nothing was lit lately.
  void turn_to(Rung rung, std::int64_t target_ns, double blend_ms);

  float share(Rung rung) const { return shares_[static_cast<std::size_t>(rung)]; }
  bool is_pure(Rung rung) const { return share(rung) == 1; }

 private:
  std::array<float, kRungs> shares_{};  ///< sum to 1, or nothing was lit yet
  std::int64_t last_ns_ = 0;
  bool started_ = false;
};

}  // namespace handcast::renderer
