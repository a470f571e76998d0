// SPDX-License-Identifier: Apache-2.0
#include "services/tools/devices/ask.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::devices {
namespace {

/// Starts a program, whose descriptor `what` becomes `out`. -1 if it cannot be started.
pid_t start(std::vector<std::string> words, int what, int out) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out, what);
  pid_t child = -1;
  const int failed =
      posix_spawn(&child, arguments.front(), &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return failed ? -1 : child;
}

std::string read_to_end(int fd) {
  std::string text;
  std::array<char, 4096> bytes;
  for (ssize_t count = 0; (count = ::read(fd, bytes.data(), bytes.size())) != 0;) {
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) break;
  }
  return text;
}

}  // namespace

std::optional<Answer> ask(std::vector<std::string> words, int what) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const UniqueFd from(ends[0]);
  UniqueFd to(ends[1]);
  const auto child = start(std::move(words), what, to.get());
  to = UniqueFd();
  if (child < 0) return std::nullopt;
  Answer answer{0, read_to_end(from.get())};
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kExitBadResult;
  return answer;
}

}  // namespace handcast::devices
