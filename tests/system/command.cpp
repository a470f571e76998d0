// SPDX-License-Identifier: Apache-2.0
#include "tests/system/command.hpp"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "ipc/base/clock.hpp"

namespace handcast::system_test {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void send_to_file(int fd, const std::filesystem::path& file) {
  dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600), fd);
}

}  // namespace

Command::Command(const std::filesystem::path& folder, const Arguments& arguments) {
  static int number = 0;
  output_ = folder / ("output-" + std::to_string(++number));
  log_ = folder / ("log-" + std::to_string(number));
  const auto program = (program_folder() / "handcast").string();
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);

  pid_ = fork();
  if (pid_ != 0) return;
  send_to_file(STDOUT_FILENO, output_);
  send_to_file(STDERR_FILENO, log_);
  setenv("HANDCAST_SCOPE", folder.c_str(), 1);
  execv(program.c_str(), pointers.data());
  _exit(127);
}

Command::~Command() {
  if (reaped_) return;
  signal(SIGKILL);
  wait();
}

void Command::signal(int number) const {
  if (!reaped_) kill(pid_, number);
}

pid_t Command::supervisor() const {
  const auto number = std::to_string(pid_);
  std::ifstream children("/proc/" + number + "/task/" + number + "/children");
  for (pid_t child = 0; children >> child;)
    if (text_of("/proc/" + std::to_string(child) + "/cmdline").find("--kept") != std::string::npos)
      return child;
  return -1;
}

bool Command::running() { return !reaped_ && is_alive(pid_); }

int Command::wait() {
  if (reaped_) return exit_code_;
  int status = 0;
  waitpid(pid_, &status, 0);
  reaped_ = true;
  return exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string Command::output() const { return text_of(output_); }
std::string Command::log() const { return text_of(log_); }

bool eventually(const std::function<bool()>& done) {
  for (const auto limit = Deadline::in(std::chrono::minutes(1)); !limit.passed();) {
    if (done()) return true;
    usleep(20'000);
  }
  return done();
}

bool is_alive(pid_t pid) {
  const auto stat = text_of("/proc/" + std::to_string(pid) + "/stat");
  return !stat.empty() && stat.find(") Z ") == std::string::npos;
}

std::vector<pid_t> processes_of(const std::filesystem::path& scope) {
  const auto mark = '\0' + ("HANDCAST_SCOPE=" + scope.string()) + '\0';
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const pid_t pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 0 || pid == getpid() || !is_alive(pid)) continue;
    if (('\0' + text_of(entry.path() / "environ")).find(mark) != std::string::npos)
      pids.push_back(pid);
  }
  return pids;
}

void kill_all_of(const std::filesystem::path& scope) {
  for (auto found = processes_of(scope); !found.empty(); found = processes_of(scope)) {
    for (const auto pid : found) kill(pid, SIGKILL);
    usleep(10'000);  // a keeper may have started another one
  }
}

std::filesystem::path program_folder() {
  const char* folder = std::getenv("HANDCAST_BIN");
  return folder ? folder : "build/bin";
}

std::string missing_program() {
  for (const auto* name : {"handcast", "handcast-camera", "handcast-pose", "handcast-landmarks",
                           "handcast-projector", "handcast-observer"})
    if (!std::filesystem::exists(program_folder() / name))
      return std::string(name) + " has not been built";
  return "";
}

}  // namespace handcast::system_test
