// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "config/sections/cascade.hpp"
#include "renderer/ladder/rung.hpp"

namespace handcast::renderer {

/// The evidence by which the rungs of one hand are judged in one frame: mean squares over the
/// landmarks, undistorted camera px^2.
struct Evidence {
  // Errors caused by motion of the hand, see Hindsight::Motion.
  float hold_px2 = 0;      ///< of the newest sample
  float predict_px2 = 0;   ///< of its prediction
  float register_px2 = 0;  ///< of the prediction after registration to the newest image
  /// Per rung: the part of Q̂ - P that the model of the rung does not reproduce.
  std::array<float, kRungs> left_px2{};
  /// Error of Q̂ itself: detector noise that passes the filter, and drift since the detection.
  float landmark_px2 = 0;
  /// Error of Q̂ caused by motion, if Q̂ does not move with P; else empty.
  std::optional<float> lag_px2;
  bool has_landmarks = false;  ///< false: Q̂ is P
  bool can_register = false;   ///< there is an image to register to
};

/// The expected error of each rung r, camera px RMS; 1e6 for a rung that is not possible (no
/// landmarks, no image). See `docs/method.md#ladder`.
///
///     E(r)^2     = floor^2 + model(r)^2 + motion(r)^2
///     model(r)^2 = max(left(r) - landmark^2 (1 - 2 f), landmark^2 f)
///     f          = degrees_of_freedom(r) / 42
///
/// | rung                       | f                 | motion(r)^2 |
/// |----------------------------|-------------------|-------------|
/// | hold                       | 0                 | hold^2      |
/// | predict                    | 0                 | predict^2   |
/// | shift, similarity, fingers | 2/42, 4/42, 14/42 | predict^2   |
/// | landmarks                  | 1                 | predict^2   |
/// | register                   | 1                 | register^2  |
///
/// model(r)^2 is the part of Q̂ - P that the rung does not follow plus the error of Q̂ that it does
/// follow: Mallows's C_p (Mallows 1973). A rung with fewer free numbers follows less of the truth,
/// and less of the noise. It is 0 without landmarks.
///
/// If Q̂ does not move with P (filters naive, kalman and ideal), it does not share the error of the
/// prediction but lags: then the motion term of shift to landmarks is lag^2.
std::array<float, kRungs> expected_errors_px(const Evidence& evidence);

/// Chooses the rung of one hand in each frame: the cheapest whose expected error is within
/// `margin_percent` of the least. A more expensive rung is taken at once if the present one no
/// longer qualifies, a cheaper one after it has qualified for `dwell_ms`. One thread.
class Gate {
 public:
  /// Copies the settings.
  explicit Gate(const config::Ladder& settings) : settings_(settings) {}
  /// Chooses by other settings from now on.
  void adjust(const config::Ladder& settings) { settings_ = settings; }

  /// The rung for the frame at `target_ns`. Call it once per frame.
  Rung choose(std::int64_t target_ns, const Evidence& evidence);

 private:
  config::Ladder settings_;
  Rung rung_ = Rung::hold;
  std::array<std::int64_t, kRungs> enough_since_ns_{};  ///< kNever if the rung does not qualify
  bool started_ = false;
};

/// The share of each rung in the light. A change of rung is a cross-fade with exp(-t / blend_ms),
/// so that no frame moves by more than that share of the step between two rungs. One thread.
class RungBlend {
 public:
  /// Moves the shares towards `rung` for the frame at `target_ns`; at once if `blend_ms` is 0 or
  /// the last frame is more than 100 ms older.
  void turn_to(Rung rung, std::int64_t target_ns, double blend_ms);

  /// The share of `rung`, 0..1.
  float share(Rung rung) const { return shares_[static_cast<std::size_t>(rung)]; }
  /// True if `rung` has the whole share.
  bool is_pure(Rung rung) const { return share(rung) == 1; }

 private:
  std::array<float, kRungs> shares_{};  ///< sum to 1; all 0 before the first frame
  std::int64_t last_ns_ = 0;
  bool started_ = false;
};

}  // namespace handcast::renderer
