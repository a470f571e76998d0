// SPDX-License-Identifier: Apache-2.0
// The start and the stop of a rig of real processes.
#include <gmock/gmock.h>
#include <signal.h>

#include <fstream>

#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class Lifecycle : public SystemTest {};

std::size_t descriptors_of(pid_t pid) {
  const auto folder = std::filesystem::path("/proc") / std::to_string(pid) / "fd";
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST_F(Lifecycle, ARigMakesLightAndLeavesNothingBehind) {
  const auto rig = up();
  wait_until_light();
  expect_more_light();
  const auto services = pids();
  rig->signal(SIGTERM);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  for (const auto pid : services) EXPECT_FALSE(is_alive(pid));
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(Lifecycle, DownStopsTheRigAndReturnsWhenItHasStopped) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  for (const auto pid : services) EXPECT_FALSE(is_alive(pid));
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_THAT(traces(), IsEmpty());
  const auto status = handcast({"status"});
  EXPECT_EQ(status.exit_code, 111);
  EXPECT_THAT(status.log, HasSubstr("no rig is up"));
}

TEST_F(Lifecycle, ARunOfSomeSecondsEndsByItselfAndKeepsItsFigures) {
  const auto out = scratch_.path() / "out";
  const auto rig = up({"--seconds", "4", "--out", out.string(), "--set", "observer.enabled=false"});
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  const auto report = nlohmann::json::parse(std::ifstream(out / "live.json"), nullptr, false);
  EXPECT_GE(report["seconds"], 4);
  EXPECT_EQ(report["rates"]["camera"]["wanted_hz"], 60);
  EXPECT_GT(report["rates"]["camera"]["held_hz"], 0);
  EXPECT_EQ(report["services"]["pose"]["backend"], "twin");
  EXPECT_EQ(report["services"]["pose"]["restarts"], 0);
  EXPECT_GT(report["stage_us"]["frame"]["count"], 0);
  EXPECT_GE(report["stage_us"]["frame"]["p99"], report["stage_us"]["frame"]["p50"]);
}

TEST_F(Lifecycle, RestartingAServiceAgainAndAgainTakesNoDescriptors) {
  const auto rig = up();
  wait_until_light();
  const auto before =
      descriptors_of(rig->supervisor());  // may include the connection of the last status request
  for (int i = 0; i < 3; ++i) EXPECT_EQ(handcast({"restart", "observer"}).exit_code, 0);
  EXPECT_EQ(service("observer")["restarts"], 3);
  EXPECT_TRUE(eventually([&] { return descriptors_of(rig->supervisor()) <= before; }))
      << before << " became " << descriptors_of(rig->supervisor());
}

}  // namespace
}  // namespace handcast::system_test
