// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "services/lab/hand_maker/glb_write.hpp"
#include "services/lab/twin/ground_truth_mesh.hpp"
#include "services/lab/twin/surface.hpp"
#include "services/lab/twin/true_hands.hpp"
#include "tests/scratch.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

constexpr int kIndexIntermediate = 8, kIndexDistal = 9, kIndexTip = 10;

HandMesh drawn_hand() { return *renderer::load_hand_or_default({}, Side::left); }

std::vector<glm::vec3> posed(const TrueHand& hand, const JointFrames& joints) {
  std::vector<glm::vec3> positions(hand.mesh.vertex_count());
  pose(hand, joints, positions);
  return positions;
}

/// The rest pose with the index finger bent at its middle joint.
JointFrames bent(JointFrames joints, float degrees) {
  const glm::mat4 pivot = joints[kIndexIntermediate];
  const glm::mat4 turn = pivot *
                         glm::rotate(glm::mat4(1), glm::radians(-degrees), glm::vec3(1, 0, 0)) *
                         glm::inverse(pivot);
  for (int j = kIndexIntermediate; j <= kIndexTip; ++j) joints[j] = turn * joints[j];
  return joints;
}

/// The volume of a closed mesh.
double volume_m3(const HandMesh& mesh, const std::vector<glm::vec3>& at) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six += glm::dot(glm::dvec3(at[a]), glm::cross(glm::dvec3(at[b]), glm::dvec3(at[c])));
  return six / 6;
}

TEST(TrueHand, WithTheBonesAndTheFleshOfItsModelIsTheModel) {
  const HandMesh drawn = drawn_hand();
  for (const auto skinning :
       {config::TwinSkinning::linear, config::TwinSkinning::dual_quaternion}) {
    const auto hand = flesh_on_bones(drawn, drawn.rest, 1, Flesh::of_model(), skinning);
    const auto at_rest = posed(hand, drawn.rest);
    float most = 0;
    for (std::size_t v = 0; v < drawn.vertex_count(); ++v)
      most = std::max(most, glm::distance(at_rest[v], drawn.positions[v]));
    EXPECT_LT(most, 2e-3f) << "only fingertips move, to where the tip joints are";
    EXPECT_NEAR(volume_m3(drawn, at_rest) / volume_m3(drawn, drawn.positions), 1, 0.01);
  }
}

TEST(TrueHand, BothWaysOfSkinningMoveARigidHandAlike) {
  const HandMesh drawn = drawn_hand();
  const glm::mat4 moved = glm::translate(glm::mat4(1), glm::vec3(0.3f, -0.2f, 0.5f)) *
                          glm::rotate(glm::mat4(1), 2.0f, glm::normalize(glm::vec3(1, 2, 3)));
  auto joints = drawn.rest;
  for (auto& frame : joints) frame = moved * frame;
  const auto linear = posed({drawn, config::TwinSkinning::linear, {}, {}}, joints),
             dual = posed({drawn, config::TwinSkinning::dual_quaternion, {}, {}}, joints);
  for (std::size_t v = 0; v < linear.size(); ++v)
    ASSERT_LT(glm::distance(linear[v], dual[v]), 1e-5f);
}

TEST(TrueHand, DualQuaternionsKeepTheVolumeOfABentFinger) {
  const HandMesh drawn = drawn_hand();
  const auto joints = bent(drawn.rest, 90);
  const double rest = volume_m3(drawn, drawn.positions);
  const double linear =
      volume_m3(drawn, posed({drawn, config::TwinSkinning::linear, {}, {}}, joints));
  const double dual =
      volume_m3(drawn, posed({drawn, config::TwinSkinning::dual_quaternion, {}, {}}, joints));
  EXPECT_LT(linear, rest);
  EXPECT_LT(std::abs(dual - rest), 0.6 * std::abs(linear - rest));
}

TEST(TrueHand, BulgesOnTheInsideOfABentJointOnly) {
  const HandMesh drawn = drawn_hand();
  Flesh flesh = Flesh::of_model();
  const auto plain =
      flesh_on_bones(drawn, drawn.rest, 1, flesh, config::TwinSkinning::dual_quaternion);
  flesh.bulge = 0.3f;
  const auto soft =
      flesh_on_bones(drawn, drawn.rest, 1, flesh, config::TwinSkinning::dual_quaternion);
  EXPECT_EQ(posed(soft, drawn.rest), posed(plain, drawn.rest));
  const auto joints = bent(drawn.rest, 90);
  const auto hard_at = posed(plain, joints), soft_at = posed(soft, joints);
  const auto fingers = fingers_of(drawn);
  float most_m = 0;
  for (std::size_t v = 0; v < hard_at.size(); ++v) {
    const float moved_m = glm::distance(hard_at[v], soft_at[v]);
    if (moved_m == 0) continue;
    most_m = std::max(most_m, moved_m);
    EXPECT_EQ(fingers[v], 1);
    EXPECT_LT(glm::dot(drawn.normals[v], glm::vec3(drawn.rest[kIndexIntermediate][1])), 0);
  }
  EXPECT_GT(most_m, 1e-3f);
  EXPECT_LT(most_m, 4e-3f) << "0.3 of a radius of about 9 mm";
}

TEST(TrueHand, PeopleDifferInWhatTheSettingsName) {
  config::TwinShape none{.length_spread = 0, .width_spread = 0};
  const Flesh model = Flesh::draw(none, 1);
  EXPECT_EQ(model.width, Flesh::of_model().width);
  EXPECT_EQ(model.thickness, Flesh::of_model().thickness);
  auto widths = none, thick = none, taper = none, roll = none;
  widths.bone_width_spread = 0.1;
  thick.thickness_spread = 0.1;
  taper.taper_spread = 0.1;
  roll.roll_deg = 7;
  const auto of = [](const auto& settings) { return Flesh::draw(settings, 3); };
  EXPECT_NE(of(widths).width[kIndexDistal], of(widths).width[kIndexTip]);
  EXPECT_NE(of(thick).thickness[0], of(thick).thickness[kIndexTip]);
  EXPECT_EQ(of(taper).width[7], 1) << "a finger tapers from its root";
  EXPECT_NE(of(taper).width[kIndexTip], 1);
  EXPECT_NE(of(roll).roll_rad[1], of(roll).roll_rad[2]);
}

TEST(TrueHand, AModelWithoutTipsIsRefused) {
  const test::Scratch folder;
  HandMesh hand = drawn_hand();
  hand.rest[kIndexTip] = hand.rest[kIndexDistal];
  ASSERT_TRUE(renderer::save_hand(hand, folder.path() / "hand.glb"));
  const auto model = load_ground_truth_mesh((folder.path() / "hand.glb").string(), drawn_hand());
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Errc::bad_config);
  EXPECT_THAT(model.error().what, testing::HasSubstr("no joints at the finger tips"));
}

TEST(TrueHand, ARightHandInThePlaceOfTheLeftIsRefused) {
  for (const Side drawn : {Side::left, Side::right}) {
    const auto load = [&](Side side) {
      return load_ground_truth_mesh(renderer::default_hand_file(side).string(),
                                    *renderer::load_hand_or_default({}, drawn));
    };
    EXPECT_TRUE(load(Side::left)) << load(Side::left).error().what;
    ASSERT_FALSE(load(Side::right));
    EXPECT_THAT(load(Side::right).error().what, testing::HasSubstr("is a right hand"));
  }
}

/// Tests of every mesh that is not the drawn one.
class OtherFlesh : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("webxr") && webxr_hand_file().empty())
      GTEST_SKIP() << "the WebXR hand is not installed; see scripts/setup --hands";
  }
  static GroundTruthMesh model(Side side) {
    auto model = load_ground_truth_mesh(GetParam(), *renderer::load_hand_or_default({}, side));
    EXPECT_TRUE(model) << model.error().what;
    return std::move(*model);
  }
};
INSTANTIATE_TEST_SUITE_P(Meshes, OtherFlesh, testing::Values("webxr", "implicit"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(OtherFlesh, HasTheBonesOfThePerson) {
  const HandMesh drawn = drawn_hand();
  const auto flesh = model(Side::left);
  EXPECT_FALSE(flesh.is_drawn_mesh);
  const auto hand =
      flesh_on_bones(flesh.mesh, drawn.rest, 1, Flesh::of_model(), config::TwinSkinning::linear);
  const auto fingers = fingers_of(hand.mesh);
  for (int f = 0; f < 5; ++f) {
    constexpr std::array<int, 5> kTip{5, 10, 15, 20, 25};
    const glm::vec3 tip(drawn.rest[kTip[f]][3]), along(-glm::vec3(drawn.rest[kTip[f]][2]));
    float skin_m = -1;
    for (std::size_t v = 0; v < hand.mesh.vertex_count(); ++v)
      if (fingers[v] == f) skin_m = std::max(skin_m, glm::dot(hand.mesh.positions[v] - tip, along));
    EXPECT_NEAR(1e3 * skin_m, 0, 2) << "the skin of finger " << f << " ends at the tip joint";
  }
}

TEST_P(OtherFlesh, OfTheRightHandIsTheMirrorImageOfTheLeft) {
  const auto left = model(Side::left).mesh, right = model(Side::right).mesh;
  EXPECT_EQ(right.side, Side::right);
  for (std::size_t v = 0; v < left.vertex_count(); ++v)
    ASSERT_EQ(right.positions[v].x, -left.positions[v].x);
  EXPECT_GT(volume_m3(right, right.positions), 0) << "its triangles face outwards";
}

TEST(TrueHand, AMeshThatCannotBeReadIsABadSetting) {
  auto rig = rig_with("builtin:still");
  rig.twin.shape.mesh = "/no/such/hand.glb";
  const auto twin = Twin::create(rig, calib::reference_rig());
  ASSERT_FALSE(twin);
  EXPECT_EQ(twin.error().code, Errc::bad_config);
  EXPECT_NE(twin.error().what.find("/no/such/hand.glb"), std::string::npos);
}

}  // namespace
}  // namespace handcast::twin
