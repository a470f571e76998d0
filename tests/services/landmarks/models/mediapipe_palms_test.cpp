// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_palms.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace handcast::landmarks {
namespace {

/// An answer without a palm in it.
struct Answer {
  std::vector<float> boxes = std::vector<float>(kPalmAnchors * kPalmValues),
                     logits = std::vector<float>(kPalmAnchors, -20.0f);

  /// A box `side` wide whose middle lies (x, y) beside its anchor's, in px of the 192.
  void put(int anchor, float logit, float x, float y, float side) {
    logits[anchor] = logit;
    float* values = &boxes[static_cast<std::size_t>(anchor) * kPalmValues];
    values[0] = x, values[1] = y, values[2] = values[3] = side;
    for (int k = 0; k < Palm::kPoints; ++k)
      values[4 + 2 * k] = x, values[5 + 2 * k] = y + (k == 2 ? -side / 2 : side / 2);
  }
};

TEST(MediapipePalms, HasTheAnchorsOfTheLiteNetwork) {
  const auto anchors = palm_anchors();
  ASSERT_EQ(anchors.size(), 2016u);
  EXPECT_FLOAT_EQ(anchors[0].x, 0.5f / 24);
  EXPECT_FLOAT_EQ(anchors[2].x, 1.5f / 24) << "two to a cell";
  EXPECT_FLOAT_EQ(anchors[48].y, 1.5f / 24);
  EXPECT_FLOAT_EQ(anchors[1152].x, 0.5f / 12) << "the coarse ones come after 24 x 24 x 2";
  EXPECT_FLOAT_EQ(anchors[1158].x, 1.5f / 12) << "six to a cell";
  EXPECT_FLOAT_EQ(anchors[2015].y, 11.5f / 12);
}

TEST(MediapipePalms, AnEmptyAnswerIsNoPalm) {
  EXPECT_TRUE(decode_palms(Answer().boxes, Answer().logits).empty());
}

TEST(MediapipePalms, AnswersAreRelativeToTheirAnchor) {
  Answer answer;
  answer.put(1152 + 6 * (12 * 4 + 7), 3, 4.8f, -9.6f, 48);
  const auto palms = decode_palms(answer.boxes, answer.logits);
  ASSERT_EQ(palms.size(), 1u);
  EXPECT_NEAR(palms[0].score, 0.9526f, 1e-3);
  EXPECT_NEAR(palms[0].centre.x, 7.5f / 12 + 0.025f, 1e-5);
  EXPECT_NEAR(palms[0].centre.y, 4.5f / 12 - 0.05f, 1e-5);
  EXPECT_NEAR(palms[0].extent.x, 0.25f, 1e-5);
}

TEST(MediapipePalms, OverlappingCandidatesBecomeTheirMeanByScore) {
  Answer answer;
  answer.put(600, 0.1f, 10, 0, 40);
  answer.put(601, 5, 0, 0, 40);
  answer.put(1100, 1, 0, 0, 40);  // elsewhere
  const auto palms = decode_palms(answer.boxes, answer.logits);
  ASSERT_EQ(palms.size(), 2u);
  EXPECT_GT(palms[0].score, palms[1].score);
  const float weak = 0.52498f, strong = 0.99331f;
  EXPECT_NEAR(palms[0].centre.x, palm_anchors()[600].x + weak / (weak + strong) * 10 / 192, 1e-4);
  EXPECT_NEAR(palms[0].score, strong, 1e-4);
}

TEST(MediapipePalms, BoxesThatAreHugeOrNotFiniteAreNone) {
  for (const float odd : {1e38f, 1e20f, -1e20f, std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
    Answer answer;
    answer.put(600, 5, 0, 0, odd);
    answer.put(700, 5, odd, 0, 40);
    answer.put(1100, 1, 0, 0, 40);
    EXPECT_EQ(decode_palms(answer.boxes, answer.logits).size(), 1u) << odd;
  }
}

TEST(MediapipePalms, ABoxWithoutAnExtentIsNone) {
  Answer answer;
  answer.put(5, 9, 0, 0, -3);
  answer.put(6, 9, 0, 0, 0);
  EXPECT_TRUE(decode_palms(answer.boxes, answer.logits).empty());
}

TEST(MediapipePalms, TheHandIsLookedForAboveItsPalm) {
  Answer answer;
  answer.put(600, 5, 0, 0, 40);
  const Region shown = region_of_image(720, 540);
  const Region region = region_of_palm(decode_palms(answer.boxes, answer.logits).front(), shown);
  const glm::vec2 palm_px = shown.to_image(palm_anchors()[600] - 0.5f);
  const float side_px = 40.0f / 192 * 720;
  EXPECT_NEAR(region.angle_rad, 0, 1e-4);
  EXPECT_NEAR(region.size_px, 2.6f * side_px, 0.1);
  EXPECT_NEAR(region.centre_px.x, palm_px.x, 0.1);
  EXPECT_NEAR(region.centre_px.y, palm_px.y - 0.5f * side_px, 0.1);
}

}  // namespace
}  // namespace handcast::landmarks
