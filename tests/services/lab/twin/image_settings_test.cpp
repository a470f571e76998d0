// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "services/lab/twin/image_sensor.hpp"
#include "tests/services/lab/twin/world.hpp"

/// Each setting of the twin's images changes what it names, and two twins agree.
namespace handcast::twin {
namespace {

using renderer::Image;

/// A twin of these settings, without noise.
std::unique_ptr<Twin> scene(config::TwinImage settings, const char* motion = "builtin:still",
                            int seed = 1) {
  auto rig = rig_with(motion);
  settings.noise = 0;
  rig.twin.image = settings;
  rig.twin.seed = seed;
  return twin_of(rig);
}

Image<std::uint8_t> shot_with(const Twin& twin, std::uint64_t k) {
  Image<std::uint8_t> image(720, 540);
  twin.camera_image(k, image.view());
  return image;
}

/// An image of a still hand.
Image<std::uint8_t> picture(const config::TwinImage& settings, int seed = 1) {
  return shot_with(*scene(settings, "builtin:still", seed), 0);
}

/// The image without any of the settings.
const Image<std::uint8_t>& neutral() {
  static const Image<std::uint8_t> image = picture({});
  return image;
}

/// Mean grey value where the neutral image is skin, or where it is background.
double mean_over(const Image<std::uint8_t>& image, bool skin) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x)
      if (skin ? neutral().at(x, y) > 60 : neutral().at(x, y) < 15) sum += image.at(x, y), ++count;
  return sum / count;
}

/// Pixels that differ by more than `by`.
int changed(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b, int by) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    count += std::abs(a.pixels()[i] - b.pixels()[i]) > by;
  return count;
}

TEST(PointSpread, AnEdgeGetsTheWidthOfAGaussian) {
  constexpr double kSigma_px = 2;
  Image<float> image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 32; x < 64; ++x) image.at(x, y) = 100;
  PointSpread(kSigma_px).spread(image.view(), {0, 0, 64, 64});
  for (int x = 20; x < 44; ++x) {
    const double from_edge_px = x - 31.5;
    const double expected = 50 * (1 + std::erf(from_edge_px / (kSigma_px * std::sqrt(2.0))));
    EXPECT_NEAR(image.at(x, 32), expected, 0.8) << x;
  }
}

TEST(PointSpread, ItLosesNoLightAndStaysInsideItsRegion) {
  Image<float> image(40, 40);
  image.at(20, 20) = 100;
  image.at(2, 2) = 100;
  PointSpread(1.5).spread(image.view(), {10, 10, 30, 30});
  double sum = 0;
  for (int y = 10; y < 30; ++y)
    for (int x = 10; x < 30; ++x) sum += image.at(x, y);
  EXPECT_NEAR(sum, 100, 0.01);
  EXPECT_EQ(image.at(2, 2), 100);
}

TEST(ImageSetting, SpreadWidensTheOutline) {
  const auto soft = [](double spread_px) {
    const auto image = picture({.spread_px = spread_px});
    int count = 0;
    for (const std::uint8_t grey : image.pixels()) count += grey > 20 && grey < 70;
    return count;
  };
  EXPECT_GT(soft(2), 3 * soft(0));
}

TEST(ImageSetting, SubsurfaceLightReachesTheRimAndThinParts) {
  const auto soft = picture({.subsurface_mm = 6});
  EXPECT_GT(mean_over(soft, true), mean_over(neutral(), true) * 1.03);
  EXPECT_NEAR(mean_over(soft, false), mean_over(neutral(), false), 0.3);
}

TEST(ImageSetting, TextureHasTheAskedContrastAndKeepsTheBackground) {
  const auto rough = picture({.texture = 0.4});
  EXPECT_NEAR(mean_over(rough, true) / mean_over(neutral(), true), 1, 0.1);
  EXPECT_EQ(mean_over(rough, false), mean_over(neutral(), false));
  EXPECT_GT(changed(neutral(), rough, 5), 5000);
  EXPECT_GT(changed(rough, picture({.texture = 0.4}, 2), 5), 2000)
      << "another person has another skin";
}

TEST(ImageSetting, ClutterIsBehindTheHandAndStandsStill) {
  const auto full = picture({.clutter = 0.5});
  EXPECT_GT(mean_over(full, false), mean_over(neutral(), false) + 2);
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x) {
      if (neutral().at(x, y) > 100) {
        ASSERT_EQ(full.at(x, y), neutral().at(x, y)) << "the hand is in front";
      }
    }
}

TEST(ImageSetting, SunlightComesFromOneSide) {
  const auto sunny = picture({.sunlight = 0.3});
  const auto added = [&](int x0) {
    double sum = 0;
    for (int y = 0; y < 100; ++y)
      for (int x = x0; x < x0 + 100; ++x) sum += sunny.at(x, y) - neutral().at(x, y);
    return sum / 1e4;
  };
  EXPECT_GT(added(0), 5);
  EXPECT_GT(added(0), 1.3 * added(620));
  EXPECT_GT(mean_over(sunny, true), mean_over(neutral(), true) + 10);
}

TEST(ImageSetting, ATableShowsAnImageThatMovesWithTheHand) {
  const auto bare = scene({}, "builtin:wave"), glossy = scene({.table = 0.3}, "builtin:wave");
  double least = 720, most = 0;
  for (const std::uint64_t k : {0, 100, 200, 300}) {
    const auto without = shot_with(*bare, k), with = shot_with(*glossy, k);
    double x_sum = 0, count = 0;
    for (int y = 0; y < 540; ++y)
      for (int x = 0; x < 720; ++x)
        if (with.at(x, y) > without.at(x, y) + 5) x_sum += x, ++count;
    EXPECT_GT(count, 1500) << k;
    least = std::min(least, x_sum / count);
    most = std::max(most, x_sum / count);
  }
  EXPECT_GT(most - least, 5);
}

TEST(ImageSetting, TheLeakIsBoundToTheSurface) {
  const auto dark = scene({}, "builtin:reverse"), leaking = scene({.leak = 0.5}, "builtin:reverse");
  const auto stripes_along_bones = [&](std::uint64_t k) {
    const auto plain = shot_with(*dark, k), striped = shot_with(*leaking, k);
    std::vector<double> ratios;
    const auto points = *dark->landmarks(Side::left, dark->camera_origin_ns(k));
    for (int i = 1; i < msg::kLandmarks; ++i)
      for (const float along : {0.2f, 0.5f, 0.8f}) {
        const auto px = glm::mix(points[i % 4 == 1 ? 0 : i - 1], points[i], along);
        const int x = static_cast<int>(px.x), y = static_cast<int>(px.y);
        ratios.push_back(striped.at(x, y) / std::max(1.0, double(plain.at(x, y))));
      }
    return ratios;
  };
  const auto first = stripes_along_bones(0);
  EXPECT_LT(*std::min_element(first.begin(), first.end()), 1.15);
  EXPECT_GT(*std::max_element(first.begin(), first.end()), 1.35);
  for (const std::uint64_t k : {50, 100}) {
    const auto now = stripes_along_bones(k);
    int same = 0;
    for (std::size_t i = 0; i < now.size(); ++i) same += std::abs(now[i] - first[i]) < 0.12;
    EXPECT_GE(same, 50) << "of 60, frame " << k;
  }
}

TEST(ImageSetting, TheSecondPersonIsInTheImageAndNobodysTruth) {
  const auto two = scene({.second_person = true});
  const auto image = shot_with(*two, 0);
  int at_edge = 0, elsewhere = 0;
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x)
      (x > 450 ? at_edge : elsewhere) += image.at(x, y) > neutral().at(x, y) + 40;
  EXPECT_GT(at_edge, 8'000);
  EXPECT_EQ(elsewhere, 0);
  EXPECT_FALSE(two->landmarks(Side::right, 0));
  EXPECT_EQ(two->tracker_sample(0).poses.count, 1u);
  EXPECT_EQ(two->detect(0, 0, 0).landmarks.count, 1u);
}

TEST(ImageSetting, AHeldObjectMovesWithTheHand) {
  const auto empty = scene({}, "builtin:reverse"),
             full = scene({.object = true}, "builtin:reverse");
  const auto middle_x = [&](std::uint64_t k) {
    const auto bare = shot_with(*empty, k), held = shot_with(*full, k);
    double sum = 0, count = 0;
    for (int y = 0; y < 540; ++y)
      for (int x = 0; x < 720; ++x)
        if (std::abs(held.at(x, y) - bare.at(x, y)) > 5) sum += x, ++count;
    EXPECT_GT(count, 300) << k;
    return sum / count;
  };
  const auto palm_x = [&](std::uint64_t k) {
    return double((*empty->landmarks(Side::left, empty->camera_origin_ns(k)))[9].x);
  };
  EXPECT_NEAR(middle_x(80) - middle_x(0), palm_x(80) - palm_x(0), 25);
}

TEST(ImageSetting, WithAllOfThemTwoTwinsStillAgree) {
  const config::TwinImage all{.spread_px = 1.5,
                              .subsurface_mm = 4,
                              .texture = 0.2,
                              .clutter = 0.3,
                              .sunlight = 0.1,
                              .table = 0.1,
                              .leak = 0.1,
                              .second_person = true,
                              .object = true};
  const auto first = scene(all, "builtin:wave"), second = scene(all, "builtin:wave");
  shot_with(*first, 7);  // what was drawn before must not matter
  EXPECT_EQ(shot_with(*first, 40).pixels(), shot_with(*second, 40).pixels());
}

}  // namespace
}  // namespace handcast::twin
