// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/mask.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace handcast::renderer {
namespace {

constexpr int kWidth = 720, kHeight = 540;

/// A hand of capsules, fingers up. Its forearm leaves the image at the bottom.
struct Scene {
  Image<std::uint8_t> image{kWidth, kHeight, 8};
  Image<std::uint8_t> mask{kWidth, kHeight, 0};
  std::vector<std::vector<glm::vec2>> seeds;
  std::vector<HandHint> hints;

  void capsule(glm::vec2 a, glm::vec2 b, float radius, std::uint8_t grey) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const glm::vec2 v(x, y), ab = b - a;
        const float t = std::clamp(glm::dot(v - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
        if (glm::distance(v, a + t * ab) < radius) image.at(x, y) = std::max(image.at(x, y), grey);
      }
  }

  /// Adds a hand; `wrist` is the middle of its wrist.
  void hand(glm::vec2 wrist, std::uint8_t grey = 150, glm::vec2 forearm = {0, 300}) {
    seeds.reserve(4);
    auto& joints = seeds.emplace_back();
    capsule(wrist - glm::vec2(0, 30), wrist - glm::vec2(0, 50), 36, grey);
    for (int finger = 0; finger < 4; ++finger) {
      const glm::vec2 knuckle = wrist + glm::vec2(-30 + 20 * finger, -75);
      capsule(knuckle, knuckle - glm::vec2(0, 70), 8, grey);
      for (const float along : {0.0f, 35.0f, 65.0f})
        joints.push_back(knuckle - glm::vec2(0, along));
    }
    capsule(wrist, wrist + forearm, 26, grey);
    hints.push_back({{static_cast<int>(wrist.x) - 90, static_cast<int>(wrist.y) - 190,
                      static_cast<int>(wrist.x) + 90, static_cast<int>(wrist.y) + 70},
                     wrist,
                     glm::normalize(forearm),
                     joints});
  }

  Rect find(MaskFinder& finder) { return finder.find(image.view(), hints, mask.view()); }
  bool lit(float x, float y) const {
    return mask.at(static_cast<int>(x), static_cast<int>(y)) == 255;
  }
  int area() const {
    return static_cast<int>(std::count(mask.pixels().begin(), mask.pixels().end(), 255));
  }
};

TEST(MaskFinder, TheHandIsFoundAndTheArmCutOff) {
  Scene scene;
  scene.hand({360, 400});
  MaskFinder finder({});
  const Rect region = scene.find(finder);
  EXPECT_EQ(region.y0, 210);
  EXPECT_TRUE(scene.lit(360, 340));   // palm
  EXPECT_TRUE(scene.lit(330, 260));   // little finger
  EXPECT_TRUE(scene.lit(360, 398));   // above the line at the wrist
  EXPECT_FALSE(scene.lit(360, 403));  // below it: arm
  EXPECT_FALSE(scene.lit(360, 460));
  EXPECT_FALSE(scene.lit(300, 260));  // background
  EXPECT_GT(finder.threshold(), 20);
  EXPECT_LT(finder.threshold(), 140);
}

TEST(MaskFinder, NothingOutsideTheRegionIsWritten) {
  Scene scene;
  scene.hand({360, 400});
  std::fill(scene.mask.pixels().begin(), scene.mask.pixels().end(), 77);
  MaskFinder finder({});
  const Rect region = scene.find(finder);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1;
      ASSERT_EQ(scene.mask.at(x, y) == 77, !inside) << x << ' ' << y;
    }
}

TEST(MaskFinder, WithoutHintsNothingIsHand) {
  Scene scene;
  scene.hand({360, 400});
  scene.hints.clear();
  MaskFinder finder({});
  EXPECT_TRUE(scene.find(finder).empty());
}

TEST(MaskFinder, ADarkImageHoldsNoHand) {
  Scene scene;
  scene.hand({360, 400}, 9);
  std::mt19937 random(1);
  for (auto& pixel : scene.image.pixels()) pixel = static_cast<std::uint8_t>(pixel + random() % 6);
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_EQ(scene.area(), 0);
}

TEST(MaskFinder, ADimHandIsStillFound) {
  Scene scene;
  scene.hand({360, 400}, 45);
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(360, 340));
  EXPECT_FALSE(scene.lit(300, 260));
}

TEST(MaskFinder, ASaturatedHandOnABrightGroundIsFound) {
  Scene scene;
  std::fill(scene.image.pixels().begin(), scene.image.pixels().end(), 120);
  scene.hand({360, 400}, 255);
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(360, 340));
  EXPECT_FALSE(scene.lit(300, 260));
}

TEST(MaskFinder, AWhollyBrightImageIsAllHandUpToTheWrist) {
  Scene scene;
  scene.hand({360, 400});
  std::fill(scene.image.pixels().begin(), scene.image.pixels().end(), 250);
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(300, 260));
  EXPECT_FALSE(scene.lit(360, 420));
}

TEST(MaskFinder, AFixedThresholdIsUsedAsItIs) {
  Scene scene;
  scene.hand({360, 400}, 150);
  config::Mask settings;
  settings.threshold = 160;
  MaskFinder finder(settings);
  scene.find(finder);
  EXPECT_EQ(finder.threshold(), 160);
  EXPECT_EQ(scene.area(), 0);
}

TEST(MaskFinder, SpecksAndOtherBrightThingsAreNotHand) {
  Scene scene;
  scene.hand({360, 400});
  scene.capsule({285, 230}, {300, 240}, 6, 200);
  std::mt19937 random(2);
  for (int n = 0; n < 3000; ++n) scene.image.at(random() % kWidth, random() % kHeight) = 230;
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_FALSE(scene.lit(290, 234));
  int specks = 0;
  for (int y = 215; y < 320; ++y)
    for (int x = 275; x < 315; ++x) specks += scene.lit(x, y);
  EXPECT_EQ(specks, 0);
  EXPECT_TRUE(scene.lit(360, 340));
}

TEST(MaskFinder, AFingerCutOffByADarkBandStillBelongs) {
  Scene scene;
  scene.hand({360, 400});
  for (int y = 290; y < 294; ++y)
    for (int x = 300; x < 420; ++x) scene.image.at(x, y) = 8;
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(330, 270));
}

TEST(MaskFinder, SeedsBesideTheHandFindTheLargestThing) {
  Scene scene;
  scene.hand({360, 400});
  const std::vector<glm::vec2> wrong{{290, 230}, {285, 250}};
  scene.hints[0].inside_px = wrong;
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(360, 340));
}

TEST(MaskFinder, AHandThatLeavesTheImageKeepsWhatIsSeen) {
  Scene scene;
  scene.hand({700, 120});
  MaskFinder finder({});
  const Rect region = scene.find(finder);
  EXPECT_EQ(region.x1, kWidth);
  EXPECT_EQ(region.y0, 0);
  EXPECT_TRUE(scene.lit(700, 60));
  EXPECT_FALSE(scene.lit(700, 130));
}

TEST(MaskFinder, AHandOutsideTheImageHasNoMask) {
  Scene scene;
  scene.hand({360, 400});
  scene.hints[0].region = {800, 100, 900, 300};
  MaskFinder finder({});
  EXPECT_TRUE(scene.find(finder).empty());
}

TEST(MaskFinder, TwoHandsAreFoundAndOneArmsLineDoesNotCutTheOtherHand) {
  Scene scene;
  scene.hand({260, 250});
  scene.hand({430, 420});  // its fingers are beyond the other hand's wrist
  scene.hints[0].region = {150, 40, 340, 330};
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(260, 190));
  EXPECT_FALSE(scene.lit(260, 270));
  EXPECT_TRUE(scene.lit(430, 360));
  EXPECT_TRUE(scene.lit(400, 300));
  EXPECT_FALSE(scene.lit(430, 440));
}

TEST(MaskFinder, EachHandHasItsOwnTightBounds) {
  Scene scene;
  scene.hand({200, 400});
  scene.hand({500, 380});
  MaskFinder finder({});
  scene.find(finder);
  for (const std::size_t hand : {0, 1}) {
    Rect lit;
    for (int y = 0; y < scene.mask.height(); ++y)
      for (int x = hand == 0 ? 0 : 350; x < (hand == 0 ? 350 : scene.mask.width()); ++x)
        if (scene.lit(x, y)) lit = lit.joined({x, y, x + 1, y + 1});
    const Rect bounds = finder.hand_bounds(hand);
    EXPECT_GT(lit.width(), 40);
    EXPECT_EQ(bounds.x0, lit.x0);
    EXPECT_EQ(bounds.x1, lit.x1);
    EXPECT_EQ(bounds.y0, lit.y0);
    EXPECT_EQ(bounds.y1, lit.y1);
  }
  EXPECT_TRUE(finder.hand_bounds(2).empty());
  scene.hints.clear();
  scene.find(finder);
  EXPECT_TRUE(finder.hand_bounds(0).empty());
}

TEST(MaskFinder, FingersCurledBackOverTheWristAreKept) {
  Scene scene;
  scene.hand({360, 400});
  scene.capsule({360, 390}, {360, 425}, 8, 220);
  scene.seeds[0].push_back({360, 422});
  scene.hints[0].inside_px = scene.seeds[0];
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(360, 422));
  EXPECT_FALSE(scene.lit(360, 450));
}

TEST(MaskFinder, ASlantingForearmIsCutAcrossItsOwnDirection) {
  Scene scene;
  scene.hand({360, 400}, 150, {180, 180});
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_FALSE(scene.lit(385, 425));
  EXPECT_FALSE(scene.lit(405, 445));
  EXPECT_TRUE(scene.lit(355, 392));
}

TEST(MaskFinder, TheThresholdDoesNotFlickerWithNoise) {
  MaskFinder finder({});
  std::mt19937 random(3);
  int least = 255, most = 0;
  for (int frame = 0; frame < 12; ++frame) {
    Scene scene;
    scene.hand({360, 400});
    for (auto& pixel : scene.image.pixels())
      pixel = static_cast<std::uint8_t>(pixel + random() % 12);
    scene.find(finder);
    least = std::min(least, finder.threshold());
    most = std::max(most, finder.threshold());
  }
  EXPECT_LE(most - least, 2);
}

TEST(MaskFinder, WhenTheLightFallsSuddenlyTheHandIsFoundInTheNextImage) {
  MaskFinder finder({});
  Scene bright, dim;
  bright.hand({360, 400}, 200);
  dim.hand({360, 400}, 30);
  std::fill(dim.image.pixels().begin(), dim.image.pixels().begin() + kWidth, 0);
  bright.find(finder);
  dim.find(finder);
  EXPECT_NEAR(dim.area(), bright.area(), 0.01 * bright.area());
}

TEST(MaskFinder, WhenTheLightRisesSuddenlyTheGroundIsNoHandInTheNextImage) {
  MaskFinder finder({});
  Scene dim, bright;
  dim.hand({360, 400}, 60);
  std::fill(bright.image.pixels().begin(), bright.image.pixels().end(), 70);
  bright.hand({360, 400}, 255);
  dim.find(finder);
  bright.find(finder);
  EXPECT_NEAR(bright.area(), dim.area(), 0.01 * dim.area());
}

TEST(MaskFinder, ASmallDarkSpotOnTheHandIsHandAndALargeOneIsNot) {
  Scene scene;
  scene.hand({360, 400});
  for (int y = 340; y < 352; ++y)
    for (int x = 340; x < 352; ++x) scene.image.at(x, y) = 8;
  for (int y = 340; y < 365; ++y)
    for (int x = 360; x < 385; ++x) scene.image.at(x, y) = 8;
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(346, 346));
  EXPECT_FALSE(scene.lit(372, 352));
}

/// The flesh of the hand of a Scene: fingers and palm.
std::vector<Capsule> capsules_of_hand(glm::vec2 wrist) {
  std::vector<Capsule> capsules;
  for (int finger = 0; finger < 4; ++finger) {
    const glm::vec2 knuckle = wrist + glm::vec2(-30 + 20 * finger, -75);
    capsules.push_back({knuckle, knuckle - glm::vec2(0, 70), 8, 8});
  }
  capsules.push_back({wrist, wrist - glm::vec2(0, 50), 30, 36});
  return capsules;
}

TEST(MaskFinder, ABrightThingBehindTheHandIsNotHand) {
  Scene scene;
  scene.hand({360, 400});
  MaskFinder finder({});
  scene.find(finder);
  const int clean = scene.area();
  scene.capsule({300, 220}, {420, 220}, 60, 120);
  const auto capsules = capsules_of_hand({360, 400});
  scene.hints[0].capsules = capsules;
  scene.hints[0].sure_px = 1;
  scene.hints[0].most_px = 14;
  scene.find(finder);
  EXPECT_TRUE(scene.lit(330, 270));
  EXPECT_FALSE(scene.lit(330, 225));
  EXPECT_FALSE(scene.lit(340, 270));  // between two fingers
  EXPECT_NEAR(scene.area(), clean, 0.1 * clean);
}

TEST(MaskFinder, AHandThatIsSomewhatOffItsBonesIsWhollyFound) {
  Scene scene;
  scene.hand({360, 400});
  MaskFinder finder({});
  scene.find(finder);
  const int clean = scene.area();
  const auto capsules = capsules_of_hand({366, 396});
  scene.hints[0].capsules = capsules;
  scene.hints[0].sure_px = 1;
  scene.hints[0].most_px = 14;
  scene.find(finder);
  EXPECT_NEAR(scene.area(), clean, 0.005 * clean);
}

TEST(MaskFinder, BonesThatAreFarOffDoNotCutTheHandToTheirShape) {
  Scene scene;
  scene.hand({360, 400});
  const auto capsules = capsules_of_hand({380, 370});
  scene.hints[0].capsules = capsules;
  scene.hints[0].sure_px = 1;
  scene.hints[0].most_px = 14;
  MaskFinder finder({});
  scene.find(finder);
  EXPECT_TRUE(scene.lit(334, 270));   // a finger beside the bones
  EXPECT_FALSE(scene.lit(324, 270));  // the part of it outside the outer bound
}

TEST(MaskFinder, WhenTheHandGoesDarkTheThresholdIsHeld) {
  MaskFinder finder({});
  Scene lit;
  lit.hand({360, 400});
  lit.find(finder);
  const int before = finder.threshold();
  Scene dark;
  dark.hand({360, 400}, 10);
  dark.find(finder);
  EXPECT_EQ(finder.threshold(), before);
  EXPECT_EQ(dark.area(), 0);
}

}  // namespace
}  // namespace handcast::renderer
