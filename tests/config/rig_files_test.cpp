// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/config/every_setting.hpp"

/// Tests of the rig files in config/rigs.
namespace handcast::config {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

Rig shipped(const std::string& name) {
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto rig =
      load_rig(std::filesystem::path(source ? source : ".") / "config/rigs" / (name + ".toml"));
  EXPECT_TRUE(rig) << rig.error().what;
  return rig ? *rig : Rig{};
}

/// The differences between two rigs, except the name and the software: the cascade, the detector
/// and their times.
std::vector<std::string> differences_in_hardware(const Rig& a, const Rig& b) {
  auto paths = differences(a, b);
  std::erase_if(paths, [](const std::string& path) {
    return path == "name" || path == "projector.software_ms" || path.starts_with("cascade.") ||
           path.starts_with("landmarks.") || path.starts_with("twin.detector.") ||
           path.starts_with("twin.projector.work_");
  });
  return paths;
}

/// The settings of a rig that are not the defaults, as lines of a rig file.
std::vector<std::string> changes(Rig rig) {
  Rig defaults;
  const auto of_rig = every_setting(rig), of_defaults = every_setting(defaults);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < of_rig.size(); ++i)
    if (const auto value = print_value(of_rig[i]); value != print_value(of_defaults[i]))
      lines.push_back(of_rig[i].path + " = " + value);
  return lines;
}

TEST(ShippedRigs, TwinIsTheDefaultsWithOurNetworkAndTheTimesOfOurSoftware) {
  EXPECT_THAT(
      changes(shipped("twin")),
      UnorderedElementsAre("name = \"twin\"", "landmarks.backend = \"handcast\"",
                           "projector.software_ms = 2", "twin.detector.age_ms = 5",
                           "twin.detector.age_sd_ms = 0.6", "twin.detector.noise_px = 0.6",
                           "twin.detector.bias_px = 2.5", "twin.detector.bias_ms = 350",
                           "twin.detector.bias_hidden = 6", "twin.projector.work_ms = 1.6"));
}

TEST(ShippedRigs, PaperAndBaselineDifferFromTwinInSoftwareAlone) {
  EXPECT_THAT(differences_in_hardware(shipped("paper"), shipped("twin")), IsEmpty());
  EXPECT_THAT(differences_in_hardware(shipped("baseline"), shipped("twin")), IsEmpty());
}

TEST(ShippedRigs, PaperIsThePapersCascade) {
  // All that differs from our cascade; what is equal (similarity, a grid of 21 x 21 nodes, the
  // threshold, reflection) is checked below.
  EXPECT_THAT(
      changes(shipped("paper")),
      UnorderedElementsAre(
          "name = \"paper\"", "landmarks.backend = \"mediapipe\"", "landmarks.fallback = \"twin\"",
          "projector.software_ms = 3.19", "twin.detector.noise_px = 0.6",
          "twin.detector.bias_px = 2.5", "twin.detector.bias_ms = 350",
          "twin.detector.bias_hidden = 6", "cascade.predict.method = \"velocity\"",
          "cascade.predict.still_mm_s = 0", "cascade.skin.fit = false",
          "cascade.skin.widths = false", "cascade.filter.method = \"paper\"",
          "cascade.filter.blend_ms = 0", "cascade.correct.method = \"grid\"",
          "cascade.correct.alpha = 0.5", "cascade.correct.outline = false",
          "cascade.mask.advance = false", "cascade.fill.reach_px = 10", "cascade.fill.fade_px = 0",
          "cascade.register.method = \"none\"", "cascade.ladder.rung = \"landmarks\""));
  const auto cascade = shipped("paper").cascade;
  EXPECT_EQ(cascade.correct.grid_columns, 21);
  EXPECT_EQ(cascade.correct.grid_rows, 21);
  EXPECT_EQ(cascade.fill.method, FillMethod::reflect);
  EXPECT_EQ(shipped("paper").twin.detector.age_ms, 16.2);
}

/// A model with white noise is what an offset filter is made for: it flatters ours.
TEST(ShippedRigs, NoRigHasADetectorOfWhiteNoise) {
  for (const char* name : {"twin", "paper"}) {
    const auto rig = shipped(name);
    EXPECT_NE(rig.landmarks.backend, "twin") << name;
    EXPECT_GT(rig.twin.detector.bias_px, 2 * rig.twin.detector.noise_px) << name;
  }
}

TEST(ShippedRigs, FramesOfOurSoftwareTakeTimesThatMissRefreshes) {
  for (const char* name : {"twin", "baseline"}) {
    const auto rig = shipped(name);
    EXPECT_GT(rig.twin.projector.work_ms, 0) << name;
    EXPECT_GT(rig.twin.projector.work_spread, 0) << name;
    EXPECT_GE(rig.projector.software_ms, rig.twin.projector.work_ms) << name;
  }
}

TEST(ShippedRigs, TwinIsTheCascadeThatTheDocumentsDescribe) {
  const auto cascade = shipped("twin").cascade;
  EXPECT_EQ(cascade.filter.method, FilterMethod::articulated);
  EXPECT_EQ(cascade.correct.method, CorrectMethod::vertices);
  EXPECT_EQ(cascade.registration.method, RegisterMethod::mask);
  EXPECT_EQ(cascade.ladder.rung, RungChoice::registered);
  EXPECT_TRUE(cascade.skin.fit);
  EXPECT_TRUE(cascade.mask.advance);
}

TEST(ShippedRigs, BaselinePredictsAndDrawsOnly) {
  const auto rig = shipped("baseline");
  EXPECT_EQ(rig.cascade.predict.method, PredictMethod::velocity);
  EXPECT_EQ(rig.cascade.filter.method, FilterMethod::none);
  EXPECT_EQ(rig.cascade.correct.method, CorrectMethod::none);
  EXPECT_EQ(rig.cascade.fill.method, FillMethod::none);
}

TEST(ShippedRigs, WebcamHasNoTracker) {
  const auto rig = shipped("webcam");
  EXPECT_EQ(rig.camera.backend, "v4l2");
  EXPECT_EQ(rig.pose.backend, "none");
  EXPECT_EQ(rig.landmarks.backend, "handcast");
  EXPECT_EQ(rig.projector.backend, "window");
}

TEST(ShippedRigs, ReplayReadsOneRecordingWithAllSensors) {
  const auto rig = shipped("replay");
  for (const auto* sensor : {&rig.camera.backend, &rig.pose.backend, &rig.landmarks.backend})
    EXPECT_EQ(*sensor, "replay");
  EXPECT_TRUE(rig.camera.replay.directory.ends_with("/out/recording"))
      << rig.camera.replay.directory;
  EXPECT_EQ(rig.pose.replay.directory, rig.camera.replay.directory);
  EXPECT_EQ(rig.landmarks.replay.directory, rig.camera.replay.directory);
}

}  // namespace
}  // namespace handcast::config
