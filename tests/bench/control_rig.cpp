// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/control_rig.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "ipc/base/clock.hpp"
#include "ipc/control/control_client.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

using control::Request;
using control::Verb;

constexpr auto kRigName = "twin";
constexpr auto kSetting = "software_ms = 1.2";
constexpr int kWork_us = 400'000;

std::filesystem::path folder_of_programs() {
  if (const char* folder = ::getenv("HANDCAST_BIN")) return std::filesystem::absolute(folder);
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Starts a program, whose output goes to a file.
pid_t start(const std::vector<std::string>& words, const std::filesystem::path& log) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

int wait_for(pid_t pid) {
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

RigFolder::RigFolder() : programs_(folder_of_programs()) {
  std::string name = (std::filesystem::temp_directory_path() / "handcast-bench-XXXXXX").string();
  if (!::mkdtemp(name.data())) give_up("no folder for a rig");
  folder_ = name;
  ::setenv("HANDCAST_SCOPE", folder_.c_str(), 1);
  rig_text_ = text_of("config/rigs/twin.toml");
  if (rig_text_.find(kSetting) == std::string::npos)
    give_up(fmt::format("config/rigs/twin.toml has no '{}' to change", kSetting));
  record();
  std::ofstream(rig_file()) << rig_text_;
}

RigFolder::~RigFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void RigFolder::record() const {
  const auto recorded =
      wait_for(start({(programs_ / "handcast").string(), "simulate", "config/rigs/twin.toml",
                      "--quiet", "--joints-only", "--seconds", "0.5", "--warm-up", "0.1", "--set",
                      "camera.rate_hz=100", "--record", (folder_ / "recording").string()},
                     folder_ / "log"));
  if (recorded != 0) give_up("handcast simulate made no recording: " + text_of(folder_ / "log"));
}

void RigFolder::change_a_projector_setting() {
  auto text = rig_text_;
  text.replace(text.find(kSetting), std::string(kSetting).size(),
               fmt::format("software_ms = {:.2f}", 1.2 + 0.01 * (++changes_ % 50)));
  std::ofstream(rig_file(), std::ios::trunc) << text;
}

TwinRig::TwinRig(const RigFolder& folder, const std::vector<std::string>& settings) {
  std::vector<std::string> words{
      (folder.programs() / "handcast").string(),
      "up",
      folder.rig_file().string(),
      "--out",
      folder.path().string(),
      "--set",
      "camera.replay.directory=" + (folder.path() / "recording").string()};
  for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
  pid_ = start(words, folder.path() / "log");
  settle("");
}

TwinRig::~TwinRig() {
  ::kill(pid_, SIGTERM);
  if (const int code = wait_for(pid_); code != 0)
    fmt::print(stderr, "bench_control: the rig ended with {}\n", code);
}

nlohmann::json TwinRig::ask(const Request& request) const {
  const auto answer = control::ask(kRigName, request);
  if (!answer) give_up(answer.error().what);
  return *answer;
}

bool TwinRig::is_ready(const std::string& standby) const {
  const auto answer = control::ask(kRigName, {.verb = Verb::status, .service = {}, .backend = {}});
  if (!answer) return false;
  const auto services = (*answer)["status"]["services"];
  for (const auto& [name, service] : services.items())
    if (service["state"] != "ready" || (name == standby && service["standby"].is_null()))
      return false;
  return services.size() > 0;
}

void TwinRig::settle(const std::string& standby) const {
  const auto limit = Deadline::in(std::chrono::seconds(30));
  while (!is_ready(standby)) {
    if (limit.passed()) give_up("the rig does not get ready");
    ::usleep(20'000);
  }
  ::usleep(kWork_us);
}

pid_t TwinRig::pid_of(const std::string& service) const {
  const auto answer = ask({.verb = Verb::status, .service = {}, .backend = {}});
  return answer["status"]["services"][service]["pid"].get<pid_t>();
}

ipc::RingView TwinRig::view_of(const std::string& stream) const {
  auto answer =
      control::ask_with_descriptors(kRigName, {.verb = Verb::rings, .service = {}, .backend = {}});
  if (!answer) give_up(answer.error().what);
  const auto& names = answer->object["rings"];
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != stream) continue;
    auto view = ipc::RingView::open(std::move(answer->descriptors.at(i)));
    if (!view) give_up(view.error().what);
    return std::move(*view);
  }
  give_up(fmt::format("the rig has no ring '{}'", stream));
}

}  // namespace handcast::bench
