// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/base/image.hpp"

namespace handcast::renderer {
namespace {

TEST(Rect, KeepsThePartInsideAnImage) {
  const Rect part = Rect{-5, 3, 50, 40}.within(20, 10);
  EXPECT_EQ(part.x0, 0);
  EXPECT_EQ(part.y0, 3);
  EXPECT_EQ(part.x1, 20);
  EXPECT_EQ(part.y1, 10);
}

TEST(Rect, OutsideAnImageHasNoNegativeSize) {
  for (const Rect outside : {Rect{-50, 2, -10, 8}, Rect{30, 2, 60, 8}, Rect{2, -9, 8, -1},
                             Rect{2, 50, 8, 60}, Rect{9, 9, 3, 3}}) {
    const Rect part = outside.within(20, 10);
    EXPECT_TRUE(part.empty());
    EXPECT_GE(part.width(), 0);
    EXPECT_GE(part.height(), 0);
    EXPECT_GE(part.x0, 0);
    EXPECT_LE(part.x1, 20);
    EXPECT_GE(part.y0, 0);
    EXPECT_LE(part.y1, 10);
  }
}

}  // namespace
}  // namespace handcast::renderer
