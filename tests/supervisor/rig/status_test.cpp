// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

TEST(Status, AServiceWhoseProgramIsMissingIsToldWithItsReason) {
  auto loop = EventLoop::open().value();
  Launch launch;
  launch.program_folder = "/nowhere";
  Services services;
  services.push_back(std::make_unique<Service>(
      ServiceSpec{.name = "pose", .stream = "", .backend = "twin", .wanted_hz = 0}, launch, loop,
      [](Service&, Notice) {}));
  services.front()->start();
  const std::string name = "desk";
  const Recorder recorder;
  const auto status = status_of({name, services, recorder, 0, 1'000'000'000})["services"]["pose"];
  EXPECT_EQ(status["state"], "failed");
  EXPECT_EQ(status["last_exit"], "exit 100");
  EXPECT_THAT(status["reason"].get<std::string>(), HasSubstr("/nowhere/handcast-pose"));
  EXPECT_TRUE(status["retry_s"].is_null());
  EXPECT_FALSE(status["log"].empty());
}

}  // namespace
}  // namespace handcast::supervisor
