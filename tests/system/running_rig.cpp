// SPDX-License-Identifier: Apache-2.0
#include "tests/system/running_rig.hpp"

#include <algorithm>

namespace handcast::system_test {

void SystemTest::SetUp() {
  if (const auto missing = missing_program(); !missing.empty()) GTEST_SKIP() << missing;
}

SystemTest::Outcome SystemTest::handcast(const Arguments& arguments) const {
  Command command(scratch_.path(), arguments);
  const int exit_code = command.wait();
  return {exit_code, command.output(), command.log()};
}

std::unique_ptr<Command> SystemTest::up(const Arguments& more) const {
  Arguments arguments{"up", "config/rigs/twin.toml"};
  for (const auto* setting : {"camera.rate_hz=60", "projector.rate_hz=60", "observer.rate_hz=2",
                              "supervisor.ready_s=60", "landmarks.backend=twin"})
    arguments.insert(arguments.end(), {"--set", setting});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return std::make_unique<Command>(scratch_.path(), arguments);
}

void SystemTest::wait_until_light() const {
  ASSERT_TRUE(eventually([this] {
    const auto now = status();
    if (now.is_null()) return false;
    const bool ready = std::ranges::all_of(
        kServices, [&](const auto& name) { return now["services"][name]["state"] == "ready"; });
    return ready && now["rings"]["projection.frames"]["count"] > 0;
  }));
}

nlohmann::json SystemTest::status() const {
  const auto outcome = handcast({"status", "--json"});
  return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.output) : nlohmann::json();
}

std::uint64_t SystemTest::light() const {
  return status()["rings"]["projection.frames"]["count"].get<std::uint64_t>();
}

void SystemTest::expect_more_light() const {
  const auto before = light();
  EXPECT_TRUE(eventually([&] { return light() > before; }));
}

std::vector<pid_t> SystemTest::pids() const {
  std::vector<pid_t> pids;
  const auto now = status();
  for (const auto& name : kServices) pids.push_back(now["services"][name]["pid"].get<pid_t>());
  return pids;
}

std::vector<std::string> SystemTest::traces() const {
  std::vector<std::string> names;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", absent))
    if (entry.path().string().find("handcast") != std::string::npos) names.push_back(entry.path());
  for (const auto pid : processes_of(scratch_.path()))
    names.push_back("process " + std::to_string(pid));
  return names;
}

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "";
  const auto before = text.rfind('\n', end);
  return text.substr(before == std::string::npos ? 0 : before + 1,
                     end - (before == std::string::npos ? 0 : before + 1) + 1);
}

}  // namespace handcast::system_test
