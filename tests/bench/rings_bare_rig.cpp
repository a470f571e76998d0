// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_bare_rig.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

#include "ipc/control/control_client.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

using control::Request;
using control::Verb;

constexpr auto kRigName = "bare";
constexpr int kPrepare_us = 100'000;  // what a bare spare needs to be prepared, and more

[[noreturn]] void become_rig(const std::filesystem::path& folder, bool standby) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int log = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  std::vector<std::string> words{(folder / "handcast").string(), "up",
                                 (folder / "rig.toml").string(), "--set", "observer.enabled=false"};
  for (const auto& [service, stream] : BareRig::streams())
    words.insert(words.end(), {"--set", fmt::format("{}.process.standby={}", service, standby)});
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

}  // namespace

BarePrograms::BarePrograms() {
  std::string name = (std::filesystem::temp_directory_path() / "handcast-bench-XXXXXX").string();
  if (!::mkdtemp(name.data())) give_up("no folder for the programs of a bare rig");
  folder_ = name;
  const auto bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  if (!std::filesystem::exists(bin / "handcast") ||
      !std::filesystem::exists(bin / "handcast_bare_daemon"))
    give_up("handcast or handcast_bare_daemon has not been built");
  std::filesystem::copy_file(bin / "handcast", folder_ / "handcast");
  for (const auto& [service, stream] : BareRig::streams())
    std::filesystem::create_symlink(bin / "handcast_bare_daemon",
                                    folder_ / ("handcast-" + service));
  const UniqueFd rig(::open((folder_ / "rig.toml").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  const auto text = fmt::format("name = \"{}\"\n", kRigName);
  if (::write(rig.get(), text.data(), text.size()) < 0) give_up("no rig file for a bare rig");
  ::setenv("HANDCAST_SCOPE", folder_.c_str(), 1);
}

BarePrograms::~BarePrograms() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

BareRig::BareRig(const BarePrograms& programs, bool standby) : pid_(::fork()) {
  if (pid_ == 0) become_rig(programs.folder(), standby);
  const auto limit = Deadline::in(std::chrono::seconds(20));
  while (!is_ready(standby)) {
    if (limit.passed()) give_up("the bare rig does not get ready");
    ::usleep(5'000);
  }
  ::usleep(kPrepare_us);
}

BareRig::~BareRig() {
  ::kill(pid_, SIGTERM);
  int status = 0;
  ::waitpid(pid_, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fmt::print(stderr, "bench_rings_restarts: the supervisor ended with {}\n", status);
}

const std::map<std::string, std::string>& BareRig::streams() {
  static const std::map<std::string, std::string> kStreams{{"camera", "camera.frames"},
                                                           {"pose", "pose.hands"},
                                                           {"landmarks", "landmarks.hands"},
                                                           {"projector", "projection.frames"}};
  return kStreams;
}

nlohmann::json BareRig::status() const {
  const auto answer = control::ask(kRigName, Request{.verb = Verb::status});
  return answer ? (*answer)["status"] : nlohmann::json();
}

bool BareRig::is_ready(bool standby) const {
  const auto now = status();
  if (now.is_null()) return false;
  for (const auto& [service, stream] : streams()) {
    const auto& one = now["services"][service];
    if (one["state"] != "ready" || one["standby"].is_null() == standby) return false;
  }
  return true;
}

pid_t BareRig::pid_of(const std::string& service) const {
  return status()["services"][service]["pid"].get<pid_t>();
}

ipc::RingView BareRig::view_of(const std::string& stream) const {
  auto answer = must(control::ask_with_descriptors(kRigName, Request{.verb = Verb::rings}));
  const auto& names = answer.object["rings"];
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == stream) return must(ipc::RingView::open(std::move(answer.descriptors.at(i))));
  give_up(fmt::format("the bare rig has no ring '{}'", stream));
}

}  // namespace handcast::bench
