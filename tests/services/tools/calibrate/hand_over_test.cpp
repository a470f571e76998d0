// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/hand_over.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "config/settings/files.hpp"
#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const config::MeasuredSetting kLatency{"projector.latency_ms", "10.2"};

/// Each call is one of the program: it reads the rig and opens the session anew.
class HandOver : public testing::Test {
 protected:
  HandOver() {
    options_.rig_file = scratch_.path() / "rig.toml";
    options_.folder = scratch_.path() / "rig.calibration";
    write_rig("name = \"mine\"\n");
  }
  void write_rig(const std::string& text) const { std::ofstream(options_.rig_file) << text; }
  config::Rig rig() const { return *config::load_rig(options_.rig_file, {}); }
  calib::Calibration running() const { return *calib::load_calibration(rig().calibration); }
  /// The rig while the step is measured.
  config::Rig as_it_runs() const {
    auto rig = this->rig();
    if (options_.second_projector) std::swap(rig.calibration, rig.projector2.calibration);
    return rig;
  }
  Session open() const { return *Session::open(options_, as_it_runs(), running()); }
  /// Keeps a step with a lens of this focal length.
  void measure(Step step, double fx_px, std::vector<config::MeasuredSetting> settings = {}) const {
    auto session = open();
    auto measured = session.draft();
    measured.camera.fx_px = fx_px;
    ASSERT_TRUE(session.keep(step, {"measured", true, {}, {}, std::move(settings)}, measured));
  }
  /// What the call prints.
  std::string call(bool apply) {
    options_.apply = apply;
    auto session = open();
    testing::internal::CaptureStdout();
    const auto done = hand_over(options_, as_it_runs(), running(), session);
    auto printed = testing::internal::GetCapturedStdout();
    EXPECT_TRUE(done) << done.error().what;
    return printed;
  }

  fs::path measured_file() const { return config::measured_file_of(options_.rig_file); }
  void take_back() const {
    testing::internal::CaptureStdout();
    const auto taken = undo(options_, rig());
    testing::internal::GetCapturedStdout();
    EXPECT_TRUE(taken) << taken.error().what;
  }

  test::Scratch scratch_;
  Options options_;
};

TEST_F(HandOver, WhatAnEarlierCallHasMeasuredIsPutInPlace) {
  measure(Step::screen, 1200, {kLatency});
  const auto printed = call(true);
  EXPECT_THAT(printed, HasSubstr("  projector.latency_ms = 10.2\n"));
  EXPECT_THAT(printed, HasSubstr("  calibration = \"rig_calibration.toml\"\n"));
  EXPECT_EQ(rig().projector.latency_ms, 10.2);
  EXPECT_EQ(running().camera.fx_px, 1200);
  EXPECT_EQ(call(true), "") << "all is in its place";
}

TEST_F(HandOver, WhatWasOnlyPrintedIsAppliedLater) {
  measure(Step::screen, 1200, {kLatency});
  const auto before = *config::read_text(options_.rig_file);
  EXPECT_THAT(call(false), HasSubstr("  projector.latency_ms = 10.2\n"));
  EXPECT_EQ(*config::read_text(options_.rig_file), before);
  call(true);
  EXPECT_EQ(rig().projector.latency_ms, 10.2);
  EXPECT_EQ(running().camera.fx_px, 1200);
}

TEST_F(HandOver, SettingsStayUntilTheyCouldBeApplied) {
  measure(Step::screen, 1200, {kLatency});
  const auto rig_before = rig();
  options_.apply = true;
  auto session = open();
  fs::create_directory(measured_file());
  testing::internal::CaptureStdout();
  EXPECT_FALSE(hand_over(options_, rig_before, calib::reference_rig(), session));
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("  projector.latency_ms = 10.2"));
  fs::remove(measured_file());
  EXPECT_EQ(open().settings().size(), 1U);
}

TEST_F(HandOver, ThePersonsFileStaysAsItIs) {
  const std::string text = "name = \"mine\"\r\nprojector = { latency_ms = 60 } # bright\r\n";
  write_rig(text);
  measure(Step::screen, 1200, {kLatency});
  call(true);
  EXPECT_EQ(*config::read_text(options_.rig_file), text);
  EXPECT_EQ(rig().projector.latency_ms, 10.2);
  fs::remove(measured_file());
  EXPECT_EQ(rig().projector.latency_ms, 60) << "without the measured file it has its own values";
}

TEST_F(HandOver, EarlierMeasuredSettingsStayBesideNewOnes) {
  std::ofstream(measured_file()) << "[projector]\nlatency_ms = 3\ngamma = 1.8\n";
  measure(Step::light, 1200, {kLatency});
  call(true);
  EXPECT_EQ(rig().projector.latency_ms, 10.2);
  EXPECT_EQ(rig().projector.gamma, 1.8);
}

TEST_F(HandOver, SettingsThatAreThereAlreadyAreNotWrittenAgain) {
  std::ofstream(measured_file()) << "projector.gamma = 1.8\n";
  measure(Step::light, 1200, {{"projector.gamma", "1.80"}});
  call(true);
  EXPECT_EQ(*config::read_text(measured_file()), "projector.gamma = 1.8\n");
  EXPECT_EQ(open().settings().size(), 0U);
}

TEST_F(HandOver, TheLastChangeIsTakenBackAndThatToo) {
  measure(Step::screen, 1200, {kLatency});
  call(true);
  measure(Step::screen, 1300, {{"projector.latency_ms", "4"}});
  call(true);
  const auto expect = [&](double fx_px, double latency_ms) {
    EXPECT_EQ(running().camera.fx_px, fx_px);
    EXPECT_EQ(rig().projector.latency_ms, latency_ms);
  };
  expect(1300, 4);
  take_back();
  expect(1200, 10.2);
  take_back();
  expect(1300, 4);
}

TEST_F(HandOver, AFirstCallIsTakenBackToThePersonsOwnValues) {
  const auto before = config::print_rig(rig());
  measure(Step::screen, 1200, {kLatency});
  call(true);
  const auto after = config::print_rig(rig());
  ASSERT_NE(after, before);
  take_back();
  EXPECT_EQ(config::print_rig(rig()), before);
  take_back();
  EXPECT_EQ(config::print_rig(rig()), after);
}

TEST_F(HandOver, WhatIsMeasuredOfASecondProjectorIsOfThatOne) {
  options_.second_projector = true;
  write_rig("name = \"mine\"\nprojector2.backend = \"twin\"\n");
  measure(Step::screen, 1200, {kLatency});
  const auto printed = call(true);
  EXPECT_THAT(printed, HasSubstr("  projector2.latency_ms = 10.2\n"));
  EXPECT_THAT(printed,
              HasSubstr("  projector2.calibration = \"rig_projector2_calibration.toml\"\n"));
  EXPECT_THAT(printed, Not(HasSubstr("truth")));
  EXPECT_EQ(rig().projector2.latency_ms, 10.2);
  EXPECT_EQ(rig().projector.latency_ms, config::Rig().projector.latency_ms);
  const auto file = scratch_.path() / "rig_projector2_calibration.toml";
  EXPECT_EQ(rig().projector2.calibration, file);
  EXPECT_EQ(calib::load_calibration(file)->camera.fx_px, 1200);
}

TEST_F(HandOver, WhatWasMeasuredLastIsTakenBackOfWhicheverProjector) {
  write_rig("name = \"mine\"\nprojector2.backend = \"twin\"\n");
  for (const double fx_px : {1100., 1200., 1300., 1400., 1500.}) {
    options_.second_projector = fx_px > 1300;
    measure(Step::screen, fx_px);
    call(true);
  }
  const auto second_px = [&] {
    return calib::load_calibration(rig().projector2.calibration)->camera.fx_px;
  };
  ASSERT_EQ(second_px(), 1500);
  take_back();
  EXPECT_EQ(second_px(), 1400);
  EXPECT_EQ(running().camera.fx_px, 1300);
}

TEST_F(HandOver, WithoutAnEarlierCallNothingIsTakenBack) {
  const auto none = undo(options_, rig());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::bad_config);
}

TEST_F(HandOver, TheTruthOfATwinStaysWhereItWas) {
  const auto truth = calib::print_calibration(running());
  measure(Step::lens, 1200);
  call(false);
  call(true);
  ASSERT_EQ(rig().twin.geometry.calibration, scratch_.path() / "rig_truth.toml");
  EXPECT_EQ(*config::read_text(rig().twin.geometry.calibration), truth);
  measure(Step::lens, 1300);
  call(true);
  EXPECT_EQ(running().camera.fx_px, 1300);
  EXPECT_EQ(*config::read_text(rig().twin.geometry.calibration), truth);
}

TEST_F(HandOver, TheTruthOfATwinWhoseCalibrationIsReplacedStays) {
  auto own = calib::reference_rig();
  own.camera.fx_px = 1100;
  std::ofstream(scratch_.path() / "own.toml") << calib::print_calibration(own);
  write_rig("name = \"mine\"\ncalibration = \"own.toml\"\n");
  const auto truth = calib::print_calibration(running());
  measure(Step::lens, 1200);
  call(false);
  EXPECT_EQ(running().camera.fx_px, 1200);
  measure(Step::lens, 1300);  // what runs is no longer the truth
  call(true);
  EXPECT_EQ(*config::read_text(rig().twin.geometry.calibration), truth);
}

TEST_F(HandOver, ARealRigHasNoTruth) {
  write_rig("name = \"mine\"\n[camera]\nbackend = \"v4l2\"\n");
  measure(Step::lens, 1200);
  call(true);
  EXPECT_EQ(rig().twin.geometry.calibration, "");
  EXPECT_FALSE(fs::exists(scratch_.path() / "rig_truth.toml"));
}

}  // namespace
}  // namespace handcast::calibrate
