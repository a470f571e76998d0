// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/services/tools/preview/scenes.hpp"

namespace handcast::preview {
namespace {

using namespace test;

constexpr glm::dvec2 kMiddle(360, 270);  ///< of the image

/// The pixel of the projector that lights a hand at a position of the image.
glm::vec2 lands(const World& in, glm::dvec2 image_px) {
  const auto& [projector, camera] = std::tie(in.calibration.projector, in.calibration.camera);
  return projector.pixel_of(camera.undistort(image_px), kDistance_m);
}

/// A hand that stands still in the middle: the image is bright within 60 px of it.
struct StillHand {
  World seen = world();
  SceneMaker maker{seen};
  msg::Owned<msg::CameraFrame> image = frame();
  msg::Owned<msg::Projection> cast = light();

  explicit StillHand(World in = world()) : seen(std::move(in)) {
    for (int i = 0; i <= 6; ++i) maker.push(poses((980 + 10 * i) * kMs, kMiddle));
    for (int y = 210; y < 330; ++y)
      for (int x = 300; x < 420; ++x) image->pixels()[y * 720 + x] = 200;
  }

  /// The drawing between two positions of the image.
  void draw(glm::dvec2 low, glm::dvec2 high) {
    draw_square(*cast, lands(seen, low), lands(seen, high));
  }
};

Region at(const Scene& scene, int x, int y) { return static_cast<Region>(scene.regions.at(x, y)); }

TEST(Regions, HandAndDrawingMakeFour) {
  StillHand hand;
  hand.draw({260, 240}, {360, 300});
  const auto scene = hand.maker.make(&*hand.image, &*hand.cast);
  ASSERT_EQ(scene.regions.width(), 720);
  EXPECT_EQ(at(scene, 20, 20), Region::background);
  EXPECT_EQ(at(scene, 270, 270), Region::beside) << "drawn, but no hand";
  EXPECT_EQ(at(scene, 390, 270), Region::unlit) << "hand, but not drawn";
  EXPECT_EQ(at(scene, 330, 270), Region::lit);
  std::size_t all = 0;
  for (const auto pixels : scene.region_px) all += pixels;
  EXPECT_EQ(all, 720u * 540u);
  EXPECT_NEAR(static_cast<double>(scene.region_px[1] + scene.region_px[3]), 100 * 60, 200)
      << "the drawing";
}

TEST(Regions, TheLightOfAProjectorBesideTheCameraIsShownWhereItMeetsTheHand) {
  auto beside = world();
  beside.calibration.projector.parallax = {120, 30, 0};  // 80 px at the hand
  StillHand hand(beside);
  hand.draw({300, 210}, {360, 330});
  const auto scene = hand.maker.make(&*hand.image, &*hand.cast);
  EXPECT_EQ(at(scene, 303, 270), Region::lit);
  EXPECT_EQ(at(scene, 357, 270), Region::lit);
  EXPECT_EQ(at(scene, 363, 270), Region::unlit);
  ASSERT_FALSE(scene.drawing.empty());
  for (const auto& [from, to] : scene.drawing)
    for (const auto px : {from, to}) {
      EXPECT_NEAR(std::abs(px.x - 330), 30, 1.5);
      EXPECT_NEAR(std::abs(px.y - 270), 60, 1.5);
    }
}

TEST(Regions, TheDrawnForearmIsNotBesideTheHand) {
  StillHand hand;
  hand.draw({320, 150}, {450, 300});
  const auto scene = hand.maker.make(&*hand.image, &*hand.cast);
  EXPECT_EQ(at(scene, 345, 165), Region::background) << "the forearm, above the wrist";
  EXPECT_EQ(at(scene, 440, 280), Region::beside) << "drawn, but neither hand nor forearm";
  EXPECT_EQ(at(scene, 360, 280), Region::lit);
  EXPECT_LT(scene.region_px[1], 30u * 150u + 20u * 100u) << "less than all that is drawn beside it";
}

TEST(Regions, TheDrawingIsShownAtTheTimeOfTheImage) {
  SceneMaker maker(world());
  for (int i = 0; i <= 6; ++i)
    maker.push(poses((980 + 10 * i) * kMs, kMiddle + glm::dvec2(6 * (i - 2), 0)));
  auto cast = light(1020 * kMs);  // 20 ms, 12 px after the image
  draw_square(*cast, lands(world(), {342, 240}), lands(world(), {402, 300}));
  const auto scene = maker.make(&*frame(), &*cast);
  ASSERT_FALSE(scene.drawing.empty());
  float left = 1e6, right = -1e6;
  for (const auto& [from, to] : scene.drawing) {
    left = std::min({left, from.x, to.x});
    right = std::max({right, from.x, to.x});
  }
  EXPECT_NEAR(left, 330, 1);
  EXPECT_NEAR(right, 390, 1);
}

TEST(Regions, TheLightLiesOverTheImageWhereItLands) {
  StillHand hand;
  const auto scene = hand.maker.make(&*hand.image, &*hand.cast);
  const auto calibration = world().calibration;
  const auto inside = calibration.camera.distort(calibration.projector.camera_pixel_of({132, 132})),
             outside =
                 calibration.camera.distort(calibration.projector.camera_pixel_of({132, 180}));
  ASSERT_GT(inside.x, 0);
  ASSERT_GT(inside.y, 0);
  const auto pixel = [&](glm::dvec2 px) {
    return scene.light_on_camera.at(static_cast<int>(px.x + 0.5), static_cast<int>(px.y + 0.5));
  };
  EXPECT_EQ(pixel(inside), 0xff00ff00u);
  EXPECT_EQ(pixel(outside), 0u);
}

TEST(Regions, OnlyTrianglesThatFaceTheCameraAreDrawn) {
  StillHand hand;
  hand.draw({320, 240}, {360, 300});
  EXPECT_EQ(hand.maker.make(&*hand.image, &*hand.cast).drawing.size(), 5u) << "4 sides, 1 diagonal";
  std::swap(hand.cast->hands[0].landings[1], hand.cast->hands[0].landings[3]);
  EXPECT_TRUE(hand.maker.make(&*hand.image, &*hand.cast).drawing.empty());
}

}  // namespace
}  // namespace handcast::preview
