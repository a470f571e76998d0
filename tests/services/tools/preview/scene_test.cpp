// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/services/tools/preview/scenes.hpp"

namespace handcast::preview {
namespace {

using namespace test;
using testing::IsEmpty;
using testing::SizeIs;

/// A hand that is at `from` px at 980 ms and moves by `step` px in 10 ms, for 60 ms.
void track(SceneMaker& maker, glm::dvec2 from, glm::dvec2 step) {
  for (int i = 0; i <= 6; ++i)
    maker.push(poses((980 + 10 * i) * kMs, from + static_cast<double>(i) * step));
}

TEST(Scene, ALandmarkIsShownWhereTheDetectorSawIt) {
  SceneMaker maker(world());
  maker.push(landmarks(kImage_ns, {300, 200}, 2.5f));
  const auto scene = maker.make(&*frame(), nullptr);
  ASSERT_THAT(scene.hands, SizeIs(1));
  const auto seen = world().calibration.camera.distort({300, 200});
  ASSERT_TRUE(scene.hands[0].landmarks[8]);
  EXPECT_NEAR(scene.hands[0].landmarks[8]->px.x, seen.x, 0.01);
  EXPECT_NEAR(scene.hands[0].landmarks[8]->px.y, seen.y, 0.01);
  EXPECT_EQ(scene.hands[0].landmarks[8]->sigma_px, 2.5f);
}

TEST(Scene, ALandmarkOfAnOlderImageMovesAsTheTrackerDid) {
  SceneMaker maker(world());
  track(maker, {300, 250}, {6, 0});
  maker.push(landmarks(980 * kMs, {310, 260}));
  const auto scene = maker.make(&*frame(), nullptr);
  ASSERT_THAT(scene.hands, SizeIs(1));
  const auto seen = world().calibration.camera.distort({310, 260});
  EXPECT_NEAR(scene.hands[0].landmarks[8]->px.x, seen.x + 12, 1.0) << "20 ms, 6 px in 10 ms";
  EXPECT_NEAR(scene.hands[0].landmarks[8]->px.y, seen.y, 1.0);
}

TEST(Scene, JointsAreThoseOfTheTimeOfTheImage) {
  SceneMaker maker(world());
  track(maker, {300, 250}, {6, 0});
  const auto scene = maker.make(&*frame(995 * kMs), nullptr);
  ASSERT_THAT(scene.hands, SizeIs(1));
  ASSERT_THAT(scene.hands[0].joints_px, SizeIs(msg::kJoints));
  EXPECT_NEAR(scene.hands[0].joints_px[12].x, 309, 0.5) << "1.5 steps";
  EXPECT_NEAR(scene.hands[0].joints_px[12].y, 250, 0.5);
}

TEST(Scene, NothingIsDrawnOnAnImageOfAnotherCalibration) {
  auto ours = world();
  ours.calibration.id = 5;
  SceneMaker maker(ours);
  maker.push(landmarks(kImage_ns, {300, 200}, 2.5f));
  auto image = frame();
  image->calibration = 6;
  const auto scene = maker.make(&*image, nullptr);
  EXPECT_EQ(scene.camera.width(), 720) << "the image itself is shown";
  EXPECT_THAT(scene.hands, IsEmpty());
  EXPECT_THAT(scene.missing, SizeIs(1));
  image->calibration = 5;
  EXPECT_THAT(maker.make(&*image, nullptr).hands, SizeIs(1));
}

TEST(Scene, ARigWithoutHandsShowsImageAndLight) {
  SceneMaker maker(world());
  const auto scene = maker.make(&*frame(), &*light());
  EXPECT_EQ(scene.camera.at(5, 5), 10);
  EXPECT_EQ(scene.image_id, 7u);
  EXPECT_EQ(scene.light_id, 9u);
  EXPECT_EQ(scene.light.width(), 1024);
  EXPECT_EQ(scene.light.at(99, 100), 0u);
  EXPECT_EQ(scene.light.at(100, 100), 0xff00ff00u);
  EXPECT_EQ(scene.light.at(163, 163), 0xff00ff00u);
  EXPECT_EQ(scene.light.at(164, 163), 0u);
  EXPECT_THAT(scene.hands, IsEmpty());
  EXPECT_THAT(scene.drawing, IsEmpty());
  EXPECT_EQ(scene.regions.width(), 0) << "no hand is expected, so there is no mask";
  EXPECT_THAT(scene.missing, IsEmpty());
}

TEST(Scene, TheLightIsAsBrightAsTheProjectorMakesIt) {
  auto dim = world();
  dim.brightness = 0.5;
  EXPECT_EQ(SceneMaker(dim).make(nullptr, &*light()).light.at(120, 120), 0xff00bc00u)
      << "half of the light is the level 188";
  dim.brightness = 0;
  const auto dark = SceneMaker(dim).make(&*frame(), &*light());
  EXPECT_TRUE(std::ranges::all_of(dark.light.pixels(), [](auto pixel) { return pixel == 0; }));
  EXPECT_TRUE(
      std::ranges::all_of(dark.light_on_camera.pixels(), [](auto pixel) { return pixel == 0; }));
}

TEST(Scene, BeforeTheFirstMessageItIsEmpty) {
  SceneMaker maker(world());
  const auto scene = maker.make(nullptr, nullptr);
  EXPECT_EQ(scene.camera.width(), 0);
  EXPECT_EQ(scene.light.width(), 0);
  EXPECT_THAT(scene.hands, IsEmpty());
}

TEST(Scene, WithoutACalibrationImagesAreShownAlone) {
  SceneMaker maker(std::nullopt);
  track(maker, {300, 250}, {0, 0});
  maker.push(landmarks(kImage_ns, {300, 200}));
  const auto scene = maker.make(&*frame(), &*light());
  EXPECT_EQ(scene.camera.width(), 720);
  EXPECT_EQ(scene.light.width(), 1024);
  EXPECT_THAT(scene.hands, IsEmpty());
}

TEST(Scene, AnImageOfAnotherSizeIsShownAloneAndSaysSo) {
  SceneMaker maker(world());
  maker.push(landmarks(kImage_ns, {30, 20}));
  auto small = frame();
  small->width_px = 100;
  small->height_px = 50;
  const auto scene = maker.make(&*small, &*light());
  EXPECT_EQ(scene.camera.width(), 100);
  EXPECT_THAT(scene.hands, IsEmpty());
  ASSERT_THAT(scene.missing, SizeIs(1));
  EXPECT_THAT(scene.missing[0], testing::HasSubstr("100x50 px"));
}

}  // namespace
}  // namespace handcast::preview
