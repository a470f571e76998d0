// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "services/pose/stereo/view.hpp"
#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

class TriangulateTest : public testing::Test {
 protected:
  std::array<Sight, kViews> sights_of(const glm::dvec3& place_m, double first_px = 1,
                                      double second_px = 1) const {
    return {Sight{&views_[0], views_[0].project(place_m), first_px},
            Sight{&views_[1], views_[1].project(place_m), second_px}};
  }

  Views views_ = views_of(two_cameras()).value();
  const glm::dvec3 place_m_{0.03, -0.02, 0.7};
};

TEST_F(TriangulateTest, APointIsWhereItsRaysMeet) {
  const auto point = triangulate(sights_of(place_m_));
  ASSERT_TRUE(point);
  EXPECT_LT(glm::distance(point->place_m, place_m_), 1e-9);
  EXPECT_LT(point->misfit, 1e-12);
}

TEST_F(TriangulateTest, TheCovarianceIsTheSpreadThatTheSigmasMake) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int kTimes = 4000;
  glm::dmat3 spread(0);
  glm::dmat3 told(0);
  for (int i = 0; i < kTimes; ++i) {
    auto sights = sights_of(place_m_, 1, 3);
    for (auto& sight : sights)
      sight.px += sight.sigma_px * glm::dvec2(normal(random), normal(random));
    const auto point = triangulate(sights);
    ASSERT_TRUE(point);
    const glm::dvec3 off_m = point->place_m - place_m_;
    spread += glm::outerProduct(off_m, off_m) * (1.0 / kTimes);
    told = point->covariance_m2;
  }
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(told[axis][axis] / spread[axis][axis], 1, 0.1) << axis;
  EXPECT_NEAR(told[0][2] / spread[0][2], 1, 0.3) << "they are correlated";
}

TEST_F(TriangulateTest, TheSurerViewCountsMore) {
  auto sights = sights_of(place_m_, 1, 10);
  sights[0].px.y += 5;  // across the epipolar line, which is about horizontal
  const auto sure = triangulate(sights);
  std::swap(sights[0].sigma_px, sights[1].sigma_px);
  const auto unsure = triangulate(sights);
  ASSERT_TRUE(sure && unsure);
  EXPECT_GT(sure->place_m.y - place_m_.y, 5 * (unsure->place_m.y - place_m_.y));
}

TEST_F(TriangulateTest, TheMisfitIsTheEpipolarDistanceOverItsVariance) {
  auto sights = sights_of(place_m_, 2, 2);
  sights[0].px.y += 4;
  sights[1].px.y -= 4;
  EXPECT_NEAR(triangulate(sights)->misfit, 8 * 8 / (4.0 + 4.0), 0.5);
}

TEST_F(TriangulateTest, RaysThatMeetNowhereInFrontOfTheCamerasAreNoPoint) {
  auto sights = sights_of(place_m_);
  EXPECT_FALSE(triangulate(std::span(sights).first(1)));
  sights[0].px = {100, 270}, sights[1].px = {719, 270};
  EXPECT_FALSE(triangulate(sights)) << "they meet behind the cameras";
  sights = sights_of(place_m_);
  sights[1].view = sights[0].view;
  sights[1].px = sights[0].px;
  EXPECT_FALSE(triangulate(sights)) << "parallel";
  sights = sights_of(place_m_);
  sights[0].px.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(triangulate(sights));
}

}  // namespace
}  // namespace handcast::pose::stereo
