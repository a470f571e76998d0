// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/deform.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace handcast::renderer {
namespace {

std::vector<glm::vec2> random_points(int count, unsigned seed, float from = 300, float to = 600) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(from, to);
  std::vector<glm::vec2> points(count);
  for (auto& point : points) point = {place(random), place(random)};
  return points;
}

class Alpha : public ::testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Alphas, Alpha, ::testing::Values(0.5f, 0.8f, 1.0f, 2.0f));

TEST_P(Alpha, AFieldOfASimilarityIsThatSimilarity) {
  const auto p = random_points(21, 1);
  const auto turn = [](glm::vec2 v) {
    return glm::vec2(0.9f * v.x - 0.3f * v.y + 40, 0.3f * v.x + 0.9f * v.y - 25);
  };
  std::vector<glm::vec2> q;
  for (const auto& point : p) q.push_back(turn(point));
  const MovingLeastSquares field(p, q, GetParam());
  for (const auto& v : random_points(200, 2, 0, 1000))
    EXPECT_LT(glm::distance(field(v), turn(v)), 0.05f);
}

TEST_P(Alpha, NothingMovesWhereNothingWasMoved) {
  const auto p = random_points(21, 1);
  const MovingLeastSquares field(p, p, GetParam());
  for (const auto& v : random_points(200, 2, 0, 1000)) EXPECT_LT(glm::distance(field(v), v), 0.02f);
}

TEST_P(Alpha, MovingManyPointsIsMovingEach) {
  const auto p = random_points(21, 1), q = random_points(21, 3);
  const MovingLeastSquares field(p, q, GetParam());
  auto points = random_points(131, 4, 0, 1000);
  const auto before = points;
  field.apply(points);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i], field(before[i]));
}

TEST_P(Alpha, FollowsTheTextbookFormula) {
  const auto p = random_points(12, 1), q = random_points(12, 5);
  const MovingLeastSquares field(p, q, GetParam());
  for (const auto& v : random_points(20, 6, 200, 700)) {
    glm::dvec2 p_mean{0}, q_mean{0};
    double total = 0, cosine = 0, sine = 0, spread = 0;
    std::vector<double> w;
    for (const auto& point : p) w.push_back(std::pow(glm::dot(point - v, point - v), -GetParam()));
    for (std::size_t i = 0; i < p.size(); ++i) {
      total += w[i];
      p_mean += w[i] * glm::dvec2(p[i]);
      q_mean += w[i] * glm::dvec2(q[i]);
    }
    p_mean /= total;
    q_mean /= total;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const glm::dvec2 a = glm::dvec2(p[i]) - p_mean, b = glm::dvec2(q[i]) - q_mean;
      cosine += w[i] * glm::dot(a, b);
      sine += w[i] * (a.x * b.y - a.y * b.x);
      spread += w[i] * glm::dot(a, a);
    }
    const glm::dvec2 d = glm::dvec2(v) - p_mean;
    const glm::dvec2 expected =
        q_mean + glm::dvec2(cosine * d.x - sine * d.y, sine * d.x + cosine * d.y) / spread;
    EXPECT_LT(glm::distance(glm::dvec2(field(v)), expected), 0.02);
  }
}

TEST(MovingLeastSquares, ControlPointsLandOnTheirTargetsFromAlphaOneOn) {
  const auto p = random_points(21, 1), q = random_points(21, 3);
  for (const float alpha : {1.0f, 2.0f}) {
    const MovingLeastSquares field(p, q, alpha);
    for (int i = 0; i < 21; ++i) EXPECT_LT(glm::distance(field(p[i]), q[i]), 0.1f);
  }
}

TEST(MovingLeastSquares, PointsOnOneSpotAreAShift) {
  const std::vector<glm::vec2> p(21, {100, 100}), q(21, {130, 90});
  const MovingLeastSquares field(p, q, 1);
  EXPECT_LT(glm::distance(field({200, 200}), {230, 190}), 1.0f);
}

TEST(MovingLeastSquares, WithoutControlPointsNothingMoves) {
  EXPECT_EQ(MovingLeastSquares({}, {}, 1)({5, 6}), glm::vec2(5, 6));
}

}  // namespace
}  // namespace handcast::renderer
