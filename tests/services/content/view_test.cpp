// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "renderer/media/picture.hpp"
#include "services/content/unwrap.hpp"
#include "services/tools/try/projected.hpp"
#include "tests/scratch.hpp"
#include "tests/services/content/touching_hands.hpp"

namespace handcast::content {
namespace {

/// A picture in the plane of the projector, and a hand that the projector sees from behind.
class ViewSourceTest : public testing::Test {
 protected:
  std::string file(const renderer::Texture& picture) const {
    const auto path = scratch_.path() / "picture.png";
    EXPECT_TRUE(renderer::write_png(path, picture.view()));
    return path.string();
  }
  void open(const std::string& what) {
    auto opening = opening_of("view", what, Side::left, out_.width(), out_.height());
    opening.calibration = &calibration_;
    source_ = opened(opening);
  }
  bool draw() {
    const auto drawn = source_->draw(hands_.moment, {}, out_);
    EXPECT_TRUE(drawn) << drawn.error().what;
    hands_.moment.frame += *drawn;
    return *drawn;
  }
  std::uint32_t on(std::size_t vertex) const {
    return texel_at(out_, made_hand(Side::left).uv[vertex]);
  }
  void move(const glm::vec3& by_m) {
    for (auto& at : hands_.positions_m) at += by_m;
  }

  test::Scratch scratch_;
  const calib::Calibration calibration_ = calib::reference_rig();
  /// Its level grows to the right.
  renderer::Texture slope_ = [this] {
    renderer::Texture slope(calibration_.projector.width_px, calibration_.projector.height_px);
    for (int y = 0; y < slope.height(); ++y)
      for (int x = 0; x < slope.width(); ++x)
        slope.at(x, y) = 0xff000000u | static_cast<std::uint32_t>(x / 4) * 0x010101u;
    return slope;
  }();
  TouchingHands hands_;
  std::unique_ptr<Source> source_;
  renderer::Texture out_{640, 400};
};

double pixel_x(const calib::Calibration& calibration, const glm::vec3& at) {
  return viewer_of(calibration).pixel_of(at).x;
}

TEST_F(ViewSourceTest, SkinShowsWhatThePictureHasWhereTheLightFallsOnIt) {
  open(file(slope_));
  EXPECT_TRUE(source_->needs().surface);
  ASSERT_TRUE(draw());
  int seen = 0;
  for (std::size_t v = 0; v < hands_.positions_m.size(); ++v) {
    if (hands_.normals[v].z > -0.8f) continue;
    ++seen;
    EXPECT_NEAR(level_of(on(v), 0), pixel_x(calibration_, hands_.positions_m[v]) / 4, 3) << v;
  }
  EXPECT_GT(seen, 200);
}

// Texture, the projector's image of the hand, texture.
TEST_F(ViewSourceTest, AnImageOfTheHandBecomesItsTextureAgain) {
  renderer::Texture texture(640, 400);
  for (int y = 0; y < 400; ++y)
    for (int x = 0; x < 640; ++x)
      texture.at(x, y) = texel_of({0.5 + 0.4 * std::sin(0.2 * x), 0.5 + 0.4 * std::cos(0.2 * y),
                                   0.5 + 0.4 * std::sin(0.1 * (x + y)), 1});
  open(file(trial::projected(hands_.hand, texture, calibration_)));
  ASSERT_TRUE(draw());
  const SurfaceMap map(made_hand(Side::left), 640, 400);
  double squares = 0;
  int count = 0;
  for (const auto& [which, px] : seen_texels(viewer_of(calibration_), map, hands_.hand, nullptr)) {
    const auto& texel = map.texels()[which];
    if (texel.of(hands_.hand.normals).z > -0.5f) continue;  // seen at an angle
    for (int c = 0; c < 3; ++c) {
      const double off =
          level_of(out_.pixels()[texel.index], c) - level_of(texture.pixels()[texel.index], c);
      squares += off * off;
      ++count;
    }
  }
  const double psnr_db = 10 * std::log10(255 * 255 * count / squares);
  std::printf("%d levels, %.1f dB\n", count, psnr_db);
  EXPECT_GT(count, 60'000);
  EXPECT_GT(psnr_db, 30);
}

TEST_F(ViewSourceTest, SkinWithoutLightGetsTheColoursAroundItAcrossTheSeam) {
  open(file(renderer::Texture(64, 64, 0xff2080c0u)));
  draw();
  const SurfaceMap map(made_hand(Side::left), 640, 400);
  for (const auto& texel : map.texels())
    ASSERT_EQ(out_.pixels()[texel.index], 0xff2080c0u) << texel.index;
  ASSERT_TRUE(source_->set("fill", "false"));
  ASSERT_TRUE(draw());
  EXPECT_EQ(on(hands_.middle(true)), 0xff2080c0u);
  EXPECT_EQ(on(hands_.middle(false)), 0u);
}

TEST_F(ViewSourceTest, ThePictureStaysInTheRoomUntilItIsBaked) {
  open(file(slope_));
  const auto vertex = hands_.middle(true);
  draw();
  const int before = level_of(on(vertex), 0);
  move({0.03f, 0, 0});
  ASSERT_TRUE(draw());
  const int moved = level_of(on(vertex), 0);
  EXPECT_GT(moved, before + 5);
  ASSERT_TRUE(source_->set("bake", "true"));
  move({-0.03f, 0, 0});
  ASSERT_TRUE(draw());
  EXPECT_EQ(level_of(on(vertex), 0), before);
  move({0.03f, 0, 0});
  EXPECT_FALSE(draw());
  EXPECT_EQ(level_of(on(vertex), 0), before);
  ASSERT_TRUE(source_->set("bake", "false"));
  ASSERT_TRUE(draw());
  EXPECT_EQ(level_of(on(vertex), 0), moved);
}

TEST_F(ViewSourceTest, BakingWaitsUntilTheHandHasBeenThereForAWhile) {
  open(file(slope_));
  ASSERT_TRUE(source_->set("bake", "true"));
  ASSERT_TRUE(source_->set("after", "2"));
  for (const double time_s : {0., 1.}) {
    hands_.moment.time_s = time_s;
    EXPECT_TRUE(draw());
  }
  const auto surface = hands_.hand.positions_m;
  hands_.hand.positions_m = {};
  hands_.moment.time_s = 2;
  EXPECT_FALSE(draw());
  hands_.hand.positions_m = surface;
  for (const double time_s : {2.5, 4., 4.5}) {
    hands_.moment.time_s = time_s;
    EXPECT_TRUE(draw()) << time_s;
  }
  hands_.moment.time_s = 5;
  EXPECT_FALSE(draw());
}

TEST_F(ViewSourceTest, WhatLiesBeforeTheHandKeepsTheLightOffIt) {
  open(file(slope_));
  draw();
  const auto vertex = hands_.middle(true);
  const auto before = on(vertex);
  std::vector<glm::vec3> nearer = hands_.positions_m;
  for (auto& at : nearer) at *= 0.8f;
  hands_.other.mesh = &made_hand(Side::left);
  hands_.other.positions_m = nearer;
  move({0.02f, 0, 0});
  draw();
  EXPECT_EQ(on(vertex), before);
}

TEST_F(ViewSourceTest, TheSourceInsideCanBeSet) {
  open("picture:" + file(slope_));
  EXPECT_TRUE(source_->set("fit", "cover"));
  EXPECT_FALSE(source_->set("speed", "2"));
}

TEST_F(ViewSourceTest, OnlyASingleSourceCanBeInside) {
  const auto fault = [](const std::string& what) {
    const auto source = open_source(opening_of("view", what));
    return source ? "" : source.error().what;
  };
  EXPECT_NE(fault("builtin:atlas | builtin:white").find("filters are put behind it"),
            std::string::npos);
  EXPECT_NE(fault("nowhere.png").find("nowhere.png"), std::string::npos);
}

}  // namespace
}  // namespace handcast::content
