// SPDX-License-Identifier: Apache-2.0
#include "tests/system/terminal.hpp"

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <vector>

namespace handcast::system_test {

Terminal::Terminal(const std::filesystem::path& folder, const Arguments& arguments) {
  const auto program = (program_folder() / "handcast").string();
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
  if (pid_ != 0) return;
  setenv("HANDCAST_SCOPE", folder.c_str(), 1);
  execv(program.c_str(), pointers.data());
  _exit(127);
}

Terminal::~Terminal() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(terminal_);
}

bool Terminal::read_some() {
  constexpr int kPatience_ms = 100;
  std::array<char, 4096> bytes{};
  pollfd input{terminal_, POLLIN, 0};
  if (poll(&input, 1, kPatience_ms) == 0) return true;
  const auto count = read(terminal_, bytes.data(), bytes.size());
  if (count <= 0) return false;
  said_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

bool Terminal::says(std::string_view text) {
  bool is_said = false;
  bool runs = true;
  const auto done = [&] {
    runs = read_some();
    const auto at = said_.find(text, heard_);
    is_said = at != std::string::npos;
    if (is_said) heard_ = at + text.size();
    return is_said || !runs;
  };
  return eventually(done) && is_said;
}

void Terminal::press(std::string_view keys) const {
  [[maybe_unused]] const auto written = write(terminal_, keys.data(), keys.size());
}

int Terminal::wait() {
  if (pid_ <= 0) return exit_code_;
  if (!eventually([&] { return !read_some(); })) kill(pid_, SIGKILL);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace handcast::system_test
