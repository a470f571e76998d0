// SPDX-License-Identifier: Apache-2.0
#include "renderer/blend/light_share.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;

constexpr float kAway_m = 0.7f;

/// A projector `degrees` to the right of the camera, as far from what is kAway_m before the camera,
/// and turned towards it.
calib::ProjectorModel projector_at(double degrees) {
  const auto rig = calib::reference_rig();
  const double angle = glm::radians(degrees);
  const glm::dvec3 hand(0, 0, kAway_m),
      centre = hand + double{kAway_m} * glm::dvec3(std::sin(angle), 0, -std::cos(angle));
  // Turned about the camera's y axis, whose image in the projector is its own.
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0)));
  const glm::dmat3 lens(1400, 0, 0, 0, 1400, 0, 511.5, 383.5, 1);
  calib::ProjectorModel model;
  model.plane_m = kAway_m;
  model.parallax = -(lens * turn * centre);
  model.from_camera = lens * turn * glm::inverse(rig.camera.matrix());
  model.from_camera[2] += model.parallax / model.plane_m;
  return model.normalised();
}

/// A rig with projectors on both sides of the camera.
calib::Calibration two_sides(double degrees) {
  auto rig = calib::reference_rig();
  rig.projector = projector_at(-degrees);
  rig.projector2 = calib::SecondProjector{"", projector_at(degrees)};
  return rig;
}

/// A square patch of a surface, 9 x 9 vertices.
struct Patch {
  static constexpr int kSide = 9;
  std::vector<glm::vec3> position_m, normal;
  std::vector<float> light;

  /// `turned`: by this angle to the right of the camera.
  Patch(glm::vec3 middle_m, float size_m, float turned_deg = 0) {
    const float angle = glm::radians(turned_deg);
    const glm::vec3 across(std::cos(angle), 0, std::sin(angle));
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const glm::vec2 place = (glm::vec2(x, y) / (kSide - 1.0f) - 0.5f) * size_m;
        position_m.push_back(middle_m + place.x * across + glm::vec3(0, place.y, 0));
        normal.emplace_back(std::sin(angle), 0, -std::cos(angle));
      }
    light.assign(position_m.size(), 1);
  }
  LightShare::Hand hand() { return {position_m, normal, light}; }
};

/// The light, not the level, of each vertex of the first patch from one projector of the rig.
std::vector<double> shares(calib::Calibration rig, config::Viewpoint at, std::vector<Patch> patches,
                           float beside = 1) {
  std::vector<LightShare::Hand> hands;
  for (auto& patch : patches) hands.push_back(patch.hand());
  LightShare(calib::at_projector(std::move(rig), at)).apply(hands, beside);
  std::vector<double> light;
  for (const float level : patches.front().light) light.push_back(srgb_light(level));
  return light;
}

using config::Viewpoint;

TEST(LightShare, BothLightsAddUpToOne) {
  for (const float turned : {-60.0f, -20.0f, 0.0f, 35.0f}) {
    const Patch patch({0, 0, kAway_m}, 0.08f, turned);
    auto sum = shares(two_sides(30), Viewpoint::first, {patch});
    const auto second = shares(two_sides(30), Viewpoint::second, {patch});
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += second[v];
    EXPECT_THAT(sum, Each(DoubleNear(1, 0.02))) << turned;
  }
}

TEST(LightShare, TheProjectorThatMeetsTheSkinMoreSquarelyLightsMostOfIt) {
  EXPECT_THAT(shares(two_sides(30), Viewpoint::second, {Patch({0, 0, kAway_m}, 0.02f)}),
              Each(DoubleNear(0.5, 0.05)));
  EXPECT_THAT(shares(two_sides(30), Viewpoint::second, {Patch({0, 0, kAway_m}, 0.02f, 25)}),
              Each(::testing::Gt(0.85)));
  EXPECT_THAT(shares(two_sides(30), Viewpoint::second, {Patch({0, 0, kAway_m}, 0.02f, -80)}),
              Each(::testing::Lt(0.01)))
      << "it is seen from behind";
}

TEST(LightShare, WhatIsInTheShadowOfOneIsLitByTheOther) {
  const Patch palm({0, 0, kAway_m}, 0.01f);
  // Half way to the second projector, 30 mm before the palm.
  const float away_m = 0.03f, angle = glm::radians(30.0f);
  const Patch finger({away_m * std::sin(angle), 0, kAway_m - away_m * std::cos(angle)}, 0.03f);
  EXPECT_THAT(shares(two_sides(30), Viewpoint::second, {palm, finger}), Each(::testing::Lt(0.01)));
  EXPECT_THAT(shares(two_sides(30), Viewpoint::first, {palm, finger}), Each(::testing::Gt(0.99)));
}

TEST(LightShare, OutsideTheImageOfOneTheOtherLightsAll) {
  auto rig = two_sides(30);
  rig.projector2->model.width_px = 200;  // its right part ends before the middle
  const Patch patch({0, 0, kAway_m}, 0.02f);
  EXPECT_THAT(shares(rig, Viewpoint::first, {patch}), Each(::testing::Gt(0.99)));
}

TEST(LightShare, ALightWhoseNeighbourIsOffLightsAllThatItCan) {
  const Patch patch({0, 0, kAway_m}, 0.05f, 20);
  EXPECT_THAT(shares(two_sides(30), Viewpoint::first, {patch}, 0), Each(DoubleNear(1, 0.01)));
}

TEST(LightShare, NothingOfAHandThatIsNowhereIsShadow) {
  const Patch patch({0, 0, kAway_m}, 0.05f);
  Patch broken({0, 0, kAway_m}, 0.05f);
  for (auto& position : broken.position_m) position.x = std::nanf("");
  broken.position_m[3] = {0, 0, -1};
  EXPECT_EQ(shares(two_sides(30), Viewpoint::first, {patch, broken}),
            shares(two_sides(30), Viewpoint::first, {patch}));
}

}  // namespace
}  // namespace handcast::renderer
