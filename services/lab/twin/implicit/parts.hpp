// SPDX-License-Identifier: Apache-2.0
/// What the implicit hand is made of. Millimetres; axes as in renderer::HandShape.
#pragma once
#include <vector>

#include "services/lab/hand_maker/rest_pose.hpp"
#include "services/lab/twin/implicit/limb.hpp"

namespace handcast::twin {

/// The joint that moves a limb from a place along it on.
struct MovedBy {
  int joint = 0;       ///< XR joint
  double from_mm = 0;  ///< the first one's place does not count
};

/// A limb and what moves it.
struct Part {
  Limb limb;
  std::vector<MovedBy> moved_by;  ///< from begin to end
  double blend_mm = 0;            ///< half the length on which two joints share the flesh
};

/// The bones of the implicit hand, whose fingers are straight and spread. They are not those of
/// the mean person: each part is scaled to the bones of the hand that it is put on.
renderer::HandShape implicit_shape();

/// A finger, or the thumb with its metacarpal, from the palm to the tip.
Part finger_part(const renderer::HandShape& shape, const renderer::RestPose& rest, int finger);
/// Metacarpals, heel, thenar, hypothenar, webs, wrist and a stub of the forearm.
std::vector<Part> palm_parts(const renderer::HandShape& shape, const renderer::RestPose& rest);

}  // namespace handcast::twin
