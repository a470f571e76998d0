// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/handcast_network.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "services/landmarks/crop/crop.hpp"

namespace handcast::landmarks::handcast_network {
namespace {

using testing::Each;
using testing::FloatNear;

constexpr std::size_t kImageSize = kSide_px * kSide_px;

/// 21 places spread over the region, none the mirror image of another.
Points spots_in(const Region& region) {
  Points spots;
  for (std::size_t i = 0; i < spots.size(); ++i)
    spots[i] = region.to_image(
        {-0.33f + 0.12f * static_cast<float>(i % 7), -0.3f + 0.3f * static_cast<float>(i / 7)});
  return spots;
}

renderer::Image<std::uint8_t> picture_of(std::span<const glm::vec2> spots_px, float sigma_px) {
  renderer::Image<std::uint8_t> picture(720, 540);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      float light = 0;
      for (const glm::vec2 spot : spots_px) {
        const glm::vec2 way = glm::vec2(x, y) - spot;
        light += std::exp(-0.5f * glm::dot(way, way) / (sigma_px * sigma_px));
      }
      picture.at(x, y) = static_cast<std::uint8_t>(std::lround(200 * std::min(light, 1.0f)));
    }
  return picture;
}

/// Where the light near `place` has its middle, as a place.
glm::vec2 middle_of_light(std::span<const float> image, glm::vec2 place) {
  const glm::ivec2 centre = glm::ivec2(place * static_cast<float>(kSide_px));
  glm::vec2 sum(0);
  float weight = 0;
  for (int y = centre.y - 4; y <= centre.y + 4; ++y)
    for (int x = centre.x - 4; x <= centre.x + 4; ++x) {
      const float light = image[y * kSide_px + x] + kShownShift;
      sum += light * (glm::vec2(x, y) + 0.5f);
      weight += light;
    }
  return sum / weight / static_cast<float>(kSide_px);
}

class EitherSide : public testing::TestWithParam<msg::Side> {};
INSTANTIATE_TEST_SUITE_P(HandcastNetwork, EitherSide,
                         testing::Values(msg::Side::left, msg::Side::right));

TEST_P(EitherSide, WhatTheNetworkIsShownLiesWherePlacesSayToATenthOfAPixel) {
  for (const float angle : {0.0f, 0.7f, 3.1415927f})
    for (const float size : {96.0f, 210.0f, 340.0f}) {
      const Region region{{361.3f, 268.6f}, size, angle};
      const Points spots = spots_in(region);
      Crop crop(kSide_px);
      crop.cut(picture_of(spots, 1.6f * size / kSide_px).view(), region);
      std::vector<float> image(kImageSize);
      write_image(crop.pixels(), GetParam(), image);
      const Places places = to_places(region, GetParam(), spots);
      for (const glm::vec2 place : places) {
        const glm::vec2 off_px =
            (middle_of_light(image, place) - place) * static_cast<float>(kSide_px);
        EXPECT_NEAR(off_px.x, 0, 0.1f) << "region of " << size << " px turned by " << angle;
        EXPECT_NEAR(off_px.y, 0, 0.1f) << "region of " << size << " px turned by " << angle;
      }
    }
}

TEST_P(EitherSide, PlacesLeadBackToTheImage) {
  const Region region{{300, 200}, 250, -1.2f};
  const Points spots = spots_in(region);
  const Points back = to_image(region, GetParam(), to_places(region, GetParam(), spots));
  for (std::size_t i = 0; i < spots.size(); ++i) EXPECT_LT(glm::distance(spots[i], back[i]), 1e-3f);
}

TEST_P(EitherSide, APeakInAHeatMapLeadsBackToThePixelItStandsFor) {
  const Region region{{300, 200}, 240, 0};
  std::vector<float> output((2 * msg::kLandmarks + 1) * kHeatCells * kHeatCells, 0.0f);
  const int column = 3, row = 7;
  for (int i = 0; i < msg::kLandmarks; ++i)
    output[(i * kHeatCells + row) * kHeatCells + column] = 60;
  const Points points = to_image(region, GetParam(), read_answer(output).places);
  const float across = GetParam() == msg::Side::left ? kHeatCells - 1 - column : column;
  const glm::vec2 expected(180 + 20 * (across + 0.5f), 80 + 20 * (row + 0.5f));  // 20 px a cell
  for (const glm::vec2 point : points) EXPECT_LT(glm::distance(point, expected), 0.01f);
}

TEST(HandcastNetwork, ReadsSigmaWhereTheHeatIsAndPresenceEverywhere) {
  constexpr int kCells = kHeatCells * kHeatCells;
  std::vector<float> output((2 * msg::kLandmarks + 1) * kCells, 0.0f);
  for (int i = 0; i < msg::kLandmarks; ++i) {
    output[i * kCells + 50] = 60;
    output[(msg::kLandmarks + i) * kCells + 50] = std::log(0.02f);
  }
  for (int c = 0; c < kCells; ++c) output[2 * msg::kLandmarks * kCells + c] = c % 2 ? 4.0f : 0.0f;
  const Answer answer = read_answer(output);
  EXPECT_THAT(answer.sigma, Each(FloatNear(0.02f, 1e-4f)));
  EXPECT_NEAR(answer.presence, 1 / (1 + std::exp(-2.0f)), 1e-5f);
}

TEST(HandcastNetwork, ADarkerPictureIsShownAlike) {
  std::vector<std::uint8_t> bright(kImageSize), dark(kImageSize);
  for (std::size_t i = 0; i < bright.size(); ++i) {
    bright[i] = static_cast<std::uint8_t>(2 * (i % 100));
    dark[i] = static_cast<std::uint8_t>(i % 100);
  }
  std::vector<float> one(kImageSize), other(kImageSize);
  write_image(bright, msg::Side::right, one);
  write_image(dark, msg::Side::right, other);
  EXPECT_THAT(one, testing::Pointwise(FloatNear(1e-4f), other));
}

TEST(HandcastNetwork, TheTrackersMapsPeakAtItsJoints) {
  Places places;
  places.fill({(5 + 0.5f) / kMapCells, (9 + 0.5f) / kMapCells});
  std::vector<float> maps(msg::kLandmarks * kMapCells * kMapCells);
  write_tracker(places, maps);
  EXPECT_NEAR(maps[9 * kMapCells + 5], 1, 1e-5f);
  EXPECT_NEAR(maps[9 * kMapCells + 6], std::exp(-0.5f / (1.2f * 1.2f)), 1e-5f);
  write_tracker(std::nullopt, maps);
  EXPECT_THAT(maps, Each(0.0f));
}

/// Processors are a hundred times slower at numbers too small for a normal float.
TEST(HandcastNetwork, TheTrackersMapsAreGaussiansWithoutDenormalNumbers) {
  Places places;
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {0.07f * static_cast<float>(i) - 0.2f, 1.1f - 0.05f * static_cast<float>(i)};
  std::vector<float> maps(msg::kLandmarks * kMapCells * kMapCells);
  write_tracker(places, maps);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const glm::dvec2 cell(i % kMapCells, i / kMapCells % kMapCells);
    const glm::dvec2 way =
        (cell + 0.5 - glm::dvec2(places[i / (kMapCells * kMapCells)]) * double{kMapCells}) / 1.2;
    ASSERT_NEAR(maps[i], std::exp(-0.5 * glm::dot(way, way)), 1e-6);
    ASSERT_NE(std::fpclassify(maps[i]), FP_SUBNORMAL);
  }
}

TEST(HandcastNetwork, AJointThatIsNoNumberLeavesItsMapEmpty) {
  Places places;
  places.fill({0.5f, NAN});
  std::vector<float> maps(msg::kLandmarks * kMapCells * kMapCells, 1.0f);
  write_tracker(places, maps);
  EXPECT_THAT(maps, Each(0.0f));
}

TEST(HandcastNetwork, ALeftHandIsShownMirrored) {
  std::vector<std::uint8_t> pixels(kImageSize);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<std::uint8_t>(i * 37 % 251);
  const auto shown = shown_values(pixels);
  std::vector<float> left(kImageSize), right(kImageSize);
  write_image(pixels, msg::Side::left, left);
  write_image(pixels, msg::Side::right, right);
  for (int i = 0; i < static_cast<int>(kImageSize); ++i) {
    ASSERT_EQ(right[i], shown[pixels[i]]);
    ASSERT_EQ(left[i], right[i / kSide_px * kSide_px + kSide_px - 1 - i % kSide_px]);
  }
}

TEST(HandcastNetwork, ReadsTheMeansThatItsHeatSays) {
  constexpr int kCells = kHeatCells * kHeatCells;
  std::vector<float> output((2 * msg::kLandmarks + 1) * kCells);
  for (std::size_t i = 0; i < output.size(); ++i)
    output[i] = static_cast<float>(static_cast<int>(i * 7919 % 2003) - 1001) * 0.02f;
  const Answer answer = read_answer(output);
  for (int i = 0; i < msg::kLandmarks; ++i) {
    double weight = 0, log_sigma = 0;
    glm::dvec2 cell(0);
    for (int c = 0; c < kCells; ++c) {
      const double w = std::exp(static_cast<double>(output[i * kCells + c]));
      weight += w;
      cell += w * glm::dvec2(c % kHeatCells, c / kHeatCells);
      log_sigma += w * output[(msg::kLandmarks + i) * kCells + c];
    }
    EXPECT_NEAR(answer.places[i].x, (cell.x / weight + 0.5) / kHeatCells, 1e-5);
    EXPECT_NEAR(answer.places[i].y, (cell.y / weight + 0.5) / kHeatCells, 1e-5);
    EXPECT_NEAR(std::log(answer.sigma[i]), std::clamp(log_sigma / weight, -12.0, 3.0), 1e-4);
  }
}

TEST(Exponential, IsRightToAFloatsRounding) {
  for (float x = -87; x <= 88; x += 0.01f)
    ASSERT_NEAR(exponential(x) / std::exp(static_cast<double>(x)), 1, 3e-7) << x;
  for (const float x : {-88.0f, -1e30f, -INFINITY, NAN})
    EXPECT_EQ(exponential(x), exponential(-87.0f)) << x;
}

TEST(HandcastNetwork, ItsRegionHoldsEveryLandmarkUpright) {
  const Region wide{{200, 300}, 100, 0.5f};
  Points points = spots_in(wide);
  points[0] = wide.to_image({0, 0.4f});
  points[9] = wide.to_image({0, -0.1f});
  const Region region = region_around(points);
  EXPECT_NEAR(region.angle_rad, 0.5f, 1e-4f);
  for (const glm::vec2 point : points) {
    const glm::vec2 place = region.to_place(point);
    EXPECT_LT(std::max(std::abs(place.x), std::abs(place.y)), 0.4f);
  }
}

}  // namespace
}  // namespace handcast::landmarks::handcast_network
