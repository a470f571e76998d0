// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/image_fields.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace handcast::calibrate {
namespace {

TEST(ImageFields, NameWhereLittleWasSeen) {
  ImageFields fields(720, 540);
  EXPECT_EQ(fields.emptiest(), "top left");
  for (int y = 90; y < 540; y += 180)
    for (int x = 120; x < 720; x += 240)
      if (x < 600 || y > 400) fields.add({x, y});
  EXPECT_EQ(fields.empty(), "top right, right");
  EXPECT_EQ(fields.emptiest(), "top right");
  fields.add({719, 0});
  fields.add({700, 0});
  fields.add({719, 300});
  fields.add({719, 300});
  EXPECT_EQ(fields.empty(), "");
  EXPECT_EQ(fields.emptiest(), "top left");
}

TEST(ImageFields, LeaveOutWhatIsNotInTheImage) {
  ImageFields fields(720, 540);
  for (const auto& px : {glm::dvec2(-1, 5), {720, 5}, {5, 540}, {NAN, 5}, {5, INFINITY}})
    fields.add(px);
  EXPECT_EQ(fields.empty(),
            "top left, top, top right, left, middle, right, bottom left, bottom, bottom right");
}

}  // namespace
}  // namespace handcast::calibrate
