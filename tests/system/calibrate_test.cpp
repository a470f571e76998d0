// SPDX-License-Identifier: Apache-2.0
// `handcast calibrate` measures the twin, whose truth is known.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Calibrate : public SystemTest {
 protected:
  /// Copies the rig file of the twin, so that what is measured stays in the folder of the test.
  std::string rig_file() const {
    const fs::path file = scratch_.path() / "twin.toml";
    fs::copy_file("config/rigs/twin.toml", file, fs::copy_options::skip_existing);
    return file;
  }
  Outcome calibrate(Arguments more) const {
    Arguments arguments{"calibrate", rig_file(),         "--yes", "--set", "observer.enabled=false",
                        "--set",     "camera.rate_hz=30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return handcast(arguments);
  }
  /// What --apply has written to the rig file: 3 ms and a gamma as in sRGB were there before. A
  /// loaded machine stamps images and light some tenths of a millisecond late; how exact a delay
  /// is, is measured by bench_calib_session.
  void expect_projector(double latency_ms, double gamma, const Outcome& outcome) const {
    const auto rig = config::load_rig(rig_file(), {});
    ASSERT_TRUE(rig) << rig.error().what;
    EXPECT_NEAR(rig->projector.latency_ms, latency_ms, 1) << outcome.output << outcome.log;
    EXPECT_NEAR(rig->projector.gamma, gamma, 0.1) << outcome.output << outcome.log;
  }
  /// Files beside the rig file, and their times.
  std::vector<std::pair<fs::path, fs::file_time_type>> files() const {
    std::vector<std::pair<fs::path, fs::file_time_type>> files;
    for (const auto& entry : fs::recursive_directory_iterator(scratch_.path()))
      if (const auto name = entry.path().filename().string();
          !name.starts_with("output-") && !name.starts_with("log-"))
        files.emplace_back(entry.path(), entry.last_write_time());
    std::ranges::sort(files);
    return files;
  }
  /// The numbers under which the processes of this test have a file open.
  std::set<std::string> descriptors_of(const std::string& name) const {
    std::set<std::string> numbers;
    std::error_code gone;
    for (const auto pid : processes_of(scratch_.path()))
      for (fs::directory_iterator fd("/proc/" + std::to_string(pid) + "/fd", gone), end; fd != end;
           fd.increment(gone))
        if (fs::read_symlink(fd->path(), gone).filename() == name)
          numbers.insert(fd->path().filename());
    return numbers;
  }
};

TEST_F(Calibrate, TheTwinsLensIsFoundAndWrittenAsACalibration) {
  const auto outcome = calibrate({"lens", "--most-s", "90"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.output, HasSubstr("report.html"));
  EXPECT_TRUE(fs::exists(scratch_.path() / "twin.calibration" / "report.html"));
  const auto found = calib::load_calibration(scratch_.path() / "twin_calibration.toml");
  ASSERT_TRUE(found) << found.error().what;
  const auto truth = calib::reference_rig().camera;
  EXPECT_NEAR(found->camera.fx_px / truth.fx_px, 1, 0.01);
  const glm::dvec2 corner(40, 40);
  EXPECT_LT(glm::distance(found->camera.distort(corner), truth.distort(corner)), 1);
  EXPECT_THAT(found->made.lens, HasSubstr("images"));
}

TEST_F(Calibrate, TheTwinsProjectorIsFoundByStructuredLight) {
  // 50 mm beside the camera, which the rig does not know.
  auto truth = calib::reference_rig();
  truth.projector.parallax = {82, 0, 0};
  const auto file = (scratch_.path() / "truth.toml").string();
  std::ofstream(file) << calib::print_calibration(truth);
  const auto outcome = calibrate(
      {"screen", "--most-s", "150", "--apply", "--set", "twin.geometry.calibration=" + file,
       "--set", "twin.prop.light_late_ms=5", "--set", "twin.prop.light_gamma=1.8"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  expect_projector(8, 1.8, outcome);
  EXPECT_THAT(outcome.log, HasSubstr("5 places of the board"));
  const auto found = calib::load_calibration(scratch_.path() / "twin_calibration.toml");
  ASSERT_TRUE(found) << found.error().what;
  for (const double depth_m : {0.65, 0.8})
    for (const glm::dvec2 px : {glm::dvec2(180, 135), {540, 135}, {180, 405}, {540, 405}})
      EXPECT_LT(glm::distance(found->projector.pixel_of(px, depth_m),
                              truth.projector.pixel_of(px, depth_m)),
                1)
          << px.x << " " << px.y << " at " << depth_m << " m";
}

TEST_F(Calibrate, ASecondProjectorIsFoundInTheSameWay) {
  const auto truth = *calib::load_calibration("config/calibrations/right_of_two.toml");
  const auto here = [](const char* file) { return fs::absolute(file).string(); };
  std::ofstream(rig_file()) << "calibration = \"" << here("config/calibrations/left_of_two.toml")
                            << "\"\n[projector2]\nbackend = \"twin\"\nlatency_ms = 4\n";
  const auto outcome = calibrate(
      {"screen", "--second-projector", "--projector", "1024x768", "--most-s", "150", "--apply",
       "--set", "twin.geometry.calibration=" + here("config/calibrations/right_of_two.toml"),
       "--set", "twin.prop.light_late_ms=5"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  const auto rig = config::load_rig(rig_file(), {});
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_NEAR(rig->projector2.latency_ms, 9, 1) << outcome.output << outcome.log;
  EXPECT_EQ(rig->projector.latency_ms, config::Rig().projector.latency_ms);
  ASSERT_EQ(rig->projector2.calibration, scratch_.path() / "twin_projector2_calibration.toml");
  const auto found = calib::load_calibration(rig->projector2.calibration);
  ASSERT_TRUE(found) << found.error().what;
  for (const glm::dvec2 px : {glm::dvec2(180, 135), {540, 135}, {180, 405}, {540, 405}})
    EXPECT_LT(
        glm::distance(found->projector.pixel_of(px, 0.73), truth.projector.pixel_of(px, 0.73)), 2)
        << px.x << " " << px.y;
}

TEST_F(Calibrate, TheTwinsTrackerIsFoundByAReflector) {
  const auto outcome = calibrate(
      {"tracker", "--reflector", "8", "--most-s", "45", "--set", "twin.geometry.tracker_mm=20",
       "--set", "twin.geometry.tracker_deg=2", "--set", "twin.tracker.offset_mm=0", "--set",
       "twin.tracker.rotation_deg=0", "--set", "twin.tracker.scale=1"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  const auto found = calib::load_calibration(scratch_.path() / "twin_calibration.toml");
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_THAT(found->made.tracker, HasSubstr("held out"));
  // Twenty millimetres were wrong, in the middle of the volume.
  const auto& before = calib::reference_rig().camera_from_tracker;
  const glm::dvec4 middle = glm::inverse(before) * glm::dvec4(0, 0, 0.73, 1);
  const double moved_mm =
      1e3 * glm::distance(glm::dvec3(found->camera_from_tracker * middle), {0, 0, 0.73});
  EXPECT_NEAR(moved_mm, 20, 3);
}

TEST_F(Calibrate, RecordedPointsAreJudged) {
  const auto missing = handcast({"calibrate", rig_file(), "--points", scratch_.path().string()});
  EXPECT_NE(missing.exit_code, 0);
  EXPECT_THAT(missing.log, HasSubstr("2dpoints.npy"));
}

TEST_F(Calibrate, TheCheckTellsAProjectorThatHasMovedAndChangesNothing) {
  (void)rig_file();
  const auto before = files();
  const auto good = calibrate({"--check", "--set", "pose.backend=none"});
  EXPECT_EQ(good.exit_code, 0) << good.log;
  EXPECT_THAT(good.output, HasSubstr("screen: as calibrated"));
  const auto moved = calibrate(
      {"--check", "--set", "pose.backend=none", "--set", "twin.geometry.homography_px=3"});
  EXPECT_EQ(moved.exit_code, 1) << moved.log;
  EXPECT_THAT(moved.output, HasSubstr("screen: has moved"));
  EXPECT_EQ(files(), before);
}

TEST_F(Calibrate, WhatWasMeasuredIsHandedOverBesideARigThatIsUp) {
  const fs::path folder = scratch_.path() / "twin.calibration";
  fs::create_directories(folder);
  auto draft = calib::reference_rig();
  draft.made.lens = draft.made.screen = draft.made.tracker = "measured";
  std::ofstream(folder / "draft.toml") << calib::print_calibration(draft);
  std::ofstream(folder / "light.json") << "measured";
  std::ofstream(folder / "screen.settings") << "projector.latency_ms = 4\n";
  const auto rig = up();
  wait_until_light();
  EXPECT_THAT(calibrate({"lens"}).log, HasSubstr("stop it with `handcast down`"));
  EXPECT_THAT(calibrate({"--restart"}).log, HasSubstr("stop it with `handcast down`"));
  const auto outcome = calibrate({"--apply"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.output, HasSubstr("nothing is left to be measured"));
  EXPECT_TRUE(fs::exists(scratch_.path() / "twin_calibration.toml"));
  const auto applied = config::load_rig(rig_file(), {});
  ASSERT_TRUE(applied) << applied.error().what;
  EXPECT_EQ(applied->projector.latency_ms, 4);
  fs::remove(folder / "light.json");
  EXPECT_THAT(calibrate({}).log, HasSubstr("stop it with `handcast down`"));
}

TEST_F(Calibrate, TheLightOnAStillHandIsJudged) {
  const auto outcome = calibrate({"light", "--most-s", "60"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.log, HasSubstr("finger tips"));
  EXPECT_FALSE(fs::exists(scratch_.path() / "twin_calibration.toml"))
      << "it measures no part of it";
  std::ifstream report(scratch_.path() / "twin.calibration" / "report.html");
  const std::string page((std::istreambuf_iterator<char>(report)), {});
  EXPECT_THAT(page, HasSubstr("Grey values 0 to 255 of the background"));
}

TEST_F(Calibrate, ARigThatCannotStartIsToldInASentence) {
  const auto outcome = calibrate({"lens", "--set", "camera.rate_hz=-5"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.log, HasSubstr("camera.rate_hz"));
  EXPECT_FALSE(fs::exists(scratch_.path() / "twin_calibration.toml"));
}

TEST_F(Calibrate, ASessionThatIsKilledTakesItsRigWithIt) {
  const Command session(scratch_.path(),
                        {"calibrate", rig_file(), "lens", "--yes", "--most-s", "300"});
  ASSERT_TRUE(eventually([&] { return session.log().find("lens:") != std::string::npos; }))
      << session.log();
  ASSERT_TRUE(eventually([&] { return processes_of(scratch_.path()).size() > 5; }))
      << session.log();
  EXPECT_EQ(descriptors_of("lens.log"), (std::set<std::string>{"1", "2"}));
  session.signal(SIGKILL);
  EXPECT_TRUE(eventually([&] { return processes_of(scratch_.path()).empty(); }));
}

TEST_F(Calibrate, TheBoardIsPrinted) {
  const auto pdf = (scratch_.path() / "board.pdf").string();
  EXPECT_EQ(handcast({"calibrate", "--print-board", pdf}).exit_code, 0);
  EXPECT_GT(fs::file_size(pdf), 1000u);
}

}  // namespace
}  // namespace handcast::system_test
