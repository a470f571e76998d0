// SPDX-License-Identifier: Apache-2.0
// Messages that no service of handcast sends: any number may come from a ring.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "services/tools/preview/layout/layout.hpp"
#include "tests/services/tools/preview/scenes.hpp"

namespace handcast::preview {
namespace {

using namespace test;
using testing::IsEmpty;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN(),
                kInfinite = std::numeric_limits<float>::infinity();

TEST(HostileMessages, LandmarksThatCannotBeSeenAreLeftOut) {
  SceneMaker maker(world());
  auto marks = landmarks(kImage_ns, {300, 200});
  auto& points = marks.hands[0].points;
  points[0].x_px = kNotANumber;
  points[1].y_px = -kInfinite;
  points[2].x_px = 1e30f;
  points[3].confidence = kNotANumber;
  points[4].sigma_px = kNotANumber;
  points[5].sigma_px = 1e30f;
  points[6].sigma_px = -3;
  marks.count = 4'000'000'000u;
  maker.push(marks);
  const auto scene = maker.make(&*frame(), nullptr);
  ASSERT_FALSE(scene.hands.empty());
  const auto& shown = scene.hands[0].landmarks;
  for (const std::size_t i : {0, 1, 2, 3}) EXPECT_FALSE(shown[i]) << i;
  for (const std::size_t i : {4, 5, 6}) EXPECT_EQ(shown[i]->sigma_px, 0) << i;
  EXPECT_TRUE(shown[7]);
}

TEST(HostileMessages, PosesThatCannotBeHandsAreLeftOut) {
  SceneMaker maker(world());
  for (const float bad : {kNotANumber, kInfinite, 1e30f, -50.0f}) {
    auto pose = poses(kImage_ns, {300, 200});
    pose.hands[0].joints[9].position_m[1] = bad;
    maker.push(pose);
  }
  auto wrong_side = poses(kImage_ns, {300, 200});
  wrong_side.hands[0].side = static_cast<msg::Side>(77);
  wrong_side.hands[1] = wrong_side.hands[0];
  wrong_side.count = 4'000'000'000u;
  maker.push(wrong_side);
  EXPECT_THAT(maker.make(&*frame(), &*light()).hands, IsEmpty());
}

TEST(HostileMessages, LightWhoseSizeMakesNoSenseIsLeftOutAndSaysSo) {
  SceneMaker maker(world());
  const auto expect_refused = [&](auto spoil) {
    auto cast = light();
    spoil(*cast);
    const auto scene = maker.make(&*frame(), &*cast);
    EXPECT_EQ(scene.light.width(), 0);
    EXPECT_EQ(scene.camera.width(), 720) << "the image is shown all the same";
    EXPECT_THAT(scene.missing, testing::SizeIs(1));
  };
  expect_refused([](auto& cast) { cast.width_px = 0; });
  expect_refused([](auto& cast) { cast.width_px = 4'000'000'000u; });
  expect_refused([](auto& cast) { cast.height_px = 100'000; });
  expect_refused([](auto& cast) { cast.region_x_px = -1; });
  expect_refused([](auto& cast) { cast.region_x_px = 1000; });
  expect_refused([](auto& cast) { cast.region_y_px = std::numeric_limits<std::int32_t>::max(); });
  expect_refused([](auto& cast) { cast.region_width_px = 0xffffffffu; });
  expect_refused([](auto& cast) { cast.region_width_px = cast.region_height_px = 0xffffffffu; });
  expect_refused([](auto& cast) {
    cast.width_px = cast.height_px = 8192;
    cast.region_x_px = cast.region_y_px = 0;
    cast.region_width_px = cast.region_height_px = 8192;
  });
}

TEST(HostileMessages, ALargeProjectorIsNotHostile) {
  SceneMaker maker(world());
  auto cast = light();
  cast->width_px = 3840;
  cast->height_px = 2160;
  EXPECT_THAT(maker.make(&*frame(), &*cast).missing, IsEmpty());
}

TEST(HostileMessages, AnImageWhoseSizeMakesNoSenseIsLeftOut) {
  SceneMaker maker(world());
  for (const std::uint32_t bad : {0u, 100'000u, 0xffffffffu}) {
    auto image = frame();
    image->width_px = bad;
    EXPECT_EQ(maker.make(&*image, nullptr).camera.width(), 0) << bad;
  }
}

TEST(HostileMessages, VerticesThatAreNowhereAreLeftOut) {
  SceneMaker maker(world());
  const auto edges_with = [&](auto spoil) {
    auto cast = light();
    draw_square(*cast, {300, 300}, {340, 340});
    spoil(*cast);
    return maker.make(&*frame(), &*cast).drawing.size();
  };
  EXPECT_EQ(edges_with([](auto&) {}), 5u);
  EXPECT_EQ(edges_with([](auto& cast) { cast.hands[0].landings[1].x_px = kNotANumber; }), 3u);
  EXPECT_EQ(edges_with([](auto& cast) { cast.hands[0].landings[0].y_px = kInfinite; }), 0u);
  EXPECT_EQ(edges_with([](auto& cast) { cast.hands[0].landings[2].x_px = 1e9f; }), 0u);
  EXPECT_EQ(edges_with([](auto& cast) { cast.hands[0].vertex_count = 3; }), 0u)
      << "another mesh than the rig's";
  EXPECT_EQ(edges_with([](auto& cast) { cast.hands[0].vertex_count = 0xffffffffu; }), 0u);
  EXPECT_EQ(edges_with([](auto& cast) { cast.hands[0].side = static_cast<msg::Side>(5); }), 0u);
  EXPECT_EQ(edges_with([](auto& cast) { cast.hand_count = 0xffffffffu; }), 5u);
}

TEST(HostileMessages, TimesAtTheEndOfTheWorldAreNoTrouble) {
  constexpr auto kFirst = std::numeric_limits<std::int64_t>::min(),
                 kLast = std::numeric_limits<std::int64_t>::max();
  SceneMaker maker(world());
  for (const auto time : {kFirst, std::int64_t{0}, kLast}) {
    maker.push(landmarks(kImage_ns, {300, 200}));
    auto marks = landmarks(0, {300, 200});
    marks.header.origin_ns = time;
    maker.push(marks);
    auto pose = poses(kImage_ns, {300, 200});
    maker.push(pose);
    pose.header.origin_ns = pose.header.published_ns = time;
    maker.push(pose);
    auto image = frame();
    image->header.origin_ns = time;
    auto cast = light();
    cast->target_ns = cast->lit_ns = time;
    const auto scene = maker.make(&*image, &*cast);
    EXPECT_EQ(scene.camera.width(), 720);
    EXPECT_EQ(draw(scene, {}, {.width_px = 400, .height_px = 320}).width(), 400);
  }
}

}  // namespace
}  // namespace handcast::preview
