// SPDX-License-Identifier: Apache-2.0
// Two projectors, 30 degrees to both sides of the camera, on white hands: whole runs in virtual
// time. The limits are measured figures with a margin.
#include <gtest/gtest.h>

#include "renderer/media/picture.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

using Settings = std::vector<std::string>;

nlohmann::json both_lights(const std::string& motion, Settings settings = {}) {
  settings.insert(settings.end(), {"content.left=builtin:white", "content.right=builtin:white"});
  return run_rig("two_projectors", "builtin:" + motion, 0.4, settings)["shared"];
}

TEST(TwoProjectors, TogetherTheyLightWhatOneCannotReach) {
  for (const auto* motion : {"open_close", "fist", "two_hands"}) {
    const auto shared = both_lights(motion);
    EXPECT_GT(figure(shared, "/coverage"), 0.92) << motion;
    EXPECT_LT(figure(shared, "/coverage_first"), 0.6) << motion;
  }
}

TEST(TwoProjectors, TheirLightAddsUpToThatOfOne) {
  const auto shared = both_lights("show");
  EXPECT_GT(figure(shared, "/light/p5"), 0.7);
  EXPECT_NEAR(figure(shared, "/light/p50"), 1, 0.05);
  EXPECT_LT(figure(shared, "/light/p95"), 1.3);
}

TEST(TwoProjectors, FromTheSideTheCamerasMaskNeitherDarkensNorSpills) {
  const auto first = run_rig("two_projectors", "builtin:wave", 0.4);
  EXPECT_GT(figure(first, "/coverage"), 0.98);
  EXPECT_LT(figure(first, "/spill"), 0.12);
}

TEST(TwoProjectors, TheirPicturesAgree) {
  EXPECT_LT(figure(both_lights("still"), "/apart_mm/mean"), 5);
}

TEST(TwoProjectors, WrongCalibrationsCastPicturesFartherApart) {
  EXPECT_GT(figure(both_lights("still", {"twin.geometry.homography_px=30"}), "/apart_mm/mean"),
            figure(both_lights("still"), "/apart_mm/mean") + 1);
}

TEST(TwoProjectors, APictureShowsTheFirstTheSecondAndBoth) {
  const test::Scratch folder;
  Options options = options_of("two_projectors", 0.05);
  options.frames_directory = folder.path().string();
  add_settings(options, {"content.left=builtin:white", "content.right=builtin:white"});
  ASSERT_TRUE(run(options));
  const auto picture = renderer::read_picture(folder.path() / "000000.png");
  ASSERT_TRUE(picture) << picture.error().what;
  ASSERT_EQ(picture->width(), 3 * 720);
  std::array<double, 3> light{};
  for (int y = 0; y < picture->height(); ++y)
    for (int x = 0; x < picture->width(); ++x)
      light[static_cast<std::size_t>(x / 720)] += picture->at(x, y) & 0xff;
  EXPECT_GT(light[2], light[0]);
  EXPECT_GT(light[2], light[1]);
}

TEST(TwoProjectors, OnAPictureOnlyTheDistanceIsMeasured) {
  const auto shared = run_rig("two_projectors", "builtin:still", 0.1)["shared"];
  EXPECT_TRUE(shared["coverage"].is_null());
  EXPECT_TRUE(shared["light"]["p50"].is_null());
  EXPECT_GT(figure(shared, "/apart_mm/mean"), 0);
}

TEST(OneProjector, HasNoSharedLight) {
  EXPECT_TRUE(run_rig("twin", "builtin:still", 0.1)["shared"].is_null());
}

}  // namespace
}  // namespace handcast::simulate
