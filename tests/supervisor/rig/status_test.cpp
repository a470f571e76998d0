// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

ServiceSpec pose_by(const char* backend) {
  return {.name = "pose", .stream = "pose.hands", .backend = backend, .wanted_hz = 110};
}

/// The figures of a rig whose one service has no program.
Figures figures_without_program(ServiceSpec spec = pose_by("twin")) {
  auto loop = EventLoop::open().value();
  Launch launch;
  launch.program_folder = "/nowhere";
  Services services;
  services.push_back(
      std::make_unique<Service>(std::move(spec), launch, loop, [](Service&, Notice) {}));
  services.front()->start();
  const std::string name = "desk";
  const Recorder recorder;
  return figures_of({name, services, recorder, 0, 60'000'000'000});
}

TEST(Status, ARecordingAndSubFramesAreNotHeldToTheRate) {
  const auto is_held = [](const ServiceSpec& spec) {
    return figures_without_program(spec).streams.at("pose.hands").is_held_to_it;
  };
  EXPECT_TRUE(is_held(pose_by("twin")));
  EXPECT_FALSE(is_held(pose_by("replay")));
  auto sub_frames = pose_by("twin");
  sub_frames.counts_sub_frames = true;
  EXPECT_FALSE(is_held(sub_frames));
}

TEST(Status, AServiceThatDoesNotRunIsNotSettled) {
  const auto ring = figures_without_program().streams.at("pose.hands");
  EXPECT_EQ(ring.wanted_hz, 110);
  EXPECT_FALSE(ring.is_settled);
}

TEST(Status, AServiceWhoseProgramIsMissingIsToldWithItsReason) {
  const auto pose = figures_without_program().services.at("pose");
  EXPECT_EQ(pose.state, "failed");
  EXPECT_EQ(pose.last_exit, "exit 100");
  EXPECT_THAT(pose.reason, HasSubstr("/nowhere/handcast-pose"));
  EXPECT_EQ(pose.retry_s, std::nullopt);
  EXPECT_FALSE(pose.log.empty());
}

}  // namespace
}  // namespace handcast::supervisor
