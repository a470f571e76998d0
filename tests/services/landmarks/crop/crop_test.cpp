// SPDX-License-Identifier: Apache-2.0
// A crop is what its definition says, pixel by pixel: everywhere in the image, at every size and
// turn.
#include "services/landmarks/crop/crop.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

/// An image made smaller by a whole factor, slowly. Black beside the image.
struct Smaller {
  const test::Grey& image;
  glm::ivec2 corner, size;
  int factor;

  double at(int x, int y) const {
    if (x < 0 || y < 0 || x >= size.x || y >= size.y) return 0;
    int sum = 0;
    for (int i = 0; i < factor * factor; ++i)
      sum += image.at(corner.x + x * factor + i % factor, corner.y + y * factor + i / factor);
    return (sum + factor * factor / 2) / (factor * factor);
  }

  double bilinear(glm::dvec2 at_px) const {
    const glm::dvec2 inside =
        (at_px - glm::dvec2(corner) - 0.5 * (factor - 1)) / static_cast<double>(factor);
    const glm::dvec2 corner_px = glm::floor(inside), f = inside - corner_px;
    if (!(std::abs(corner_px.x) < 1e6 && std::abs(corner_px.y) < 1e6)) return 0;
    const glm::ivec2 c(corner_px);
    return (at(c.x, c.y) * (1 - f.x) + at(c.x + 1, c.y) * f.x) * (1 - f.y) +
           (at(c.x, c.y + 1) * (1 - f.x) + at(c.x + 1, c.y + 1) * f.x) * f.y;
  }
};

/// Where whole steps begin along one axis: two before the box, or as many as end with the image.
int first_step(int low, int high, int factor, int extent) {
  const int from = std::max(low - 2 * factor, 0), to = std::min(high + 2 * factor, extent);
  return to == extent && from > 0 ? from + (to - from) % factor : from;
}

/// The whole image, or the surroundings of the region made smaller where the region is much larger
/// than the crop.
Smaller source_of(const test::Grey& image, const Region& region, int side) {
  const glm::vec2 size(image.width(), image.height());
  const int factor =
      std::clamp(static_cast<int>(std::lround(region.size_px / static_cast<float>(side))), 1, 64);
  if (factor == 1) return {image, {0, 0}, size, 1};
  glm::vec2 low(1e30f), high(-1e30f);
  for (const glm::vec2 corner :
       {glm::vec2{-0.5f, -0.5f}, {0.5f, -0.5f}, {-0.5f, 0.5f}, {0.5f, 0.5f}}) {
    low = glm::min(low, region.to_image(corner));
    high = glm::max(high, region.to_image(corner));
  }
  const glm::ivec2 begin = glm::clamp(low, glm::vec2(0), size),
                   end = glm::min(glm::ivec2(glm::clamp(high, glm::vec2(-1), size)) + 2,
                                  glm::ivec2(size)),
                   from(first_step(begin.x, end.x, factor, image.width()),
                        first_step(begin.y, end.y, factor, image.height())),
                   to = glm::min(end + 2 * factor, glm::ivec2(size));
  return {image, from, (to - from) / factor, factor};
}

void expect_as_defined(const test::Grey& image, const Region& region, int side) {
  Crop crop(side);
  crop.cut(image.view(), region);
  const Smaller source = source_of(image, region, side);
  double worst = 0;
  for (int i = 0; i < side * side; ++i) {
    const glm::vec2 place =
        (glm::vec2(i % side, i / side) + 0.5f) / static_cast<float>(side) - 0.5f;
    worst = std::max(worst, std::abs(crop.pixels()[i] - source.bilinear(region.to_image(place))));
  }
  EXPECT_LE(worst, 1) << fmt::format("a region of {} px at ({}, {}), turned by {}", region.size_px,
                                     region.centre_px.x, region.centre_px.y, region.angle_rad);
}

TEST(Crop, IsWhatItsDefinitionSaysWhereverTheRegionLies) {
  const auto image = test::painted(310, 233, [](int x, int y) {
    return 127 + 90 * std::sin(0.13 * x) * std::cos(0.09 * y) + (x * 7 + y * 13) % 31;
  });
  for (const float size_px :
       {0.01f, 3.f, 40.f, 47.9f, 72.f, 96.f, 120.f, 168.f, 216.f, 264.f, 400.f, 3000.f, 40000.f})
    for (const float angle_rad : {0.f, 0.3f, 1.5707964f, -2.2f, 3.1f})
      for (const glm::vec2 centre_px : {glm::vec2{154.5f, 116},
                                        {0, 0},
                                        {309, 232},
                                        {-20, 120.25f},
                                        {300, -30},
                                        {154, 260},
                                        {-900, 70}})
        expect_as_defined(image, {centre_px, size_px, angle_rad}, 48);
}

TEST(Crop, OfAnEvenImageIsEvenUpToItsEdges) {
  const test::Grey image(720, 540, 200);
  Crop crop(96);
  for (float size_px = 90; size_px < 500; size_px += 7)
    for (const float angle_rad : {0.f, 0.4f, 1.5707964f, -2.2f}) {
      crop.cut(image.view(), {{361.3f, 268.7f}, std::min(size_px, 380.f), angle_rad});
      EXPECT_EQ(std::ranges::count(crop.pixels(), 200), 96 * 96)
          << size_px << " px, turned by " << angle_rad;
    }
}

TEST(Crop, ReachesTheImagesOwnEdge) {
  const test::Grey image(721, 541, 200);
  Crop crop(96);
  crop.cut(image.view(), {{720.5f - 150, 540.5f - 150}, 300, 0});
  EXPECT_EQ(std::ranges::count(crop.pixels(), 200), 96 * 96);
}

TEST(Crop, IsWhatItsDefinitionSaysOfAPartOfALargerImage) {
  const test::Grey image = test::noise(64, 48);
  renderer::GreyView part = image.view();
  part.data += 10 * part.stride + 5;
  part.width = 40;
  part.height = 30;
  test::Grey copy(40, 30);
  for (int y = 0; y < 30; ++y) std::copy_n(part.row(y), 40, copy.row(y));
  for (const float size_px : {20.f, 60.f, 130.f}) {
    Crop crop(24), expected(24);
    crop.cut(part, {{30, 20}, size_px, 0.4f});
    expected.cut(copy.view(), {{30, 20}, size_px, 0.4f});
    EXPECT_TRUE(std::ranges::equal(crop.pixels(), expected.pixels()));
  }
}

TEST(Crop, OfARegionThatIsNoneIsBlackWhateverWasCutBefore) {
  const test::Grey image(90, 70, 200);
  Crop crop(32);
  for (const Region& region : {Region{{NAN, 5}, 100, 0},
                               {{5, 5}, NAN, 0},
                               {{5, 5}, 100, NAN},
                               {{5, 5}, INFINITY, 0},
                               {{INFINITY, 5}, 20, 0},
                               {{1e9f, -1e9f}, 100, 1},
                               {{3e38f, 3e38f}, 3e38f, 1}}) {
    crop.cut(image.view(), {{45, 35}, 30, 0});
    ASSERT_EQ(crop.pixels()[100], 200);
    crop.cut(image.view(), region);
    EXPECT_EQ(std::ranges::count(crop.pixels(), 0), 32 * 32);
  }
}

}  // namespace
}  // namespace handcast::landmarks
