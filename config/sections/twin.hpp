// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/sections/twin/detector.hpp"
#include "config/sections/twin/geometry.hpp"
#include "config/sections/twin/image.hpp"
#include "config/sections/twin/projector.hpp"
#include "config/sections/twin/prop.hpp"
#include "config/sections/twin/shape.hpp"
#include "config/sections/twin/tracker.hpp"
#include "config/settings/field.hpp"

/// The digital twin: a true hand, and the errors of the sensors that observe it. The defaults are
/// the figures of docs/method.md#twin, the same for all rigs that are compared.
namespace handcast::config {

/// The hands of the motion that exist in the twin.
enum class TwinHands {
  both,
  left,
  right,
};
constexpr std::array<std::string_view, 3> words_of(TwinHands) { return {"both", "left", "right"}; }

/// [twin]
struct Twin {
  std::string motion = "builtin:open_close";
  TwinHands hands = TwinHands::both;
  double speed = 1;
  int seed = 1;
  TwinShape shape;
  TwinGeometry geometry;
  TwinTracker tracker;
  TwinDetector detector;
  TwinImage image;
  TwinProjector projector;
  TwinProp prop;
};

template <class Visitor>
void describe(Visitor& visitor, Twin& twin) {
  visitor.field(
      "motion", twin.motion,
      "The true motion: builtin:show, open_close, wave, rotate, pinch, shake, two_hands, "
      "still, crossing, flip, fist, point_at_camera, enter_leave, reverse, "
      "cross_fingers, turn_pointing, turn_fist, places, count, piano, grasp, beckon, coin; or a "
      "folder with a recording.");
  visitor.field("hands", twin.hands, "The hands of the motion that exist in the twin.");
  visitor.field("speed", twin.speed, between(0.01, 20), "Speed of the motion; 1: unchanged.");
  visitor.field("seed", twin.seed, between(0, 1e9), "The seed of all random numbers.");
  visitor.section("shape", twin.shape, "The differences of the true hand from the model.");
  visitor.section("geometry", twin.geometry,
                  "What the calibration has wrong: the differences of the true rig from it.");
  visitor.section("tracker", twin.tracker, "The errors of the hand tracker.", Effect::live);
  visitor.section("detector", twin.detector, "The errors of the landmark detector.", Effect::live);
  visitor.section("image", twin.image, "The camera images.", Effect::live);
  visitor.section("projector", twin.projector, "The times of the projector's frames.");
  visitor.section("prop", twin.prop, "What is in front of the camera in place of hands.");
}

}  // namespace handcast::config
