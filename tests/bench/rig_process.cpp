// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rig_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "ipc/control/control_client.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {

using control::Verb;

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

RigScope::RigScope() {
  std::string name = (std::filesystem::temp_directory_path() / "handcast-bench-XXXXXX").string();
  if (!::mkdtemp(name.data())) give_up("no folder for a rig");
  folder_ = name;
  ::setenv("HANDCAST_SCOPE", folder_.c_str(), 1);
}

RigScope::~RigScope() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

RigProcess::RigProcess(std::string name, const std::vector<std::string>& words,
                       const std::filesystem::path& log)
    : name_(std::move(name)), pid_(start(words, log)) {}

RigProcess::~RigProcess() {
  ::kill(pid_, SIGTERM);
  if (const int code = wait_for(pid_); code != 0)
    fmt::print(stderr, "the rig '{}' ended with {}\n", name_, code);
}

nlohmann::json RigProcess::ask(const control::Request& request) const {
  return must(control::ask(name_, request));
}

void RigProcess::wait_until(
    const std::function<bool(const nlohmann::json& services)>& is_ready) const {
  const auto ready = [&] {
    const auto answer = control::ask(name_, {.verb = Verb::status, .service = {}, .backend = {}});
    return answer && is_ready((*answer)["status"]["services"]);
  };
  for (const auto limit = Deadline::in(std::chrono::seconds(30)); !ready(); ::usleep(5'000))
    if (limit.passed()) give_up(fmt::format("the rig '{}' does not get ready", name_));
}

pid_t RigProcess::pid_of(const std::string& service) const {
  const auto answer = ask({.verb = Verb::status, .service = {}, .backend = {}});
  return answer["status"]["services"][service]["pid"].get<pid_t>();
}

ipc::RingView RigProcess::view_of(const std::string& stream) const {
  auto answer = must(
      control::ask_with_descriptors(name_, {.verb = Verb::rings, .service = {}, .backend = {}}));
  const auto& names = answer.object["rings"];
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == stream) return must(ipc::RingView::open(std::move(answer.descriptors.at(i))));
  give_up(fmt::format("the rig '{}' has no ring '{}'", name_, stream));
}

}  // namespace handcast::bench
