// SPDX-License-Identifier: Apache-2.0
// The look "light" against the formulas it states.
#include <algorithm>
#include <cmath>

#include "services/content/surface_map.hpp"
#include "tests/services/content/shader/look_stage.hpp"

namespace handcast::content {
namespace {

constexpr int kWidth = 640, kHeight = 400;

class LightTest : public LookStage {
 protected:
  struct Place {
    std::uint32_t index;
    glm::vec3 at_m, normal;
  };

  void SetUp() override {
    LookStage::SetUp();
    if (IsSkipped()) return;
    source_ = opened(opening_of("look", "light", Side::left, kWidth, kHeight));
    set({{"kind", "directional"}, {"x", "0"}, {"y", "0"}, {"z", "-1"}, {"colour", "#ffffff"}});
    set({{"strength", "1"}, {"ambient", "0"}, {"specular", "0"}, {"relief", "0"}});
    set({{"shadows", "0"}, {"rim", "0"}});
  }

  void set(const std::vector<std::pair<std::string, std::string>>& values) {
    for (const auto& [name, value] : values) {
      const auto done = source_->set(name, value);
      EXPECT_TRUE(done) << done.error().what;
    }
  }
  /// Where the texels are in camera space.
  std::vector<Place> places() const {
    const auto& hand = both_[0];
    const SurfaceMap map(*hand.mesh, kWidth, kHeight);
    std::vector<Place> all;
    for (const auto& texel : map.texels())
      all.push_back(
          {texel.index, texel.of(hand.positions_m), glm::normalize(texel.of(hand.normals))});
    return all;
  }
  /// The light on a picture of one colour, 0..1, of a channel.
  std::vector<double> lit(std::uint32_t colour = 0xffffffffu) {
    const renderer::Texture picture(kWidth, kHeight, colour);
    const std::array inputs{picture.view()};
    renderer::Texture out(kWidth, kHeight);
    EXPECT_TRUE(source_->draw(moment(Side::left, 0, 0), inputs, out));
    std::vector<double> levels;
    for (const auto texel : out.pixels()) levels.push_back(level_of(texel, 0) / 255.0);
    return levels;
  }

  /// The surface is known at half the size of the picture: near edges of its charts, and where
  /// triangles of the mesh meet at an angle, the light is that of some tenths of a mm beside.
  static void expect_small(std::vector<double> errors) {
    ASSERT_GT(errors.size(), 1000u);
    for (double& error : errors) error = std::abs(error);
    std::ranges::sort(errors);
    EXPECT_LT(errors[errors.size() * 96 / 100], 0.008);
    EXPECT_LT(errors.back(), 0.15);
  }

  std::unique_ptr<Source> source_;
};

TEST_F(LightTest, DiffuseLightIsTheCosineOfItsAngle) {
  pose("open_close", 0.1);
  const auto levels = lit(0xff808080u);
  std::vector<double> facing, away;
  for (const auto& place : places()) {
    const double cosine = -place.normal.z;
    if (cosine > 0.12) facing.push_back(levels[place.index] - cosine * 128 / 255);
    if (cosine < -0.05) away.push_back(levels[place.index]);
  }
  expect_small(facing);
  expect_small(away);
}

TEST_F(LightTest, APointLightShinesFromItsPlace) {
  pose("open_close", 0.1);
  set({{"kind", "point"}, {"x", "0.2"}, {"y", "-0.1"}, {"z", "0.3"}, {"ambient", "0.1"}});
  const auto levels = lit(0xff808080u);
  std::vector<double> errors;
  for (const auto& place : places()) {
    const double cosine =
        glm::dot(place.normal, glm::normalize(glm::vec3(0.2f, -0.1f, 0.3f) - place.at_m));
    if (cosine > 0.12) errors.push_back(levels[place.index] - (0.1 + cosine) * 128 / 255);
  }
  expect_small(errors);
}

// Where the surface faces light and viewer, D = 1 / (pi a^2), V = 1/4, F = 0.04, and the light is
// specular * pi * D * V * F = 0.16 for roughness 0.5, a = roughness^2.
TEST_F(LightTest, GlossOfASurfaceThatFacesTheLightIsGgx) {
  pose("open_close", 0.1);
  set({{"kind", "projector"}, {"specular", "1"}, {"roughness", "0.5"}});
  const auto levels = lit(0xff000000u);
  int count = 0;
  for (const auto& place : places()) {
    const bool is_on_arm = glm::distance(place.at_m, both_[0].joints_m[12]) > 0.07f;
    if (is_on_arm || glm::dot(place.normal, glm::normalize(-place.at_m)) < 0.9995) continue;
    ++count;
    ASSERT_NEAR(levels[place.index], 0.04 * 0.25 / std::pow(0.5, 4), 0.01);
  }
  EXPECT_GT(count, 10);
}

TEST_F(LightTest, AFistShadowsThePalmAndAnOpenHandDoesNot) {
  const auto light_in_the_palm = [&](double seconds) {
    const auto& hand = pose("fist", seconds)[0];
    // Light from in front of the palm.
    for (const auto& [name, value] :
         {std::pair{"x", hand.palm_normal.x}, {"y", hand.palm_normal.y}, {"z", hand.palm_normal.z}})
      set({{name, std::to_string(value)}});
    set({{"shadows", "0"}});
    const auto without = lit();
    set({{"shadows", "1"}});
    const auto with = lit();
    double all = 0, left = 0;
    for (const auto& place : places()) {
      const bool faces = glm::dot(place.normal, hand.palm_normal) > 0.7f;
      const auto middle = 0.5f * (hand.joints_m[0] + hand.joints_m[12]);
      if (!faces || glm::distance(place.at_m, middle) > 0.03f) continue;
      all += without[place.index];
      left += with[place.index];
    }
    EXPECT_GT(all, 10);
    return left / all;
  };
  double open_s = 0, closed_s = 0, least = 2, most = -1;
  for (double now = 0; now < 6; now += 0.25) {
    const float curl = pose("fist", now)[0].curl;
    if (curl < least) least = curl, open_s = now;
    if (curl > most) most = curl, closed_s = now;
  }
  ASSERT_GT(most, 0.8);
  EXPECT_GT(light_in_the_palm(open_s), 0.9);
  EXPECT_LT(light_in_the_palm(closed_s), 0.5);
}

TEST_F(LightTest, WithoutAHandThePictureStaysAsItIs) {
  both_ = Hands::load({}, GesturingHands("show").calibration())->at(GesturingHands::ns(1));
  for (const double level : lit(0xff808080u)) ASSERT_EQ(level, 128 / 255.0);
}

}  // namespace
}  // namespace handcast::content
