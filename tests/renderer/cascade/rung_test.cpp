#include "renderer/cascade/rung.hpp"

#include <gtest/gtest.h>

#include <random>

#include "config/sections/cascade.hpp"
#include "renderer/cascade/deform.hpp"

namespace handcast::renderer {
namespace {

/// A hand of five straight fingers, px.
LandmarkPoints open_hand() {
  LandmarkPoints points{glm::vec2(400, 500)};
  for (int i = 1; i < kLandmarks; ++i) {
    const int finger = (i - 1) / 4, joint = (i - 1) % 4;
    points[i] = {280.0f + 60.0f * finger, 380.0f - 45.0f * joint + 8.0f * std::abs(finger - 2)};
  }
  return points;
}

LandmarkPoints with_noise(LandmarkPoints points, unsigned seed, float noise_px = 5) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, noise_px);
  for (glm::vec2& point : points) point += glm::vec2(noise(random), noise(random));
  return points;
}

LandmarkPoints moved(LandmarkPoints points, const Similarity& move) {
  for (glm::vec2& point : points) point = move(point);
  return points;
}

float left_px(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q) { return std::sqrt(residual_px2(fit_rung(rung, p, q), p, q)); }

/// The drawn hand, 400 px tall, and the palm or finger each vertex hangs on wholly (0..4; -1: none; -2: several).
struct DrawnHand2d {
  HandMesh mesh = *load_hand_or_default({}, Side::left);
  std::vector<glm::vec2> vertices;
  std::vector<int> owner;

  DrawnHand2d() {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      vertices.emplace_back(400 + 2000 * mesh.positions[v].x, 500 + 2000 * mesh.positions[v].z);
      int owned = -3;
      for (int k = 0; k < 4; ++k) {
        if (mesh.weights[v][k] == 0) continue;
        const int finger = finger_of(mesh.joints[v][k]);
        owned = owned == -3 || owned == finger ? finger : -2;
      }
      owner.push_back(owned);
    }
  }
  static int finger_of(int joint) {
    if (joint < 2 || joint == 6 || joint == 11 || joint == 16 || joint == 21) return -1;
    return joint < 6 ? 0 : (joint - 1) / 5;
  }
};

TEST(Rung, EachReachesTheFieldsThatItsNumbersCanMake) {
  const LandmarkPoints p = open_hand();
  const LandmarkPoints shifted = moved(p, {1, 0, {7, -4}}), turned = moved(p, {1.05f, 0.08f, {7, -4}});
  EXPECT_GT(left_px(Rung::predict, p, shifted), 8);
  EXPECT_LT(left_px(Rung::shift, p, shifted), 1e-3f);
  EXPECT_GT(left_px(Rung::shift, p, turned), 3);
  EXPECT_LT(left_px(Rung::similarity, p, turned), 1e-3f);
  LandmarkPoints bent = turned;
  for (int i = 5; i <= 8; ++i) bent[i] += glm::vec2(10, 0);
  EXPECT_LT(left_px(Rung::fingers, p, bent), 0.5f * left_px(Rung::similarity, p, bent));
}

TEST(Rung, ADearerOneNeverLeavesMore) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const LandmarkPoints p = with_noise(open_hand(), seed), q = with_noise(moved(p, {1.02f, 0.05f, {9, 3}}), seed + 1000);
    float before = left_px(Rung::hold, p, q);
    for (const Rung rung : {Rung::predict, Rung::shift, Rung::similarity, Rung::fingers}) {
      const float left = left_px(rung, p, q);
      EXPECT_LE(left, before + 1e-3f) << msg::name_of(rung) << ", seed " << seed;
      before = left;
    }
  }
}

TEST(Rung, ALostFingerIsFollowedByItsSkinAndByNoOther) {
  DrawnHand2d hand;
  RungModel model;
  model.whole.shift = {3, 0};
  model.fingers[1] = {0, 20};
  auto vertices = hand.vertices;
  RungMover(hand.mesh).move(model, vertices);
  int on_finger = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const glm::vec2 moved = vertices[v] - hand.vertices[v];
    EXPECT_NEAR(moved.x, 3, 1e-3f);
    if (hand.owner[v] >= -1) {
      EXPECT_NEAR(moved.y, hand.owner[v] == 1 ? 20 : 0, 0.02f) << "vertex " << v << " of " << hand.owner[v];
    }
    on_finger += hand.owner[v] == 1;
  }
  EXPECT_GT(on_finger, 50);
}

TEST(Rung, MovingTheVerticesDirectlyIsWhatCorrectingThemOntoTheModelsLandmarksDoes) {
  DrawnHand2d hand;
  const LandmarkPoints p = open_hand();
  const RungModel model = fit_rung(Rung::similarity, p, with_noise(moved(p, {1.03f, -0.06f, {5, 9}}), 3));
  auto directly = hand.vertices, by_landmarks = hand.vertices;
  RungMover(hand.mesh).move(model, directly);
  correct_vertices(config::Correct{}, hand.mesh, p, model.moved(p), by_landmarks);
  for (std::size_t v = 0; v < directly.size(); ++v) ASSERT_LT(glm::distance(directly[v], by_landmarks[v]), 0.02f) << "vertex " << v;
}

TEST(Rung, TheNamesAreThoseOfTheSettings) {
  for (std::size_t r = 0; r < kRungs; ++r) EXPECT_EQ(rung_named(msg::kRungNames[r]), static_cast<Rung>(r));
  for (std::size_t r = 1; r < kRungs; ++r)
    EXPECT_GE(degrees_of_freedom(static_cast<Rung>(r)), degrees_of_freedom(static_cast<Rung>(r - 1)));
}

TEST(Rung, AMarkTellsTheRungOfEachHandAndNothingOfOneThatIsNotThere) {
  const auto detail = msg::with_rung(0, Side::right, Rung::hold);
  EXPECT_EQ(msg::rung_in(detail, Side::right), Rung::hold);
  EXPECT_EQ(msg::rung_in(detail, Side::left), std::nullopt);
  EXPECT_EQ(msg::rung_in(msg::with_rung(detail, Side::left, Rung::registered), Side::left), Rung::registered);
  EXPECT_EQ(msg::rung_in(0xf, Side::left), std::nullopt) << "shared memory: nothing read from it is trusted";
}

}  // namespace
}  // namespace handcast::renderer
