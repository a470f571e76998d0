// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

/// The status of a rig whose one service has no program.
nlohmann::json status_without_program(std::int64_t uptime_ns) {
  auto loop = EventLoop::open().value();
  Launch launch;
  launch.program_folder = "/nowhere";
  Services services;
  services.push_back(std::make_unique<Service>(
      ServiceSpec{.name = "pose", .stream = "pose.hands", .backend = "twin", .wanted_hz = 110},
      launch, loop, [](Service&, Notice) {}));
  services.front()->start();
  const std::string name = "desk";
  const Recorder recorder;
  return status_of({name, services, recorder, 0, uptime_ns});
}

TEST(Status, AServiceThatDoesNotRunIsNotHeldToItsRate) {
  const auto ring = status_without_program(60'000'000'000)["rings"]["pose.hands"];
  EXPECT_EQ(ring["wanted_hz"], 110);
  EXPECT_EQ(ring["is_held_to_it"], false);
}

TEST(Status, AServiceWhoseProgramIsMissingIsToldWithItsReason) {
  const auto status = status_without_program(1'000'000'000)["services"]["pose"];
  EXPECT_EQ(status["state"], "failed");
  EXPECT_EQ(status["last_exit"], "exit 100");
  EXPECT_THAT(status["reason"].get<std::string>(), HasSubstr("/nowhere/handcast-pose"));
  EXPECT_TRUE(status["retry_s"].is_null());
  EXPECT_FALSE(status["log"].empty());
}

}  // namespace
}  // namespace handcast::supervisor
