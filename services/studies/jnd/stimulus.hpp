// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "services/studies/jnd/course.hpp"

namespace handcast::study {

/// What is shown.
struct StimulusSettings {
  /// Size of the picture.
  /// @{
  int width_px = 1280, height_px = 960;
  /// @}
  double px_per_mm = 3.6;  ///< of the screen: the hand is shown in its own size
  std::string motion = "builtin:show";
  double speed = 1;                         ///< of the motion
  std::string content = "builtin:checker";  ///< on the hand: a picture, or builtin:NAME
};

/// A moving left hand with light on it, for a flat screen (Casper DPM, Just Noticeable Difference).
/// The hand is the digital twin's; the light is the same surface as it was `delay_ms` before, drawn
/// by the painter of the projector from the same place: a delay is exact at any refresh rate. Light
/// beside the hand meets nothing. One thread.
class Stimulus {
 public:
  /// Errors: bad_config (no such motion or picture, sizes out of range).
  static Result<Stimulus> open(const StimulusSettings& settings);
  Stimulus(Stimulus&&) noexcept;
  ~Stimulus();

  /// The picture at a time of the motion, RGBA8, opaque, dark outside of region(). Valid until the
  /// next call.
  renderer::View<const std::uint32_t> draw(double time_s, double delay_ms, Condition condition);
  /// What contains the hand and its light in the last picture.
  renderer::Rect region() const;
  /// The speeds of places of the hand as the viewer sees them, degrees/s, 30 times a second.
  std::vector<double> speeds_deg_s(double from_s, double to_s) const;

 private:
  struct Parts;
  explicit Stimulus(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace handcast::study
