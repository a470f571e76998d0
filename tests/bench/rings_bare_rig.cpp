// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_bare_rig.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "ipc/base/program.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

constexpr auto kRigName = "bare";
constexpr int kPrepare_us = 100'000;  // what a bare standby needs to be prepared, and more

std::vector<std::string> command_of(const std::filesystem::path& folder, bool standby) {
  std::vector<std::string> words{(folder / "handcast").string(),
                                 "up",
                                 (folder / "rig.toml").string(),
                                 "--set",
                                 "observer.enabled=false",
                                 "--set",
                                 "desk.page.listen="};
  for (const auto& [service, stream] : BareRig::streams())
    words.insert(words.end(), {"--set", fmt::format("{}.process.standby={}", service, standby)});
  return words;
}

}  // namespace

BarePrograms::BarePrograms() {
  const auto bin = program_folder();
  if (!std::filesystem::exists(bin / "handcast") ||
      !std::filesystem::exists(bin / "handcast_bare_daemon"))
    give_up("handcast or handcast_bare_daemon has not been built");
  std::filesystem::copy_file(bin / "handcast", folder() / "handcast");
  for (const auto& [service, stream] : BareRig::streams())
    std::filesystem::create_symlink(bin / "handcast_bare_daemon",
                                    folder() / ("handcast-" + service));
  std::filesystem::create_symlink(bin / "handcast_bare_daemon", folder() / "handcast-content");
  if (!(std::ofstream(folder() / "rig.toml") << fmt::format("name = \"{}\"\n", kRigName)))
    give_up("no rig file for a bare rig");
}

BareRig::BareRig(const BarePrograms& programs, bool standby)
    : RigProcess(kRigName, command_of(programs.folder(), standby), programs.folder() / "log") {
  wait_until([standby](const nlohmann::json& services) {
    return std::ranges::all_of(streams(), [&](const auto& named) {
      const auto service = services.value(named.first, nlohmann::json::object());
      return service.value("state", "") == "ready" && service["standby"].is_null() != standby;
    });
  });
  ::usleep(kPrepare_us);
}

const std::map<std::string, std::string>& BareRig::streams() {
  static const std::map<std::string, std::string> kStreams{{"camera", "camera.frames"},
                                                           {"pose", "pose.hands"},
                                                           {"landmarks", "landmarks.hands"},
                                                           {"projector", "projection.frames"}};
  return kStreams;
}

}  // namespace handcast::bench
