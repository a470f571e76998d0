// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/skin/skinning.hpp"
#include "services/lab/hand_maker/hand_field.hpp"
#include "tests/renderer/poses.hpp"
#include "tests/services/lab/hand_maker/mesh_checks.hpp"

namespace handcast::renderer {
namespace {

using namespace samples;

class MadeHand : public ::testing::TestWithParam<Side> {
 protected:
  const HandMesh& hand() const { return mean_hand(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(BothSides, MadeHand, ::testing::Values(Side::left, Side::right),
                         [](const auto& tested) {
                           return tested.param == Side::left ? "Left" : "Right";
                         });

TEST_P(MadeHand, IsWatertightOnceTheSeamIsWelded) {
  EXPECT_EQ(open_edges(hand()), 0);
  EXPECT_GE(least_valence(hand()), 3);
  EXPECT_GT(volume_m3(hand(), hand().positions), 3e-4);  // about 0.4 litres; negative if inside out
  const auto same = welded(hand());
  std::printf("%zu vertices, %td welded, %zu triangles\n", hand().vertex_count(),
              std::count_if(same.begin(), same.end(),
                            [&, v = 0](int first) mutable { return first == v++; }),
              hand().triangles.size());
}

TEST_P(MadeHand, DoesNotCutItselfAtRest) {
  EXPECT_EQ(self_intersections(hand(), hand().positions), 0);
  EXPECT_EQ(flips(hand()), 0);
}

TEST_P(MadeHand, HasUpToFourWeightsThatSumToOne) {
  for (std::size_t v = 0; v < hand().vertex_count(); ++v) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(hand().weights[v][k], 0);
      EXPECT_LT(hand().joints[v][k], kJoints);
      sum += hand().weights[v][k];
    }
    ASSERT_NEAR(sum, 1, 1e-5);
  }
}

TEST_P(MadeHand, ForearmFollowsTheWrist) {
  int forearm = 0;
  for (std::size_t v = 0; v < hand().vertex_count(); ++v) {
    if (hand().positions[v].z < 0.04f) continue;
    ++forearm;
    EXPECT_EQ(hand().joints[v][0], 1);
    EXPECT_GT(hand().weights[v][0], 0.95f);
  }
  EXPECT_GT(forearm, 200);
}

TEST_P(MadeHand, HasABackAndAPalmOnTheTexture) {
  EXPECT_EQ(std::count(hand().chart.begin(), hand().chart.end(), 1),
            std::count(hand().chart.begin(), hand().chart.end(), 2));
  EXPECT_EQ(std::set(hand().chart.begin(), hand().chart.end()), (std::set<std::uint8_t>{1, 2}));
  float back = 0, palm = 0;
  for (std::size_t v = 0; v < hand().vertex_count(); ++v)
    (hand().chart[v] == 1 ? back : palm) += hand().normals[v].y;
  EXPECT_GT(back, 0);
  EXPECT_LT(palm, 0);
}

TEST_P(MadeHand, TextureDoesNotOverlapAndKeepsItsGutter) {
  EXPECT_EQ(uv_overlaps(hand()), 0);
  const glm::vec2 atlas_px(1024, 1024 / kAtlasAspect);
  float gap_px = 1e9f;
  for (std::size_t a = 0; a < hand().vertex_count(); ++a) {
    const glm::vec2 p = hand().uv[a] * atlas_px;
    EXPECT_GE(std::min({p.x, p.y, atlas_px.x - p.x, atlas_px.y - p.y}), 7.99f);
    for (std::size_t b = a + 1; b < hand().vertex_count(); ++b)
      if (hand().chart[a] != hand().chart[b])
        gap_px = std::min(gap_px, glm::distance(p, hand().uv[b] * atlas_px));
  }
  EXPECT_GE(gap_px, 8);
}

/// A triangle that winds counter-clockwise on the skin must wind so on the picture as well (v
/// points down there).
TEST_P(MadeHand, TextOnTheTextureReadsRight) {
  for (const auto& t : hand().triangles) {
    const glm::vec2 a = hand().uv[t[1]] - hand().uv[t[0]], b = hand().uv[t[2]] - hand().uv[t[0]];
    ASSERT_LT(a.x * b.y - a.y * b.x, 0);
  }
}

TEST_P(MadeHand, FingersPointUpOnTheTextureAndTheThumbsFaceEachOther) {
  for (const int chart : {1, 2}) {
    std::size_t tip = 0, forearm = 0, thumb = 0;
    const float thumb_side = GetParam() == Side::left ? 1.0f : -1.0f;
    for (std::size_t v = 0; v < hand().vertex_count(); ++v) {
      if (hand().chart[v] != chart) continue;
      if (hand().chart[tip] != chart || hand().positions[v].z < hand().positions[tip].z) tip = v;
      if (hand().chart[forearm] != chart || hand().positions[v].z > hand().positions[forearm].z)
        forearm = v;
      if (hand().chart[thumb] != chart ||
          hand().positions[v].x * thumb_side > hand().positions[thumb].x * thumb_side)
        thumb = v;
    }
    EXPECT_LT(hand().uv[tip].y, 0.1f);
    EXPECT_GT(hand().uv[forearm].y, 0.9f);
    EXPECT_LT(std::abs(hand().uv[thumb].x - 0.5f), std::abs(hand().uv[forearm].x - 0.5f));
  }
}

TEST_P(MadeHand, TextureHardlyStretches) {
  const auto ratios = stretch_ratios(hand());
  std::printf("UV stretch ratio: median %.3f, p95 %.3f\n", percentile(ratios, 0.5),
              percentile(ratios, 0.95));
  EXPECT_LT(percentile(ratios, 0.95), 1.3);
}

TEST_P(MadeHand, KeepsMostOfItsVolumeInEveryPose) {
  const double rest = volume_m3(hand(), hand().positions);
  for (const Pose& pose : kPoses) {
    std::vector<glm::vec3> positions(hand().vertex_count());
    skin(hand(), posed(hand(), pose), positions);
    const double change = volume_m3(hand(), positions) / rest - 1;
    std::printf("volume in %s: %+.1f %%\n", std::string(pose.name).c_str(), change * 100);
    EXPECT_GT(change, -0.12) << pose.name;
    EXPECT_LT(change, 0.12) << pose.name;
  }
}

TEST_P(MadeHand, IsMadeTheSameEachTime) {
  const HandMesh again = make_hand(HandShape::mean(), GetParam());
  EXPECT_EQ(again.positions, hand().positions);
  EXPECT_EQ(again.uv, hand().uv);
  EXPECT_EQ(again.weights, hand().weights);
}

TEST(MakeHand, TheRightHandMirrorsTheLeft) {
  const HandMesh &left = mean_hand(Side::left), &right = mean_hand(Side::right);
  const glm::vec3 flip(-1, 1, 1);
  for (std::size_t v = 0; v < left.vertex_count(); ++v) {
    ASSERT_EQ(left.positions[v] * flip, right.positions[v]);
    ASSERT_EQ(left.normals[v] * flip, right.normals[v]);
  }
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_EQ(glm::vec3(left.rest[j][3]) * flip, glm::vec3(right.rest[j][3]));
    EXPECT_NEAR(glm::determinant(right.rest[j]), 1, 1e-4);
    EXPECT_EQ(glm::vec3(left.rest[j][1]) * flip, glm::vec3(right.rest[j][1]));
  }
  EXPECT_EQ(right.side, Side::right);
}

TEST(RefitHand, KeepsTopologyTextureAndWeights) {
  const HandMesh& mean = mean_hand(Side::left);
  const HandMesh person = refit_hand(mean, another_person());
  EXPECT_EQ(person.triangles, mean.triangles);
  EXPECT_EQ(person.uv, mean.uv);
  EXPECT_EQ(person.joints, mean.joints);
  EXPECT_EQ(person.weights, mean.weights);
  EXPECT_EQ(person.chart, mean.chart);
  EXPECT_EQ(person.rest, rest_frames(another_person()));
}

TEST(RefitHand, LiesOnTheSkinOfTheOtherPerson) {
  const HandShape shape = another_person();
  const HandMesh person = refit_hand(mean_hand(Side::left), shape);
  const HandField field(shape, rest_pose(shape));
  double worst_mm = 0;
  for (const glm::vec3& p : person.positions)
    worst_mm = std::max(worst_mm, std::abs(field.at(glm::dvec3(p) * 1e3).distance_mm));
  std::printf("refit residual: %.4f mm\n", worst_mm);
  EXPECT_LT(worst_mm, 0.1);
}

TEST(RefitHand, StaysWholeOnThinThickAndUnevenPeople) {
  const HandShape mean = HandShape::mean();
  const HandShape people[] = {another_person(),
                              mean.scaled({0.92f, 0.95f, 0.93f, 0.95f, 0.9f}, 0.93f, 1.08f),
                              mean.scaled({1.1f, 1.1f, 1.1f, 1.1f, 1.1f}, 1.1f, 1.1f),
                              mean.scaled({0.85f, 0.85f, 0.85f, 0.85f, 0.85f}, 0.85f, 0.85f)};
  for (const HandShape& shape : people) {
    const HandMesh person = refit_hand(mean_hand(Side::left), shape);
    EXPECT_EQ(open_edges(person), 0);
    EXPECT_EQ(flips(person), 0);
    EXPECT_EQ(self_intersections(person, person.positions), 0);
    const auto ratios = stretch_ratios(person);
    std::printf("UV stretch ratio of another person: median %.3f, p95 %.3f\n",
                percentile(ratios, 0.5), percentile(ratios, 0.95));
    EXPECT_LT(percentile(ratios, 0.95), 1.5);
  }
}

TEST(RefitHand, ARightHandStaysARightHand) {
  const HandMesh left = refit_hand(mean_hand(Side::left), another_person()),
                 right = refit_hand(mean_hand(Side::right), another_person());
  EXPECT_EQ(right.side, Side::right);
  EXPECT_EQ(flips(right), 0);
  for (std::size_t v = 0; v < left.vertex_count(); ++v)
    ASSERT_LT(glm::distance(left.positions[v] * glm::vec3(-1, 1, 1), right.positions[v]), 1e-5f);
}

TEST(RefitHand, ToTheSamePersonHardlyMovesAnything) {
  const HandMesh& mean = mean_hand(Side::left);
  const HandMesh again = refit_hand(mean, HandShape::mean());
  double worst_mm = 0;
  for (std::size_t v = 0; v < mean.vertex_count(); ++v)
    worst_mm =
        std::max<double>(worst_mm, glm::distance(mean.positions[v], again.positions[v]) * 1e3);
  std::printf("refit to the same person moves a vertex by up to %.2f mm along the skin\n",
              worst_mm);
  EXPECT_LT(worst_mm, 0.01);
}

}  // namespace
}  // namespace handcast::renderer
