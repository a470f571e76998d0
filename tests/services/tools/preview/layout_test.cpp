// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/layout/layout.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <set>

#include "services/tools/preview/layout/panels.hpp"

namespace handcast::preview {
namespace {

constexpr auto kInk = Colour::of(0x000000);
constexpr int kSide_px = 100, kScale = 5;
constexpr Box kBox{0, 0, kSide_px* kScale, kSide_px* kScale};

/// A black image with one landmark at (40, 60).
Scene one_landmark(float sigma_px) {
  Scene scene;
  scene.camera = renderer::Image<std::uint8_t>(kSide_px, kSide_px);
  ShownHand hand;
  hand.landmarks[8] = {.px = {40, 60}, .sigma_px = sigma_px};
  scene.hands.push_back(hand);
  return scene;
}

renderer::Texture camera_panel(const Scene& scene, const Layers& layers = Layers().set()) {
  Canvas canvas(kSide_px * kScale, kSide_px * kScale, kInk);
  draw_camera(canvas, kBox, scene, layers);
  return canvas.picture();
}

/// Brightness of the pixel that shows position `px` of the image, moved by `dx` px of the canvas.
int brightness(const renderer::Texture& picture, glm::vec2 px, int dx = 0) {
  const auto pixel = picture.at(static_cast<int>((px.x + 0.5f) * kScale) + dx,
                                static_cast<int>((px.y + 0.5f) * kScale));
  return static_cast<int>((pixel & 255) + (pixel >> 8 & 255) + (pixel >> 16 & 255));
}

TEST(CameraPanel, ALandmarkIsADotInACircleOfThreeSigma) {
  const auto picture = camera_panel(one_landmark(4));
  const int radius_px = 3 * 4 * kScale;
  EXPECT_GT(brightness(picture, {40, 60}), 600);
  EXPECT_GT(brightness(picture, {40, 60}, radius_px), 300);
  EXPECT_GT(brightness(picture, {40, 60}, -radius_px), 300);
  EXPECT_EQ(brightness(picture, {40, 60}, radius_px / 2), 0);
  EXPECT_EQ(brightness(picture, {40, 60}, radius_px + 5), 0);
}

TEST(CameraPanel, ALandmarkOfUnknownSigmaHasNoCircle) {
  const auto picture = camera_panel(one_landmark(0));
  EXPECT_GT(brightness(picture, {40, 60}), 600);
  for (int dx = 6; dx < 100; ++dx) EXPECT_EQ(brightness(picture, {40, 60}, dx), 0);
}

TEST(CameraPanel, TheRegionsHaveFourColours) {
  Scene scene;
  scene.camera = renderer::Image<std::uint8_t>(kSide_px, kSide_px, 100);
  scene.regions = renderer::Image<std::uint8_t>(kSide_px, kSide_px);
  for (int y = 0; y < kSide_px; ++y)
    for (int x = 0; x < kSide_px; ++x)
      scene.regions.at(x, y) = static_cast<std::uint8_t>(x / (kSide_px / 4));
  const auto picture = camera_panel(scene);
  std::set<std::uint32_t> colours;
  for (const int x : {12, 37, 62, 87}) colours.insert(picture.at(x * kScale, 50 * kScale));
  EXPECT_EQ(colours.size(), 4u);
}

TEST(CameraPanel, ARegionHasItsColourInProportionToItsOpacity) {
  Scene scene;
  scene.camera = renderer::Image<std::uint8_t>(kSide_px, kSide_px);  // black
  scene.regions = renderer::Image<std::uint8_t>(kSide_px, kSide_px, 1);
  const auto pixel = camera_panel(scene).at(200, 200);
  const auto& colour = theme::kRegion[1];
  EXPECT_NEAR(pixel & 255, 255 * colour.alpha * colour.red, 2);
  EXPECT_NEAR(pixel >> 8 & 255, 255 * colour.alpha * colour.green, 2);
  EXPECT_NEAR(pixel >> 16 & 255, 255 * colour.alpha * colour.blue, 2);
}

TEST(CameraPanel, OnlyTheChosenLayersAreDrawn) {
  auto scene = one_landmark(0);
  scene.camera = renderer::Image<std::uint8_t>(kSide_px, kSide_px, 200);
  scene.light_on_camera = renderer::Texture(kSide_px, kSide_px, 0xff0000ffu);
  scene.regions = renderer::Image<std::uint8_t>(kSide_px, kSide_px, 3);
  scene.drawing.emplace_back(glm::vec2(10, 10), glm::vec2(30, 10));
  scene.hands[0].joints_px.assign(msg::kJoints, glm::vec2(80, 20));
  const auto pixel = [&](std::string_view layers, glm::vec2 px) {
    return camera_panel(scene, *parse_layers(layers))
        .at(static_cast<int>((px.x + 0.5f) * kScale), static_cast<int>((px.y + 0.5f) * kScale));
  };
  constexpr std::uint32_t kNothing = 0xff000000u;
  for (const auto& [layer, px] :
       {std::pair{"image", glm::vec2(50, 50)}, std::pair{"regions", glm::vec2(50, 50)},
        std::pair{"light", glm::vec2(50, 50)}, std::pair{"drawing", glm::vec2(20, 9.9)},
        std::pair{"joints", glm::vec2(80, 20)}, std::pair{"landmarks", glm::vec2(40, 60)}}) {
    EXPECT_NE(pixel(layer, px), kNothing) << layer;
    for (const auto other : kLayerNames)
      if (other != layer && other != "image" && other != "regions" && other != "light") {
        EXPECT_EQ(pixel(other, glm::vec2(50, 50)), kNothing) << other;
      }
  }
  EXPECT_EQ(pixel("light", {50, 50}), 0xff0000ffu);
}

/// Grey of level 100 that is `share` of a pixel: the level contains the share.
constexpr std::uint32_t edge_of(std::uint32_t share) { return share << 24 | 0x646464u; }
constexpr std::uint32_t kAsLit = 0xff646464u;

TEST(CameraPanel, AnEdgeIsShownAsItIsLitIfItIsAtLeastHalfOfAPixel) {
  Scene scene;
  scene.camera = renderer::Image<std::uint8_t>(kSide_px, kSide_px, 200);
  scene.camera.at(0, 0) = 255;
  scene.light_on_camera = renderer::Texture(kSide_px, kSide_px);
  const auto with_light = [&](std::uint32_t pixel) {
    for (auto& each : scene.light_on_camera.pixels()) each = pixel;
    return camera_panel(scene, *parse_layers("image,light")).at(250, 250);
  };
  const auto image = with_light(0);
  EXPECT_NE(image, kAsLit);
  EXPECT_EQ(with_light(edge_of(255)), kAsLit);
  EXPECT_EQ(with_light(edge_of(128)), kAsLit);
  EXPECT_EQ(with_light(edge_of(127)), image);
  EXPECT_EQ(with_light(edge_of(1)), image);
}

TEST(LightPanel, AnEdgeIsShownAsItIsLitWhateverShareOfThePixelIsHand) {
  const auto grey_pixels = [](std::uint32_t pixel) {
    Scene scene;
    scene.light = renderer::Texture(kSide_px, kSide_px, pixel);
    const auto picture = draw(scene, {}, {.width_px = 1600, .height_px = 900});
    return std::ranges::count(picture.pixels(), kAsLit);
  };
  const auto whole = grey_pixels(edge_of(255));
  EXPECT_GT(whole, 100'000) << "the panel";
  EXPECT_EQ(grey_pixels(edge_of(128)), whole);
  EXPECT_EQ(grey_pixels(edge_of(1)), whole);
  EXPECT_LT(grey_pixels(0), whole / 100) << "no light";
}

TEST(Layout, AnyContentsAtAnySizeGivesAPictureOfThatSize) {
  Gauges gauges{.rig = std::string("\xff\x01 strange"), .ill = {"camera is degraded"}};
  gauges.rates = {{"camera.frames", 0.0, {std::numeric_limits<float>::quiet_NaN(), 1e30f, -5}},
                  {"pose.hands", std::nullopt, {}}};
  gauges.ages = {{"image", {std::numeric_limits<float>::infinity(), 1}}, {"tracker", {}}};
  gauges.stages = {{"fill", -1, std::numeric_limits<double>::quiet_NaN()}, {"draw", 1e300, 1e300}};
  for (const auto& [width, height] :
       {std::pair{320, 320}, std::pair{4000, 320}, std::pair{320, 2000}, std::pair{1600, 900}})
    for (const auto& each : {Gauges{}, gauges}) {
      const auto picture =
          draw(one_landmark(1), each, {.width_px = width, .height_px = height, .help = true});
      EXPECT_EQ(picture.width(), width);
      EXPECT_EQ(picture.height(), height);
    }
}

TEST(Layout, ARigThatIsDownIsDarkAndSaysSo) {
  Scene lit;
  lit.light = renderer::Texture(kSide_px, kSide_px, 0xffffffffu);
  auto down = lit;
  down.is_down = true;
  const auto white = [](const Scene& scene) {
    const auto picture = draw(scene, {}, {.width_px = 1600, .height_px = 900});
    return std::ranges::count(picture.pixels(), 0xffffffffu);
  };
  EXPECT_GT(white(lit), 100'000);
  EXPECT_LT(white(down), 1000) << "marks of the legend";
}

TEST(Layers, ThePictureOnTheHandIsNotHiddenByDefault) {
  EXPECT_EQ(default_layers(), *parse_layers("image,light"));
}

TEST(Layout, AHalfSizedPictureIsTheSamePictureMadeSmaller) {
  const auto large = draw({}, {}, {.width_px = 1400, .height_px = 780}),
             small = draw({}, {}, {.width_px = 700, .height_px = 390});
  for (const auto& [x, y] : {std::pair{100, 100}, std::pair{5, 300}, std::pair{690, 380}})
    EXPECT_EQ(small.at(x, y), large.at(2 * x, 2 * y)) << x << " " << y;
}

TEST(Layout, AbsurdSizesAreLimited) {
  EXPECT_EQ(draw({}, {}, {.width_px = -5, .height_px = 0}).width(), kSmallestSide_px);
}

TEST(Layout, TheGraphOfARateRisesWithTheRate) {
  const auto lit_rows = [](float hz) {
    Canvas canvas(300, 150, kInk);
    draw_rates(canvas, {0, 0, 300, 150}, {.rates = {{"s", 100.0, std::vector<float>(20, hz)}}});
    int rows = 0;
    for (int y = 50; y < 150; ++y) rows += canvas.picture().at(200, y) != 0xff000000u;
    return rows;
  };
  EXPECT_GT(lit_rows(100), lit_rows(50) + 20);
  EXPECT_GT(lit_rows(50), lit_rows(5) + 20);
}

TEST(Layers, ATextNamesThem) {
  EXPECT_EQ(parse_layers("image,joints")->to_ulong(), 0b010001u);
  EXPECT_TRUE(parse_layers("all")->all());
  for (const auto* wrong : {"", "image,", "hands", "image joints", ",", "IMAGE"}) {
    const auto layers = parse_layers(wrong);
    ASSERT_FALSE(layers) << wrong;
    EXPECT_THAT(layers.error().what, testing::HasSubstr("landmarks"));
  }
}

}  // namespace
}  // namespace handcast::preview
