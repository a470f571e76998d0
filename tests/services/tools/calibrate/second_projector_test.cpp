// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/second_projector.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "calib/calibration.hpp"
#include "services/tools/calibrate/hand_over.hpp"
#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

/// A rig whose first projector is calibrated, with a newer lens than the calibration of its second
/// one.
class SecondProjector : public testing::Test {
 protected:
  SecondProjector() {
    options_.rig_file = scratch_.path() / "rig.toml";
    options_.folder = scratch_.path() / "session";
    options_.second_projector = true;
    auto first = calib::reference_rig();
    first.camera.fx_px = 1234;
    std::ofstream(scratch_.path() / "left.toml") << calib::print_calibration(first);
    auto second = calib::reference_rig();
    second.projector.parallax = {82, 0, 0};
    second.projector_device = "right";
    std::ofstream(scratch_.path() / "right.toml") << calib::print_calibration(second);
    write_rig(R"(
calibration = "left.toml"
projector.latency_ms = 4
projector.window.monitor = "HDMI-1"
[projector2]
backend = "window"
calibration = "right.toml"
latency_ms = 7
window.monitor = "HDMI-2"
)");
  }
  void write_rig(const std::string& text) const { std::ofstream(options_.rig_file) << text; }
  config::Rig rig() const { return *config::load_rig(options_.rig_file, options_.settings); }
  std::string refusal() {
    const auto turned = turn_to_projector(rig(), options_);
    return turned ? "" : turned.error().what;
  }

  test::Scratch scratch_;
  Options options_;
};

TEST_F(SecondProjector, BothProjectorsChangePlaces) {
  const auto before = rig();
  ASSERT_EQ(refusal(), "");
  const auto after = rig();
  EXPECT_EQ(after.projector.backend, "window");
  EXPECT_EQ(after.projector.latency_ms, 7);
  EXPECT_EQ(after.projector.window.monitor, "HDMI-2");
  EXPECT_EQ(after.projector2.backend, before.projector.backend);
  EXPECT_EQ(after.projector2.latency_ms, 4);
  EXPECT_EQ(after.projector2.window.monitor, "HDMI-1");
  EXPECT_EQ(after.projector2.calibration, before.calibration);
}

TEST_F(SecondProjector, ItsCalibrationHasTheLensOfTheFirstOne) {
  ASSERT_EQ(refusal(), "");
  const auto known = calib::load_calibration(rig().calibration);
  ASSERT_TRUE(known) << known.error().what;
  EXPECT_EQ(known->camera.fx_px, 1234);
  EXPECT_EQ(known->projector.parallax[0], 82);
  EXPECT_EQ(known->projector_device, "right");
}

TEST_F(SecondProjector, TheTruthOfTheFirstOneIsNotThatOfTheSecond) {
  std::ofstream(options_.rig_file, std::ios::app)
      << "[twin]\ngeometry.calibration = \"rig_truth.toml\"\n";
  ASSERT_EQ(rig().twin.geometry.calibration, truth_of(options_));
  ASSERT_EQ(refusal(), "");
  EXPECT_EQ(rig().twin.geometry.calibration, "");
}

TEST_F(SecondProjector, OneWithoutACalibrationNeedsItsSize) {
  write_rig("calibration = \"left.toml\"\nprojector2.backend = \"window\"\n");
  EXPECT_THAT(refusal(), HasSubstr("add --projector, e.g. --projector 1920x1080"));
  options_.projector = {1920, 1080};
  ASSERT_EQ(refusal(), "");
  const auto known = calib::load_calibration(rig().calibration);
  ASSERT_TRUE(known) << known.error().what;
  EXPECT_EQ(known->projector.width_px, 1920);
}

TEST_F(SecondProjector, OneThatIsNotCalibratedIsLeftOutWhileTheFirstOneIsMeasured) {
  options_.second_projector = false;
  ASSERT_EQ(refusal(), "");
  EXPECT_EQ(options_.settings.size(), 0U) << "--check of a rig that is up takes none";
  write_rig("projector2.backend = \"window\"\n");
  ASSERT_EQ(refusal(), "");
  EXPECT_EQ(rig().projector2.backend, "none");
}

TEST_F(SecondProjector, WhatIsMissingIsSaid) {
  write_rig("calibration = \"left.toml\"\n");
  EXPECT_THAT(refusal(), HasSubstr("has no second projector; set projector2.backend"));
  write_rig("projector2.backend = \"window\"\nprojector2.calibration = \"right.toml\"\n");
  EXPECT_THAT(refusal(), HasSubstr("measure it first: handcast calibrate"));
}

}  // namespace
}  // namespace handcast::calibrate
