// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/content/surface_map.hpp"
#include "tests/services/content/made_hand.hpp"

namespace handcast::content {
namespace {

class SkeletonTest : public testing::Test {
 protected:
  bool draw() {
    ++moment.frame;
    return *source->draw(moment, {}, out);
  }
  SkeletonTest() {
    hand.is_there = true;
    for (std::size_t joint = 0; joint < kJoints; ++joint)
      hand.joints_m[joint] = glm::vec3(made_hand(Side::left).rest[joint][3]);
    moment.hand = moment.other = &hand;
    moment.step_s = 0.02;
  }
  /// The brightest red of all texels.
  int reddest() const {
    int red = 0;
    for (const auto texel : out.pixels()) red = std::max(red, level_of(texel, 0));
    return red;
  }

  HandState hand;
  Moment moment;
  renderer::Texture out{160, 100};
  std::unique_ptr<Source> source = opened(opening_of("skeleton"));
};

TEST_F(SkeletonTest, DrawsBonesOverTransparency) {
  *source->draw(moment, {}, out);
  const auto lit = std::ranges::count_if(out.pixels(), [](auto texel) { return texel != 0; });
  EXPECT_GT(lit, 500);
  EXPECT_LT(lit, 160 * 100 / 2);
}

TEST_F(SkeletonTest, AStillHandIsNotDrawnAgain) {
  *source->draw(moment, {}, out);
  EXPECT_FALSE(draw());
  ASSERT_TRUE(source->set("width", "8"));
  EXPECT_TRUE(draw());
  EXPECT_FALSE(draw());
}

TEST_F(SkeletonTest, AMovingFingerTakesTheColourOfMotion) {
  ASSERT_TRUE(source->set("colour", "#0000ff"));
  ASSERT_TRUE(source->set("fast", "#ff0000"));
  *source->draw(moment, {}, out);
  EXPECT_EQ(reddest(), 0);
  for (int k = 0; k < 20; ++k) {
    hand.joints_m[10].y += 0.03f;  // the tip of the index finger, at 1.5 m/s
    draw();
  }
  EXPECT_GT(reddest(), 230);
  const auto fast = std::ranges::count_if(out.pixels(), [](auto t) { return level_of(t, 0) > 0; });
  const auto all = std::ranges::count_if(out.pixels(), [](auto t) { return t != 0; });
  EXPECT_LT(fast, all / 5) << "the other bones are at rest";
}

TEST_F(SkeletonTest, AHandThatMovesAsAWholeIsAtRest) {
  ASSERT_TRUE(source->set("fast", "#ff0000"));
  *source->draw(moment, {}, out);
  for (auto& joint : hand.joints_m) joint.x += 0.1f;
  EXPECT_FALSE(draw());
}

TEST_F(SkeletonTest, WidthsThatNoBoneHasAreRefused) {
  EXPECT_FALSE(source->set("width", "100"));
  EXPECT_FALSE(source->set("colour", "blue-ish"));
}

}  // namespace
}  // namespace handcast::content
