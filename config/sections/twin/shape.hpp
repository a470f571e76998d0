// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// How the flesh of the true hand follows its bones.
enum class TwinSkinning {
  linear,           ///< linear blend skinning, as the cascade draws
  dual_quaternion,  ///< Kavan et al. 2007, "Skinning with Dual Quaternions"
};
constexpr std::array<std::string_view, 2> words_of(TwinSkinning) {
  return {"linear", "dual_quaternion"};
}

/// [twin.shape]
struct TwinShape {
  std::string mesh = "handcast";
  double length_spread = 0.04;
  double width_spread = 0.06;
  double bone_width_spread = 0;
  double thickness_spread = 0;
  double taper_spread = 0;
  double roll_deg = 0;
  TwinSkinning skinning = TwinSkinning::linear;
  double bulge = 0;
};

template <class Visitor>
void describe(Visitor& visitor, TwinShape& shape) {
  visitor.field("mesh", shape.mesh,
                "The surface of the true hands: handcast (the mesh that is drawn), webxr (the "
                "generic hand of WebXR's input profiles, which `scripts/setup --hands` installs), "
                "implicit (a hand that is made of implicit surfaces, with vertices, weights and "
                "proportions of its own), or a glTF file of a left hand with WebXR's joint names.");
  visitor.field(
      "length_spread", shape.length_spread, between(0, 0.2),
      "Largest deviation of a true bone length from the model, as a share; drawn from the seed.");
  visitor.field("width_spread", shape.width_spread, between(0, 0.3),
                "The same for the width of the hand and its fingers.");
  visitor.field("bone_width_spread", shape.bone_width_spread, between(0, 0.3),
                "The same for the width of each bone alone.");
  visitor.field("thickness_spread", shape.thickness_spread, between(0, 0.3),
                "The same for the thickness of the palm and of the fingers, from back to front.");
  visitor.field("taper_spread", shape.taper_spread, between(0, 0.3),
                "The same for the width of a finger's tip relative to its root.");
  visitor.field(
      "roll_deg", shape.roll_deg, between(0, 30, "deg"),
      "Standard deviation of the rotation of each finger's flesh about its bones, relative "
      "to the joints' axes.");
  visitor.field("skinning", shape.skinning, "How the flesh follows the bones.");
  visitor.field("bulge", shape.bulge, between(0, 0.5),
                "How far flesh bulges on the inside of a joint that is bent by 90 degrees, as a "
                "share of the joint's radius.");
}

}  // namespace handcast::config
