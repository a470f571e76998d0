// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace handcast::renderer {
namespace {

Similarity similarity(float scale, float turn_rad, glm::vec2 shift) {
  return {scale * std::cos(turn_rad), scale * std::sin(turn_rad), shift};
}

std::vector<glm::vec2> some_points(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place_px(100, 500);
  std::vector<glm::vec2> points(count);
  for (glm::vec2& point : points) point = {place_px(random), place_px(random)};
  return points;
}

std::vector<glm::vec2> moved(const std::vector<glm::vec2>& points, const Similarity& move) {
  std::vector<glm::vec2> there;
  for (const glm::vec2& point : points) there.push_back(move(point));
  return there;
}

float scale_of(const Similarity& fit) { return std::hypot(fit.cosine, fit.sine); }

glm::vec2 middle_of(const std::vector<glm::vec2>& points) {
  glm::vec2 sum{0};
  for (const glm::vec2& point : points) sum += point;
  return sum / static_cast<float>(points.size());
}

void expect_near(const Similarity& found, const Similarity& expected, float tolerance_px) {
  for (const glm::vec2 point : {glm::vec2(0, 0), glm::vec2(700, 0), glm::vec2(0, 500)})
    EXPECT_LT(glm::distance(found(point), expected(point)), tolerance_px)
        << point.x << ' ' << point.y;
}

TEST(Similarity, TurnsFromXToYScalesAndShifts) {
  const Similarity quarter = similarity(2, 1.5707963f, {10, 20});
  EXPECT_LT(glm::distance(quarter({3, 0}), {10, 26}), 1e-4f);
  EXPECT_LT(glm::distance(quarter({0, 3}), {4, 20}), 1e-4f);
  EXPECT_EQ(Similarity()({3, 4}), glm::vec2(3, 4));
}

TEST(Similarity, ATurnAScaleAndAShiftAreFoundAgain) {
  const auto points = some_points(21);
  for (const float scale : {0.55f, 1.0f, 1.9f})
    for (const float turn_rad : {-3.0f, -0.4f, 0.0f, 1.2f, 3.1f}) {
      const Similarity truth = similarity(scale, turn_rad, {-30, 55});
      expect_near(fit_similarity(points, moved(points, truth)), truth, 0.01f);
    }
}

TEST(Similarity, TwoPointsAreEnough) {
  const auto points = some_points(2);
  const Similarity truth = similarity(1.2f, 0.7f, {5, -8});
  expect_near(fit_similarity(points, moved(points, truth)), truth, 0.01f);
}

TEST(Similarity, PointsThatStayAreLeftWhereTheyAreExactly) {
  const auto points = some_points(21);
  const Similarity fit = fit_similarity(points, points);
  EXPECT_EQ(fit.cosine, 1);
  EXPECT_EQ(fit.sine, 0);
  EXPECT_EQ(fit.shift, glm::vec2(0));
}

TEST(Similarity, NoiseIsAveragedOut) {
  const auto points = some_points(200);
  const Similarity truth = similarity(1.1f, 0.3f, {7, 9});
  auto seen = moved(points, truth);
  std::mt19937 random(4);
  std::normal_distribution<float> noise_px(0, 2);
  for (glm::vec2& point : seen) point += glm::vec2(noise_px(random), noise_px(random));
  expect_near(fit_similarity(points, seen), truth, 1);
}

TEST(Similarity, TheScaleIsHeldBetweenAHalfAndTwo) {
  const auto points = some_points(21);
  for (const float wild : {0.001f, 0.3f, 5.0f, 1000.0f}) {
    const auto seen = moved(points, similarity(wild, 0.4f, {1, 2}));
    const Similarity fit = fit_similarity(points, seen);
    EXPECT_NEAR(scale_of(fit), wild < 1 ? 0.5f : 2.0f, 1e-3f) << wild;
    EXPECT_NEAR(std::atan2(fit.sine, fit.cosine), 0.4f, 1e-3f) << "rotation, scale " << wild;
    EXPECT_LT(glm::distance(fit(middle_of(points)), middle_of(seen)), 1e-3f * std::max(1.0f, wild))
        << "translation, scale " << wild;
  }
}

TEST(Similarity, PointsInOnePlaceGiveAShift) {
  const auto spread = some_points(5);
  const std::vector<glm::vec2> heap(5, {200, 300});
  const Similarity from_heap = fit_similarity(heap, spread), to_heap = fit_similarity(spread, heap);
  for (const Similarity& fit : {from_heap, to_heap}) {
    EXPECT_EQ(fit.cosine, 1);
    EXPECT_EQ(fit.sine, 0);
  }
  EXPECT_LT(glm::distance(from_heap({200, 300}), middle_of(spread)), 1e-3f);
  EXPECT_LT(glm::distance(to_heap(middle_of(spread)), {200, 300}), 1e-3f);
}

TEST(Similarity, OnePointGivesAShift) {
  const std::vector<glm::vec2> from{{3, 4}}, to{{10, -1}};
  const Similarity fit = fit_similarity(from, to);
  EXPECT_EQ(fit.cosine, 1);
  EXPECT_EQ(fit.sine, 0);
  EXPECT_EQ(fit.shift, glm::vec2(7, -5));
}

}  // namespace
}  // namespace handcast::renderer
