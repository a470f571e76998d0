#include "renderer/pipeline.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "stage_set.hpp"

namespace handcast::renderer {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

std::unique_ptr<Pipeline> make_pipeline(const config::Cascade& settings = {}, const calib::Calibration& calibration = rig_above_hand(),
                                        const config::Content& content = {}) {
  auto pipeline = Pipeline::create(settings, content, {}, calibration);
  if (!pipeline) throw std::runtime_error(pipeline.error().what);
  return std::move(*pipeline);
}

config::Cascade cascade(const char* correct, const char* fill) {
  config::Cascade settings;
  settings.correct.method = correct;
  settings.fill.method = fill;
  return settings;
}

/// Tracker samples of a still hand up to `until_ns`.
void feed_still(Pipeline& pipeline, std::initializer_list<msg::HandPose> hands, std::int64_t until_ns = 100 * kMs) {
  for (std::int64_t t = 0; t <= until_ns; t += 9 * kMs) pipeline.push(t + 9 * kMs, poses_of(t, hands));
}

/// Detections of it that are `offset_px` off, and the questions between.
void feed_landmarks(Pipeline& pipeline, const calib::Calibration& calibration, const msg::HandPose& hand, glm::vec2 offset_px) {
  for (std::int64_t t = 20 * kMs; t <= 100 * kMs; t += 2 * kMs) {
    if (t % (16 * kMs) == 0) pipeline.push(t, landmarks_of(calibration, t - 16 * kMs, hand, offset_px));
    pipeline.track(t, t + 4 * kMs);
  }
}

bool lit(const Frame& frame, int x, int y) {
  const Rect& r = frame.region;
  return x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1 && (frame.colour.at(x, y) >> 24) > 0;
}

int lit_pixels(const Frame& frame) {
  int count = 0;
  for (int y = frame.region.y0; y < frame.region.y1; ++y)
    for (int x = frame.region.x0; x < frame.region.x1; ++x) count += lit(frame, x, y);
  return count;
}

/// Grey value of the camera image at a projector pixel, or `aside_px` camera px from there.
int grey_at(const calib::Calibration& calibration, const Image<std::uint8_t>& image, int x, int y, glm::dvec2 aside_px = {}) {
  const glm::dvec2 at = calibration.camera.distort(calibration.to_camera({x, y})) + aside_px;
  const int cx = static_cast<int>(std::lround(at.x)), cy = static_cast<int>(std::lround(at.y));
  return cx < 0 || cy < 0 || cx >= image.width() || cy >= image.height() ? 0 : image.at(cx, cy);
}

/// True where no hand is, not even a tenth of a camera pixel away: so exact is the projector's table.
bool beside_hand(const calib::Calibration& calibration, const Image<std::uint8_t>& image, int x, int y) {
  int most = 0;
  for (const glm::dvec2 aside : {glm::dvec2(0.1, 0), glm::dvec2(-0.1, 0), glm::dvec2(0, 0.1), glm::dvec2(0, -0.1)})
    most = std::max(most, grey_at(calibration, image, x, y, aside));
  return most < 100;
}

glm::vec2 mean_landing(const FrameHand& hand) {
  glm::vec2 sum{0};
  for (const glm::vec2& landing : hand.landings) sum += landing / static_cast<float>(hand.landings.size());
  return sum;
}

TEST(Pipeline, WithoutAHandTheFrameIsDark) {
  const auto pipeline = make_pipeline();
  const Image<std::uint8_t> image(720, 540, 100);
  const Frame frame = pipeline->render(10 * kMs, 14 * kMs, image.view(), 8 * kMs);
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
  ideal.filter.method = "ideal";
  const auto alone = Pipeline::create(ideal, {}, {}, rig_above_hand());
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, Errc::bad_config);
  const auto knows_nothing = [](Side, std::int64_t) { return std::optional<LandmarkPoints>(); };
  EXPECT_TRUE(Pipeline::create(ideal, {}, {}, rig_above_hand(), knows_nothing));
}

TEST(Pipeline, ImagesOfFramesThatAreNotDrawnAreAskedForOnlyWhereTheyAreRegistered) {
  EXPECT_TRUE(make_pipeline()->looks());
  config::Cascade settings;
  settings.ladder.rung = "landmarks";
  EXPECT_FALSE(make_pipeline(settings)->looks());
  settings.ladder.rung = "register";
  EXPECT_TRUE(make_pipeline(settings)->looks());
  settings.filter.method = "kalman";
  EXPECT_FALSE(make_pipeline(settings)->looks());
  settings = {};
  settings.registration.method = "none";
  EXPECT_FALSE(make_pipeline(settings)->looks());
}

class EverySide : public ::testing::TestWithParam<Side> {};
INSTANTIATE_TEST_SUITE_P(Sides, EverySide, ::testing::Values(Side::left, Side::right),
                         [](const auto& each) { return each.param == Side::left ? "Left" : "Right"; });

TEST_P(EverySide, LightCoversTheHandAndNothingElse) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline();
  const auto hand = pose_of(GetParam());
  const auto image = image_of(calibration, {hand});
  feed_still(*pipeline, {hand});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, image.view(), 102 * kMs);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(frame.hands[0].side, GetParam());

  const glm::dvec2 wrist = calibration.to_projector(glm::dvec2(frame.hands[0].tracker[0]));
  int hand_px = 0, dark_px = 0, spill_px = 0, arm_px = 0;
  for (int y = 0; y < 768; ++y)
    for (int x = 0; x < 1024; ++x) {
      const bool on_hand = grey_at(calibration, image, x, y) > 100;
      spill_px += lit(frame, x, y) && beside_hand(calibration, image, x, y);
      hand_px += on_hand && y < wrist.y;
      dark_px += on_hand && y < wrist.y && !lit(frame, x, y);
      arm_px += y > wrist.y + 45 && lit(frame, x, y);
    }
  EXPECT_GT(hand_px, 20000);
  EXPECT_LT(dark_px, hand_px / 200);
  EXPECT_EQ(spill_px, 0);
  EXPECT_EQ(arm_px, 0);
}

TEST(Pipeline, WithoutMaskingTheArmBeyondTheWristIsNotDrawnEither) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade("none", "none"));
  feed_still(*pipeline, {pose_of(Side::left)});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {}, 0);
  const glm::dvec2 wrist = calibration.to_projector(glm::dvec2(frame.hands[0].tracker[0]));
  EXPECT_GT(lit_pixels(frame), 20000);
  EXPECT_LT(frame.region.y1, wrist.y + 90);  // 14 mm of forearm and the ring of triangles across the cut
}

TEST(Pipeline, BeforeTheFirstCameraImageTheHandIsDrawnUnmasked) {
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::left)});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {}, 0);
  EXPECT_GT(lit_pixels(frame), 20000);
  EXPECT_EQ(frame.fill.lit, 0);
}

TEST(Pipeline, AnEmptyCameraImageMeansNoLight) {
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::left)});
  const Image<std::uint8_t> dark(720, 540, 5);
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, dark.view(), 102 * kMs);
  EXPECT_EQ(lit_pixels(frame), 0);
}

class EveryCorrection : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryCorrection, ::testing::Values("vertices", "grid"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EveryCorrection, LandmarksMoveTheLightOntoTheHand) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade(GetParam(), "none"));
  const auto hand = pose_of(Side::left);
  feed_still(*pipeline, {hand});
  const glm::vec2 before = mean_landing(pipeline->render(20 * kMs, 24 * kMs, {}, 0).hands[0]);
  const int lit_before = lit_pixels(pipeline->render(20 * kMs, 24 * kMs, {}, 0));
  feed_landmarks(*pipeline, calibration, hand, {12, -6});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, {}, 0);
  EXPECT_TRUE(frame.hands[0].has_landmarks);
  EXPECT_NEAR(frame.hands[0].corrected[8].x - frame.hands[0].tracker[8].x, 12, 0.2);

  const glm::dvec2 at = frame.hands[0].tracker[9];
  const glm::dvec2 moved = calibration.to_projector(at + glm::dvec2(12, -6)) - calibration.to_projector(at);
  const glm::vec2 landed = mean_landing(frame.hands[0]) - before;
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
  for (const glm::vec2& landing : frame.hands[0].landings) tip = glm::min(tip, landing);
  EXPECT_NEAR(low.x, tip.x, 3);  // the light is where the landings say
  EXPECT_NEAR(low.y, tip.y, 3);
  EXPECT_NEAR(lit_pixels(frame), lit_before, 0.03 * lit_before);
}

TEST_P(EveryCorrection, AWrongTrackerIsMendedByLandmarksMaskAndFill) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade(GetParam(), "reflect"));
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand}, {15, 10});
  feed_still(*pipeline, {hand});
  feed_landmarks(*pipeline, calibration, hand, {15, 10});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, image.view(), 102 * kMs);
  int hand_px = 0, dark_px = 0, spill_px = 0;
  const glm::dvec2 wrist = calibration.to_projector(glm::dvec2(frame.hands[0].corrected[0]));
  for (int y = 0; y < 768; ++y)
    for (int x = 0; x < 1024; ++x) {
      const bool on_hand = grey_at(calibration, image, x, y) > 100;
      spill_px += lit(frame, x, y) && beside_hand(calibration, image, x, y);
      hand_px += on_hand && y < wrist.y;
      dark_px += on_hand && y < wrist.y && !lit(frame, x, y);
    }
  EXPECT_EQ(spill_px, 0);
  EXPECT_LT(dark_px, hand_px / 100);
  EXPECT_GT(frame.fill.lit, 9 * frame.fill.filled);
}

TEST_P(EveryCorrection, TwoHandsAreBothCorrectedOnTheFullPath) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade(GetParam(), "reflect"));
  const auto left = pose_of(Side::left, {-0.085f, 0, 0}), right = pose_of(Side::right, {0.085f, 0, 0});
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
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, image.view(), 102 * kMs);
  ASSERT_EQ(frame.hands.size(), 2u);
  EXPECT_NEAR(frame.hands[0].corrected[8].x - frame.hands[0].tracker[8].x, 8, 0.2);
  EXPECT_NEAR(frame.hands[1].corrected[8].x - frame.hands[1].tracker[8].x, -8, 0.2);
  for (const FrameHand& hand : frame.hands) {
    const glm::dvec2 knuckle = calibration.to_projector(glm::dvec2(hand.tracker[9]));
    EXPECT_TRUE(lit(frame, static_cast<int>(knuckle.x), static_cast<int>(knuckle.y)));
  }
}

TEST(Pipeline, AGridThatFoldsIsCounted) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade("grid", "none"));
  const auto hand = pose_of(Side::left);
  feed_still(*pipeline, {hand});
  auto torn = landmarks_of(calibration, 80 * kMs, hand, {});
  std::swap(torn.hands[0].points[8], torn.hands[0].points[20]);  // index and little tip change places
  std::swap(torn.hands[0].points[6], torn.hands[0].points[18]);
  pipeline->track(99 * kMs, 103 * kMs);
  pipeline->push(100 * kMs, torn);
  for (std::int64_t t = 100; t < 140; t += 2) pipeline->track(t * kMs, (t + 4) * kMs);
  EXPECT_GT(pipeline->render(140 * kMs, 144 * kMs, {}, 0).foldovers, 0);
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
  const Frame frame = rendering->render(104 * kMs, 108 * kMs, {}, 0);
  ASSERT_EQ(tracked.size(), 1u);
  EXPECT_EQ(tracked[0].tracker, frame.hands[0].tracker);
  EXPECT_EQ(tracked[0].corrected, frame.hands[0].corrected);
  EXPECT_TRUE(tracked[0].landings.empty());
}

TEST(Pipeline, NoLightStaysWhereTheHandWas) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline();
  for (int i = 0; i < 12; ++i) {
    const auto hand = pose_of(Side::left, {0.004f * static_cast<float>(i), 0, 0});
    const auto image = image_of(calibration, {hand});
    pipeline->push(i * 9 * kMs, poses_of(i * 9 * kMs, {hand}));
    const Frame frame = pipeline->render(i * 9 * kMs, i * 9 * kMs, image.view(), i * 9 * kMs);
    int spill_px = 0;
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x) spill_px += lit(frame, x, y) && beside_hand(calibration, image, x, y);
    EXPECT_EQ(spill_px, 0) << i;
  }
}

TEST(Pipeline, AHandTheTrackerLostGoesDark) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline();
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand});
  feed_still(*pipeline, {hand}, 99 * kMs);
  EXPECT_GT(lit_pixels(pipeline->render(200 * kMs, 204 * kMs, image.view(), 198 * kMs)), 20000);
  EXPECT_TRUE(pipeline->render(320 * kMs, 324 * kMs, image.view(), 318 * kMs).region.empty());
}

TEST(Pipeline, AHandLeavingTheViewIsFollowedToTheEdgeAndBeyond) {
  const auto calibration = rig_above_hand();
  for (const char* method : {"vertices", "grid"}) {
    const auto pipeline = make_pipeline(cascade(method, "reflect"));
    std::int64_t t = 0;
    for (float x = 0; x < 0.5f; x += 0.01f, t += 9 * kMs) {
      const auto hand = pose_of(Side::left, {x, 0, 0.3f * x});
      pipeline->push(t, poses_of(t, {hand}));
      if (t % 18 == 0) pipeline->push(t, landmarks_of(calibration, t, hand, {3, 3}));
      const auto image = image_of(calibration, {hand});
      const Frame frame = pipeline->render(t, t + 1 * kMs, image.view(), t);
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

TEST(Pipeline, AHandBehindTheCameraIsNotDrawn) {
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::left, {0, 1.0f, 0})});
  EXPECT_TRUE(pipeline->render(104 * kMs, 108 * kMs, {}, 0).hands.empty());
}

/// A moving hand with noisy sensors for a quarter of a second; every pixel and landing that was made.
std::vector<std::uint32_t> everything(const config::Cascade& settings) {
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(settings);
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0, 1);
  std::vector<std::uint32_t> all;
  for (std::int64_t t = 0; t < 250 * kMs; t += 9 * kMs) {
    const float s = static_cast<float>(t) * 1e-9f;
    const auto hand = pose_of(Side::right, {0.05f * std::sin(9 * s) + 1e-4f * noise(random), 0, 0.03f * s});
    pipeline->push(t, poses_of(t - 9 * kMs, {hand}));
    if (t % 18 == 0) pipeline->push(t, landmarks_of(calibration, t - 16 * kMs, hand, {6 + noise(random), noise(random)}));
    const auto image = image_of(calibration, {hand}, {6, 0});
    const Frame frame = pipeline->render(t, t + 4 * kMs, image.view(), t - 2 * kMs);
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x) all.push_back(frame.colour.at(x, y));
    for (const FrameHand& each : frame.hands)
      for (const glm::vec2& landing : each.landings) all.push_back(std::bit_cast<std::uint32_t>(landing.x));
  }
  return all;
}

TEST_P(EveryCorrection, TheSameMessagesGiveTheSameLightBitByBit) {
  const auto once = everything(cascade(GetParam(), "reflect"));
  EXPECT_GT(once.size(), 100000u);
  EXPECT_TRUE(once == everything(cascade(GetParam(), "reflect")));
}

TEST(Pipeline, EveryStageIsMarkedInOrder) {
  using msg::Stage;
  const auto calibration = rig_above_hand();
  const auto pipeline = make_pipeline(cascade("grid", "reflect"));
  const auto hand = pose_of(Side::left);
  feed_still(*pipeline, {hand});
  feed_landmarks(*pipeline, calibration, hand, {5, 5});
  const auto image = image_of(calibration, {hand});
  const Frame frame = pipeline->render(104 * kMs, 108 * kMs, image.view(), 102 * kMs);
  std::vector<Stage> stages;
  for (const auto& mark : frame.stages) {
    stages.push_back(mark.stage);
    EXPECT_LE(mark.begin_ns, mark.end_ns);
  }
  EXPECT_THAT(stages, ElementsAre(Stage::predict, Stage::mask, Stage::registration, Stage::advance, Stage::skin, Stage::correct,
                                  Stage::draw, Stage::warp, Stage::fill, Stage::frame));
  EXPECT_EQ(frame.stages.back().begin_ns, frame.stages.front().begin_ns);
}

TEST(Pipeline, ShadingDarkensWhatTurnsAway) {
  config::Content white;
  white.left = "builtin:white";
  const auto plain = make_pipeline(cascade("none", "none"), rig_above_hand(), white);
  white.shading = 1;
  const auto shaded = make_pipeline(cascade("none", "none"), rig_above_hand(), white);
  const auto sum_of = [](Pipeline& pipeline) {
    feed_still(pipeline, {pose_of(Side::left)});
    const Frame frame = pipeline.render(104 * kMs, 108 * kMs, {}, 0);
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
