// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::joints {

/// Where a source puts the joints.
enum class Place {
  unknown,      ///< the source does not say
  bones,        ///< in the middle of the limb, between two bones; a tip is at the end of its bone
  model,        ///< where handcast's own hand model has them; a tip is at the skin
  as_recorded,  ///< as in the recording that is played
  as_sent,      ///< as a program outside the rig sends them
};

/// Where the distance from a joint to the skin comes from.
enum class Radii { none, bone_widths, model, as_recorded, as_sent };

/// What the joints of a source mean, after they have been converted to the 26 of the rig.
struct Conventions {
  Place place = Place::unknown;
  bool has_measured_palm = false;  ///< else it is half-way along the middle metacarpal
  bool has_metacarpals = true;     ///< it reports the metacarpals of the four fingers
  bool has_measured_axes = true;   ///< else they follow from the positions
  Radii radii = Radii::none;
};

/// The conventions as one sentence for the log.
std::string sentence_of(const Conventions& conventions);

/// Those of Leap Motion and Ultraleap: the ends of bones, axes of the bones, widths of the flesh.
inline constexpr Conventions kLeap{
    .place = Place::bones, .has_measured_palm = false, .radii = Radii::bone_widths};

/// The distance from each joint of the mean hand to its skin, m: for sources that report no widths
/// (Radii::model). A test compares them with renderer::joint_radii_m(renderer::HandShape::mean()).
inline constexpr std::array<float, msg::kJoints> kMeanRadii_m = [] {
  std::array<float, msg::kJoints> radii{12, 17.5f,                      // palm, wrist
                                        13, 10.6f, 10.2f, 8.4f,         // thumb
                                        12, 10.4f, 9.2f,  8,    7,      // index finger
                                        12, 10.6f, 9.5f,  8.2f, 7.1f,   // middle finger
                                        12, 10.1f, 8.9f,  7.8f, 6.8f,   // ring finger
                                        12, 8.8f,  7.8f,  6.9f, 6.1f};  // little finger
  for (float& radius : radii) radius *= 1e-3f;
  return radii;
}();

}  // namespace handcast::joints
