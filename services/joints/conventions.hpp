// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace handcast::joints {

/// Where a source puts the joints.
enum class Place {
  unknown,      ///< the source does not say
  bones,        ///< in the middle of the limb, between two bones; a tip is at the end of its bone
  model,        ///< where handcast's own hand model has them; a tip is at the skin
  as_recorded,  ///< as in the recording that is played
};

/// Where the distance from a joint to the skin comes from.
enum class Radii { none, bone_widths, model, as_recorded };

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

}  // namespace handcast::joints
