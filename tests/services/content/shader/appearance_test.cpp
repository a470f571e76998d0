// SPDX-License-Identifier: Apache-2.0
// The look "appearance" against the formulas it states.
#include <algorithm>
#include <cmath>

#include "renderer/base/srgb.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/surface_map.hpp"
#include "tests/scratch.hpp"
#include "tests/services/content/shader/look_stage.hpp"

namespace handcast::content {
namespace {

class AppearanceTest : public LookStage {
 protected:
  static constexpr int kWidth = 320, kHeight = 200;

  void SetUp() override {
    LookStage::SetUp();
    if (IsSkipped()) return;
    source_ = opened(opening_of("look", "appearance", Side::left, kWidth, kHeight));
    pose("open_close", 0.1);
  }
  void set(const std::string& name, const std::string& value) {
    const auto done = source_->set(name, value);
    ASSERT_TRUE(done) << done.error().what;
  }
  /// What becomes of a picture of one colour.
  renderer::Texture seen(std::uint32_t colour) {
    const renderer::Texture picture(kWidth, kHeight, colour);
    const std::array inputs{picture.view()};
    renderer::Texture out(kWidth, kHeight);
    EXPECT_TRUE(source_->draw(moment(Side::left, 0, frame_++), inputs, out));
    return out;
  }
  static double light_of(std::uint32_t texel, int channel) {
    return renderer::srgb_light(level_of(texel, channel) / 255.0);
  }
  /// A photo of paper (its right half: lit by the room alone) above skin.
  std::string photo(std::uint32_t paper, std::uint32_t room, std::uint32_t skin) const {
    renderer::Texture picture(64, 64, skin);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x) picture.at(x, y) = x < 32 ? paper : room;
    const auto file = scratch_.path() / "photo.png";
    EXPECT_TRUE(renderer::write_png(file, std::as_const(picture).view()));
    return file.string();
  }

  std::unique_ptr<Source> source_;
  test::Scratch scratch_;
  std::uint64_t frame_ = 0;
};

TEST_F(AppearanceTest, SkinThatGetsMoreLightIsDimmedToTheReach) {
  const auto picture = seen(0xffffffffu);
  const auto palm = both_[0].joints_m[0];
  const SurfaceMap map(*both_[0].mesh, kWidth, kHeight);
  std::vector<double> dimmed, kept;
  for (const auto& texel : map.texels()) {
    const auto at = texel.of(both_[0].positions_m);
    const double share = -glm::dot(glm::normalize(texel.of(both_[0].normals)), glm::normalize(at)) *
                         glm::dot(palm, palm) / glm::dot(at, at);
    const double light = light_of(picture.pixels()[texel.index], 1);
    if (share > 0.55) dimmed.push_back(std::abs(light * share - 0.5));
    if (share < 0.3) kept.push_back(1 - light);
  }
  ASSERT_GT(dimmed.size(), 1000u);
  ASSERT_GT(kept.size(), 1000u);
  // Near edges of the charts the surface is known less exactly.
  std::ranges::sort(dimmed);
  std::ranges::sort(kept);
  EXPECT_LT(dimmed[dimmed.size() * 97 / 100], 0.01);
  EXPECT_LT(kept[kept.size() * 97 / 100], 0.01);
}

TEST_F(AppearanceTest, WithoutAPhotoAndEvennessThePictureStays) {
  set("evenness", "0");
  const auto picture = seen(0xff4080c0u);
  EXPECT_EQ(std::ranges::count(picture.pixels(), 0xff4080c0u), kWidth * kHeight);
}

// k (p + r) is what it looks like: as grey paper does.
TEST_F(AppearanceTest, APhotoTakesTheSkinAndTheRoomOutOfThePicture) {
  set("evenness", "0");
  set("photo", photo(0xffe6e6e6u, 0xff505050u, 0xff7899c8u));
  set("skin", "0.5,0.2");
  set("paper", "0.2,0.8");
  set("room", "0.8,0.8");
  const double paper = light_of(0xe6, 0), room = light_of(0x50, 0) / (paper - light_of(0x50, 0));
  std::array<double, 3> reflectance{}, whites{}, blacks{};
  for (int i = 0; i < 3; ++i) {
    const auto c = static_cast<std::size_t>(i);
    reflectance[c] = light_of(0xff7899c8u, i) / paper;
    whites[c] = reflectance[c] * (1 + room);
    blacks[c] = reflectance[c] * room;
  }
  const double white = std::ranges::min(whites), black = std::ranges::max(blacks);
  set("lift", "1");
  for (const std::uint32_t colour : {0xffffffffu, 0xff60c0f0u, 0xff000000u}) {
    const auto picture = seen(colour);
    for (int i = 0; i < 3; ++i) {
      const double cast = light_of(picture.at(160, 100), i),
                   looks_like = reflectance[static_cast<std::size_t>(i)] * (cast + room);
      EXPECT_NEAR(looks_like, black + (white - black) * light_of(colour, i), 0.006) << i;
    }
  }
  set("lift", "0");
  EXPECT_EQ(seen(0xff000000u).at(160, 100), 0xff000000u);
  set("compensation", "0");
  EXPECT_EQ(seen(0xff4080c0u).at(160, 100), 0xff4080c0u);
}

}  // namespace
}  // namespace handcast::content
