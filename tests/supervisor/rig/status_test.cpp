// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

ServiceSpec pose_by(const char* backend) {
  return {.name = "pose", .stream = "pose.hands", .backend = backend, .wanted_hz = 110};
}

/// The status of a rig whose one service has no program.
nlohmann::json status_without_program(ServiceSpec spec = pose_by("twin")) {
  auto loop = EventLoop::open().value();
  Launch launch;
  launch.program_folder = "/nowhere";
  Services services;
  services.push_back(
      std::make_unique<Service>(std::move(spec), launch, loop, [](Service&, Notice) {}));
  services.front()->start();
  const std::string name = "desk";
  const Recorder recorder;
  return status_of({name, services, recorder, 0, 60'000'000'000});
}

TEST(Status, ARecordingAndSubFramesAreNotHeldToTheRate) {
  const auto is_held = [](const ServiceSpec& spec) {
    return status_without_program(spec)["rings"]["pose.hands"]["is_held_to_it"].get<bool>();
  };
  EXPECT_TRUE(is_held(pose_by("twin")));
  EXPECT_FALSE(is_held(pose_by("replay")));
  auto sub_frames = pose_by("twin");
  sub_frames.counts_sub_frames = true;
  EXPECT_FALSE(is_held(sub_frames));
}

TEST(Status, AServiceThatDoesNotRunIsNotSettled) {
  const auto ring = status_without_program()["rings"]["pose.hands"];
  EXPECT_EQ(ring["wanted_hz"], 110);
  EXPECT_EQ(ring["is_settled"], false);
}

TEST(Status, AServiceWhoseProgramIsMissingIsToldWithItsReason) {
  const auto status = status_without_program()["services"]["pose"];
  EXPECT_EQ(status["state"], "failed");
  EXPECT_EQ(status["last_exit"], "exit 100");
  EXPECT_THAT(status["reason"].get<std::string>(), HasSubstr("/nowhere/handcast-pose"));
  EXPECT_TRUE(status["retry_s"].is_null());
  EXPECT_FALSE(status["log"].empty());
}

}  // namespace
}  // namespace handcast::supervisor
