// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/mask/mask.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {

/// A hint with the seeds and the capsules that it refers to.
struct OwnedHint {
  HandHint hint;                    ///< refers to the members below
  std::vector<glm::vec2> seeds_px;  ///< HandHint::inside_px
  std::vector<Capsule> capsules;    ///< HandHint::capsules
};

/// Where a hand is expected in an image: `then`, its pose at the exposure, moved by `offset_px`
/// (Q̂ - P). `has_landmarks`: the offset is that of landmarks, not 0. Empty if the hand is more than
/// half an image outside the image.
std::optional<OwnedHint> make_hint(const calib::Calibration& calibration,
                                   const config::Mask& settings, const ProjectedPose& then,
                                   const LandmarkPoints& offset_px, bool has_landmarks);

}  // namespace handcast::renderer
