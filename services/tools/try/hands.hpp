// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/base/result.hpp"
#include "services/content/hands.hpp"

namespace handcast::trial {

/// The default hands, which sway in front of the camera and open and close slowly.
class MovingHands {
 public:
  /// Errors: those of renderer::load_hand_or_default().
  static Result<MovingHands> load();

  /// Whether at() fills the surfaces.
  void needs_surface(bool needed) { hands_.needs_surface(needed); }
  std::array<const renderer::HandMesh*, 2> meshes() const { return hands_.meshes(); }
  /// The hands at a time, s. Times go on from call to call.
  content::BothHands at(double time_s);

 private:
  explicit MovingHands(content::Hands hands) : hands_(std::move(hands)) {}

  content::Hands hands_;
};

}  // namespace handcast::trial
