// SPDX-License-Identifier: Apache-2.0
// From landmarks to light, with each method of correction.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "config/settings/choice.hpp"
#include "tests/renderer/pipeline/driven_pipeline.hpp"

namespace handcast::renderer {
namespace {

class EveryCorrection : public ::testing::TestWithParam<config::CorrectMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryCorrection,
                         ::testing::Values(config::CorrectMethod::vertices,
                                           config::CorrectMethod::grid),
                         [](const auto& each) { return std::string(config::word_of(each.param)); });

TEST_P(EveryCorrection, LandmarksMoveTheLightOntoTheHand) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade(GetParam(), config::FillMethod::none));
  const auto hand = pose_of(Side::left);
  feed_still(*pipeline, {hand});
  const glm::vec2 before = mean_vertex(pipeline->render(20 * kMs, 24 * kMs, {}).hands[0]);
  const int lit_before = lit_pixels(pipeline->render(20 * kMs, 24 * kMs, {}));
  feed_landmarks(*pipeline, calibration, hand, {12, -6});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {});
  EXPECT_TRUE(frame.hands[0].has_landmarks);
  EXPECT_NEAR(frame.hands[0].corrected[8].x - frame.hands[0].tracker[8].x, 12, 0.2);

  const glm::dvec2 at = frame.hands[0].tracker[9];
  const glm::dvec2 moved =
      calibration.projector.pixel_of(at + glm::dvec2(12, -6)) - calibration.projector.pixel_of(at);
  const glm::vec2 landed = mean_vertex(frame.hands[0]) - before;
  EXPECT_NEAR(landed.x, moved.x, 0.7);
  EXPECT_NEAR(landed.y, moved.y, 0.7);
  EXPECT_EQ(frame.foldovers, 0);

  glm::dvec2 low{1e9}, high{-1e9};
  for (int y = frame.region.y0; y < frame.region.y1; ++y)
    for (int x = frame.region.x0; x < frame.region.x1; ++x)
      if (lit(frame, x, y)) {
        low = glm::min(low, glm::dvec2(x, y));
        high = glm::max(high, glm::dvec2(x, y));
      }
  glm::vec2 tip{1e9f};
  for (const glm::vec2& vertex : frame.hands[0].projected_px) tip = glm::min(tip, vertex);
  EXPECT_NEAR(low.x, tip.x, 3);  // the light is at the vertices
  EXPECT_NEAR(low.y, tip.y, 3);
  EXPECT_NEAR(lit_pixels(frame), lit_before, 0.03 * lit_before);
}

TEST_P(EveryCorrection, AWrongTrackerIsMendedByLandmarksMaskAndFill) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade(GetParam(), config::FillMethod::reflect));
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand}, {15, 10});
  feed_still(*pipeline, {hand});
  feed_landmarks(*pipeline, calibration, hand, {15, 10});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {image.view(), 102 * kMs});
  const glm::dvec2 wrist = calibration.projector.pixel_of(glm::dvec2(frame.hands[0].corrected[0]));
  const LightCount count = count_light(frame, calibration, image, wrist.y);
  EXPECT_EQ(count.spill_px, 0);
  EXPECT_LT(count.dark_px, count.hand_px / 100);
  EXPECT_GT(frame.fill.lit, 9 * frame.fill.filled);
}

TEST_P(EveryCorrection, TwoHandsAreBothCorrectedOnTheFullPath) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade(GetParam(), config::FillMethod::reflect));
  const auto left = pose_of(Side::left, {-0.085f, 0, 0}),
             right = pose_of(Side::right, {0.085f, 0, 0});
  feed_still(*pipeline, {left, right});
  for (std::int64_t t = 20 * kMs; t <= 100 * kMs; t += 2 * kMs) {
    if (t % (16 * kMs) == 0) {
      auto seen = landmarks_of(calibration, t - 16 * kMs, left, {8, 0});
      seen.hands[1] = landmarks_of(calibration, t - 16 * kMs, right, {-8, 4}).hands[0];
      seen.count = 2;
      pipeline->push(t, seen);
    }
    pipeline->track(t, t + 4 * kMs);
  }
  const auto image = image_of(calibration, {left, right});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {image.view(), 102 * kMs});
  ASSERT_EQ(frame.hands.size(), 2u);
  EXPECT_NEAR(frame.hands[0].corrected[8].x - frame.hands[0].tracker[8].x, 8, 0.2);
  EXPECT_NEAR(frame.hands[1].corrected[8].x - frame.hands[1].tracker[8].x, -8, 0.2);
  for (const FrameHand& hand : frame.hands) {
    const glm::dvec2 knuckle = calibration.projector.pixel_of(glm::dvec2(hand.tracker[9]));
    EXPECT_TRUE(lit(frame, static_cast<int>(knuckle.x), static_cast<int>(knuckle.y)));
  }
}

/// A detector that sees the index finger beside its place, and images that show where it is: the
/// mean distance of the vertices from those with a flawless detector, projector px.
float beside_px(bool outline, float sigma_px = 3) {
  const auto calibration = rig_above_hand();
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand});
  const auto vertices = [&](float wrong_px) {
    auto settings = cascade(config::CorrectMethod::vertices, config::FillMethod::reflect);
    settings.correct.outline = outline;
    const auto pipeline = make_pipeline(settings);
    feed_still(*pipeline, {hand}, 400 * kMs);
    for (std::int64_t t = 20 * kMs; t < 400 * kMs; t += 2 * kMs) {
      auto seen = landmarks_of(calibration, t - 8 * kMs, hand, {});
      for (auto& point : seen.hands[0].points) point.sigma_px = sigma_px;
      for (const int i : {6, 7, 8}) seen.hands[0].points[i].x_px += wrong_px;
      pipeline->push(t, seen);
      pipeline->track(t, t + 4 * kMs, {image.view(), t - 2 * kMs, static_cast<std::uint64_t>(t)});
    }
    const auto hands = pipeline->render(400 * kMs, 404 * kMs, {image.view(), 398 * kMs, 1}).hands;
    return std::vector<glm::vec2>(hands[0].projected_px.begin(), hands[0].projected_px.end());
  };
  const auto right = vertices(0), wrong = vertices(6);
  float sum_px = 0;
  for (std::size_t v = 0; v < right.size(); ++v) sum_px += glm::distance(right[v], wrong[v]);
  return sum_px / static_cast<float>(right.size());
}

TEST(Correction, TheOutlineMendsAFingerThatTheDetectorSeesBesideItsPlace) {
  const float without_px = beside_px(false);
  EXPECT_GT(without_px, 0.3f);
  EXPECT_LT(beside_px(true), 0.75f * without_px);
}

TEST(Correction, LandmarksOfADetectorWithoutSigmasAreNotPulledToTheOutline) {
  EXPECT_EQ(beside_px(true, 0), beside_px(false, 0));
}

TEST(Correction, AGridThatFoldsIsCounted) {
  const auto calibration = rig_above_hand();
  const auto pipeline =
      make_pipeline(cascade(config::CorrectMethod::grid, config::FillMethod::none));
  const auto hand = pose_of(Side::left);
  feed_still(*pipeline, {hand});
  auto torn = landmarks_of(calibration, 80 * kMs, hand, {});
  // The tips of index and little finger are exchanged.
  std::swap(torn.hands[0].points[8], torn.hands[0].points[20]);
  std::swap(torn.hands[0].points[6], torn.hands[0].points[18]);
  pipeline->track(99 * kMs, 103 * kMs);
  pipeline->push(100 * kMs, torn);
  for (std::int64_t t = 100; t < 140; t += 2) pipeline->track(t * kMs, (t + 4) * kMs);
  EXPECT_GT(pipeline->render(140 * kMs, 144 * kMs, {}).foldovers, 0);
}

/// How far the light of the grid's correction is from the drawing, by hand: the mean distance of
/// the vertices from those without a correction, px. `displaced`: the landmark that the detector
/// sees 12 px aside; -1: all.
std::vector<float> moved_by_grid(config::Cascade settings, std::vector<Side> sides, int displaced) {
  const auto calibration = rig_above_hand();
  const auto vertices = [&](config::CorrectMethod method) {
    settings.correct.method = method;
    const auto pipeline = make_pipeline(settings);
    std::vector<msg::HandPose> hands;
    for (const Side side : sides)
      hands.push_back(pose_of(side, {side == Side::left ? -0.09f : 0.09f, 0, 0}));
    feed_still(*pipeline, hands);
    msg::Landmarks seen;
    for (const auto& hand : hands)
      seen.hands[seen.count++] =
          landmarks_of(calibration, 80 * kMs, hand, displaced < 0 ? glm::vec2(12, 0) : glm::vec2(0))
              .hands[0];
    if (displaced >= 0) seen.hands[0].points[displaced].x_px += 12;
    seen.header.origin_ns = 80 * kMs;
    pipeline->push(100 * kMs, seen);
    std::vector<std::vector<glm::vec2>> places;
    for (const auto& hand : pipeline->render(104 * kMs, 108 * kMs, {}).hands)
      places.emplace_back(hand.projected_px.begin(), hand.projected_px.end());
    return places;
  };
  const auto drawn = vertices(config::CorrectMethod::none),
             corrected = vertices(config::CorrectMethod::grid);
  std::vector<float> moved;
  for (std::size_t h = 0; h < drawn.size(); ++h) {
    moved.push_back(0);
    for (std::size_t v = 0; v < drawn[h].size(); ++v)
      moved[h] += glm::distance(drawn[h][v], corrected[h][v]) / static_cast<float>(drawn[h].size());
  }
  return moved;
}

/// The paper's correction alone.
config::Cascade paper_grid() {
  auto settings = cascade(config::CorrectMethod::grid, config::FillMethod::none);
  settings.filter.method = config::FilterMethod::paper;
  settings.ladder.rung = config::RungChoice::landmarks;
  return settings;
}

TEST(PapersGrid, TheReleasedProgramTakes16LandmarksAndLeavesOutMiddleJoints) {
  auto settings = paper_grid();
  constexpr int kMiddleJoint = 6, kTip = 8;
  const auto moved_by = [&](config::GridPoints points, int displaced) {
    settings.correct.grid_points = points;
    return moved_by_grid(settings, {Side::left}, displaced)[0];
  };
  EXPECT_GT(moved_by(config::GridPoints::all, kTip), 0.05f);
  EXPECT_GT(moved_by(config::GridPoints::all, kMiddleJoint), 0.05f);
  EXPECT_GT(moved_by(config::GridPoints::released, kTip), 0.05f);
  EXPECT_LT(moved_by(config::GridPoints::released, kMiddleJoint), 0.01f);
}

TEST(PapersGrid, TheReleasedProgramDoesNotCorrectTwoHands) {
  auto settings = paper_grid();
  settings.correct.grid_hands = 1;
  EXPECT_GT(moved_by_grid(settings, {Side::left}, -1)[0], 1);
  for (const float each : moved_by_grid(settings, {Side::left, Side::right}, -1))
    EXPECT_EQ(each, 0);
  settings.correct.grid_hands = 2;
  for (const float each : moved_by_grid(settings, {Side::left, Side::right}, -1))
    EXPECT_GT(each, 1);
}

/// All pixels and vertices of a moving hand with noisy sensors, for a quarter of a second.
std::vector<std::uint32_t> everything(const config::Cascade& settings) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(settings);
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0, 1);
  std::vector<std::uint32_t> all;
  for (std::int64_t t = 0; t < 250 * kMs; t += 9 * kMs) {
    const float s = static_cast<float>(t) * 1e-9f;
    const auto hand =
        pose_of(Side::right, {0.05f * std::sin(9 * s) + 1e-4f * noise(random), 0, 0.03f * s});
    pipeline->push(t, poses_of(t - 9 * kMs, {hand}));
    if (t % 18 == 0)
      pipeline->push(
          t, landmarks_of(calibration, t - 16 * kMs, hand, {6 + noise(random), noise(random)}));
    const auto image = image_of(calibration, {hand}, {6, 0});
    const Frame frame = pipeline->render(t, t + 4 * kMs, {image.view(), t - 2 * kMs});
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x) all.push_back(frame.colour.at(x, y));
    for (const FrameHand& each : frame.hands)
      for (const glm::vec2& vertex : each.projected_px)
        all.push_back(std::bit_cast<std::uint32_t>(vertex.x));
  }
  return all;
}

TEST_P(EveryCorrection, TheSameMessagesGiveTheSameLightBitByBit) {
  const auto once = everything(cascade(GetParam(), config::FillMethod::reflect));
  EXPECT_GT(once.size(), 100000u);
  EXPECT_TRUE(once == everything(cascade(GetParam(), config::FillMethod::reflect)));
}

}  // namespace
}  // namespace handcast::renderer
