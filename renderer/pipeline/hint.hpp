#pragma once
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/cascade/mask.hpp"
#include "renderer/pipeline/hand_track.hpp"

namespace handcast::renderer {

/// What the mask finder is told of one hand; owns the seeds and the flesh that the hint points to.
struct OwnedHint {
  HandHint hint;
  std::vector<glm::vec2> seeds_px;
  std::vector<Flesh> flesh;
};

/// Where a hand is expected in an image: its pose when the image was taken, moved by what the landmarks know (Q̂ - P of `tracked`).
/// Nothing of a hand that is behind the camera or far outside the image.
std::optional<OwnedHint> make_hint(const calib::Calibration& calibration, const config::Mask& settings, const msg::HandPose& then,
                                   const HandTrack::Tracked& tracked);

}  // namespace handcast::renderer
