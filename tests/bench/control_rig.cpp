// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/control_rig.hpp"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "ipc/base/program.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

constexpr auto kRigName = "twin";
constexpr auto kSetting = "software_ms = 2.0";
constexpr int kWork_us = 400'000;

std::filesystem::path folder_of_programs() {
  if (const char* folder = ::getenv("HANDCAST_BIN")) return std::filesystem::absolute(folder);
  return program_folder();
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> command_of(const RigFolder& folder,
                                    const std::vector<std::string>& settings) {
  std::vector<std::string> words{
      (folder.programs() / "handcast").string(),
      "up",
      folder.rig_file().string(),
      "--out",
      folder.path().string(),
      "--set",
      "camera.replay.directory=" + (folder.path() / "recording").string()};
  for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
  return words;
}

}  // namespace

RigFolder::RigFolder() : programs_(folder_of_programs()) {
  rig_text_ = text_of("config/rigs/twin.toml");
  if (rig_text_.find(kSetting) == std::string::npos)
    give_up(fmt::format("config/rigs/twin.toml has no '{}' to change", kSetting));
  record();
  std::ofstream(rig_file()) << rig_text_;
}

void RigFolder::record() const {
  const auto log = path() / "log";
  const auto recorded =
      wait_for(start({(programs_ / "handcast").string(), "simulate", "config/rigs/twin.toml",
                      "--quiet", "--joints-only", "--seconds", "0.5", "--warm-up", "0.1", "--set",
                      "camera.rate_hz=100", "--record", (path() / "recording").string()},
                     log));
  if (recorded != 0) give_up("handcast simulate made no recording: " + text_of(log));
}

void RigFolder::change_a_projector_setting() {
  auto text = rig_text_;
  text.replace(text.find(kSetting), std::string(kSetting).size(),
               fmt::format("software_ms = {:.2f}", 1.2 + 0.01 * (++changes_ % 50)));
  std::ofstream(rig_file(), std::ios::trunc) << text;
}

TwinRig::TwinRig(const RigFolder& folder, const std::vector<std::string>& settings)
    : RigProcess(kRigName, command_of(folder, settings), folder.path() / "log") {
  settle("");
}

void TwinRig::settle(const std::string& standby) const {
  wait_until([&](const nlohmann::json& services) {
    for (const auto& [name, service] : services.items())
      if (service["state"] != "ready" || (name == standby && service["standby"].is_null()))
        return false;
    return !services.empty();
  });
  ::usleep(kWork_us);
}

}  // namespace handcast::bench
