// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/lens_step.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

TEST(LensMemory, GivesTheCovarianceOfTheLensThatWasMeasuredLast) {
  const test::Scratch scratch;
  calib::LensFit fit;
  fit.camera = calib::reference_rig().camera;
  fit.covariance[0][0] = 1.0 / 3;
  fit.covariance[8][2] = -2e-9;
  ASSERT_TRUE(remember_lens(scratch.path(), "lens", fit));
  const auto known = recall_lens(scratch.path(), "lens", fit.camera);
  ASSERT_TRUE(known);
  EXPECT_EQ(*known, fit.covariance);
}

TEST(LensMemory, KnowsNothingOfAnotherLens) {
  const test::Scratch scratch;
  calib::LensFit fit;
  fit.camera = calib::reference_rig().camera;
  EXPECT_FALSE(recall_lens(scratch.path(), "lens", fit.camera)) << "none was measured";
  ASSERT_TRUE(remember_lens(scratch.path(), "lens", fit));
  EXPECT_FALSE(recall_lens(scratch.path(), "lens2", fit.camera));
  auto other = fit.camera;
  other.fx_px += 0.1;
  EXPECT_FALSE(recall_lens(scratch.path(), "lens", other));
}

TEST(LensMemory, APipeInItsPlaceIsNotWaitedFor) {
  const test::Scratch scratch;
  ASSERT_EQ(::mkfifo((scratch.path() / "lens.covariance").c_str(), 0600), 0);
  EXPECT_FALSE(recall_lens(scratch.path(), "lens", calib::reference_rig().camera));
}

TEST(LensAdvice, NearTheEndItSaysWhatIsMissing) {
  EXPECT_THAT(lens_advice(0, 15, "x"), HasSubstr("Hold the board still"));
  EXPECT_EQ(lens_advice(9, 15, "Hold it there."), "Hold it there.");
  EXPECT_EQ(lens_advice(15, 15, "Hold it there."), "Almost done: Hold it there.");
  EXPECT_THAT(lens_advice(9, 15, ""), HasSubstr("6 more images"));
  EXPECT_THAT(lens_advice(14, 15, ""), HasSubstr("one more image"));
}

}  // namespace
}  // namespace handcast::calibrate
