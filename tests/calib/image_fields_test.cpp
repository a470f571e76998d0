// SPDX-License-Identifier: Apache-2.0
#include "calib/image_fields.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace handcast::calib {
namespace {

using testing::ElementsAre, testing::IsEmpty, testing::SizeIs;

TEST(ImageFields, NameWhereLittleWasSeen) {
  ImageFields fields(720, 540);
  EXPECT_EQ(fields.emptiest(), "top left");
  for (int y = 90; y < 540; y += 180)
    for (int x = 120; x < 720; x += 240)
      if (x < 600 || y > 400) fields.add({x, y});
  EXPECT_THAT(fields.with_fewer_than(1), ElementsAre("top right", "right"));
  EXPECT_EQ(fields.emptiest(), "top right");
  fields.add({719, 0});
  fields.add({700, 0});
  fields.add({719, 300});
  fields.add({719, 300});
  EXPECT_THAT(fields.with_fewer_than(1), IsEmpty());
  EXPECT_THAT(fields.with_fewer_than(2), SizeIs(7));
  EXPECT_EQ(fields.emptiest(), "top left");
}

TEST(ImageFields, LeaveOutWhatIsNotInTheImage) {
  ImageFields fields(720, 540);
  for (const auto& px : {glm::dvec2(-1, 5), {720, 5}, {5, 540}, {NAN, 5}, {5, INFINITY}})
    fields.add(px);
  EXPECT_THAT(fields.with_fewer_than(1), SizeIs(ImageFields::kFields));
}

}  // namespace
}  // namespace handcast::calib
