// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/heat_map.hpp"

#include <gtest/gtest.h>

#include "renderer/media/picture.hpp"
#include "tests/scratch.hpp"

namespace handcast::study {
namespace {

TEST(HeatMap, PlacesThatMoreSubjectsMarkedAreBrighterAndConditionsAreSideBySide) {
  const test::Scratch scratch;
  renderer::Image<std::uint8_t> marks(20, 10);
  const auto write = [&](const char* name) {
    ASSERT_TRUE(renderer::write_png(scratch.path() / name, marks.view()));
  };
  marks.at(3, 4) = marks.at(5, 5) = 255;
  write("subject-01.baseline.marks.png");
  marks.at(5, 5) = 0;
  write("subject-02.baseline.marks.png");
  marks.at(3, 4) = 0;
  marks.at(9, 9) = 255;
  write("subject-01.fill.marks.png");
  const auto map = heat_map({scratch.path().string()});
  ASSERT_TRUE(map);
  ASSERT_EQ(map->width(), 40);
  EXPECT_EQ(map->at(3, 4), 0xffffffffu) << "marked by both";
  EXPECT_GT(map->at(5, 5) & 0xffffff, 0u);
  EXPECT_LT(map->at(5, 5) >> 16 & 0xff, 255u);
  EXPECT_EQ(map->at(20 + 9, 9), 0xffffffffu);
  EXPECT_EQ(map->at(20 + 3, 4), 0xff000000u);
}

TEST(HeatMap, WithoutMarksThereIsNone) {
  const test::Scratch scratch;
  EXPECT_FALSE(heat_map({scratch.path().string(), "/nowhere"}));
}

}  // namespace
}  // namespace handcast::study
