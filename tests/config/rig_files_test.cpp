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

/// The differences between two rigs, except the name, the cascade and the software time.
std::vector<std::string> differences_in_hardware(const Rig& a, const Rig& b) {
  auto paths = differences(a, b);
  std::erase_if(paths, [](const std::string& path) {
    return path == "name" || path == "projector.software_ms" || path.starts_with("cascade.");
  });
  return paths;
}

TEST(ShippedRigs, TwinIsTheDefaults) {
  EXPECT_THAT(differences(shipped("twin"), Rig{}), UnorderedElementsAre("name"));
}

TEST(ShippedRigs, PaperAndBaselineDifferFromTwinInSoftwareAlone) {
  EXPECT_THAT(differences_in_hardware(shipped("paper"), shipped("twin")), IsEmpty());
  EXPECT_THAT(differences_in_hardware(shipped("baseline"), shipped("twin")), IsEmpty());
}

TEST(ShippedRigs, PaperIsThePapersCascade) {
  const auto rig = shipped("paper");
  EXPECT_EQ(rig.projector.software_ms, 3.19);
  EXPECT_EQ(rig.cascade.filter.method, FilterMethod::paper);
  EXPECT_EQ(rig.cascade.correct.method, CorrectMethod::grid);
  EXPECT_EQ(rig.cascade.correct.grid_columns * rig.cascade.correct.grid_rows, 21 * 21);
  EXPECT_EQ(rig.cascade.fill.reach_px, 10);
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
