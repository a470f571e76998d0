// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "config/settings/choice.hpp"
#include "renderer/pipeline/projection.hpp"
#include "tests/renderer/pipeline/driven_pipeline.hpp"

namespace handcast::renderer {
namespace {

using ::testing::ElementsAre;

TEST(Pipeline, WithoutAHandTheFrameIsDark) {
  const auto pipeline = make_pipeline();
  const Image<std::uint8_t> image(720, 540, 100);
  const Frame frame = pipeline->render(10 * kMs, 14 * kMs, {image.view(), 8 * kMs});
  EXPECT_TRUE(frame.region.empty());
  EXPECT_TRUE(frame.hands.empty());
  EXPECT_EQ(frame.target_ns, 14 * kMs);
}

TEST(Pipeline, AMissingHandFileIsAConfigurationError) {
  config::Hand hand;
  hand.left = "/nowhere/hand.glb";
  const auto pipeline = Pipeline::create({}, {}, hand, rig_above_hand());
  ASSERT_FALSE(pipeline);
  EXPECT_EQ(pipeline.error().code, Errc::bad_config);
  EXPECT_THAT(pipeline.error().what, ::testing::HasSubstr("/nowhere/hand.glb"));
}

TEST(Pipeline, TheIdealFilterNeedsATruthThatOnlyASimulatorHas) {
  config::Cascade ideal;
  ideal.filter.method = config::FilterMethod::ideal;
  const auto alone = Pipeline::create(ideal, {}, {}, rig_above_hand());
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, Errc::bad_config);
  const auto knows_nothing = [](Side, std::int64_t) { return std::optional<LandmarkPoints>(); };
  EXPECT_TRUE(Pipeline::create(ideal, {}, {}, rig_above_hand(), knows_nothing));
}

TEST(Pipeline, ImagesOfFramesThatAreNotDrawnAreAskedForOnlyWhereTheyAreRegistered) {
  EXPECT_TRUE(make_pipeline()->looks());
  config::Cascade settings;
  settings.ladder.rung = config::RungChoice::landmarks;
  EXPECT_FALSE(make_pipeline(settings)->looks());
  settings.ladder.rung = config::RungChoice::registered;
  EXPECT_TRUE(make_pipeline(settings)->looks());
  settings.filter.method = config::FilterMethod::kalman;
  EXPECT_FALSE(make_pipeline(settings)->looks());
  settings = {};
  settings.registration.method = config::RegisterMethod::none;
  EXPECT_FALSE(make_pipeline(settings)->looks());
}

class EverySide : public ::testing::TestWithParam<Side> {};
INSTANTIATE_TEST_SUITE_P(Sides, EverySide, ::testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "Left" : "Right";
                         });

TEST_P(EverySide, LightCoversTheHandAndNothingElse) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline();
  const auto hand = pose_of(GetParam());
  const auto image = image_of(calibration, {hand});
  feed_still(*pipeline, {hand});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {image.view(), 102 * kMs});
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(frame.hands[0].side, GetParam());

  const glm::dvec2 wrist = calibration.projector.pixel_of(glm::dvec2(frame.hands[0].tracker[0]));
  const LightCount count = count_light(frame, calibration, image, wrist.y);
  EXPECT_GT(count.hand_px, 20000);
  EXPECT_LT(count.dark_px, count.hand_px / 200);
  EXPECT_EQ(count.spill_px, 0);
  const Rect beyond_wrist{0, static_cast<int>(wrist.y) + 46, 1024, 768};
  EXPECT_EQ(lit_pixels(frame, beyond_wrist), 0) << "light on the arm";
}

TEST(Pipeline, WithoutMaskingTheArmBeyondTheWristIsNotDrawnEither) {
  const auto calibration = rig_above_hand();
  const auto pipeline =
      make_pipeline(cascade(config::CorrectMethod::none, config::FillMethod::none));
  feed_still(*pipeline, {pose_of(Side::left)});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {});
  const glm::dvec2 wrist = calibration.projector.pixel_of(glm::dvec2(frame.hands[0].tracker[0]));
  EXPECT_GT(lit_pixels(frame), 20000);
  // 14 mm of forearm, and the ring of triangles across the cut.
  EXPECT_LT(frame.region.y1, wrist.y + 90);
}

TEST(Pipeline, BeforeTheFirstCameraImageTheHandIsDrawnUnmasked) {
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::left)});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {});
  EXPECT_GT(lit_pixels(frame), 20000);
  EXPECT_EQ(frame.fill.lit, 0);
}

TEST(Pipeline, AnEmptyCameraImageMeansNoLight) {
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::left)});
  const Image<std::uint8_t> dark(720, 540, 5);
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {dark.view(), 102 * kMs});
  EXPECT_EQ(lit_pixels(frame), 0);
}

TEST(Pipeline, TrackingSaysWhatRenderingWouldUse) {
  const auto calibration = rig_above_hand();
  const auto tracking = make_pipeline(), rendering = make_pipeline();
  const auto hand = pose_of(Side::left);
  for (const auto* pipeline : {&tracking, &rendering}) {
    feed_still(**pipeline, {hand});
    feed_landmarks(**pipeline, calibration, hand, {9, 3});
  }
  const auto tracked = tracking->track(104 * kMs, 108 * kMs);
  const Frame frame = rendering->render(104 * kMs, 108 * kMs, {});
  ASSERT_EQ(tracked.size(), 1u);
  EXPECT_EQ(tracked[0].tracker, frame.hands[0].tracker);
  EXPECT_EQ(tracked[0].corrected, frame.hands[0].corrected);
  EXPECT_TRUE(tracked[0].projected_px.empty());
}

TEST_P(EverySide, TheEdgeOfASmoothPictureIsLitInPart) {
  const auto calibration = rig_above_hand();
  const auto hand = pose_of(GetParam());
  const auto image = image_of(calibration, {hand});
  double shares = 0, whole = 0;
  int partly = 0;
  for (const bool smooth : {false, true}) {
    const auto pipeline = make_pipeline({}, calibration, {.smooth = smooth});
    feed_still(*pipeline, {hand});
    const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {image.view(), 102 * kMs});
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x) {
        const std::uint32_t alpha = frame.colour.at(x, y) >> 24;
        (smooth ? shares : whole) += alpha / 255.;
        partly += alpha > 0 && alpha < 255;
      }
  }
  EXPECT_GT(partly, 1500);
  EXPECT_NEAR(shares / whole, 1, 0.003) << "the hand must keep its size";
}

TEST(Pipeline, NoLightStaysWhereTheHandWas) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline();
  for (int i = 0; i < 12; ++i) {
    const auto hand = pose_of(Side::left, {0.004f * static_cast<float>(i), 0, 0});
    const auto image = image_of(calibration, {hand});
    pipeline->push(i * 9 * kMs, poses_of(i * 9 * kMs, {hand}));
    const Frame frame = pipeline->render(i * 9 * kMs, i * 9 * kMs, {image.view(), i * 9 * kMs});
    int spill_px = 0;
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x)
        spill_px += lit(frame, x, y) && beside_hand(calibration, image, x, y);
    EXPECT_EQ(spill_px, 0) << i;
  }
}

TEST(Pipeline, AHandTheTrackerLostGoesDark) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline();
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand});
  feed_still(*pipeline, {hand}, 99 * kMs);
  EXPECT_GT(lit_pixels(pipeline->render(200 * kMs, 204 * kMs, {image.view(), 198 * kMs})), 20000);
  EXPECT_TRUE(pipeline->render(320 * kMs, 324 * kMs, {image.view(), 318 * kMs}).region.empty());
}

TEST(Pipeline, AHandLeavingTheViewIsFollowedToTheEdgeAndBeyond) {
  const auto calibration = rig_above_hand();
  for (const auto method : {config::CorrectMethod::vertices, config::CorrectMethod::grid}) {
    const auto pipeline = make_pipeline(cascade(method, config::FillMethod::reflect));
    std::int64_t t = 0;
    for (float x = 0; x < 0.5f; x += 0.01f, t += 9 * kMs) {
      const auto hand = pose_of(Side::left, {x, 0, 0.3f * x});
      pipeline->push(t, poses_of(t, {hand}));
      if (t % 18 == 0) pipeline->push(t, landmarks_of(calibration, t, hand, {3, 3}));
      const auto image = image_of(calibration, {hand});
      const Frame frame = pipeline->render(t, t + 1 * kMs, {image.view(), t});
      EXPECT_GE(frame.region.x0, 0);
      EXPECT_LE(frame.region.x1, 1024);
      EXPECT_LE(frame.region.y1, 768);
      if (x < 0.1f) {
        EXPECT_GT(lit_pixels(frame), 5000) << x;
      }
      if (x > 0.4f) {
        EXPECT_EQ(lit_pixels(frame), 0) << x;
      }
    }
  }
}

TEST(Pipeline, WhatIsStampedInTheFutureOutdatesNothing) {
  const auto calibration = rig_above_hand();
  const auto hand = pose_of(Side::left), elsewhere = pose_of(Side::left, {0.03f, 0, 0});
  const auto image = image_of(calibration, {hand});
  const auto light_of = [&](std::int64_t ahead_ns) {
    const auto pipeline = make_pipeline();
    feed_still(*pipeline, {hand}, 45 * kMs);
    pipeline->track(60 * kMs, 64 * kMs);
    if (ahead_ns > 0) {
      pipeline->push(60 * kMs, poses_of(60 * kMs + ahead_ns, {elsewhere}));
      pipeline->push(60 * kMs, landmarks_of(calibration, 60 * kMs + ahead_ns, elsewhere, {}));
      pipeline->track(60 * kMs, 64 * kMs, {image.view(), 60 * kMs + ahead_ns});
      EXPECT_EQ(
          lit_pixels(pipeline->render(60 * kMs, 64 * kMs, {image.view(), 60 * kMs + ahead_ns})),
          lit_pixels(pipeline->render(60 * kMs, 64 * kMs, {})));
    } else {
      pipeline->track(60 * kMs, 64 * kMs);
      pipeline->render(60 * kMs, 64 * kMs, {});
      pipeline->render(60 * kMs, 64 * kMs, {});
    }
    for (std::int64_t t = 61 * kMs; t <= 200 * kMs; t += kMs) {
      const auto moved = pose_of(Side::left, {2e-10f * static_cast<float>(t - 61 * kMs), 0, 0});
      if (t % (9 * kMs) == 0) pipeline->push(t, poses_of(t - 9 * kMs, {moved}));
      if (t % (16 * kMs) == 0)
        pipeline->push(t, landmarks_of(calibration, t - 16 * kMs, moved, {4, 2}));
      pipeline->track(t, t + 4 * kMs);
    }
    const Frame frame = pipeline->render(200 * kMs, 204 * kMs, {image.view(), 198 * kMs});
    return std::pair(frame.hands[0].tracker, frame.hands[0].corrected);
  };
  EXPECT_EQ(light_of(3'600'000 * kMs), light_of(0));
}

TEST(Pipeline, AProjectionWhoseRegionIsLeftOutHasNoPlaceOfAnEarlierOne) {
  const auto projection = std::make_unique<msg::Projection>();
  projection->region_x_px = projection->region_y_px = 7;
  Frame frame;
  frame.region = {2, 1, 5, 4};
  write_projection(frame, *projection, 0);
  EXPECT_EQ(projection->region_x_px, 0);
  EXPECT_EQ(projection->region_y_px, 0);
}

TEST(Pipeline, APoseInWhichTheTrackerHasNoConfidenceIsNotUsed) {
  for (const float confidence : {0.05f, 0.5f}) {
    const auto pipeline = make_pipeline();
    auto hand = pose_of(Side::left);
    hand.confidence = confidence;
    feed_still(*pipeline, {hand});
    const auto hands = pipeline->render(104 * kMs, 108 * kMs, {}).hands.size();
    EXPECT_EQ(hands, confidence < 0.1f ? 0u : 1u);
  }
}

TEST(Pipeline, AHandBehindTheCameraIsNotDrawn) {
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::left, {0, 1.0f, 0})});
  EXPECT_TRUE(pipeline->render(104 * kMs, 108 * kMs, {}).hands.empty());
}

TEST(Pipeline, EveryStageIsMarkedInOrder) {
  using msg::Stage;
  const auto calibration = rig_above_hand();
  const auto pipeline =
      make_pipeline(cascade(config::CorrectMethod::grid, config::FillMethod::reflect));
  const auto hand = pose_of(Side::left);
  feed_still(*pipeline, {hand});
  feed_landmarks(*pipeline, calibration, hand, {5, 5});
  const auto image = image_of(calibration, {hand});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {image.view(), 102 * kMs});
  std::vector<Stage> stages;
  for (const auto& mark : frame.stages) {
    stages.push_back(mark.stage);
    EXPECT_LE(mark.begin_ns, mark.end_ns);
  }
  EXPECT_THAT(stages, ElementsAre(Stage::predict, Stage::mask, Stage::registration, Stage::skin,
                                  Stage::correct, Stage::advance, Stage::draw, Stage::warp,
                                  Stage::fill, Stage::frame));
  EXPECT_EQ(frame.stages.back().begin_ns, frame.stages.front().begin_ns);
}

TEST(Pipeline, TheRungThatIsSetIsDrawnAndMarked) {
  const auto calibration = rig_above_hand();
  using enum config::RungChoice;
  for (const config::RungChoice rung : {hold, similarity, landmarks}) {
    config::Cascade settings;
    settings.ladder.rung = rung;
    const auto pipeline = *Pipeline::create(settings, {}, {}, calibration);
    for (std::int64_t t = 0; t <= 100 * kMs; t += kMs) {
      if (t % (9 * kMs) == 0) pipeline->push(t, poses_of(t, {pose_of(Side::left)}));
      if (t % (16 * kMs) == 0)
        pipeline->push(t, landmarks_of(calibration, t, pose_of(Side::left), {6, 0}));
      pipeline->track(t, t + 4 * kMs);
    }
    const Frame frame = pipeline->render(101 * kMs, 105 * kMs, {});
    ASSERT_EQ(frame.hands.size(), 1u);
    const auto& hand = frame.hands[0];
    EXPECT_EQ(hand.rung, rung_of(rung));
    EXPECT_NEAR(hand.corrected[9].x - hand.tracker[9].x, hand.rung < Rung::shift ? 0 : 6, 0.5f)
        << config::word_of(rung);
    const auto mark = std::ranges::find(frame.stages, msg::Stage::correct, &msg::StageMark::stage);
    ASSERT_NE(mark, frame.stages.end());
    EXPECT_EQ(msg::rung_in(mark->detail, Side::left), hand.rung);
  }
}

TEST(Pipeline, ShadingDarkensWhatTurnsAway) {
  config::Content white;
  white.left = "builtin:white";
  const auto plain = make_pipeline(cascade(config::CorrectMethod::none, config::FillMethod::none),
                                   rig_above_hand(), white);
  white.shading = 1;
  const auto shaded = make_pipeline(cascade(config::CorrectMethod::none, config::FillMethod::none),
                                    rig_above_hand(), white);
  const auto sum_of = [](Pipeline& pipeline) {
    feed_still(pipeline, {pose_of(Side::left)});
    const Frame frame = pipeline.render(104 * kMs, 108 * kMs, {});
    double sum = 0;
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x)
        if (lit(frame, x, y)) sum += frame.colour.at(x, y) & 255;
    return sum / lit_pixels(frame);
  };
  const double bright = sum_of(*plain), dark = sum_of(*shaded);
  EXPECT_GT(bright, 200);
  EXPECT_LT(dark, 0.97 * bright);
  EXPECT_GT(dark, 0.5 * bright);  // the back of the hand faces the camera
}

}  // namespace
}  // namespace handcast::renderer
