// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/services/content/touching_hands.hpp"

namespace handcast::content {
namespace {

/// A camera that sees a hand, in an image whose level grows to the right.
class HandSourceTest : public testing::Test {
 protected:
  HandSourceTest() {
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        image.at(x, y) = static_cast<std::uint8_t>(255 * x / image.width());
    view.image = {image.view(), 1, 1};
    view.lens = &calibration.camera;
    view.hand = &hands.hand;
    view.other = &hands.other;
    hands.moment.camera = &view;
  }
  bool draw() {
    const auto drawn = source->draw(hands.moment, {}, out);
    EXPECT_TRUE(drawn) << drawn.error().what;
    ++hands.moment.frame;
    return *drawn;
  }
  std::uint32_t on(std::size_t vertex) const {
    return texel_at(out, made_hand(Side::left).uv[vertex]);
  }
  double column_of(std::size_t vertex) const {
    return calibration.camera.distort(calibration.camera.project(hands.positions_m[vertex])).x;
  }

  calib::Calibration calibration = calib::reference_rig();
  renderer::Image<std::uint8_t> image{calibration.camera.width_px, calibration.camera.height_px};
  TouchingHands hands;
  CameraView view;
  std::unique_ptr<Source> source = opened(opening_of("hand", {}, Side::left, 640, 400));
  renderer::Texture out{640, 400};
};

TEST_F(HandSourceTest, TheBackShowsWhatTheCameraSeesThere) {
  EXPECT_TRUE(source->needs().camera);
  ASSERT_TRUE(draw());
  int seen = 0;
  for (std::size_t v = 0; v < hands.positions_m.size(); ++v) {
    if (hands.normals[v].z > -0.8f || on(v) == 0) continue;
    ++seen;
    EXPECT_EQ(alpha_of(on(v)), 255);
    EXPECT_NEAR(level_of(on(v), 0), 255 * column_of(v) / image.width(), 3) << v;
  }
  EXPECT_GT(seen, 200);
}

TEST_F(HandSourceTest, ThePalmWasNeverSeenAndIsTransparent) {
  draw();
  EXPECT_EQ(on(hands.middle(false)), 0u);
}

TEST_F(HandSourceTest, AnImageIsTakenOnce) {
  draw();
  EXPECT_FALSE(draw());
  ++view.image.id;
  EXPECT_TRUE(draw());
  hands.moment.camera = nullptr;
  EXPECT_FALSE(draw());
}

TEST_F(HandSourceTest, WhatIsHiddenNowStaysAsItWasSeenLast) {
  draw();
  const auto vertex = hands.middle(true);
  const auto before = on(vertex);
  // The other hand comes between, and the image goes dark.
  std::vector<glm::vec3> nearer = hands.positions_m;
  for (auto& at : nearer) at *= 0.8f;
  hands.other.mesh = &made_hand(Side::left);
  hands.other.positions_m = nearer;
  std::ranges::fill(image.pixels(), std::uint8_t{0});
  ++view.image.id;
  draw();
  EXPECT_EQ(on(vertex), before);
  hands.other.positions_m = {};
  ++view.image.id;
  draw();
  EXPECT_EQ(on(vertex), 0xff000000u);
}

TEST_F(HandSourceTest, AHandBesideTheImageIsNotRead) {
  for (auto& at : hands.positions_m) at.x += 5;
  EXPECT_TRUE(draw());
  EXPECT_TRUE(std::ranges::all_of(out.pixels(), [](auto texel) { return texel == 0; }));
}

TEST_F(HandSourceTest, LevelsAreRaisedAndTinted) {
  std::ranges::fill(image.pixels(), std::uint8_t{50});
  ASSERT_TRUE(source->set("gain", "2"));
  ASSERT_TRUE(source->set("colour", "#ff0000"));
  draw();
  EXPECT_EQ(on(hands.middle(true)), 0xff000064u);
}

}  // namespace
}  // namespace handcast::content
