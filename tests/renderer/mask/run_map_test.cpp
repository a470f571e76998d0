// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/run_map.hpp"

#include <gtest/gtest.h>

namespace handcast::renderer {
namespace {

TEST(RunMap, ReservedMemoryIsEnoughForEveryImageOfThisSize) {
  Image<std::uint8_t> stripes(7, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 7; x += 2) stripes.at(x, y) = 255;
  RunMap runs;
  runs.reserve(7, 3);
  const auto reserved = runs.runs().capacity();
  runs.build(stripes.view(), {0, 0, 7, 3});
  EXPECT_EQ(runs.runs().size(), 12u);
  EXPECT_EQ(runs.runs().capacity(), reserved);
}

}  // namespace
}  // namespace handcast::renderer
