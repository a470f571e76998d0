// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/palm_outline.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/renderer/correct/seen_hand.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kPalmFrame_ns = 2'000'000;

class PalmOutlineTest : public testing::Test {
 protected:
  const SeenHand& hand_ = SeenHand::mean();
  PalmOutline outline_{hand_.mesh};
  std::int64_t time_ns_ = 10'000'000'000;

  /// Vertices of a palm whose heel is `factor` times as broad, which fades towards the knuckles.
  std::vector<glm::vec2> with_heel(float factor) const {
    const float wrist_y = hand_.landmarks_px[0].y, knuckle_y = hand_.landmarks_px[9].y,
                middle_x = hand_.landmarks_px[0].x;
    auto px = hand_.vertices_px;
    for (auto& each : px) {
      const float share = (each.y - knuckle_y) / (wrist_y - knuckle_y);
      if (share > 0)
        each.x = middle_x + (each.x - middle_x) * glm::mix(1.0f, factor, std::min(share, 1.0f));
    }
    return px;
  }

  std::vector<glm::vec2> drawn(const LandmarkPoints& landmarks) const {
    auto px = hand_.moved_to(landmarks);
    outline_.move(landmarks, px);
    return px;
  }
  std::vector<glm::vec2> drawn() const { return drawn(hand_.landmarks_px); }

  void look_at(const Image<std::uint8_t>& mask, int frames, const LandmarkPoints& landmarks) {
    for (int i = 0; i < frames; ++i, time_ns_ += kPalmFrame_ns)
      outline_.measure(time_ns_, drawn(landmarks), landmarks, mask.view());
  }
  void look_at(const Image<std::uint8_t>& mask, int frames) {
    look_at(mask, frames, hand_.landmarks_px);
  }

  /// The larger distance of the heel's two borders from where a person has them.
  float border_error_px(const std::vector<glm::vec2>& px, const std::vector<glm::vec2>& person) {
    const float y = glm::mix(hand_.landmarks_px[0].y, hand_.landmarks_px[9].y, 0.2f);
    const auto border = [&](const std::vector<glm::vec2>& vertices) {
      const std::vector<MeshEdge> edges =
          edges_among(hand_.mesh, std::vector<bool>(hand_.mesh.vertex_count(), true));
      return section_of(edges, vertices, {{320, y}, {0, -1}, {1, 0}}, 0);
    };
    const Section a = border(px), b = border(person);
    return std::max(std::abs(a.low_px - b.low_px), std::abs(a.high_px - b.high_px));
  }

  float farthest_px(const std::vector<glm::vec2>& px, const std::vector<glm::vec2>& from) {
    float far = 0;
    for (std::size_t v = 0; v < px.size(); ++v) far = std::max(far, glm::distance(px[v], from[v]));
    return far;
  }
};

TEST_F(PalmOutlineTest, ANarrowHeelIsLearned) {
  for (const float factor : {0.85f, 1.12f}) {
    outline_ = PalmOutline(hand_.mesh);
    const auto person = with_heel(factor);
    ASSERT_GT(border_error_px(drawn(), person), 6) << factor;
    look_at(mask_of(hand_.mesh, person), 1000);
    EXPECT_LT(border_error_px(drawn(), person), 3) << factor;
  }
}

TEST_F(PalmOutlineTest, APalmThatFitsStaysAndFingersAreNotMoved) {
  look_at(mask_of(hand_.mesh, hand_.vertices_px), 500);
  EXPECT_LT(farthest_px(drawn(), hand_.vertices_px), 2);
  look_at(mask_of(hand_.mesh, with_heel(0.85f)), 1000);
  const auto px = drawn();
  const std::array finger{msg::kJointOfLandmark[6], msg::kJointOfLandmark[10]};
  for (std::size_t v = 0; v < px.size(); ++v) {
    if (weight_of(hand_.mesh, v, finger) < 0.99f) continue;
    EXPECT_LT(glm::distance(px[v], hand_.vertices_px[v]), 0.01f);
  }
}

TEST_F(PalmOutlineTest, AMaskThatMergesOrShowsNothingTeachesNothing) {
  look_at(Image<std::uint8_t>(kSize_px, kSize_px, 255), 300);
  EXPECT_LT(farthest_px(drawn(), hand_.vertices_px), 0.01f);
  look_at(Image<std::uint8_t>(kSize_px, kSize_px), 300);
  EXPECT_LT(farthest_px(drawn(), hand_.vertices_px), 0.01f);
  look_at(Image<std::uint8_t>(), 300);
  EXPECT_LT(farthest_px(drawn(), hand_.vertices_px), 0.01f);
}

TEST_F(PalmOutlineTest, ASleeveDoesNotPullTheWrist) {
  auto mask = mask_of(hand_.mesh, hand_.vertices_px);
  for (int y = int(hand_.landmarks_px[0].y) - 15; y < kSize_px; ++y)
    for (int x = 150; x < 490; ++x) mask.at(x, y) = 255;
  look_at(mask, 500);
  EXPECT_LT(farthest_px(drawn(), hand_.vertices_px), 2);
}

TEST_F(PalmOutlineTest, AFistTeachesNothingAndForgetsNothing) {
  LandmarkPoints fist = hand_.landmarks_px;
  for (const int knuckle : {5, 9, 13, 17})
    for (int k = 1; k < 4; ++k) fist[knuckle + k] = fist[knuckle] + glm::vec2(0, 15 * k);
  look_at(mask_of(hand_.mesh, with_heel(0.85f)), 500, fist);
  EXPECT_LT(farthest_px(drawn(), hand_.vertices_px), 0.01f);

  const auto person = with_heel(0.85f);
  look_at(mask_of(hand_.mesh, person), 1000);
  look_at(mask_of(hand_.mesh, hand_.moved_to(fist)), 2000, fist);
  EXPECT_LT(border_error_px(drawn(), person), 5);
}

TEST_F(PalmOutlineTest, AHandSeenFromItsEdgeIsNotMoved) {
  look_at(mask_of(hand_.mesh, with_heel(0.85f)), 1000);
  LandmarkPoints edge_on = hand_.landmarks_px;
  for (auto& point : edge_on) point.x = 320 + 0.2f * (point.x - 320);
  look_at(mask_of(hand_.mesh, hand_.moved_to(edge_on)), 1, edge_on);
  EXPECT_LT(farthest_px(drawn(edge_on), hand_.moved_to(edge_on)), 0.01f);
}

}  // namespace
}  // namespace handcast::renderer
