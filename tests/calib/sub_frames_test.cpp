// SPDX-License-Identifier: Apache-2.0
#include "calib/sub_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/base/write_whole.hpp"
#include "tests/scratch.hpp"

namespace handcast::calib {
namespace {

using config::Packing;

TEST(SubFrames, AQuarterOfTheOutputShowsTheWholeScene) {
  const auto output = *load_calibration({});
  const auto quarter = *load_calibration({}, Packing::quadrants_4);
  EXPECT_EQ(quarter.projector.width_px, output.projector.width_px / 2);
  EXPECT_EQ(quarter.projector.height_px, output.projector.height_px / 2);
  for (const glm::dvec2 camera_px :
       {glm::dvec2(0, 0), glm::dvec2(300, 200), glm::dvec2(719, 539)}) {
    // Measured from the corner of the image, which is half a pixel from the centre of the first.
    const auto whole = output.projector.pixel_of(camera_px) + 0.5,
               half = quarter.projector.pixel_of(camera_px) + 0.5;
    EXPECT_NEAR(half.x, whole.x / 2, 1e-9);
    EXPECT_NEAR(half.y, whole.y / 2, 1e-9);
  }
}

TEST(SubFrames, BitPlanesHaveTheSizeOfTheOutput) {
  for (const auto packing : {Packing::none, Packing::planes_24x1, Packing::planes_8x3})
    EXPECT_EQ(load_calibration({}, packing)->projector.width_px, 1024);
}

TEST(SubFrames, TheOutputIsWhatTheCalibrationFileSays) {
  for (const auto packing : {Packing::planes_24x1, Packing::quadrants_12}) {
    const auto output = output_of(*load_calibration({}, packing), packing);
    const auto file = *load_calibration({});
    EXPECT_EQ(output.projector.width_px, file.projector.width_px);
    const auto at = output.projector.pixel_of({100, 200}),
               expected = file.projector.pixel_of({100, 200});
    EXPECT_NEAR(at.x, expected.x, 1e-9);
    EXPECT_NEAR(at.y, expected.y, 1e-9);
  }
}

TEST(TwoProjectors, TheSecondOneIsThatOfItsFile) {
  config::SecondProjector second;
  second.calibration = "config/calibrations/right_of_two.toml";
  const std::string first = "config/calibrations/left_of_two.toml";
  EXPECT_FALSE(load_calibration(first, {}, second)->projector2) << "it has no back end";
  second.backend = "twin";
  const auto both = load_calibration(first, {}, second);
  ASSERT_TRUE(both) << both.error().what;
  EXPECT_EQ(both->projector2->model.parallax,
            load_calibration(second.calibration)->projector.parallax);
  EXPECT_EQ(both->id, load_calibration(first)->id);
  second.packing = Packing::quadrants_4;
  EXPECT_EQ(load_calibration(first, {}, second)->projector2->model.width_px, 512);
}

TEST(TwoProjectors, TheSecondOneMustBeMeasuredWithTheSameCamera) {
  config::SecondProjector second;
  second.backend = "twin";
  const auto what = [&](const std::filesystem::path& first) {
    const auto both = load_calibration(first, {}, second);
    return both ? "" : both.error().what;
  };
  EXPECT_THAT(what(""), testing::HasSubstr("projector2.calibration is empty"));
  second.calibration = "/nowhere.toml";
  EXPECT_THAT(what(""), testing::HasSubstr("projector2.calibration: "));
  test::Scratch scratch;
  auto other = reference_rig();
  other.camera.fx_px += 1;
  const auto file = scratch.path() / "other.toml";
  ASSERT_TRUE(write_whole(file, print_calibration(other)));
  second.calibration = file;
  EXPECT_THAT(what(""), testing::HasSubstr("another lens"));
  EXPECT_EQ(what(file), "");
}

TEST(SubFrames, HaveTheIdOfTheirCalibration) {
  EXPECT_EQ(load_calibration("", Packing::quadrants_4)->id, load_calibration("")->id);
}

TEST(SubFrames, AnOutputThatCannotBeHalvedIsRefused) {
  test::Scratch scratch;
  auto odd = reference_rig();
  odd.projector.height_px = 767;
  const auto file = scratch.path() / "odd.toml";
  ASSERT_TRUE(write_whole(file, print_calibration(odd)));
  EXPECT_TRUE(load_calibration(file, Packing::planes_24x1));
  const auto refused = load_calibration(file, Packing::quadrants_12);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_config);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("1024x767"));
}

}  // namespace
}  // namespace handcast::calib
