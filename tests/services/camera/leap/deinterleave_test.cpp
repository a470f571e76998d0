// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/deinterleave.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace handcast::camera::leap {
namespace {

using testing::Each;
using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

Bytes image_of(const Bytes& both, std::size_t eye, int width_px, std::size_t pixels) {
  Bytes image(pixels, 99);
  deinterleave(both, eye, width_px, image);
  return image;
}

TEST(Deinterleave, EachEyeGetsItsBytes) {
  const Bytes both{1, 101, 2, 102, 3, 103, 4, 104};
  EXPECT_THAT(image_of(both, 0, 2, 4), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(image_of(both, 1, 2, 4), ElementsAre(101, 102, 103, 104));
}

TEST(Deinterleave, RowsOfTheSensorLieInTheMiddleOfTheirRowsOfTheImage) {
  const Bytes both{10, 0, 90, 0, 50, 0};  // three rows of one pixel
  EXPECT_THAT(image_of(both, 0, 1, 6), ElementsAre(10, 30, 70, 80, 60, 50));
  EXPECT_THAT(image_of(both, 0, 1, 12),
              ElementsAre(10, 10, 20, 40, 60, 80, 85, 75, 65, 55, 50, 50));
}

TEST(Deinterleave, AnEdgeStaysWhereItIs) {
  // Where a ramp of 16 per row of the image passes, seen by a sensor with half of the rows.
  Bytes both;
  for (int y = 0; y < 8; ++y) both.insert(both.end(), {static_cast<std::uint8_t>(32 * y + 8), 0});
  const auto image = image_of(both, 0, 1, 16);
  for (int y = 1; y < 15; ++y) EXPECT_EQ(image[static_cast<std::size_t>(y)], 16 * y) << y;
}

TEST(Deinterleave, EqualRowsStayEqual) {
  const Bytes both(2 * 3 * 5, 255);
  EXPECT_THAT(image_of(both, 1, 3, 3 * 10), Each(255));
}

}  // namespace
}  // namespace handcast::camera::leap
