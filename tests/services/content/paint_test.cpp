// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/content/surface_map.hpp"
#include "tests/services/content/touching_hands.hpp"

namespace handcast::content {
namespace {

class PaintTest : public testing::Test {
 protected:
  bool draw(double step_s = 0.02) {
    hands.moment.step_s = step_s;
    const auto drawn = source->draw(hands.moment, {}, out);
    EXPECT_TRUE(drawn) << drawn.error().what;
    ++hands.moment.frame;
    return *drawn;
  }
  std::size_t painted() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(out.pixels(), [](auto texel) { return texel != 0; }));
  }
  std::uint32_t on(std::size_t vertex) const {
    return texel_at(out, made_hand(Side::left).uv[vertex]);
  }
  /// The width and height of what is painted, mm at rest.
  float extent_mm() const {
    const auto places = rest_positions_mm(made_hand(Side::left));
    glm::vec3 low(1e9f), high(-1e9f);
    const SurfaceMap map(made_hand(Side::left), out.width(), out.height());
    for (const auto& texel : map.texels()) {
      if (out.pixels()[texel.index] == 0) continue;
      const auto place = texel.of<glm::vec3>(places);
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
    return std::max(high.x - low.x, high.z - low.z);
  }

  TouchingHands hands;
  std::unique_ptr<Source> source = opened(opening_of("paint", {}, Side::left, 320, 200));
  renderer::Texture out{320, 200};
};

TEST_F(PaintTest, AnUntouchedHandIsTransparent) {
  EXPECT_TRUE(draw());
  EXPECT_EQ(painted(), 0u);
  EXPECT_FALSE(draw());
  EXPECT_TRUE(source->needs().surface);
}

TEST_F(PaintTest, ATipOnTheSkinLeavesASpotOfTheSizeOfTheBrush) {
  const auto vertex = hands.middle(true);
  ASSERT_TRUE(source->set("colour", "#ff0000"));
  ASSERT_TRUE(source->set("size", "16"));
  hands.touch(vertex);
  EXPECT_TRUE(draw());
  EXPECT_EQ(on(vertex), 0xff0000ffu);
  EXPECT_NEAR(extent_mm(), 16, 3);
  EXPECT_EQ(on(hands.middle(false)), 0u) << "the other side of the palm";
  EXPECT_FALSE(draw()) << "the tip rests";
}

TEST_F(PaintTest, AWideBrushDoesNotReachThroughAFinger) {
  const glm::vec3 finger = hands.hand.joints_m[8], out_of_back(0, 0, -0.02f);
  const auto above = hands.vertex_near(finger + out_of_back),
             below = hands.vertex_near(finger - out_of_back);
  ASSERT_TRUE(source->set("size", "60"));
  hands.touch(above);
  draw();
  EXPECT_NE(on(above), 0u);
  EXPECT_EQ(on(below), 0u);
}

TEST_F(PaintTest, ATipThatHoversDoesNotPaint) {
  hands.touch(hands.middle(true), 0.025f);
  draw();
  EXPECT_EQ(painted(), 0u);
}

TEST_F(PaintTest, ALineIsClosedBetweenTwoPictures) {
  const glm::vec3 begin = hands.hand.joints_m[12], end = hands.hand.joints_m[11];
  const glm::vec3 out_of_back(0, 0, -0.03f);
  const auto at = [&](float part) {
    return hands.vertex_near(glm::mix(begin, end, part) + out_of_back);
  };
  hands.touch(at(0));
  draw();
  EXPECT_EQ(on(at(0.5f)), 0u);
  hands.touch(at(0.8f));
  draw();
  EXPECT_GT(alpha_of(on(at(0.4f))), 100);
}

TEST_F(PaintTest, AStrokeCrossesTheSeamBetweenBackAndPalm) {
  // Round the side of the palm, from the back over the little finger's edge.
  const glm::vec3 edge = glm::mix(hands.hand.joints_m[22], hands.hand.joints_m[21], 0.5f);
  const auto& mesh = made_hand(Side::left);
  const auto rim =
      hands.vertex_near(edge + glm::vec3(hands.hand.joints_m[22].x < 0 ? -0.05f : 0.05f, 0, 0));
  ASSERT_TRUE(source->set("size", "24"));
  hands.touch(rim);
  draw();
  std::array<int, 3> by_chart{};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if (on(v) != 0 && glm::distance(hands.positions_m[v], hands.positions_m[rim]) < 0.01f)
      ++by_chart[std::min<std::size_t>(mesh.chart[v], 2)];
  EXPECT_GT(by_chart[1], 1);
  EXPECT_GT(by_chart[2], 1);
}

TEST_F(PaintTest, ALaterStrokeOfAnotherColourLiesOverIt) {
  const auto vertex = hands.middle(true);
  ASSERT_TRUE(source->set("colour", "#ff0000"));
  hands.touch(vertex);
  draw();
  hands.lift();
  draw();
  ASSERT_TRUE(source->set("colour", "#0000ff80"));
  hands.touch(vertex);
  draw();
  EXPECT_EQ(alpha_of(on(vertex)), 255);
  EXPECT_NEAR(level_of(on(vertex), 2), 128, 2);
  EXPECT_NEAR(level_of(on(vertex), 0), 127, 2);
}

TEST_F(PaintTest, AStrokeFadesAndIsGone) {
  ASSERT_TRUE(source->set("fade", "1"));
  hands.touch(hands.middle(true));
  draw();
  hands.lift();
  draw(0.1);
  const auto vertex = hands.middle(true);
  const int before = alpha_of(on(vertex));
  EXPECT_TRUE(draw(0.3));
  EXPECT_LT(alpha_of(on(vertex)), before);
  for (int k = 0; k < 60; ++k) draw(0.1);
  EXPECT_EQ(painted(), 0u);
  EXPECT_FALSE(draw());
}

TEST_F(PaintTest, AllStrokesCanBeCleared) {
  hands.touch(hands.middle(true));
  draw();
  hands.lift();
  draw();
  EXPECT_GT(painted(), 0u);
  ASSERT_TRUE(source->set("clear", "true"));
  EXPECT_TRUE(draw());
  EXPECT_EQ(painted(), 0u);
  EXPECT_FALSE(draw());
}

TEST_F(PaintTest, WithoutTheOtherHandNothingIsPainted) {
  hands.touch(hands.middle(true));
  hands.other.is_there = false;
  draw();
  EXPECT_EQ(painted(), 0u);
}

}  // namespace
}  // namespace handcast::content
