// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

#include "renderer/mask/mask.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

/// @file
/// Tests that the mask, which is as old as the camera's image, is moved to the time of the photons.

namespace handcast::renderer {
namespace {

constexpr std::int64_t kExposure_ns = 200 * kMs, kNow_ns = 204 * kMs, kTarget_ns = 212 * kMs;

struct MovingHand {
  Side side;
  glm::vec3 velocity_m_s, at_target_m;

  msg::HandPose at(std::int64_t time_ns) const {
    return pose_of(
        side, at_target_m + velocity_m_s * static_cast<float>(
                                               static_cast<double>(time_ns - kTarget_ns) * 1e-9));
  }
};

/// Hands at a time, as messages and as the camera's image. At most two hands, which do not overlap.
struct AdvanceScene {
  calib::Calibration calibration = rig_above_hand();
  std::vector<MovingHand> hands;

  msg::HandPoses poses(std::int64_t time_ns) const {
    msg::HandPoses all;
    all.header.origin_ns = time_ns;
    for (const MovingHand& hand : hands) all.hands[all.count++] = hand.at(time_ns);
    return all;
  }
  Image<std::uint8_t> image(std::int64_t time_ns) const {
    return hands.size() == 1 ? image_of(calibration, {hands[0].at(time_ns)})
                             : image_of(calibration, {hands[0].at(time_ns), hands[1].at(time_ns)});
  }
};

using Pixels = Image<std::uint32_t>;  ///< projector pixels, 0 if less than half of it is lit

Pixels light_of(const AdvanceScene& scene, bool advance) {
  config::Cascade settings;
  settings.correct.method = config::CorrectMethod::none;
  settings.mask.advance = advance;
  const auto pipeline = Pipeline::create(settings, {}, {}, scene.calibration);
  if (!pipeline) throw std::runtime_error(pipeline.error().what);
  for (std::int64_t t = kNow_ns - 180 * kMs; t <= kNow_ns; t += 9 * kMs)
    (*pipeline)->push(t, scene.poses(t));
  const auto image = scene.image(kExposure_ns);
  const Frame frame = (*pipeline)->render(kNow_ns, kTarget_ns, {image.view(), kExposure_ns});
  Pixels light(scene.calibration.projector.width_px, scene.calibration.projector.height_px);
  for (int y = frame.region.y0; y < frame.region.y1; ++y)
    for (int x = frame.region.x0; x < frame.region.x1; ++x)
      if (frame.colour.at(x, y) >> 24 >= 128) light.at(x, y) = frame.colour.at(x, y);
  return light;
}

/// The hands at the time of the photons.
Pixels truth_of(const AdvanceScene& scene) {
  const auto image = scene.image(kTarget_ns);
  Image<std::uint8_t> grey(scene.calibration.projector.width_px,
                           scene.calibration.projector.height_px);
  CameraLookup(scene.calibration)
      .resample(image.view(), {0, 0, grey.width(), grey.height()}, grey.view());
  Pixels truth(grey.width(), grey.height());
  for (std::size_t i = 0; i < grey.pixels().size(); ++i) truth.pixels()[i] = grey.pixels()[i] > 100;
  return truth;
}

/// Projector row of the wrist at the target time. Below it is the arm, which gets no light.
int wrist_row(const AdvanceScene& scene) {
  const auto [x, y, z] = scene.hands[0].at(kTarget_ns).joints[1].position_m;
  return static_cast<int>(
      scene.calibration.projector
          .pixel_of(scene.calibration.camera.project(in_camera(scene.calibration, {x, y, z})))
          .y);
}

/// Centroid of the lit pixels in [x0, x1) x [0, y1).
glm::dvec2 centroid(const Pixels& pixels, int x0, int x1, int y1) {
  glm::dvec2 sum{0};
  double count = 0;
  for (int y = 0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (pixels.at(x, y)) {
        sum += glm::dvec2(x, y);
        ++count;
      }
  return sum / count;
}

int lit_aside(const Pixels& light, const Pixels& truth, int y1) {
  int count = 0;
  for (int y = 0; y < y1; ++y)
    for (int x = 0; x < light.width(); ++x) count += light.at(x, y) && !truth.at(x, y);
  return count;
}

class MaskAdvance : public ::testing::TestWithParam<Side> {};
INSTANTIATE_TEST_SUITE_P(Sides, MaskAdvance, ::testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "Left" : "Right";
                         });

TEST_P(MaskAdvance, TheLightOfAMovingHandIsWhereTheHandWillBe) {
  for (const glm::vec3 velocity_m_s :
       {glm::vec3(0.8f, 0, 0), glm::vec3(-0.8f, 0, 0), glm::vec3(0.3f, 0, 0.6f)}) {
    const AdvanceScene scene{.hands = {{GetParam(), velocity_m_s, {}}}};
    const Pixels with = light_of(scene, true), without = light_of(scene, false),
                 truth = truth_of(scene);
    const int last_row = wrist_row(scene);
    const glm::dvec2 true_px = centroid(truth, 0, truth.width(), last_row);
    const double off_with_px = glm::distance(centroid(with, 0, with.width(), last_row), true_px);
    const double off_without_px =
        glm::distance(centroid(without, 0, with.width(), last_row), true_px);
    EXPECT_LT(off_with_px, 1);
    EXPECT_GT(off_without_px, 10);
    EXPECT_LT(lit_aside(with, truth, last_row), lit_aside(without, truth, last_row) / 10);
  }
}

TEST_P(MaskAdvance, AtTheImagesEdgeItMovesAsTheLensShowsIt) {
  for (const float way : {-1.0f, 1.0f}) {
    const AdvanceScene scene{.hands = {{GetParam(), {1.5f * way, 0, 0}, {0.09f * way, 0, 0}}}};
    const Pixels with = light_of(scene, true), truth = truth_of(scene);
    const int last_row = wrist_row(scene);
    EXPECT_LT(glm::distance(centroid(with, 0, with.width(), last_row),
                            centroid(truth, 0, truth.width(), last_row)),
              1)
        << way;
  }
}

TEST_P(MaskAdvance, AStillHandGetsTheSameLight) {
  const AdvanceScene scene{.hands = {{GetParam(), {}, {0.02f, 0, 0}}}};
  const Pixels with = light_of(scene, true), without = light_of(scene, false);
  int lit = 0, other = 0;
  for (std::size_t i = 0; i < with.pixels().size(); ++i) {
    lit += with.pixels()[i] != 0;
    other += with.pixels()[i] != without.pixels()[i];
  }
  EXPECT_GT(lit, 20000);
  EXPECT_LE(other, 5);  // rounding at the edges of camera pixels
}

TEST(TwoMasks, EachHandsMaskMovesWithItsOwnHand) {
  const AdvanceScene scene{.hands = {{Side::left, {-0.5f, 0, 0}, {-0.09f, 0, 0}},
                                     {Side::right, {0.5f, 0, 0}, {0.09f, 0, 0}}}};
  const Pixels with = light_of(scene, true), without = light_of(scene, false),
               truth = truth_of(scene);
  const int last_row = wrist_row(scene), middle = truth.width() / 2;
  for (const auto& [x0, x1] : {std::pair(0, middle), std::pair(middle, truth.width())}) {
    const glm::dvec2 true_px = centroid(truth, x0, x1, last_row);
    const double off_with_px = glm::distance(centroid(with, x0, x1, last_row), true_px);
    const double off_without_px = glm::distance(centroid(without, x0, x1, last_row), true_px);
    EXPECT_LT(off_with_px, 1) << x0;
    EXPECT_GT(off_without_px, 10) << x0;
  }
}

}  // namespace
}  // namespace handcast::renderer
